//! Scripts: a list of actions, one per line, that the viewer plays like user input. They make the pictures of
//! the docs and drive the tests of the window. The names of the actions are the text form of commands.
//!
//! ```text
//! # the courtyard, compared with rays
//! open courtyard
//! await loaded
//! technique stable-4
//! set bias.constant 0
//! view error
//! await judged
//! window errors.png
//! quit
//! ```

use std::path::Path;

use anyhow::{Context, Result, anyhow, ensure};
use egui::ThemePreference;
use shadowfit_egui::{Artefact, Chord, Command, Toggle};
use shadowfit_params as params;
use shadowfit_params::tool::Settings;
use shadowfit_study::NamedTechnique;

use crate::platform;
use crate::scene_source::OPTION_PREFIX;

/// The action of a line of a script.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Step {
    /// Runs a command.
    Run(Command),
    /// Presses and releases a key.
    Press(Chord),
    /// Holds a key for a number of seconds.
    Hold(Chord, f32),
    /// Types a text.
    Type(String),
    /// Clicks at a point of the window, in points, a number of times.
    Click([f32; 2], u32),
    /// Moves the pointer to a point of the window.
    Hover([f32; 2]),
    /// Drags from one point of the window to another.
    Drag([f32; 2], [f32; 2]),
    /// Turns the wheel by a number of notches.
    Wheel(f32),
    /// Resizes the window, in pixels.
    Resize([u32; 2]),
    /// Drops a file on the window.
    Drop(String),
    /// Waits for a number of seconds.
    Wait(f32),
    /// Waits for a number of frames.
    Frames(u32),
    /// Waits until something is done.
    Await(Awaited),
    /// Loses the device.
    LoseDevice,
    /// Lets the window's surface refuse a texture.
    Refuse(Refusal),
    /// Plays random actions.
    Monkey(Monkey),
}

/// A line of a script.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Line {
    pub(crate) step: Step,
    /// File, number and text, for messages.
    pub(crate) place: String,
}

/// The state that a script waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Awaited {
    /// No scene is loading, and no search for the view of an artefact is running.
    Loaded,
    /// The shown picture has been judged.
    Judged,
    /// No search for a technique is running.
    Tuned,
}

/// Reason why the window's surface has no texture for a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Refusal {
    Lost,
    Outdated,
    Timeout,
    Occluded,
}

/// Random actions.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Monkey {
    pub(crate) seconds: f32,
    pub(crate) seed: u64,
    /// Folder of files to drop, valid and hostile ones.
    pub(crate) files: Option<String>,
}

/// An action: its name, its arguments, its description, and its parser.
pub(crate) struct Action {
    pub(crate) name: &'static str,
    pub(crate) takes: &'static str,
    pub(crate) does: &'static str,
    read: Read,
}

