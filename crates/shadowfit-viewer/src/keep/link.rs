//! Links: the state of the viewer as the fragment of a URL, and back.
//!
//! `#v=1&scene=forest&bias.constant=0.75&camera=1,2,-3.5,90,-5`: keys with a value each. Only differences
//! from the scene's initial state are written. A key with a dot is a parameter id, optionally with a prefix:
//! `b.` for technique B, `sample.` for an option of the sample, `was.` for the settings before the shown
//! artefact, and `ill.` for the technique that shows a fixed artefact. Files are given by name only, since no
//! page can open a path.

use std::f32::consts::FRAC_PI_2;
use std::fmt::Write as _;

use anyhow::{Context, Result, anyhow, bail, ensure};
use glam::DVec3;
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, percent_decode_str, utf8_percent_encode};
use shadowfit_classics::SampleValues;
use shadowfit_egui::Artefact;
use shadowfit_params::tool::Settings;
use shadowfit_params::{self as params, PARAMETERS, ParameterError, RejectionReason};
use shadowfit_render::FlyCamera;
use shadowfit_scene::builtin::BuiltinScene;

use crate::scene_source::{OPTION_PREFIX, SceneSource};

/// Version of the keys and their meanings.
const VERSION: u32 = 1;
/// Prefixes of parameters other than those of the scene and of technique A.
const OTHER: &str = "b.";
const WAS: &str = "was.";
const ILL: &str = "ill.";
/// Characters to encode. All others need no encoding in a fragment, and programs that turn text into links do
/// not take them for the end of a link.
const ENCODED: &AsciiSet =
    &NON_ALPHANUMERIC.remove(b'-').remove(b'.').remove(b'_').remove(b'~').remove(b',').remove(b'/').remove(b':');
/// Greatest distance of a link's camera from the origin along each axis, in metres. Beyond it, neighbouring
/// pixels have the same position.
const FARTHEST: f64 = 1e12;
/// Greatest number of unknown keys in a message.
const MOST_NAMED: usize = 3;

/// Parameters by id, with their values as text.
pub(crate) type Pairs = Vec<(String, String)>;

/// The contents of a link.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Link {
    pub(crate) scene: LinkedScene,
    /// Index of the animation to play.
    pub(crate) animation: usize,
    pub(crate) camera: Option<FlyCamera>,
    /// Time of a paused animation, in seconds.
    pub(crate) seconds: Option<f32>,
    /// The parameters that differ from the scene's own.
    pub(crate) settings: Pairs,
    /// The options of the sample that differ from its own values.
    pub(crate) sample: Pairs,
    /// The parameters of technique B that differ from A, and the position of the bar; `None` without B.
    pub(crate) other: Option<(Pairs, f32)>,
    pub(crate) artefact: Option<LinkedArtefact>,
    /// Messages for the user about ignored parts. Not part of the text.
    pub(crate) notes: Vec<String>,
}

/// The scene of a link.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum LinkedScene {
    /// A built-in scene or a sample.
    Known(SceneSource),
    /// A file by its name, which only the user can open.
    File { name: String, index: Option<usize> },
}

/// The shown artefact.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LinkedArtefact {
    pub(crate) artefact: Artefact,
    pub(crate) fixed: bool,
    /// The camera before the artefact.
    pub(crate) before: Option<FlyCamera>,
    /// The parameters before the artefact that differ from the current ones.
    pub(crate) was: Pairs,
    /// The differing parameters of the technique that shows a fixed artefact.
    pub(crate) ill: Pairs,
}

impl Default for LinkedScene {
    fn default() -> Self {
        Self::Known(SceneSource::default())
    }
}

impl LinkedScene {
    pub(crate) fn of(source: &SceneSource) -> Self {
        match source {
            SceneSource::File { .. } => Self::File { name: source.label(), index: source.index() },
            known => Self::Known(known.clone()),
        }
    }

    /// Returns a request to the user; `None` for a scene that needs no file.
    pub(crate) fn request(&self) -> Option<String> {
        match self {
            Self::Known(_) => None,
            Self::File { name, .. } => Some(format!("This link needs {name}: drop that file here")),
        }
    }
}

