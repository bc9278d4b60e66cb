//! The command line.

use std::path::PathBuf;

use anyhow::{Context, Result, anyhow, bail};
use clap::Parser;
use shadowfit::Technique;
use shadowfit_adapter::{AdapterChoice, AdapterOptions};
use shadowfit_classics::{SAMPLES, SampleValues};
use shadowfit_egui::{KeyGroup, KeyHelp, KeyLayout, key_table};
use shadowfit_params::tool::Settings;
use shadowfit_params::{self as params, Kind, Number, Parameter, ParameterError, RejectionReason};
use shadowfit_study::NamedTechnique;

use crate::platform::output;
use crate::play::script::{self, Line};
use crate::scene_source::{OPTION_PREFIX, SceneSource};

/// Returns the keys of the window and the exit codes, for `--help`.
fn keys_and_exit_codes() -> String {
    let line = |line: &KeyHelp| format!("    {:<22} {}\n", line.keys, line.does);
    let group =
        |group: &KeyGroup| format!("\n  {}\n{}", group.heading, group.keys.iter().map(line).collect::<String>());
    let keys: String = key_table(KeyLayout::Window).iter().map(group).collect();
    format!("Keys in the window, where H shows them too:\n{keys}")
        + "\nExit codes: 0; 1 if --check found a fault; 2 if something was rejected or failed."
}

/// Fly through a scene under one sun, and show, measure and fix shadow acne, aliasing and clipping holes.
#[derive(Clone, Debug, Default, Parser)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the command line")]
#[command(
    name = "viewer",
    version,
    after_help = "Exit codes: 0; 1 if --check found a fault; 2 if something was rejected or failed. --help lists the keys.",
    after_long_help = keys_and_exit_codes()
)]
pub struct Arguments {
    /// Scene: a glTF file (.gltf or .glb), or one of the built-in scenes courtyard, plain, arcade, forest and town.
    /// Default: the last scene, at first the courtyard.
    pub scene: Option<PathBuf>,

    /// Shows a classic technique by its name, e.g. `xna-shadow-mapping`, optionally with a variant after a
    /// slash; `list` prints all of them and quits.
    #[arg(long, value_name = "NAME", conflicts_with = "scene")]
    pub sample: Option<String>,

    /// Index of the scene in the file. Default: the file's default scene.
    #[arg(long, value_name = "INDEX")]
    pub scene_index: Option<usize>,

    /// Index of the animation to play.
    #[arg(long, value_name = "INDEX", default_value_t = 0)]
    pub animation: usize,

    /// Renders the picture set into this folder instead of opening a window.
    #[arg(long, value_name = "DIR")]
    pub headless: Option<PathBuf>,

    /// Size of the window or of the pictures, in pixels. Default: 1280x720, or for pictures of a sample the
    /// window size of its source.
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = parse_size)]
    pub size: Option<[u32; 2]>,

    /// Starts with a technique: a preset name, e.g. `stable-4`, or a .toml file, e.g. from the tuner.
    #[arg(long, value_name = "NAME|FILE.toml")]
    pub technique: Option<String>,

    /// Sets a parameter, e.g. `--set bias.normal_offset=1.5`; `--parameters` lists them. For an option of a
    /// sample, put `sample.` before its name, e.g. `--set sample.bias=0`.
    #[arg(long = "set", value_name = "ID=VALUE")]
    pub set: Vec<String>,

    /// Opens a link of a viewer: the URL, or its fragment from the `#` on. It overrides saved settings and
    /// all other arguments.
    #[arg(long, value_name = "URL|FRAGMENT")]
    pub link: Option<String>,

    /// Prints every parameter with its range and default, and quits.
    #[arg(long)]
    pub parameters: bool,

    /// Plays a script of actions, one per line; `--actions` lists them. With `--headless` the script replaces
    /// the picture set, and its files go into that folder.
    #[arg(long, value_name = "FILE")]
    pub script: Option<PathBuf>,

    /// Prints the actions of scripts, and quits.
    #[arg(long)]
    pub actions: bool,

    /// Stores settings, camera and bookmarks in this file instead of the user's own file.
    #[arg(long, value_name = "FILE", conflicts_with = "no_state")]
    pub state: Option<PathBuf>,

    /// Does not restore or save settings.
    #[arg(long)]
    pub no_state: bool,

    /// Starts with the animation stopped.
    #[arg(long)]
    pub no_play: bool,

    /// Graphics adapter.
    #[command(flatten)]
    pub adapter: AdapterOptions,

    /// Prints a table to the standard error at the end: the time of each start step and of each line of the
    /// script.
    #[arg(long, requires_all = ["headless", "script"])]
    pub timings: bool,

    /// Checks the graphics device instead of opening a window, in a minute or less on a GPU: compares its
    /// maps, look-ups, passes and rays with the CPU's. Prints a report for an issue, and ends with exit code
    /// 1 if a check fails. Only the adapter options can be combined with it.
    #[arg(long, conflicts_with_all = NOT_WITH_CHECK)]
    pub check: bool,

    /// Prints a line to the standard error when the window is ready, and the frame time at intervals.
    #[arg(long)]
    pub log_frames: bool,
}

