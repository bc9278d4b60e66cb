//! Files of camera paths, TOML or JSON by their extension.
//!
//! A file holds a few keys, and frames are interpolated between them. People write these files by hand, so
//! errors name file, element and reason.

use std::fmt::Display;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail, ensure};
use glam::{DVec3, Vec3};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use shadowfit::{Camera, Lens};
use shadowfit_params::tool::LightSettings;

use super::{CameraPath, PathFrame};

/// Greatest number of frames of a path. Rendering more would take too long, so a larger number is a mistake.
const MAX_FRAMES: u64 = 100_000;
/// Range of the vertical field of view, in degrees. Values outside are mistakes.
const FOV_RANGE: std::ops::RangeInclusive<f64> = 0.1..=179.5;
/// Number of decimals of an angle that is enough to restore every f32.
const MAX_DECIMALS: i32 = 12;
/// Group of keys without a group.
const DEFAULT_GROUP: &str = "path";

/// The content of a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PathFile {
    /// Vertical field of view, in degrees.
    #[serde(default = "default_fov")]
    fov_y_deg: f64,
    /// Height of an orthographic picture, in metres, used instead of the field of view.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    height: Option<f64>,
    /// View depth of the near plane, in metres.
    near: f64,
    /// View depth of the far plane, in metres.
    far: f64,
    /// Direction that appears upward.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    up: Option<[f32; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    light: Option<FileLight>,
    /// Number of frames from one key to the next.
    #[serde(default = "one")]
    frames_per_key: u64,
    keys: Vec<Key>,
}

/// The sun, as the direction toward it, in degrees.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FileLight {
    /// Azimuth from +z toward +x.
    azimuth_deg: f64,
    /// Elevation above the horizon.
    elevation_deg: f64,
}

/// A camera. It has either `target` or `forward`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Key {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    group: Option<String>,
    /// World space, metres.
    eye: [f64; 3],
    /// World space, metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    target: Option<[f64; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    forward: Option<[f32; 3]>,
    /// Direction that appears upward, in place of the file's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    up: Option<[f32; 3]>,
}

/// A key whose numbers have been checked.
struct View {
    eye: DVec3,
    forward: Vec3,
    /// Direction that appears upward, if it differs from the file's.
    up: Option<Vec3>,
    group: String,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Format {
    Toml,
    Json,
}

fn default_fov() -> f64 {
    60.0
}

fn one() -> u64 {
    1
}

impl CameraPath {
    /// Reads a path for pictures of `aspect` (width divided by height). Between keys of a group, positions
    /// are interpolated linearly and directions along the arc.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, does not have this format, or contains an impossible value.
    pub(crate) fn read(file: &Path, aspect: f32) -> Result<Self> {
        let read = || {
            let format = Format::of(file)?;
            let text = fs::read_to_string(file).map_err(|error| anyhow!("file: cannot be read: {error}"))?;
            Self::parse(&text, format, aspect)
        };
        read().with_context(|| format!("{}: not a camera path", file.display()))
    }

    /// Parses TOML, as [`Self::read`] does.
    ///
    /// # Errors
    ///
    /// As [`Self::read`].
    pub(crate) fn from_toml(text: &str, aspect: f32) -> Result<Self> {
        Self::parse(text, Format::Toml, aspect)
    }

    /// Returns the text of a file that [`Self::read`] reads back without loss, with a key for each frame. It
    /// is JSON if the extension of `file` is `json`, else TOML.
    ///
    /// # Errors
    ///
    /// If the path is empty, or its frames differ in their lens, which a file stores only once.
    pub(crate) fn to_text(&self, file: &Path) -> Result<String> {
        let content = self.content()?;
        match Format::of(file)? {
            Format::Toml => Ok(toml::to_string(&content)?),
            Format::Json => Ok(serde_json::to_string_pretty(&content)? + "\n"),
        }
    }