/// Names of the artefacts, as in scripts.
const ARTEFACTS: [(&str, Artefact); 3] =
    [("acne", Artefact::Acne), ("aliasing", Artefact::Aliasing), ("hole", Artefact::ClippingHole)];

impl Link {
    /// Returns the fragment, including its `#`.
    pub(crate) fn to_fragment(&self) -> String {
        let mut text = format!("#v={VERSION}");
        for (key, value) in self.pairs() {
            // Writing to a String cannot fail.
            let _ = write!(text, "&{}={}", utf8_percent_encode(&key, ENCODED), utf8_percent_encode(&value, ENCODED));
        }
        text
    }

    /// Returns all keys and values except the version.
    fn pairs(&self) -> Pairs {
        let (scene, file, index) = match &self.scene {
            LinkedScene::Known(source) => (Some(source.text()), None, None),
            LinkedScene::File { name, index } => (None, Some(name.clone()), index.map(|index| index.to_string())),
        };
        let animation = (self.animation > 0).then(|| self.animation.to_string());
        let mut pairs = given([
            ("scene", scene),
            ("file", file),
            ("scene_index", index),
            ("animation", animation),
            ("camera", self.camera.as_ref().map(camera_text)),
            ("time", self.seconds.map(|seconds| seconds.to_string())),
        ]);
        pairs.extend(self.settings.iter().cloned());
        pairs.extend(with_prefix(OPTION_PREFIX, &self.sample));
        if let Some((other, split)) = &self.other {
            pairs.extend(given([("split", Some(split.to_string()))]));
            pairs.extend(with_prefix(OTHER, other));
        }
        if let Some(shown) = &self.artefact {
            let name = ARTEFACTS.iter().find(|(_, artefact)| *artefact == shown.artefact).map_or("", |(name, _)| name);
            let fixed = if shown.fixed { ",fixed" } else { "" };
            let before = shown.before.as_ref().map(camera_text);
            pairs.extend(given([("artefact", Some(format!("{name}{fixed}"))), ("before", before)]));
            pairs.extend(with_prefix(WAS, &shown.was).chain(with_prefix(ILL, &shown.ill)));
        }
        pairs
    }

    /// Parses a fragment, or a URL with one.
    ///
    /// # Errors
    ///
    /// For an invalid value, with its key. Unknown keys are ignored, and [noted](Self::notes).
    pub(crate) fn parse(text: &str) -> Result<Self> {
        let fragment = text.split_once('#').map_or(text, |(_, fragment)| fragment).trim();
        let mut read = Reader::default();
        for pair in fragment.split('&').filter(|pair| !pair.is_empty()) {
            let (key, value) = pair.split_once('=').unwrap_or((pair, ""));
            let decoded =
                |text| percent_decode_str(text).decode_utf8().with_context(|| format!("{pair:?} is not text"));
            let (key, value) = (decoded(key)?, decoded(value)?);
            read.take(&key, &value).with_context(|| format!("the link has {key}={value}"))?;
        }
        read.finish()
    }

    /// Returns whether the link belongs to a scene.
    pub(crate) fn is_of(&self, source: &SceneSource) -> bool {
        self.scene == LinkedScene::of(source)
    }
}

/// Returns the keys that have a value.
fn given<const N: usize>(pairs: [(&str, Option<String>); N]) -> Pairs {
    pairs.into_iter().filter_map(|(key, value)| Some((key.to_owned(), value?))).collect()
}

fn with_prefix(prefix: &str, pairs: &Pairs) -> impl Iterator<Item = (String, String)> {
    pairs.iter().map(move |(key, value)| (format!("{prefix}{key}"), value.clone()))
}

/// A link being parsed.
#[derive(Default)]
struct Reader {
    link: Link,
    index: Option<usize>,
    split: Option<f32>,
    other: Pairs,
    artefact: Option<(Artefact, bool)>,
    before: Option<FlyCamera>,
    was: Pairs,
    ill: Pairs,
    unknown: Vec<String>,
}

