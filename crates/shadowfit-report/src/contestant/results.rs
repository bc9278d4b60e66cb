//! The results of judged contestants as tables for people, as JSON for programs, and as the run of a page.

use std::collections::BTreeMap;

use serde_json::{Value, json};
use shadowfit_truth::PictureTally;

use super::sums::Sums;
use crate::markdown::{markdown_table, readable};
use crate::peers::Frame;
use crate::run::{Columns, FrameInfo, Run, TechniqueRun};

/// Columns of the Markdown tables. JSON and pages have all columns.
const COLUMNS: [&str; 10] = [
    "wrong %",
    "light error %",
    "flip",
    "crawl %",
    "change %",
    "hole %",
    "uncov %",
    "missed %",
    "false shadow %",
    "false light %",
];
/// Columns that are followed by their ratio to the reference technique.
const COMPARED: [&str; 4] = ["wrong %", "light error %", "crawl %", "change %"];

/// The results of all techniques.
#[derive(Clone, Debug, Default)]
pub struct Results {
    /// Names of the techniques.
    pub techniques: Vec<String>,
    /// Judged frames, in their order.
    pub frames: Vec<FrameResult>,
}

/// A judged frame.
#[derive(Clone, Debug)]
pub struct FrameResult {
    /// Name of the scene.
    pub scene: String,
    /// Elevation of the light over the horizon, in degrees.
    pub elevation: f64,
    /// Name of the frame, [`Frame::id`].
    pub frame: String,
    /// Sums of each technique.
    pub sums: Vec<Sums>,
}

/// Facts about a run that the results do not contain.
#[derive(Clone, Debug, Default)]
pub struct RunFacts {
    /// Title of the page.
    pub title: String,
    /// Short description of the scenes.
    pub scene: String,
    /// Number of triangles.
    pub triangles: u64,
    /// Width and height of the pictures, in pixels.
    pub size: [u32; 2],
    /// Graphics adapter that drew.
    pub adapter: String,
    /// Remarks on the measurement, in whole sentences.
    pub notes: Vec<String>,
    /// A sentence about each technique, in the order of the techniques.
    pub descriptions: Vec<String>,
}

/// The sums of a scene under one light.
struct Group<'a> {
    scene: &'a str,
    elevation: f64,
    sums: Vec<Sums>,
}

impl FrameResult {
    pub(super) fn new(scene: &str, frame: &Frame) -> Self {
        let (elevation, id) = (frame.elevation_deg, frame.id.clone());
        Self { scene: scene.to_owned(), elevation, frame: id, sums: Vec::new() }
    }
}

impl Group<'_> {
    fn name(&self) -> String {
        format!("{}/{}", self.scene, self.elevation)
    }
}

impl Results {
    /// Returns the tables in Markdown: all scenes, then each scene. Three columns are followed by their ratio to the
    /// technique of index `reference`.
    pub fn to_markdown(&self, reference: Option<usize>) -> String {
        let groups = self.groups();
        let overall = format!("## Overall\n\n{}", self.table(&groups.iter().collect::<Vec<_>>(), reference));
        let by_scene = groups.chunk_by(|a, b| a.scene == b.scene).map(|groups| {
            let table = self.table(&groups.iter().collect::<Vec<_>>(), reference);
            format!("\n## {}\n\n{table}", groups[0].scene)
        });
        overall + &by_scene.collect::<String>()
    }

    /// Returns all numbers as JSON. `run` describes the measurement.
    pub fn to_json(&self, run: &Value) -> Value {
        let groups = self.groups();
        let of_technique = |(technique, name): (usize, &String)| {
            let by_scene = groups.chunk_by(|a, b| a.scene == b.scene);
            let scenes: BTreeMap<&str, Value> =
                by_scene.map(|groups| (groups[0].scene, columns(&pooled(groups.iter(), technique)))).collect();
            let by_group: BTreeMap<String, Value> =
                groups.iter().map(|group| (group.name(), columns(&group.sums[technique]))).collect();
            let overall = columns(&pooled(groups.iter(), technique));
            json!({ "fit": name, "overall": overall, "scenes": scenes, "groups": by_group })
        };
        let fits: Vec<Value> = self.techniques.iter().enumerate().map(of_technique).collect();
        json!({ "run": run, "fits": fits })
    }

