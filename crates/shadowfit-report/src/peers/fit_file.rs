//! Fit files: the maps that a fit computed for each frame (`fits/<peer>.json`).

use std::collections::HashMap;
use std::path::Path;

use glam::{DMat4, DVec2, DVec3};
use serde::{Deserialize, Serialize};

use super::error::{PeersError, Problem, check_finite, read_json};
use super::scenarios::Scenarios;
use super::whole;
use shadowfit_truth::MeasuredMap;

/// The content of a fit file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FitFile {
    /// Name of the fit.
    pub peer: String,
    /// Language of the code that ran.
    #[serde(default)]
    pub language: String,
    /// Version of the code that ran.
    #[serde(default)]
    pub version: String,
    /// Remarks.
    #[serde(default)]
    pub note: String,
    /// Whether the renderer clamps depth, so that casters before the near plane still cast shadows;
    /// `pancake` in the file.
    #[serde(default, rename = "pancake")]
    pub depth_clamp: bool,
    /// Median time for fitting one frame, in nanoseconds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ns_per_fit: Option<f64>,
    /// Median over frames of each frame's fastest batch, in nanoseconds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ns_quiet: Option<f64>,
    /// Frames: each frame of the scenarios exactly once, in any order.
    pub frames: Vec<FitFrame>,
}

/// The maps of a frame.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FitFrame {
    /// Name of the frame, [`super::Frame::id`].
    pub id: String,
    /// Maps, in order of `split_far`.
    pub maps: Vec<FitMap>,
}

/// A shadow map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FitMap {
    /// Clip-from-world matrix, column-major. x and y are in -1..=1 (y up), and depth is in 0..=1 after
    /// division by w, plain or reversed. Perspective is allowed.
    pub view_proj: [f64; 16],
    /// Side of a square map, in texels.
    #[serde(default, deserialize_with = "whole::number")]
    pub resolution: u32,
    /// Width and height of a map that is not square, in texels. If present, `resolution` is ignored.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "whole::pair")]
    pub resolution_xy: Option<[u32; 2]>,
    /// View depth at which the map begins, in metres. The measures ignore it.
    #[serde(default)]
    pub split_near: f64,
    /// View depth at which the map ends, in metres. A point reads the first map that ends beyond its view
    /// depth. [`Self::NO_END`] means that the map does not end.
    pub split_far: f64,
}

impl FitMap {
    /// Smallest `split_far` that means "no end", in metres. JSON has no infinity.
    pub const NO_END: f64 = 1e9;

    /// Returns width and height, in texels.
    pub fn size(&self) -> DVec2 {
        let [width, height] = self.resolution_xy.unwrap_or([self.resolution; 2]);
        DVec2::new(f64::from(width), f64::from(height))
    }

    /// Returns the clip-from-world matrix.
    pub fn clip_from_world(&self) -> DMat4 {
        DMat4::from_cols_array(&self.view_proj)
    }

    /// Returns the map in the form for the measures. `to_light` is the unit direction toward the light, world
    /// axes.
    pub fn measured(&self, to_light: DVec3) -> MeasuredMap {
        MeasuredMap::new(&self.clip_from_world(), self.size(), self.split_far, to_light)
    }
}

impl FitFile {
    /// Reads and checks a file.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, does not have this format, or contains an impossible value.
    pub fn read(file: &Path) -> Result<Self, PeersError> {
        let fit: Self = read_json(file)?;
        fit.check().map_err(|problem| problem.at(file))?;
        Ok(fit)
    }

    /// Returns JSON text that [`FitFile::read`] reads back to the same values. `file` is named in errors.
    ///
    /// # Errors
    ///
    /// If a value is impossible.
    pub fn to_json(&self, file: &Path) -> Result<String, PeersError> {
        self.check().map_err(|problem| problem.at(file))?;
        let failed = |error: serde_json::Error| Problem::new("file", error.to_string()).at(file);
        Ok(serde_json::to_string(self).map_err(failed)? + "\n")
    }

