//! The data of a finished run.
//!
//! Rendering and measuring fill it. Tables, plots and the page depend only on it, so that they can be tested
//! without a GPU.

use std::path::PathBuf;

use serde::{Serialize, Serializer};
use shadowfit_params::tool::LightSettings;

/// Names of columns, such as `wrong %`, and their values. A value that could not be measured is NaN.
pub type Columns = Vec<(String, f64)>;

/// The column for ranking techniques.
pub const WRONG: &str = "wrong %";

/// Techniques compared over the frames of a path.
#[derive(Clone, Debug, Serialize)]
pub struct Run {
    /// Title of the page.
    pub title: String,
    /// Name or file of the scene.
    pub scene: String,
    /// Number of triangles.
    pub triangles: u64,
    /// Width and height of the pictures, in pixels.
    pub size: [u32; 2],
    /// Graphics adapter that rendered.
    pub adapter: String,
    /// The sun, if it is the same in all frames.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light: Option<LightSettings>,
    /// Remarks on the measurement, in whole sentences.
    pub notes: Vec<String>,
    /// Parts of the scene that import skipped, replaced or repaired. The pictures may lack them.
    pub scene_notes: Vec<String>,
    /// Frames that were measured, in their order.
    pub frames: Vec<FrameInfo>,
    /// Techniques, one for each row of the tables.
    pub techniques: Vec<TechniqueRun>,
    /// Whether all frames were measured. False if the run was stopped early.
    pub finished: bool,
}

/// A frame of the path.
#[derive(Clone, Debug, Serialize)]
pub struct FrameInfo {
    /// Name, such as `orbit/3`.
    pub name: String,
    /// Part of the path, such as `orbit`.
    pub group: String,
}

/// The results of one technique. All lists of columns have the same names in the same order.
#[derive(Clone, Debug, Serialize)]
pub struct TechniqueRun {
    /// Name in tables.
    pub name: String,
    /// Description in a sentence.
    pub what: String,
    /// Settings as TOML, for display.
    pub settings: String,
    /// Columns of all frames pooled.
    #[serde(serialize_with = "as_map")]
    pub overall: Columns,
    /// Columns of each group, with its frames pooled.
    #[serde(serialize_with = "as_map_of_maps")]
    pub groups: Vec<(String, Columns)>,
    /// Columns of each frame, in the order of [`Run::frames`].
    #[serde(serialize_with = "as_maps")]
    pub frames: Vec<Columns>,
    /// Pictures of some frames.
    pub pictures: Vec<FramePictures>,
}

/// Pictures of a frame: PNG files, relative to the output folder.
#[derive(Clone, Debug, Serialize)]
pub struct FramePictures {
    /// Index in [`Run::frames`].
    pub frame: usize,
    /// Picture with marked wrong pixels.
    pub overlay: PathBuf,
    /// Heat map of pixels per texel.
    pub heat: PathBuf,
    /// Picture as rendered.
    pub picture: PathBuf,
}

/// The good end of a column's values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Better {
    /// Low values are good.
    Lower,
    /// High values are good.
    Higher,
    /// The column describes a technique without rating it.
    Neither,
}

/// Returns the value of a column, if it exists and is not NaN.
pub fn value(columns: &Columns, name: &str) -> Option<f64> {
    columns.iter().find(|(known, _)| known == name).map(|(_, value)| *value).filter(|value| !value.is_nan())
}

/// Returns the good end of a column's values. Errors, sizes and times are low in a good technique.
pub fn better(column: &str) -> Better {
    match column {
        "used %" | "still %" | "kept %" => Better::Higher,
        "maps" | "frames" | "facing" | "edge zone %" | "grazing %" | "texels" => Better::Neither,
        _ => Better::Lower,
    }
}

/// Returns the meaning of a column in a sentence, or `None` for an unknown column.
pub fn meaning(column: &str) -> Option<&'static str> {
    Some(match column {
        "wrong %" => "Pixels that face the light and whose verdict, lit or shadowed, differs from the ray-traced truth",
        "light error %" => {
            "Mean of |factor − truth| · N·L over the mean of N·L: the error in per cent of the sunlight that arrives without shadows"
        }
        "flip" => {
            "ꟻLIP error (0 to 1) between the shaded picture and the same picture with ray-traced shadows: how much people see"
        }
        "false shadow %" => "Lit in truth, shadowed by the map, away from shadow edges: acne",
        "false light %" => "Shadowed in truth, lit by the map though an occluder is in it: peter-panning, leaks",
        "hole %" => "Shadowed in truth, lit because no occluder is in the map, or no map covers the point",
        "edge %" => "Wrong within the reach of the filter or a texel from a true shadow edge: aliasing",
        "edge zone %" => "Pixels near a true shadow edge, right or wrong",
        "edge px" => "Mean distance from true shadow edges to those of the map, in pixels, at most 32",
        "mean error %" => "Mean difference between the filtered factor and the truth",
        "grazing %" => "Pixels that the light barely grazes (cosine below 0.05); they count in all but the ppt columns",
        "grazing wrong %" => "Wrong pixels among the grazing ones, as a share of all that face the light",
        "ppt p50" => "Screen pixels per shadow texel along the worse axis, median",
        "ppt p95" => "Screen pixels per shadow texel along the worse axis, 95% quantile; 1 or less is sharp",
        "ppt p99" => "Screen pixels per shadow texel along the worse axis, 99% quantile",
        "ppt > 1 %" => "Pixels with more than a pixel per texel, where texels show",
        "crawl %" => "Edge points whose verdict changes though only the camera moved: shimmering",
        "change %" => "Mean change of the shadow at the same points though only the camera moved",
        "area error %" => "Mean difference from the light on the pixel's whole area, where it shows one surface",
        "area error several %" => "Mean difference from the light on the pixel's area, where it shows several surfaces",
        "traced %" => "Facing pixels that were decided by rays",
        "uncov %" => "Points that face the light and that no map holds",
        "missed %" => "Points that face the light and lie outside of the map that is read for them",
        "crit res" => "Side of a map, in texels, that would give 95% of the points a texel per pixel",
        "crit gm" => "Geometric mean of the groups' critical resolutions, in texels",
        "used %" => "Share of the maps' area that visible points need",
        _ => return None,
    })
}