/// Parser of the rest of a line.
enum Read {
    /// No arguments: always this command.
    Plain(Command),
    Command(fn(Words<'_>) -> Result<Command>),
    Step(fn(Words<'_>) -> Result<Step>),
}

const fn plain(name: &'static str, does: &'static str, command: Command) -> Action {
    Action { name, takes: "", does, read: Read::Plain(command) }
}

const fn command(
    name: &'static str,
    takes: &'static str,
    does: &'static str,
    read: fn(Words<'_>) -> Result<Command>,
) -> Action {
    Action { name, takes, does, read: Read::Command(read) }
}

const fn step(
    name: &'static str,
    takes: &'static str,
    does: &'static str,
    read: fn(Words<'_>) -> Result<Step>,
) -> Action {
    Action { name, takes, does, read: Read::Step(read) }
}

/// Every action, as `--actions` and error messages list them.
pub(crate) const ACTIONS: &[Action] = &[
    command("open", "SCENE", "opens courtyard, plain, arcade, forest, town, a sample or a file", |words| {
        words.text().map(Command::Open)
    }),
    step("drop", "FILE", "drops a file on the window", |words| words.text().map(Step::Drop)),
    command("set", "ID VALUE", "sets a parameter, or with `sample.` before its name an option of the sample", set),
    command("technique", "NAME|FILE.toml", "uses a technique", technique),
    command("view", "NAME", "shows a view, by its name in view.mode", view),
    plain("outside", "shows the view from outside, or the final picture", Command::ToggleOutside),
    plain("marks", "changes to the next kind of marks for wrong pixels", Command::NextMarks),
    plain("inset", "changes to the next choice of maps in the inset", Command::NextInset),
    plain("freeze", "freezes the fit, or releases it", Command::ToggleFreeze),
    plain("play", "plays or pauses the animation", Command::TogglePlay),
    plain("sun", "starts or stops the sun's motion", Command::ToggleSun),
    command("show", "acne|aliasing|hole", "shows an artefact", |words| words.artefact().map(Command::ShowArtefact)),
    plain("fix", "fixes the shown artefact", Command::FixArtefact),
    plain("close", "stops showing the artefact", Command::CloseArtefact),
    command("look", "X Y Z TO X Y Z", "moves the eye to a point and turns it toward another, in metres", look),
    command("scrub", "SECONDS", "sets the animation to a time", |words| {
        words.numbers().map(|[seconds]| Command::Scrub(seconds))
    }),
    command("compare", "on|off", "compares two techniques", |words| words.toggle().map(Command::Compare)),
    command("split", "SHARE", "moves the bar between the two pictures", |words| {
        words.numbers().map(|[share]| Command::Split(share))
    }),
    plain("swap", "swaps the two techniques", Command::SwapSides),
    plain("copy-to-other", "copies this technique to the other side", Command::CopyToOther),
    plain("undo", "undoes the last change", Command::Undo),
    plain("redo", "redoes the change that was undone last", Command::Redo),
    plain("reset", "restores the initial settings and camera", Command::Reset),
    plain("level", "removes the camera's roll", Command::LevelCamera),
    plain("reset-camera", "restores the initial camera", Command::ResetCamera),
    command("bookmark", "1..9", "saves the view under a number", |words| words.digit().map(Command::SetBookmark)),
    command("goto", "1..9", "goes to a saved view", |words| words.digit().map(Command::GoToBookmark)),
    command("focus", "X Y", "flies toward a point of the picture, in shares from the top left", |words| {
        words.numbers().map(Command::Focus)
    }),
    plain("measure", "judges the sample and modern maps against rays", Command::MeasureSample),
    plain("tune", "searches for a better technique", Command::StartTune),
    plain("cancel", "stops the search", Command::CancelTune),
    plain("apply", "applies the result of the search", Command::ApplyTune),
    plain("discard", "discards the result of the search", Command::DiscardTune),
    command("preset", "NAME", "saves the technique as a preset", |words| words.text().map(Command::SavePreset)),
    command("delete-preset", "NAME", "deletes a saved preset", |words| words.text().map(Command::DeletePreset)),
    plain("copy-rust", "copies the technique as Rust code", Command::CopyRust),
    plain("copy-link", "copies a link to the current scene and settings", Command::CopyLink),
    plain("copy-command-line", "copies the command line that starts with these settings", Command::CopyCommandLine),
    command("theme", "dark|light|system", "changes the colours", theme),
    plain("panel", "hides or shows the panel", Command::TogglePanel),
    plain("help", "shows or hides the table of keys", Command::ToggleHelp),
    step("press", "KEY", "presses a key, such as `w`, `Ctrl+Z` or `space`", |words| words.chord().map(Step::Press)),
    step("hold", "KEY SECONDS", "holds a key", hold),
    step("type", "TEXT", "types into the focused widget", |words| Ok(Step::Type(words.rest.to_owned()))),
    step("hover", "X Y", "moves the pointer, in points of the window", |words| words.numbers().map(Step::Hover)),
    step("click", "X Y", "clicks", |words| words.numbers().map(|at| Step::Click(at, 1))),
    step("doubleclick", "X Y", "clicks twice", |words| words.numbers().map(|at| Step::Click(at, 2))),
    step("drag", "X Y X Y", "drags from one point to another", |words| {
        words.numbers().map(|[a, b, c, d]| Step::Drag([a, b], [c, d]))
    }),
    step("wheel", "NOTCHES", "turns the wheel", |words| words.numbers().map(|[notches]| Step::Wheel(notches))),
    step("resize", "WIDTH HEIGHT", "resizes the window, in pixels", |words| {
        words.numbers::<2>().map(|size| Step::Resize(size.map(|side| side.clamp(1.0, 8192.0) as u32)))
    }),
    step("wait", "SECONDS", "waits", |words| words.numbers().map(|[seconds]| Step::Wait(seconds))),
    step("frames", "N", "waits for a number of frames", |words| {
        words.numbers().map(|[frames]| Step::Frames(frames as u32))
    }),
    step(
        "await",
        "loaded|judged|tuned",
        "waits until the scene and the artefact are shown, the picture is judged, or no search is running",
        |words| words.awaited().map(Step::Await),
    ),
    command("picture", "FILE.png", "saves the picture without the panel", |words| {
        words.text().map(|file| Command::Screenshot(Some(file.into())))
    }),
    command("window", "FILE.png", "saves the whole window", |words| {
        words.text().map(|file| Command::SaveWindow(file.into()))
    }),
    command("figures", "FILE.csv", "saves the plotted figures", |words| {
        words.text().map(|file| Command::SaveFigures(Some(file.into())))
    }),
    step("monkey", "SECONDS SEED [FOLDER]", "plays random actions, and drops files of a folder", |words| {
        words.monkey().map(Step::Monkey)
    }),
    step("lose-device", "", "destroys the graphics device, as if its driver had been reset", |words| {
        words.nothing().map(|()| Step::LoseDevice)
    }),
    step(
        "refuse-frame",
        "lost|outdated|timeout|occluded",
        "makes the window's surface refuse the next frame with this answer",
        |words| words.refusal().map(Step::Refuse),
    ),
    plain("quit", "quits the viewer", Command::Quit),
];

/// Reads a script. Empty lines are ignored, and comments from a `#` at the start of a word on.
///
/// # Errors
///
/// For a line that is not an action, with the name of the file, the number of the line and the list of
/// actions.
pub(crate) fn read(path: &Path) -> Result<Vec<Line>> {
    let name = path.display();
    let bytes = platform::read(path).with_context(|| format!("the script {name} cannot be read"))?;
    let text = String::from_utf8(bytes).with_context(|| format!("the script {name} is not text"))?;
    lines(&name.to_string(), &text)
}

/// Parses the text of a script. `name` is for messages.
pub(crate) fn lines(name: &str, text: &str) -> Result<Vec<Line>> {
    let mut lines = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        let line = line.split_once(" #").map_or(line, |(line, _)| line).trim();
        if !line.is_empty() && !line.starts_with('#') {
            let place = format!("{name}:{number}: {line}");
            lines.push(Line { step: parse(line).with_context(|| place.clone())?, place });
        }
    }
    Ok(lines)
}

/// Parses a line.
pub(crate) fn parse(line: &str) -> Result<Step> {
    let (name, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    let action = ACTIONS.iter().find(|action| action.name == name).ok_or_else(|| {
        let names: Vec<&str> = ACTIONS.iter().map(|action| action.name).collect();
        anyhow!("there is no action {name:?}; there are {}", names.join(", "))
    })?;
    let words = Words { rest: rest.trim() };
    let step = match &action.read {
        Read::Plain(command) => words.nothing().map(|()| Step::Run(command.clone())),
        Read::Command(read) => read(words).map(Step::Run),
        Read::Step(read) => read(words),
    };
    step.with_context(|| format!("give {}", format!("{name} {}", action.takes).trim_end()))
}

/// The arguments of an action.
#[derive(Clone, Copy)]
struct Words<'a> {
    rest: &'a str,
}

impl Words<'_> {
    fn text(self) -> Result<String> {
        ensure!(!self.rest.is_empty(), "an argument is missing");
        Ok(self.rest.to_owned())
    }

    fn nothing(self) -> Result<()> {
        ensure!(self.rest.is_empty(), "it takes no arguments");
        Ok(())
    }

    fn numbers<const N: usize>(self) -> Result<[f32; N]> {
        let read = self.rest.split_whitespace().map(|word| {
            let number: f32 = word.parse().map_err(|_| anyhow!("{word:?} is not a number"))?;
            ensure!(number.is_finite(), "{word} is not a finite number");
            Ok(number)
        });
        let numbers: Vec<f32> = read.collect::<Result<_>>()?;
        let count = numbers.len();
        numbers.try_into().map_err(|_| anyhow!("{count} numbers instead of {N}"))
    }

    fn digit(self) -> Result<u8> {
        let [number] = self.numbers()?;
        ensure!((1.0..=9.0).contains(&number) && number.fract() == 0.0, "{number} is not one of 1 to 9");
        Ok(number as u8)
    }

    /// Returns the value of the word in `words` that equals the argument, else an error that ends with
    /// `what`.
    fn one_of<T: Copy>(self, words: &[(&str, T)], what: &str) -> Result<T> {
        let found = words.iter().find(|(word, _)| *word == self.rest);
        found.map(|(_, value)| *value).ok_or_else(|| anyhow!("{:?} {what}", self.rest))
    }

    fn artefact(self) -> Result<Artefact> {
        let words = [("acne", Artefact::Acne), ("aliasing", Artefact::Aliasing), ("hole", Artefact::ClippingHole)];
        self.one_of(&words, "is not an artefact")
    }

    fn toggle(self) -> Result<Toggle> {
        self.one_of(&[("on", Toggle::On), ("off", Toggle::Off)], "is neither on nor off")
    }

    fn chord(self) -> Result<Chord> {
        self.rest.parse().map_err(|_| anyhow!("there is no key {:?}", self.rest))
    }

    fn awaited(self) -> Result<Awaited> {
        let words = [("loaded", Awaited::Loaded), ("judged", Awaited::Judged), ("tuned", Awaited::Tuned)];
        self.one_of(&words, "cannot be awaited")
    }

    fn refusal(self) -> Result<Refusal> {
        let words = [
            ("lost", Refusal::Lost),
            ("outdated", Refusal::Outdated),
            ("timeout", Refusal::Timeout),
            ("occluded", Refusal::Occluded),
        ];
        self.one_of(&words, "is not an answer of a surface")
    }

    fn monkey(self) -> Result<Monkey> {
        let mut words = self.rest.splitn(3, char::is_whitespace);
        let seconds = words.next().unwrap_or_default();
        let [seconds] = Words { rest: seconds }.numbers()?;
        let seed = words.next().context("a seed is missing")?;
        let seed = seed.parse().map_err(|_| anyhow!("{seed:?} is not a whole number"))?;
        Ok(Monkey { seconds, seed, files: words.next().map(str::to_owned) })
    }
}

/// Parses a parameter and its value. Only the name is checked, since the valid values depend on the settings
/// at run time.
fn set(words: Words<'_>) -> Result<Command> {
    let (id, value) = words.rest.split_once(char::is_whitespace).context("a value is missing")?;
    let is_known = params::parameter(id).is_some() || id.starts_with(OPTION_PREFIX);
    ensure!(is_known, "there is no parameter {id:?}; `viewer --parameters` lists them");
    Ok(Command::Set(id.to_owned(), value.trim().to_owned()))
}

/// Parses a preset name or a file name. The command reads the file again later.
fn technique(words: Words<'_>) -> Result<Command> {
    let name = words.text()?;
    NamedTechnique::find(&name)?;
    Ok(Command::Technique(name))
}

fn view(words: Words<'_>) -> Result<Command> {
    let mut settings = Settings::default();
    params::set_from_str(&mut settings, "view.mode", words.rest).map_err(|error| anyhow!("{error}"))?;
    Ok(Command::View(settings.view.mode))
}

fn look(words: Words<'_>) -> Result<Command> {
    let (eye, target) = words.rest.split_once("TO").or_else(|| words.rest.split_once("to")).context("no \"to\"")?;
    let point = |rest| Words { rest }.numbers().map(|point: [f32; 3]| point.map(f64::from));
    Ok(Command::LookAt { eye: point(eye)?, target: point(target)? })
}

fn theme(words: Words<'_>) -> Result<Command> {
    let themes =
        [("dark", ThemePreference::Dark), ("light", ThemePreference::Light), ("system", ThemePreference::System)];
    words.one_of(&themes, "is not a theme").map(Command::SetTheme)
}

fn hold(words: Words<'_>) -> Result<Step> {
    let (key, seconds) = words.rest.split_once(char::is_whitespace).context("a number of seconds is missing")?;
    let [seconds] = Words { rest: seconds }.numbers()?;
    Ok(Step::Hold(Words { rest: key }.chord()?, seconds))
}

#[cfg(test)]
mod tests {
    use shadowfit_params::tool::ViewMode;

    use super::*;

    fn write(text: &str) -> (tempfile::TempDir, std::path::PathBuf) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("script.txt");
        std::fs::write(&path, text).expect("written");
        (folder, path)
    }

    #[test]
    fn a_script_is_read_line_by_line() {
        let text = "# a comment\n\nopen forest\n  await loaded # and go on\nview error\nlook 1 2 3 TO 0 1.5 -2\n\
                    set bias.constant 0.5\nhold w 0.5\ndrag 1 2 3 4\nmonkey 5 7 some folder\nwindow a b.png\nquit\n";
        let (_folder, path) = write(text);
        let chord = "w".parse::<Chord>().expect("a key");
        let lines = read(&path).expect("a script");
        assert!(lines[1].place.ends_with("script.txt:4: await loaded"), "{}", lines[1].place);
        let steps: Vec<Step> = lines.into_iter().map(|line| line.step).collect();
        let expected = [
            Step::Run(Command::Open("forest".to_owned())),
            Step::Await(Awaited::Loaded),
            Step::Run(Command::View(ViewMode::Error)),
            Step::Run(Command::LookAt { eye: [1.0, 2.0, 3.0], target: [0.0, 1.5, -2.0] }),
            Step::Run(Command::Set("bias.constant".to_owned(), "0.5".to_owned())),
            Step::Hold(chord, 0.5),
            Step::Drag([1.0, 2.0], [3.0, 4.0]),
            Step::Monkey(Monkey { seconds: 5.0, seed: 7, files: Some("some folder".to_owned()) }),
            Step::Run(Command::SaveWindow("a b.png".into())),
            Step::Run(Command::Quit),
        ];
        assert_eq!(steps, expected);
    }

    #[test]
    fn a_bad_line_is_named_with_what_would_be_right() {
        for (line, words) in [
            ("jump", &["no action \"jump\"", "quit"][..]),
            ("view upside-down", &["upside-down", "pixels_per_texel", "give view NAME"]),
            ("set no.such 1", &["no.such", "--parameters"]),
            ("set bias.constant", &["a value is missing", "set ID VALUE"]),
            ("technique none", &["\"none\"", "windows-4"]),
            ("click 3", &["1 numbers instead of 2", "click X Y"]),
            ("wait soon", &["\"soon\" is not a number"]),
            ("wait inf", &["not a finite number"]),
            ("press hyper+x", &["no key \"hyper+x\""]),
            ("bookmark 12", &["12 is not one of 1 to 9"]),
            ("quit now", &["it takes no arguments"]),
            ("monkey 3", &["a seed is missing"]),
        ] {
            let (_folder, path) = write(&format!("wait 1\n\n{line}\n"));
            let error = format!("{:#}", read(&path).expect_err(line));
            assert!(error.contains("script.txt:3") && error.contains(line), "{error}");
            assert!(words.iter().all(|word| error.contains(word)), "{error}");
        }
        let error = format!("{:#}", read(Path::new("no/such/file")).expect_err("there is none"));
        assert!(error.contains("no/such/file"), "{error}");
    }

    #[test]
    fn every_action_is_read() {
        let examples = |takes: &str| match takes {
            "" => "",
            "SCENE" => "plain",
            "FILE" | "FILE.png" | "FILE.csv" | "TEXT" => "some.png",
            "ID VALUE" => "map.filter point",
            "NAME|FILE.toml" => "stable-4",
            "NAME" => "truth",
            "acne|aliasing|hole" => "hole",
            "X Y Z TO X Y Z" => "1 2 3 to 4 5 6",
            "on|off" => "on",
            "1..9" => "4",
            "KEY" => "space",
            "KEY SECONDS" => "w 1",
            "X Y" | "WIDTH HEIGHT" => "30 20",
            "X Y X Y" => "1 2 3 4",
            "SECONDS" | "SHARE" | "NOTCHES" | "N" => "1",
            "dark|light|system" => "light",
            "loaded|judged|tuned" => "judged",
            "lost|outdated|timeout|occluded" => "timeout",
            "SECONDS SEED [FOLDER]" => "1 2",
            other => panic!("no example for {other}"),
        };
        for Action { name, takes, does, .. } in ACTIONS {
            assert!(parse(&format!("{name} {}", examples(takes))).is_ok(), "{name} {takes}");
            assert!(!does.is_empty());
        }
    }
}