    fn parse(text: &str, format: Format, aspect: f32) -> Result<Self> {
        let content: PathFile = format.parse(text)?;
        let lens = content.lens(aspect)?;
        let views: Vec<View> = content.keys.iter().enumerate().map(view).collect::<Result<_>>()?;
        let frames = content.frames(lens, &views)?;
        Ok(Self { frames, light: content.light.map(sun).transpose()? })
    }

    fn content(&self) -> Result<PathFile> {
        let Some(PathFrame { camera: lens, .. }) = self.frames.first() else { bail!("a path without frames") };
        let shared = |camera: &Camera| (camera.lens, camera.near, camera.far);
        let keys = self.frames.iter().map(|PathFrame { camera, group }| {
            ensure!(shared(camera) == shared(lens), "the frames differ in lens, near or far; a file has one of each");
            let (eye, forward) = (camera.eye.to_array(), camera.forward.to_array());
            let up = (camera.up != lens.up).then(|| camera.up.to_array());
            Ok(Key { group: Some(group.clone()), eye, target: None, forward: Some(forward), up })
        });
        let (fov_y_deg, height) = match lens.lens {
            Lens::Perspective { fov_y } => (degrees(fov_y), None),
            Lens::Orthographic { half_height } => (default_fov(), Some(2.0 * decimal(half_height))),
        };
        Ok(PathFile {
            fov_y_deg,
            height,
            near: decimal(lens.near),
            far: decimal(lens.far),
            up: (lens.up != Vec3::Y).then(|| lens.up.to_array()),
            light: self.light.map(|light| FileLight {
                azimuth_deg: degrees(light.azimuth),
                elevation_deg: degrees(light.elevation),
            }),
            frames_per_key: 1,
            keys: keys.collect::<Result<_>>()?,
        })
    }
}

impl Format {
    fn of(file: &Path) -> Result<Self> {
        match file.extension().and_then(|extension| extension.to_str()) {
            Some("toml") => Ok(Self::Toml),
            Some("json") => Ok(Self::Json),
            _ => bail!("file: the name ends neither in .toml nor in .json; name it after what it holds"),
        }
    }

    /// Parses text. Errors begin with the path of the element, such as `keys[3].eye`.
    fn parse<T: DeserializeOwned>(self, text: &str) -> Result<T> {
        match self {
            Self::Toml => {
                let document = toml::Deserializer::parse(text)
                    .map_err(|error| anyhow!("file{}: {}", line(text, &error), error.message()))?;
                serde_path_to_error::deserialize(document)
                    .map_err(|error| refused(error.path(), error.inner().message(), &line(text, error.inner())))
            }
            Self::Json => {
                let mut json = serde_json::Deserializer::from_str(text);
                let value = serde_path_to_error::deserialize(&mut json)
                    .map_err(|error| refused(error.path(), error.inner(), ""))?;
                json.end().map_err(|error| anyhow!("file: {error}"))?;
                Ok(value)
            }
        }
    }
}

/// Returns a readable error for the position at which serde stopped.
fn refused(path: &serde_path_to_error::Path, reason: impl Display, line: &str) -> anyhow::Error {
    let path = path.to_string();
    // serde's path of the whole file is "." or, if nothing was read, "?".
    let element = if matches!(path.as_str(), "." | "?") { "file" } else { &path };
    anyhow!("{element}{line}: {reason}")
}

/// Returns the position of an error in the text, such as ` (line 4)`.
fn line(text: &str, error: &toml::de::Error) -> String {
    let before = error.span().and_then(|span| text.get(..span.start));
    before.map_or_else(String::new, |before| format!(" (line {})", before.matches('\n').count() + 1))
}

impl PathFile {
    /// Returns a camera at the origin with this file's lens.
    fn lens(&self, aspect: f32) -> Result<Camera> {
        let fov = self.fov_y_deg;
        ensure!(
            FOV_RANGE.contains(&fov),
            "fov_y_deg: {fov} is not between {} and {}",
            FOV_RANGE.start(),
            FOV_RANGE.end()
        );
        let (near, far) = (self.near as f32, self.far as f32);
        ensure!(near.is_finite() && near > 0.0, "near: {} is not a distance above 0 m", self.near);
        ensure!(far.is_finite(), "far: {} is not a distance in metres", self.far);
        ensure!(near < far, "near: {} is not less than far, which is {}", self.near, self.far);
        let up = self.up.map_or(Vec3::Y, Vec3::from_array);
        ensure!(up.is_finite() && up != Vec3::ZERO, "up: {up} is not a direction");
        let is_height = |height: &f64| *height > 0.0 && height.is_finite();
        ensure!(self.height.as_ref().is_none_or(is_height), "height: it is not a number of metres above 0");
        let lens = match self.height {
            Some(height) => Lens::Orthographic { half_height: (height * 0.5) as f32 },
            None => Lens::Perspective { fov_y: radians(fov) },
        };
        Ok(Camera { eye: DVec3::ZERO, forward: Vec3::NEG_Z, up, lens, aspect, near, far })
    }