/// Returns the mean of wrong % over the techniques at a frame. Tables and the choice of frames use it.
fn wrong_at(run: &Run, frame: usize) -> Option<f64> {
    let values: Vec<f64> =
        run.techniques.iter().filter_map(|technique| value(technique.frames.get(frame)?, WRONG)).collect();
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Returns the worst, the median and the best of some frames, each once, by the mean of wrong % over the
/// techniques.
pub fn telling(run: &Run, frames: impl Iterator<Item = usize>) -> Vec<(usize, &'static str)> {
    let mut ranked: Vec<(usize, f64)> = frames.filter_map(|frame| Some((frame, wrong_at(run, frame)?))).collect();
    ranked.sort_by(|a, b| b.1.total_cmp(&a.1));
    let Some(last) = ranked.len().checked_sub(1) else { return Vec::new() };
    let mut chosen: Vec<(usize, &'static str)> = Vec::new();
    for (rank, why) in [(0, "Worst frame"), (ranked.len() / 2, "Median frame"), (last, "Best frame")] {
        if chosen.iter().all(|(frame, _)| *frame != ranked[rank].0) {
            chosen.push((ranked[rank].0, why));
        }
    }
    chosen
}

/// Serializes columns as a map in their order, with `null` for values that are not numbers.
struct Map<'a>(&'a Columns);

impl Serialize for Map<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        as_map(self.0, serializer)
    }
}

fn as_map<S: Serializer>(columns: &Columns, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(columns.iter().map(|(name, value)| (name, value)))
}

fn as_map_of_maps<S: Serializer>(groups: &[(String, Columns)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(groups.iter().map(|(name, columns)| (name, Map(columns))))
}

fn as_maps<S: Serializer>(frames: &[Columns], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(frames.iter().map(Map))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Returns a run of two techniques over an orbit of three frames and a flight of two. The second
    /// technique is better in all columns except its false light.
    pub(crate) fn run() -> Run {
        let frame = |name: &str| FrameInfo { name: name.into(), group: name.split('/').next().unwrap_or(name).into() };
        Run {
            title: "Courtyard <1>".into(),
            scene: "courtyard.glb".into(),
            triangles: 1_234_567,
            size: [64, 36],
            adapter: "software".into(),
            light: Some(LightSettings::default()),
            notes: vec!["A note & more.".into()],
            scene_notes: vec!["images[0]: replaced by a placeholder".into(), "points <skipped>".into()],
            frames: ["orbit/0", "orbit/1", "orbit/2", "fly-through/0", "fly-through/1"].map(frame).into(),
            techniques: vec![technique("xna", 4.0), technique("focused | best", 1.0)],
            finished: true,
        }
    }

    fn technique(name: &str, factor: f64) -> TechniqueRun {
        let columns = |wrong: f64| -> Columns {
            let values =
                [("wrong %", wrong * factor), ("false light %", 1.0 / factor), ("maps", factor), ("crawl %", f64::NAN)];
            values.map(|(name, value)| (name.to_owned(), value)).into()
        };
        TechniqueRun {
            name: name.into(),
            what: format!("The {name} fit."),
            settings: "kind = \"Sphere\"\nmargin = 0.1\n".into(),
            overall: columns(3.0),
            groups: vec![("orbit".into(), columns(2.0)), ("fly-through".into(), columns(4.5))],
            frames: [1.0, 2.0, 3.0, 4.0, 5.0].map(columns).into(),
            pictures: Vec::new(),
        }
    }

    #[test]
    fn values_that_are_not_numbers_are_not_there() {
        let run = run();
        assert_eq!(value(&run.techniques[0].overall, "wrong %"), Some(12.0));
        assert_eq!(value(&run.techniques[0].overall, "crawl %"), None);
        assert_eq!(value(&run.techniques[0].overall, "nothing"), None);
        assert_eq!((wrong_at(&run, 1), wrong_at(&run, 9)), (Some(5.0), None));
    }

    #[test]
    fn every_column_of_a_picture_is_explained() {
        for (column, _) in shadowfit_truth::PictureTally::default().columns() {
            assert!(meaning(column).is_some(), "{column}");
        }
    }
}