/// Arguments that cannot be combined with a device check: all except the adapter options.
const NOT_WITH_CHECK: [&str; 17] = [
    "scene",
    "sample",
    "scene_index",
    "animation",
    "headless",
    "size",
    "technique",
    "set",
    "link",
    "parameters",
    "script",
    "actions",
    "state",
    "no_state",
    "no_play",
    "timings",
    "log_frames",
];

/// Default size of the window and of pictures, in pixels.
const SIZE: [u32; 2] = [1280, 720];

/// Parses the process's arguments. Ends the process after help, version or a list, and after invalid
/// arguments.
pub(crate) fn parse() -> Arguments {
    let arguments = Arguments::parse();
    let list = if arguments.parameters {
        parameter_list()
    } else if arguments.sample.as_deref() == Some("list") {
        sample_list()
    } else if arguments.actions {
        action_list()
    } else {
        return arguments;
    };
    let Err(error) = output::print(list) else { std::process::exit(0) };
    output::tell(format_args!("error: {error:#}"));
    std::process::exit(2)
}

impl Arguments {
    /// Returns the scene in the arguments, if any.
    pub(crate) fn source(&self) -> Result<Option<SceneSource>> {
        if let Some(name) = &self.sample {
            let unknown = || anyhow!("--sample {name}: there is no such sample; `viewer --sample list` lists them");
            let source = SceneSource::sample(name).ok_or_else(unknown)?;
            return source.with_index(self.scene_index).map(Some);
        }
        let named = self.scene.as_deref().map(|text| SceneSource::from_text(&text.to_string_lossy()));
        if named.is_none() && self.scene_index.is_none() {
            return Ok(None);
        }
        named.unwrap_or_default().with_index(self.scene_index).map(Some)
    }

    /// Returns the parameters to set, by id, with their values as text.
    pub(crate) fn settings(&self) -> impl Iterator<Item = (&str, &str)> {
        self.set.iter().filter_map(|assignment| assignment.split_once('=')).map(|(id, value)| (id.trim(), value.trim()))
    }

    /// Returns the options of a sample to set, by name.
    pub(crate) fn sample_options(&self) -> impl Iterator<Item = (&str, &str)> {
        let options = self.set.iter().filter_map(|assignment| assignment.trim().strip_prefix(OPTION_PREFIX));
        options.map(|option| option.split_once('=').unwrap_or((option, ""))).map(|(id, text)| (id.trim(), text.trim()))
    }

    /// Reads the script in the arguments. Returns no lines without one.
    pub(crate) fn lines(&self) -> Result<Vec<Line>> {
        Ok(self.script.as_deref().map(script::read).transpose()?.unwrap_or_default())
    }

    /// Returns the size of the window or of pictures, in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size.unwrap_or(SIZE)
    }

    /// Returns the requested adapter.
    pub fn adapter(&self) -> AdapterChoice {
        self.adapter.choice()
    }

    /// Applies the `--technique`, `--set` and `--no-play` arguments, in this order. A preset keeps the shadow
    /// distance and the caster extension of the settings, which suit the scene; a file has its own. Returns
    /// the opened technique.
    ///
    /// # Errors
    ///
    /// If the technique or a parameter does not exist, or a value is invalid.
    pub fn apply(&self, settings: &mut Settings) -> Result<Option<NamedTechnique>> {
        self.apply_unless(settings, |_| false)
    }

    /// Like [`Self::apply`], but ignores values of parameters that do not exist under these settings.
    ///
    /// # Errors
    ///
    /// If the technique or a parameter does not exist, or a value is invalid under any settings.
    pub(crate) fn apply_what_is_there(&self, settings: &mut Settings) -> Result<Option<NamedTechnique>> {
        self.apply_unless(settings, |error| {
            matches!(error, ParameterError::Rejected { reason: RejectionReason::NotPresent(_), .. })
        })
    }

    fn apply_unless(
        &self,
        settings: &mut Settings,
        is_ignored: impl Fn(&ParameterError) -> bool,
    ) -> Result<Option<NamedTechnique>> {
        let find = |text: &String| find_technique(text, &settings.technique).context("--technique");
        let opened = self.technique.as_ref().map(find).transpose()?;
        if let Some(opened) = &opened {
            (settings.technique, settings.inputs) = (opened.technique, opened.inputs);
        }
        for assignment in self.set.iter().filter(|assignment| !assignment.trim().starts_with(OPTION_PREFIX)) {
            let (id, value) = assignment
                .split_once('=')
                .ok_or_else(|| anyhow!("--set {assignment}: expected ID=VALUE, e.g. bias.normal_offset=1.5"))?;
            match params::set_from_str(settings, id.trim(), value.trim()) {
                Err(error) if !is_ignored(&error) => bail!("--set {assignment}: {error}"),
                Ok(()) | Err(_) => {}
            }
        }
        if self.no_play {
            settings.view.play = false;
        }
        Ok(opened)
    }
}