impl Reader {
    fn take(&mut self, key: &str, value: &str) -> Result<()> {
        let link = &mut self.link;
        match key {
            "v" => {
                let version: u32 = value.parse().context("give a version, a whole number")?;
                if version > VERSION {
                    link.notes.push("This link is of a later version of the viewer.".to_owned());
                }
            }
            "scene" => link.scene = LinkedScene::Known(scene(value)?),
            "file" => {
                ensure!(!value.is_empty() && !value.contains(['/', '\\']), "give the name of a file without a folder");
                link.scene = LinkedScene::File { name: value.to_owned(), index: None };
            }
            "scene_index" => self.index = Some(value.parse().context("give a whole number, counted from 0")?),
            "animation" => link.animation = value.parse().context("give a whole number, counted from 0")?,
            "camera" => link.camera = Some(camera(value)?),
            "before" => self.before = Some(camera(value)?),
            "time" => link.seconds = Some(number(value)?.max(0.0)),
            "split" => self.split = Some(number(value)?),
            "artefact" => self.artefact = Some(artefact(value)?),
            _ => self.take_parameter(key, value)?,
        }
        Ok(())
    }

    fn take_parameter(&mut self, key: &str, value: &str) -> Result<()> {
        let (id, pairs) = if let Some(option) = key.strip_prefix(OPTION_PREFIX) {
            self.link.sample.push((option.to_owned(), value.to_owned()));
            return Ok(());
        } else if let Some(id) = key.strip_prefix(OTHER) {
            (id, &mut self.other)
        } else if let Some(id) = key.strip_prefix(WAS) {
            (id, &mut self.was)
        } else if let Some(id) = key.strip_prefix(ILL) {
            (id, &mut self.ill)
        } else {
            (key, &mut self.link.settings)
        };
        match params::set_from_str(&mut Settings::default(), id, value) {
            Err(ParameterError::UnknownId { .. }) => self.unknown.push(key.to_owned()),
            // It may exist with the other settings of the link.
            Ok(()) | Err(ParameterError::Rejected { reason: RejectionReason::NotPresent(_), .. }) => {
                pairs.push((id.to_owned(), value.to_owned()));
            }
            Err(error) => return Err(error.into()),
        }
        Ok(())
    }

    fn finish(self) -> Result<Link> {
        let Self { mut link, unknown, .. } = self;
        match &mut link.scene {
            LinkedScene::File { index, .. } => *index = self.index,
            LinkedScene::Known(SceneSource::Sample { sample, .. }) => {
                let mut values = SampleValues::new(sample);
                for (option, value) in &link.sample {
                    values
                        .set_from_str(option, value)
                        .with_context(|| format!("the link has sample.{option}={value}"))?;
                }
            }
            LinkedScene::Known(_) => {}
        }
        link.other = self.split.map(|split| (self.other, split));
        let (before, was, ill) = (self.before, self.was, self.ill);
        link.artefact = self.artefact.map(|(artefact, fixed)| LinkedArtefact { artefact, fixed, before, was, ill });
        if !unknown.is_empty() {
            let dots = if unknown.len() > MOST_NAMED { ", …" } else { "" };
            let named = unknown[..unknown.len().min(MOST_NAMED)].join(", ");
            link.notes.push(format!("This viewer does not know these keys of the link: {named}{dots}."));
        }
        Ok(link)
    }
}

/// Sets parameters in table order, so that a choice comes before the parameters that depend on it.
pub(crate) fn apply(pairs: &Pairs, settings: &mut Settings) {
    for parameter in PARAMETERS {
        if let Some((_, value)) = pairs.iter().rev().find(|(id, _)| id == parameter.id) {
            // Values were checked when the link was parsed. A parameter that does not exist under these
            // settings is ignored.
            let _ = params::set_from_str(settings, parameter.id, value);
        }
    }
}

fn scene(name: &str) -> Result<SceneSource> {
    let built_in = BuiltinScene::from_id(name).map(SceneSource::BuiltIn);
    built_in.or_else(|| SceneSource::sample(name)).ok_or_else(|| {
        let names: Vec<&str> = BuiltinScene::ALL.iter().map(|scene| scene.id()).collect();
        anyhow!("give a sample or one of {}", names.join(", "))
    })
}

fn artefact(text: &str) -> Result<(Artefact, bool)> {
    let (name, fixed) = match text.split_once(',') {
        Some((name, "fixed")) => (name, true),
        Some(_) => bail!("only `fixed` may follow the comma"),
        None => (text, false),
    };
    let found = ARTEFACTS.iter().find(|(other, _)| *other == name);
    found.map(|(_, artefact)| (*artefact, fixed)).context("give acne, aliasing or hole")
}