    /// Returns the maps of each frame, in the order of the scenarios' frames. `file` is named in errors.
    ///
    /// # Errors
    ///
    /// If a frame is missing, occurs twice, or is unknown in the scenarios.
    pub fn maps_in_order(&self, scenarios: &Scenarios, file: &Path) -> Result<Vec<&[FitMap]>, PeersError> {
        let problem = |index: usize, reason: String| Problem::new(format!("frames[{index}].id"), reason).at(file);
        let indices: HashMap<&str, usize> =
            scenarios.frames.iter().enumerate().map(|(index, frame)| (frame.id.as_str(), index)).collect();
        let mut maps: Vec<Option<&[FitMap]>> = vec![None; scenarios.frames.len()];
        for (index, frame) in self.frames.iter().enumerate() {
            let Some(&wanted) = indices.get(frame.id.as_str()) else {
                return Err(problem(index, format!("the scenarios have no frame \"{}\"", frame.id)));
            };
            if maps[wanted].replace(&frame.maps).is_some() {
                return Err(problem(index, format!("frame \"{}\" occurs twice", frame.id)));
            }
        }
        let missing = |index: usize| format!("frame \"{}\" of the scenarios is missing", scenarios.frames[index].id);
        maps.iter()
            .enumerate()
            .map(|(index, maps)| maps.ok_or_else(|| Problem::new("frames", missing(index)).at(file)))
            .collect()
    }

    pub(super) fn check(&self) -> Result<(), Problem> {
        for (index, frame) in self.frames.iter().enumerate() {
            for (number, map) in frame.maps.iter().enumerate() {
                map.check(&|field| format!("frames[{index}] (\"{}\").maps[{number}].{field}", frame.id))?;
            }
            if let Some(number) = frame.maps.windows(2).position(|pair| pair[0].split_far > pair[1].split_far) {
                let element = format!("frames[{index}] (\"{}\").maps[{}].split_far", frame.id, number + 1);
                return Err(Problem::new(element, "the maps are not in order of split_far"));
            }
        }
        Ok(())
    }
}