/// Returns a preset by its name, with the shadow distance and caster extension of the current technique,
/// which suit the scene; or the technique of a file, unchanged.
///
/// # Errors
///
/// If the preset does not exist, or the file cannot be read or is invalid.
pub(crate) fn find_technique(text: &str, now: &Technique) -> Result<NamedTechnique> {
    let mut named = NamedTechnique::find(text)?;
    if NamedTechnique::preset(text).is_some() {
        named.technique = named.technique.with_lengths_of(now);
    }
    Ok(named)
}

/// Rejects an animation that a scene lacks. The first one is the default, and is accepted for a scene without
/// animations.
pub(crate) fn check_animation(animation: usize, animations: usize, scene: &str) -> Result<()> {
    if animation < animations.max(1) {
        return Ok(());
    }
    let there = if animations == 1 { "is 1 animation".to_owned() } else { format!("are {animations} animations") };
    Err(anyhow!("--animation {animation}: there {there} in {scene}, counted from 0"))
}

fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    sides
        .filter(|sides: &[u32; 2]| sides.iter().all(|side| (16..=8192).contains(side)))
        .ok_or_else(|| "expected WIDTHxHEIGHT with sides of 16 to 8192 pixels, e.g. 1280x720".to_owned())
}

fn parameter_list() -> String {
    use std::fmt::Write;
    let defaults = Settings::default();
    let mut list = String::new();
    for parameter in params::PARAMETERS {
        let value = params::format_value(&defaults, parameter);
        // A parameter that exists only with a choice of another one has no default value.
        let value = if parameter.is_present(&defaults) { format!("={value}") } else { String::new() };
        // Writing to a String cannot fail.
        let _ = writeln!(list, "{}{value}  ({})\n    {}", parameter.id, range(parameter), parameter.help);
    }
    list
}

fn sample_list() -> String {
    use std::fmt::Write;
    let mut list = String::new();
    for sample in &SAMPLES {
        // Writing to a String cannot fail.
        let _ = writeln!(list, "{}\n    {}. {}", sample.id, sample.title, sample.teaches);
        for variant in sample.variants {
            let _ = writeln!(list, "{}/{}\n    {}", sample.id, variant.id, variant.text);
        }
        for option in sample.options {
            let default = SampleValues::text(option, option.default_value());
            let (id, possible) = (option.id, option.possible());
            let _ = writeln!(list, "    --set sample.{id}={default}  ({possible})\n        {}", option.help);
        }
    }
    list
}

fn action_list() -> String {
    use std::fmt::Write;
    let mut list = String::new();
    for action in script::ACTIONS {
        // Writing to a String cannot fail.
        let _ = writeln!(list, "{:<38} {}", format!("{} {}", action.name, action.takes), action.does);
    }
    list
}