fn number(text: &str) -> Result<f32> {
    let number: f32 = text.trim().parse().context("give a number")?;
    ensure!(number.is_finite(), "give a finite number");
    Ok(number)
}

/// Parses position in metres, yaw, pitch and an optional roll in degrees.
fn camera(text: &str) -> Result<FlyCamera> {
    let what = "give x, y and z in metres, then yaw, pitch and optionally roll in degrees";
    let numbers = text.split(',').map(|word| word.trim().parse().ok()).collect::<Option<Vec<f64>>>();
    let mut numbers = numbers.context(what)?;
    if numbers.len() == 5 {
        numbers.push(0.0);
    }
    let [x, y, z, yaw, pitch, roll] = numbers.try_into().ok().context(what)?;
    let [yaw, pitch, roll] = [yaw, pitch, roll].map(|degrees: f64| degrees.to_radians() as f32);
    let is_finite = [yaw, pitch, roll].iter().all(|angle| angle.is_finite());
    ensure!([x, y, z].iter().all(|place| place.abs() <= FARTHEST) && is_finite, what);
    Ok(FlyCamera { position: DVec3::new(x, y, z), yaw, pitch: pitch.clamp(-FRAC_PI_2, FRAC_PI_2), roll })
}

/// Returns the text that [`camera`] reads back to the same bits.
fn camera_text(camera: &FlyCamera) -> String {
    let [x, y, z] = camera.position.to_array();
    let roll = if camera.roll == 0.0 { String::new() } else { format!(",{}", degrees_text(camera.roll)) };
    format!("{x},{y},{z},{},{}{roll}", degrees_text(camera.yaw), degrees_text(camera.pitch))
}

/// Returns an angle in degrees with the fewest decimals that restore the radians.
fn degrees_text(radians: f32) -> String {
    /// An f32 has nine significant digits. Its degrees have up to two more digits before the point than its
    /// radians.
    const MOST_DECIMALS: usize = 12;
    let degrees = f64::from(radians).to_degrees();
    let restores = |text: &String| text.parse().is_ok_and(|degrees: f64| degrees.to_radians() as f32 == radians);
    let texts = (0..=MOST_DECIMALS).map(|decimals| format!("{degrees:.decimals$}"));
    texts.into_iter().find(restores).unwrap_or_else(|| degrees.to_string())
}

#[cfg(test)]
mod tests {
    use shadowfit_params::{Kind, Number, Value};

    use super::*;
    use crate::keep::command_line::differences;
    use crate::play::monkey::Random;

    /// Returns settings with some parameters changed. Each share is a position in the parameter's range.
    fn changed(own: &Settings, shares: &[(usize, f64)]) -> Settings {
        let mut settings = *own;
        for (index, share) in shares {
            let parameter = &PARAMETERS[index % PARAMETERS.len()];
            let value = match &parameter.kind {
                Kind::Number(Number { unset: Some(_), .. }) if *share < 0.2 => Value::Unset,
                Kind::Number(range) => Value::Number(range.min + share * (range.max - range.min)),
                Kind::Choice(options) => Value::Option((share * options.len() as f64) as usize),
                Kind::Toggle => Value::Toggle(*share > 0.5),
            };
            parameter.set(&mut settings, value);
        }
        // After a change of the softness measure, its number may lie outside the range.
        for parameter in PARAMETERS {
            let now = settings;
            parameter.copy(&mut settings, &now);
        }
        settings
    }

    fn shares(random: &mut Random) -> Vec<(usize, f64)> {
        (0..random.next() % 40).map(|_| (random.next() as usize, f64::from(random.share()))).collect()
    }

    fn any_camera(random: &mut Random) -> FlyCamera {
        let mut number = |most: f32| (2.0 * random.share() - 1.0) * most;
        let position = DVec3::from_array([(); 3].map(|()| f64::from(number(1e7))));
        let roll = number(1.0).max(0.0);
        FlyCamera { position, yaw: number(10.0), pitch: number(FRAC_PI_2), roll }
    }