impl FitMap {
    fn check(&self, element: &impl Fn(&str) -> String) -> Result<(), Problem> {
        check_finite(|| element("view_proj"), &self.view_proj)?;
        check_finite(|| element("split_far"), &[self.split_far])?;
        if !self.clip_from_world().inverse().is_finite() {
            return Err(Problem::new(element("view_proj"), "the matrix has no inverse"));
        }
        if self.size().min_element() < 1.0 {
            return Err(Problem::new(element("resolution"), "the map has no texels"));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::peers::closed_form::{Room, scenarios};
    use crate::peers::error::parse_json;

    fn fit() -> FitFile {
        let maps = vec![Room::map(), FitMap { split_far: 1e9, resolution_xy: Some([64, 32]), ..Room::map() }];
        let frame = |id: &str| FitFrame { id: id.to_owned(), maps: maps.clone() };
        let frames = vec![frame("room/90/1"), frame("room/90/0")];
        FitFile { peer: "tested".to_owned(), depth_clamp: true, ns_per_fit: Some(0.1), frames, ..FitFile::default() }
    }

    fn file() -> &'static Path {
        Path::new("fits/tested.json")
    }

    #[test]
    fn a_written_file_reads_back_the_same() {
        let folder = std::env::temp_dir().join(format!("shadowfit-fit-file-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a new folder");
        let file = folder.join("fit.json");
        let mut fit = fit();
        fit.frames[0].maps[0].view_proj[5] = 0.1 + 0.2;
        std::fs::write(&file, fit.to_json(&file).expect("a text")).expect("written");
        let read = FitFile::read(&file);
        std::fs::remove_dir_all(&folder).expect("removed");
        assert_eq!(read, Ok(fit));
    }

    #[test]
    fn frames_in_any_order_are_put_in_that_of_the_scenarios() {
        let mut fit = fit();
        fit.frames[1].maps.pop();
        let scenarios = scenarios(2);
        let maps = fit.maps_in_order(&scenarios, file()).expect("all frames");
        assert_eq!(maps.iter().map(|maps| maps.len()).collect::<Vec<_>>(), [1, 2]);
    }

    #[test]
    fn a_frame_that_is_missing_unknown_or_given_twice_is_named() {
        let scenarios = scenarios(2);
        let refused = |ids: &[&str]| {
            let frames = ids.iter().map(|id| FitFrame { id: (*id).to_owned(), maps: Vec::new() }).collect();
            let fit = FitFile { frames, ..FitFile::default() };
            fit.maps_in_order(&scenarios, file()).expect_err("refused").to_string()
        };
        let missing = "fits/tested.json: frames: frame \"room/90/1\" of the scenarios is missing";
        assert_eq!(refused(&["room/90/0"]), missing);
        let twice = "fits/tested.json: frames[1].id: frame \"room/90/0\" occurs twice";
        assert_eq!(refused(&["room/90/0", "room/90/0"]), twice);
        let unknown = "fits/tested.json: frames[0].id: the scenarios have no frame \"hall/1/0\"";
        assert_eq!(refused(&["hall/1/0"]), unknown);
    }

    #[test]
    fn impossible_maps_are_refused_by_element_and_reason() {
        let refused = |change: fn(&mut FitMap)| {
            let mut fit = fit();
            change(&mut fit.frames[0].maps[1]);
            fit.check().expect_err("refused").at(file()).to_string()
        };
        let element = "fits/tested.json: frames[0] (\"room/90/1\").maps[1]";
        assert_eq!(refused(|map| map.view_proj[3] = f64::NAN), format!("{element}.view_proj: NaN is not finite"));
        assert_eq!(refused(|map| map.view_proj = [0.0; 16]), format!("{element}.view_proj: the matrix has no inverse"));
        assert_eq!(
            refused(|map| map.resolution_xy = Some([0, 1])),
            format!("{element}.resolution: the map has no texels")
        );
        assert_eq!(
            refused(|map| map.split_far = 0.0),
            format!("{element}.split_far: the maps are not in order of split_far")
        );
        assert!(refused(|map| map.split_far = f64::INFINITY).ends_with("split_far: inf is not finite"));
    }

    #[test]
    fn json_of_another_shape_is_refused_by_its_path() {
        let problem = |text: &str| parse_json::<FitFile>(text.as_bytes()).expect_err("refused").at(file()).to_string();
        let map = r#"{"peer": "a", "frames": [{"id": "b", "maps": [{"view_proj": [1, 2], "split_far": 1}]}]}"#;
        assert!(problem(map).starts_with("fits/tested.json: frames[0].maps[0].view_proj"), "{}", problem(map));
        assert!(problem("{").starts_with("fits/tested.json: file: EOF"), "{}", problem("{"));
        assert!(problem("{\"peer\": \"a\", \"frames\": []} x").contains("trailing"));
    }
    fn parsed(text: &str) -> Result<FitFile, PeersError> {
        parse_json(text.as_bytes()).map_err(|problem| problem.at(file()))
    }

    /// Returns a file with a single map that has these additional fields.
    fn with_fields(fields: &str) -> String {
        let map = serde_json::to_string(&Room::map()).expect("JSON");
        let plain = map.replace("\"resolution\":1024,", "");
        assert_ne!(map, plain);
        let map = plain.replacen('{', &format!("{{{fields}, "), 1);
        format!(r#"{{"peer": "a", "frames": [{{"id": "b", "maps": [{map}]}}]}}"#)
    }

    #[test]
    fn sizes_are_read_with_and_without_a_point() {
        let size = |fields: &str| parsed(&with_fields(fields)).expect("a fit file").frames[0].maps[0].size();
        assert_eq!(size(r#""resolution": 2048"#), DVec2::splat(2048.0));
        assert_eq!(size(r#""resolution": 2048.0"#), DVec2::splat(2048.0));
        assert_eq!(size(r#""resolution_xy": [64.0, 32]"#), DVec2::new(64.0, 32.0));
    }

    #[test]
    fn sizes_that_are_not_whole_or_negative_are_refused_by_element_and_reason() {
        let refused = |fields: &str| parsed(&with_fields(fields)).expect_err("refused").to_string();
        let cases = [
            (r#""resolution": 2048.5"#, "resolution: 2048.5 is not a whole number"),
            (r#""resolution": -1.0"#, "resolution: -1.0 is negative"),
            (r#""resolution_xy": [64, 32.5]"#, "resolution_xy[1]: 32.5 is not a whole number"),
        ];
        for (fields, reason) in cases {
            let message = refused(fields);
            let wanted = format!("fits/tested.json: frames[0].maps[0].{reason}");
            assert!(message.starts_with(&wanted), "{message}");
        }
    }
}