    fn frames(&self, lens: Camera, views: &[View]) -> Result<Vec<PathFrame>> {
        ensure!(!views.is_empty(), "keys: there are none; a path needs at least one");
        ensure!(self.frames_per_key > 0, "frames_per_key: 0 leaves no frames; 1 renders the keys themselves");
        let count = self.frames_per_key.saturating_mul(views.len() as u64);
        ensure!(
            count <= MAX_FRAMES,
            "frames_per_key: {count} frames are more than the {MAX_FRAMES} that a path may have"
        );
        let mut frames = Vec::new();
        for (index, view) in views.iter().enumerate() {
            let next = views.get(index + 1).filter(|next| next.group == view.group);
            let steps = if next.is_some() { self.frames_per_key } else { 1 };
            for step in 0..steps {
                let (eye, forward) = between(view, next.unwrap_or(view), step as f64 / steps as f64);
                // The key's own up applies until the next key.
                let camera = Camera { eye, forward, up: view.up.unwrap_or(lens.up), ..lens };
                camera.frustum().map_err(|error| {
                    anyhow!("keys[{index}]: it is not a valid camera: {error}; if it looks along up, set another up")
                })?;
                frames.push(PathFrame { camera, group: view.group.clone() });
            }
        }
        Ok(frames)
    }
}

/// Returns position and direction at a share of the way from a view to the next one.
fn between(view: &View, next: &View, share: f64) -> (DVec3, Vec3) {
    if share == 0.0 {
        return (view.eye, view.forward);
    }
    (view.eye.lerp(next.eye, share), view.forward.normalize().slerp(next.forward.normalize(), share as f32))
}

fn view((index, key): (usize, &Key)) -> Result<View> {
    let eye = DVec3::from_array(key.eye);
    ensure!(eye.is_finite(), "keys[{index}].eye: {eye} is not a position in metres");
    let forward = match (key.target, key.forward) {
        (Some(target), None) => {
            toward(eye, DVec3::from_array(target)).with_context(|| format!("keys[{index}].target"))?
        }
        (None, Some(forward)) => Vec3::from_array(forward),
        (None, None) => bail!("keys[{index}]: it has no target and no forward; give one of them"),
        (Some(_), Some(_)) => bail!("keys[{index}]: it has a target and a forward; give one of them only"),
    };
    ensure!(forward.try_normalize().is_some(), "keys[{index}].forward: {forward} is not a direction");
    let group = key.group.clone().unwrap_or_else(|| DEFAULT_GROUP.to_owned());
    let up = key.up.map(Vec3::from_array);
    ensure!(up.is_none_or(|up| up.try_normalize().is_some()), "keys[{index}].up: it is not a direction");
    ensure!(!group.is_empty(), "keys[{index}].group: an empty name; leave it out for \"{DEFAULT_GROUP}\"");
    Ok(View { eye, forward, up, group })
}

/// Returns the unit direction from the eye to its target.
fn toward(eye: DVec3, target: DVec3) -> Result<Vec3> {
    if !target.is_finite() {
        bail!("{target} is not a position in metres");
    }
    if target == eye {
        bail!("it is where the eye is, so there is no viewing direction; move one of them");
    }
    let direction = (target - eye).try_normalize();
    Ok(direction.context("it is too near the eye, or too far from it, to give a direction")?.as_vec3())
}

fn sun(light: FileLight) -> Result<LightSettings> {
    let FileLight { azimuth_deg, elevation_deg } = light;
    ensure!(azimuth_deg.abs() <= 360.0, "light.azimuth_deg: {azimuth_deg} is not between -360 and 360");
    ensure!(
        elevation_deg > 0.0 && elevation_deg <= 90.0,
        "light.elevation_deg: {elevation_deg} is not above 0 and up to 90, so the sun is not in the sky"
    );
    Ok(LightSettings { azimuth: radians(azimuth_deg), elevation: radians(elevation_deg), ..LightSettings::default() })
}

fn radians(degrees: f64) -> f32 {
    degrees.to_radians() as f32
}

/// Returns the shortest number of degrees that converts back to the same radians.
fn degrees(angle: f32) -> f64 {
    let exact = f64::from(angle).to_degrees();
    let rounded = |decimals: i32| {
        let scale = 10f64.powi(decimals);
        (exact * scale).round() / scale
    };
    (0..MAX_DECIMALS).map(rounded).find(|&short| radians(short) == angle).unwrap_or(exact)
}

/// Returns the f64 with the same shortest text as the f32.
fn decimal(value: f32) -> f64 {
    value.to_string().parse().unwrap_or_else(|_| f64::from(value))
}

/// Fuzz target: a path that is accepted must read back equal after writing, as TOML and as JSON.
#[cfg(any(test, fuzzing))]
pub(crate) fn camera_path(data: &[u8]) {
    /// Limit of the frames that are written. Longer paths only take more time.
    const MOST_FRAMES: usize = 1000;
    let Ok(text) = std::str::from_utf8(data) else { return };
    for format in [Format::Toml, Format::Json] {
        let Ok(path) = CameraPath::parse(text, format, 1.5) else { continue };
        if path.frames.len() > MOST_FRAMES {
            continue;
        }
        for (file, format) in [("path.toml", Format::Toml), ("path.json", Format::Json)] {
            let written = path.to_text(Path::new(file)).expect("what was read can be written");
            let read = CameraPath::parse(&written, format, 1.5).unwrap_or_else(|error| panic!("{error:#}: {written}"));
            assert_eq!(read, path, "{written}");
        }
    }
}

#[cfg(test)]
#[path = "../../../../../tests/fuzz/src/corpus.rs"]
mod corpus;

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = r#"
fov_y_deg = 50.0
near = 0.1
far = 200.0
light = { azimuth_deg = 37.0, elevation_deg = 45.0 }
frames_per_key = 2
[[keys]]
eye = [0.0, 1.7, 5.0]
target = [0.0, 1.7, 0.0]
[[keys]]
eye = [2.0, 1.7, 5.0]
forward = [1.0, 0.0, 0.0]
[[keys]]
group = "far"
eye = [9.0, 1.7, 5.0]
forward = [0.0, 0.0, 2.0]
"#;