/// Returns the possible values of a parameter.
fn range(parameter: &Parameter) -> String {
    match &parameter.kind {
        Kind::Number(Number { min, max, unset, .. }) => {
            let numbers = format!("{min}..{max} {}", parameter.unit);
            let unset = unset.map_or(String::new(), |unset| format!(", or {}", unset.option.id));
            numbers.trim_end().to_owned() + &unset
        }
        Kind::Choice(options) => options.iter().map(|option| option.id).collect::<Vec<_>>().join("|"),
        Kind::Toggle => "on|off".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;

    #[test]
    fn sizes_are_read_and_absurd_ones_refused() {
        assert_eq!(parse_size("640x360"), Ok([640, 360]));
        for bad in ["", "640", "640x", "x360", "0x0", "-5x10", "99999x100", "640x360x2", "axb", "8x8"] {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn a_check_takes_the_adapter_and_refuses_all_other_arguments() {
        for allowed in [&[][..], &["--adapter", "nvidia"], &["--software"]] {
            let arguments = ["viewer", "--check"].iter().chain(allowed);
            assert!(Arguments::try_parse_from(arguments).is_ok(), "{allowed:?}");
        }
        let is_adapter = |id: &str| ["adapter", "software", "check"].contains(&id);
        for argument in Arguments::command().get_arguments().filter(|argument| !is_adapter(argument.get_id().as_str()))
        {
            let flag = argument.get_long().map(|name| format!("--{name}"));
            let number = if argument.get_id() == "size" { "64x64" } else { "0" };
            let value = argument.get_action().takes_values().then(|| number.to_owned());
            let given: Vec<String> = flag.into_iter().chain(value).collect();
            let refused = Arguments::try_parse_from(["viewer", "--check"].map(str::to_owned).iter().chain(&given));
            let kind = refused.expect_err(&given.join(" ")).kind();
            assert_eq!(kind, clap::error::ErrorKind::ArgumentConflict, "{given:?}");
        }
    }

    #[test]
    fn assignments_are_applied_and_bad_ones_name_themselves() {
        let mut settings = Settings::default();
        let arguments = Arguments::parse_from(["viewer", "--set", "bias.constant=0.5", "--no-play"]);
        arguments.apply(&mut settings).expect("a good assignment");
        assert_eq!(settings.technique.bias.constant, 0.5);
        assert!(!settings.view.play);
        for bad in ["bias.constant", "bias.constant=x", "no.such=1", "bias.constant=1e9"] {
            let error = Arguments::parse_from(["viewer", "--set", bad]).apply(&mut settings).expect_err(bad);
            assert!(format!("{error:#}").contains(bad.split('=').next().unwrap_or(bad)), "{error:#}");
        }
    }

    #[test]
    fn a_value_that_needs_another_choice_is_refused_only_where_that_choice_is_known() {
        let mut settings = Settings::default();
        let lambda = Arguments::parse_from(["viewer", "--set", "splits.lambda=0.7", "--set", "bias.constant=0.5"]);
        assert!(lambda.apply(&mut settings.clone()).is_err(), "the default splits have no lambda");
        lambda.apply_what_is_there(&mut settings).expect("practical splits may come from the saved settings");
        assert_eq!(settings.technique.bias.constant, 0.5);
        for bad in ["splits.lambda", "splits.lambda=much", "splits.lambda=7", "no.such=1"] {
            let arguments = Arguments::parse_from(["viewer", "--set", bad]);
            assert!(arguments.apply_what_is_there(&mut settings).is_err(), "{bad}");
        }
    }

    #[test]
    fn presets_keep_the_lengths_of_the_scene_and_files_have_their_own() {
        let mut scene = Settings::default();
        (scene.technique.fit.max_distance, scene.technique.fit.caster_extension) = (80.0, 7.0);
        let apply = |arguments: &[&str]| {
            let mut settings = scene;
            let arguments = Arguments::parse_from(["viewer", "--technique"].iter().chain(arguments));
            arguments.apply(&mut settings).map(|opened| (settings.technique, opened))
        };
        let preset = NamedTechnique::preset("stable-4").expect("a preset");
        let (technique, opened) = apply(&["stable-4", "--set", "splits.count=3"]).expect("a preset");
        let expected = preset.technique.with_lengths_of(&scene.technique);
        assert_eq!(technique, expected.with_count(3), "--set comes after --technique");
        assert_eq!(opened.map(|opened| (opened.name, opened.technique)), Some(("stable-4".to_owned(), expected)));

        let folder = std::env::temp_dir().join(format!("shadowfit-viewer-techniques-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let write = |name: &str, text: &str| {
            let file = folder.join(name);
            std::fs::write(&file, text).expect("written");
            file.to_string_lossy().into_owned()
        };
        let tuned = NamedTechnique { name: "tuned".to_owned(), ..preset }.with_resolution(512);
        let file = write("tuned.toml", &tuned.to_toml().expect("text"));
        let (technique, opened) = apply(&[&file]).expect("a file");
        assert_eq!((technique, opened.as_ref()), (tuned.technique, Some(&tuned)));

        let bad = write("bad.toml", "[splits]\ncount = 9");
        let error = format!("{:#}", apply(&[&bad]).expect_err("nine maps"));
        assert!(["--technique", "bad.toml", "splits.count is 9"].iter().all(|word| error.contains(word)), "{error}");
        std::fs::remove_dir_all(&folder).expect("removed");
        let error = format!("{:#}", apply(&["none"]).expect_err("no such preset"));
        assert!(error.contains("\"none\"") && error.contains(shadowfit::Preset::RECOMMENDED), "{error}");
    }

    #[test]
    fn every_parameter_is_listed_with_what_stands_for_no_number() {
        let list = parameter_list();
        assert!(params::PARAMETERS.iter().all(|parameter| list.contains(parameter.id)));
        let line = |id: &str| list.lines().find(|line| line.starts_with(id)).unwrap_or_else(|| panic!("{id}"));
        assert!(
            line("fit.max_distance").contains("=far_plane") && line("fit.max_distance").contains(", or far_plane)")
        );
        assert!(line("splits.lambda").starts_with("splits.lambda  ("), "no value without the practical splits");
    }
}