    /// Returns the run for tables, plots and the page, without pictures.
    pub fn to_run(&self, facts: RunFacts) -> Run {
        let groups = self.groups();
        let of_technique = |(technique, name): (usize, &String)| TechniqueRun {
            name: name.clone(),
            what: facts.descriptions.get(technique).cloned().unwrap_or_default(),
            settings: String::new(),
            overall: named(&pooled(groups.iter(), technique)),
            groups: groups.iter().map(|group| (group.name(), named(&group.sums[technique]))).collect(),
            frames: self.frames.iter().map(|frame| named(&frame.sums[technique])).collect(),
            pictures: Vec::new(),
        };
        let info = |frame: &FrameResult| FrameInfo {
            name: frame.frame.clone(),
            group: format!("{}/{}", frame.scene, frame.elevation),
        };
        Run {
            techniques: self.techniques.iter().enumerate().map(of_technique).collect(),
            frames: self.frames.iter().map(info).collect(),
            title: facts.title,
            scene: facts.scene,
            triangles: facts.triangles,
            size: facts.size,
            adapter: facts.adapter,
            light: None,
            notes: facts.notes,
            scene_notes: Vec::new(),
            finished: true,
        }
    }

    fn table(&self, groups: &[&Group<'_>], reference: Option<usize>) -> String {
        let ratio = reference.map(|technique| format!("x {}", self.techniques[technique]));
        let reference = reference.map(|technique| pooled(groups.iter().copied(), technique));
        let mut titles = vec!["fit".to_owned()];
        for title in COLUMNS {
            titles.push(title.to_owned());
            titles.extend(ratio.clone().filter(|_| COMPARED.contains(&title)));
        }
        let row = |(technique, name): (usize, &String)| {
            let sums = pooled(groups.iter().copied(), technique);
            let mut cells = vec![name.clone()];
            for title in COLUMNS {
                let value = sums.value(title);
                cells.push(readable(value));
                let reference = reference.as_ref().filter(|_| COMPARED.contains(&title));
                cells.extend(reference.map(|reference| readable(value / reference.value(title))));
            }
            cells
        };
        markdown_table(&titles, self.techniques.iter().enumerate().map(row))
    }

    /// Returns the sums of each scene under each light, in the order of the frames.
    fn groups(&self) -> Vec<Group<'_>> {
        let is_same = |a: &FrameResult, b: &FrameResult| a.scene == b.scene && a.elevation == b.elevation;
        let group = |frames: &'_ [FrameResult]| {
            let mut sums = vec![Sums::default(); self.techniques.len()];
            for frame in frames {
                sums.iter_mut().zip(&frame.sums).for_each(|(sums, frame)| sums.merge(frame));
            }
            sums
        };
        let groups = self.frames.chunk_by(is_same);
        groups
            .map(|frames| Group { scene: &frames[0].scene, elevation: frames[0].elevation, sums: group(frames) })
            .collect()
    }
}

/// Adds the sums of some groups for one technique.
fn pooled<'a>(groups: impl Iterator<Item = &'a Group<'a>>, technique: usize) -> Sums {
    let mut sums = Sums::default();
    groups.for_each(|group| sums.merge(&group.sums[technique]));
    sums
}

fn named(sums: &Sums) -> Columns {
    sums.columns().into_iter().map(|(title, value)| (title.to_owned(), value)).collect()
}

/// Returns the columns of some sums, and the pixel counts behind them.
fn columns(sums: &Sums) -> Value {
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
}