    fn fov(degrees: f64) -> Lens {
        Lens::Perspective { fov_y: radians(degrees) }
    }

    fn parsed(text: &str) -> Result<CameraPath> {
        CameraPath::parse(text, Format::Toml, 1.5)
    }

    fn refusal(from: &str, to: &str) -> String {
        assert!(GOOD.contains(from), "{from}");
        parsed(&GOOD.replacen(from, to, 1))
            .map_or_else(|error| format!("{error:#}"), |path| format!("accepted: {path:?}"))
    }

    #[test]
    fn what_fuzzing_took_for_paths_is_refused_or_read_back_the_same() {
        corpus::replay("camera_path", camera_path);
    }

    #[test]
    fn positions_go_straight_and_directions_along_the_arc_within_a_group_only() {
        let path = parsed(GOOD).expect("a path");
        let eyes: Vec<_> = path.frames.iter().map(|frame| frame.camera.eye.x).collect();
        assert_eq!(eyes, [0.0, 1.0, 2.0, 9.0]);
        let half = std::f32::consts::FRAC_1_SQRT_2;
        assert!(path.frames[1].camera.forward.abs_diff_eq(Vec3::new(half, 0.0, -half), 1e-6));
        assert_eq!(path.names(), ["path/0", "path/1", "path/2", "far/0"]);
        let camera = path.frames[3].camera;
        assert_eq!((camera.lens, camera.aspect, camera.near, camera.far), (fov(50.0), 1.5, 0.1, 200.0));
        let light = path.light.expect("a sun");
        assert_eq!((light.azimuth, light.elevation), (radians(37.0), std::f32::consts::FRAC_PI_4));
    }