    #[test]
    fn a_link_brings_settings_cameras_and_texts_back() {
        for seed in 0..256 {
            let random = &mut Random(seed);
            let own = changed(&Settings::default(), &shares(random));
            let (a, b) = (changed(&own, &shares(random)), changed(&own, &shares(random)));
            let name = (0..=random.next() % 12).filter_map(|_| char::from_u32(random.next() as u32 % 0x3000));
            let name: String = name.filter(|c| !matches!(c, '/' | '\\')).chain(['x']).collect();
            let (has_index, has_before, has_time) = (random.share() < 0.5, random.share() < 0.5, random.share() < 0.5);
            let link = Link {
                scene: LinkedScene::File { name, index: has_index.then(|| random.next() as usize % 9) },
                animation: 3,
                camera: Some(any_camera(random)),
                seconds: has_time.then(|| 1e4 * random.share()),
                settings: differences(&a, &own),
                other: Some((differences(&a.with_technique(b.technique), &a), random.share())),
                artefact: Some(LinkedArtefact {
                    artefact: Artefact::Aliasing,
                    fixed: random.share() < 0.5,
                    before: has_before.then(|| any_camera(random)),
                    was: differences(&b, &a),
                    ill: Pairs::new(),
                }),
                ..Link::default()
            };
            let text = link.to_fragment();
            let read = Link::parse(&format!("https://example.org/page{text}")).expect("it was written");
            assert_eq!(read, link, "{seed}");
            let mut settings = own;
            apply(&read.settings, &mut settings);
            assert!(PARAMETERS.iter().all(|parameter| parameter.is_equal(&settings, &a)), "{text}");
            let mut other = settings;
            apply(&read.other.expect("B").0, &mut other);
            assert_eq!(other.technique, b.technique, "{text}");
        }
    }

    #[test]
    fn what_is_as_the_scene_has_it_is_left_out() {
        assert_eq!(Link::default().to_fragment(), "#v=1&scene=courtyard");
        let camera =
            FlyCamera { position: DVec3::new(1.5, 2.0, -3.0), yaw: 90.0_f32.to_radians(), pitch: -0.0, roll: 0.0 };
        let settings = vec![("view.mode".to_owned(), "error".to_owned())];
        let link = Link { camera: Some(camera), settings, ..Link::default() };
        assert_eq!(link.to_fragment(), "#v=1&scene=courtyard&camera=1.5,2,-3,90,-0&view.mode=error");
    }

    #[test]
    fn bad_values_are_named_with_their_key() {
        for (bad, says) in [
            ("scene=nowhere", "courtyard"),
            ("camera=1,2,3", "yaw"),
            ("camera=1,2,inf,0,0", "metres"),
            ("camera=1e300,2,3,0,0", "metres"),
            ("camera=1,2,3,1e300,0", "degrees"),
            ("time=1e300", "finite"),
            ("time=soon", "number"),
            ("artefact=moire", "acne"),
            ("artefact=acne,cured", "fixed"),
            ("animation=-1", "whole"),
            ("bias.constant=1e9", "out of range"),
            ("b.map.filter=none", "point"),
            ("file=/etc/town.glb", "folder"),
            ("v=x", "version"),
            ("scene=xna-shadow-mapping&sample.bias=9", "0..0.01"),
        ] {
            let error = format!("{:#}", Link::parse(&format!("#{bad}")).expect_err(bad));
            let pair = bad.rsplit('&').next().unwrap_or(bad);
            assert!(error.contains(pair) && error.contains(says), "{bad}: {error}");
        }
        assert!(Link::parse("#scene=%FF").is_err());
    }

    #[test]
    fn what_is_not_known_is_ignored_and_said() {
        let link = Link::parse("v=9&scene=plain&mood=low&bias.magic=1&bias.slope=2").expect("the rest makes sense");
        assert_eq!(link.settings, [("bias.slope".to_owned(), "2".to_owned())]);
        assert_eq!(link.scene, LinkedScene::Known(SceneSource::from_text("plain")));
        let notes = link.notes.join(" ");
        assert!(["later version", "mood", "bias.magic"].iter().all(|word| notes.contains(word)), "{notes}");
        assert_eq!(Link::parse("").expect("an empty link is valid"), Link::default());
    }
}
