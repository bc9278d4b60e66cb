//! The report as tables for people and as JSON for programs.

use std::collections::BTreeMap;

use serde_json::{Value, json};
use shadowfit_truth::PictureTally;
use shadowfit_truth::peers::{markdown_table, readable};

use crate::contestant::Entrant;
use crate::measure::Sums;

/// Columns of the tables; JSON has all.
const COLUMNS: [&str; 8] =
    ["wrong %", "crawl %", "change %", "hole %", "uncov %", "missed %", "false shadow %", "false light %"];
/// Columns that are followed by their ratio to those of Bevy's cascades with Bevy's bias.
const COMPARED: [&str; 3] = ["wrong %", "crawl %", "change %"];

/// What was measured of one of the fits: sums by scene and elevation of the light, in the order of the frames.
pub(crate) struct Measured {
    pub(crate) entrant: Entrant,
    pub(crate) groups: Vec<(String, f64, Sums)>,
}

impl Measured {
    /// Sums of the groups of a scene, or of all scenes.
    fn sums(&self, scene: Option<&str>) -> Sums {
        let mut sums = Sums::default();
        for (_, _, group) in self.groups.iter().filter(|(name, ..)| scene.is_none_or(|scene| scene == name)) {
            sums.merge(group);
        }
        sums
    }

    fn scenes(&self) -> Vec<&str> {
        let mut scenes: Vec<&str> = self.groups.iter().map(|(name, ..)| name.as_str()).collect();
        scenes.dedup();
        scenes
    }
}

/// All tables, in Markdown.
pub(crate) fn markdown(fits: &[Measured]) -> String {
    let scenes = fits.first().map(Measured::scenes).unwrap_or_default();
    let overall = format!("## Overall\n\n{}", table(fits, None));
    let of_scene = |scene: &str| format!("\n## {scene}\n\n{}", table(fits, Some(scene)));
    overall + &scenes.into_iter().map(of_scene).collect::<String>()
}

fn table(fits: &[Measured], scene: Option<&str>) -> String {
    let bevy = fits.iter().find(|fit| fit.entrant == Entrant::BEVY).map(|fit| fit.sums(scene));
    let mut titles = vec!["fit".to_owned()];
    for title in COLUMNS {
        titles.push(title.to_owned());
        if COMPARED.contains(&title) {
            titles.push("x bevy".to_owned());
        }
    }
    let row = |fit: &Measured| {
        let sums = fit.sums(scene);
        let mut cells = vec![fit.entrant.name()];
        for title in COLUMNS {
            let value = sums.value(title);
            cells.push(readable(value));
            if COMPARED.contains(&title) {
                let of_bevy = bevy.as_ref().map_or(f64::NAN, |bevy| bevy.value(title));
                cells.push(readable(value / of_bevy));
            }
        }
        cells
    };
    markdown_table(&titles, fits.iter().map(row))
}

/// All numbers. `run` says how they were measured.
pub(crate) fn json(fits: &[Measured], run: Value) -> Value {
    let columns = |sums: &Sums| {
        let of_column = |(title, value): (&'static str, f64)| (title, Some(value).filter(|value| value.is_finite()));
        let columns: BTreeMap<&str, Option<f64>> = sums.columns().into_iter().map(of_column).collect();
        let PictureTally { frames, all, edge_zone, crawl_compared, crawl_different, .. } = &sums.tally;
        json!({
            "frames": frames,
            "pixels": all.facing,
            "wrong pixels": all.wrong,
            "pixels in edge zones": edge_zone,
            "pixels compared for crawl": crawl_compared,
            "pixels that crawl": crawl_different,
            "columns": columns,
        })
    };
    let of_fit = |fit: &Measured| {
        let scenes: BTreeMap<&str, Value> =
            fit.scenes().into_iter().map(|scene| (scene, columns(&fit.sums(Some(scene))))).collect();
        let groups: BTreeMap<String, Value> =
            fit.groups.iter().map(|(scene, light, sums)| (format!("{scene}/{light}"), columns(sums))).collect();
        let overall = columns(&fit.sums(None));
        json!({ "fit": fit.entrant.name(), "overall": overall, "scenes": scenes, "groups": groups })
    };
    json!({ "run": run, "fits": fits.iter().map(of_fit).collect::<Vec<_>>() })
}