    #[test]
    fn json_means_the_same_as_toml() {
        let json = r#"{"near": 0.1, "far": 9, "keys": [{"eye": [0, 1, 2], "target": [0, 1, 0]}]}"#;
        let toml = "near = 0.1\nfar = 9\nkeys = [{eye = [0, 1, 2], target = [0, 1, 0]}]";
        let path = CameraPath::parse(json, Format::Json, 2.0).expect("JSON");
        assert_eq!(path, CameraPath::parse(toml, Format::Toml, 2.0).expect("TOML"));
        assert_eq!(path.frames[0].camera.lens, fov(60.0));
        assert!(path.light.is_none() && path.frames.len() == 1);
    }

    #[test]
    fn a_written_path_reads_back_the_same() {
        let mut path = parsed(GOOD).expect("a path");
        let third = 1.0 / 3.0;
        path.frames[0].camera.eye = DVec3::new(0.1 + 0.2, -1e-9, 123_456.789);
        path.frames[0].camera.forward = Vec3::new(third, -0.3, 0.7);
        for frame in &mut path.frames {
            (frame.camera.near, frame.camera.far) = (third * 0.1, 1e6 * third);
            frame.camera.lens = Lens::Perspective { fov_y: third };
        }
        for (name, format) in [("a.toml", Format::Toml), ("a.json", Format::Json)] {
            let text = path.to_text(Path::new(name)).expect("text");
            assert_eq!(CameraPath::parse(&text, format, 1.5).expect("a path"), path, "{text}");
        }
        for frame in &mut path.frames {
            frame.camera.up = Vec3::Z;
        }
        path.frames.pop();
        path.frames.pop();
        let text = path.to_text(Path::new("a.toml")).expect("text");
        assert_eq!(parsed(&text).expect("a path"), path);
        let lens = Lens::Orthographic { half_height: third };
        path.frames.iter_mut().for_each(|frame| frame.camera.lens = lens);
        let text = path.to_text(Path::new("a.toml")).expect("text");
        assert_eq!(parsed(&text).expect("a path"), path, "{text}");
        path.frames.push(path.frames[0].clone());
        path.frames[1].camera.up = Vec3::new(0.1, 0.2, third);
        let text = path.to_text(Path::new("a.toml")).expect("text");
        assert_eq!(parsed(&text).expect("a path").frames.last(), path.frames.last(), "{text}");
        path.frames[0].camera.near *= 2.0;
        assert!(path.to_text(Path::new("a.toml")).is_err());
    }

    #[test]
    fn angles_are_written_as_people_write_them() {
        assert_eq!([60.0, 37.5, 44.97].map(|angle| degrees(radians(angle))), [60.0, 37.5, 44.97]);
    }

    #[test]
    fn elements_that_make_no_sense_are_refused_by_place_and_reason() {
        let cases = [
            ("near = 0.1", "", "file (line 1): missing field `near`"),
            ("near = 0.1", "near = nan", "near: NaN is not a distance above 0 m"),
            ("near = 0.1", "near = 1e-60", "near: 0.000"),
            ("near = 0.1", "near = 200.0", "near: 200 is not less than far, which is 200"),
            ("far = 200.0", "far = inf", "far: inf is not a distance"),
            ("50.0", "0.0", "fov_y_deg: 0 is not between 0.1 and 179.5"),
            ("50.0", "180.0", "fov_y_deg: 180 is not between 0.1 and 179.5"),
            ("50.0", "nan", "fov_y_deg: NaN is not between 0.1 and 179.5"),
            ("target = [0.0, 1.7, 0.0]", "target = [0.0, 1.7, 5.0]", "keys[0].target: it is where the eye is"),
            ("target = [0.0, 1.7, 0.0]", "target = [nan, 1.7, 5.0]", "keys[0].target: [NaN, 1.7, 5] is not a position"),
            ("target = [0.0, 1.7, 0.0]", "target = [1e300, 0, 0]", "keys[0].target: it is too near"),
            ("target = [0.0, 1.7, 0.0]", "", "keys[0]: it has no target and no forward"),
            ("target = [0.0, 1.7, 0.0]", "target = [0, 0, 0]\nforward = [0, 0, 1]", "keys[0]: it has a target and"),
            ("eye = [2.0, 1.7, 5.0]", "", "keys[1] (line 10): missing field `eye`"),
            ("[2.0, 1.7, 5.0]", "[nan, 1.7, 5.0]", "keys[1].eye: [NaN, 1.7, 5] is not a position"),
            ("[1.0, 0.0, 0.0]", "[0.0, 0.0, 0.0]", "keys[1].forward: [0, 0, 0] is not a direction"),
            ("[1.0, 0.0, 0.0]", "[0.0, 1.0, 0.0]", "keys[1]: it is not a valid camera"),
            ("[2.0, 1.7, 5.0]", "[2.0, 1.7]", "keys[1].eye"),
            ("[2.0, 1.7, 5.0]", "\"here\"", "keys[1].eye (line 11): invalid type: string \"here\""),
            ("\"far\"", "\"\"", "keys[2].group: an empty name"),
            ("37.0", "nan", "light.azimuth_deg: NaN is not between"),
            ("45.0", "-5.0", "light.elevation_deg: -5 is not above 0"),
            ("frames_per_key = 2", "frames_per_key = 0", "frames_per_key: 0 leaves no frames"),
            ("frames_per_key = 2", "frames_per_key = -2", "frames_per_key (line 6): invalid value"),
            ("frames_per_key = 2", "frames_per_key = 90000", "frames_per_key: 270000 frames are more than the 100000"),
            ("frames_per_key = 2", "frames_per_key = 9000000000000000000", "more than the 100000"),
            ("frames_per_key = 2", "frame_per_key = 2", "frame_per_key (line 6): unknown field `frame_per_key`"),
            ("frames_per_key = 2", "up = [0, 0, 0]", "up: [0, 0, 0] is not a direction"),
            ("forward = [0.0, 0.0, 2.0]", "forward = [0.0, 0.0, 2.", "file (line 16): "),
        ];
        for (from, to, wanted) in cases {
            let told = refusal(from, to);
            assert!(told.contains(wanted), "{to}: {told}");
        }
    }

    #[test]
    fn files_without_keys_are_refused() {
        for text in ["near = 1\nfar = 2", "near = 1\nfar = 2\nkeys = []", "", "keys"] {
            let error = format!("{:#}", parsed(text).expect_err("refused"));
            assert!(error.starts_with("file") || error.starts_with("keys: there are none"), "{error}");
        }
        for text in ["", "{", "[]", "{\"near\": 1, \"far\": 2, \"keys\": []} x", "{\"near\": null}"] {
            assert!(CameraPath::parse(text, Format::Json, 1.0).is_err(), "{text}");
        }
    }

    #[test]
    fn errors_name_the_file() {
        let error = CameraPath::read(Path::new("nowhere/path.toml"), 1.0).expect_err("refused");
        assert!(format!("{error:#}").starts_with("nowhere/path.toml: not a camera path: file: cannot be read: "));
        let error = CameraPath::read(Path::new("path.txt"), 1.0).expect_err("refused");
        assert!(format!("{error:#}").contains("neither in .toml nor in .json"), "{error:#}");
    }
}
