//! Scripts: a list of actions, a line each, that the viewer plays as if a person did them. Pictures of the docs and the
//! tests of the window are made by them.
//!
//! ```text
//! # the courtyard, and what rays say of it
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

use anyhow::{Context, Result, anyhow, bail, ensure};
use glam::DVec3;
use shadowfit_egui::Artefact;
use shadowfit_params as params;
use shadowfit_params::tool::Settings;
use shadowfit_study::NamedTechnique;

use crate::cli::OPTION_PREFIX;
use crate::command::{Command, Toggle};
use crate::keys::Chord;
use crate::saved::Theme;
use crate::source::SceneSource;

/// An action of a script.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Step {
    Do(Command),
    Press(Chord),
    /// Seconds.
    Hold(Chord, f32),
    Type(String),
    /// A place in the window, in points, and how often it is clicked.
    Click([f32; 2], u32),
    Hover([f32; 2]),
    Drag([f32; 2], [f32; 2]),
    /// Notches.
    Wheel(f32),
    /// Pixels.
    Resize([u32; 2]),
    Drop(String),
    /// Seconds.
    Wait(f32),
    Frames(u32),
    Await(Awaited),
    Monkey(Monkey),
}

/// A line of a script.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Line {
    pub(crate) step: Step,
    /// File, number and text, for messages.
    pub(crate) place: String,
}

/// What a script waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Awaited {
    /// No scene is being loaded, and no artefact searched.
    Loaded,
    /// The picture on show has been judged.
    Judged,
    /// No search for a technique runs.
    Tuned,
}

/// Random actions.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Monkey {
    pub(crate) seconds: f32,
    pub(crate) seed: u64,
    /// Folder of files that are dropped, good ones and hostile ones.
    pub(crate) files: Option<String>,
}

/// Every action with what follows its name; read by people in the help and in error messages.
pub(crate) const ACTIONS: &[(&str, &str, &str)] = &[
    ("open", "SCENE", "opens courtyard, plain, arcade, forest, a sample or a file"),
    ("drop", "FILE", "drops a file on the window"),
    ("set", "ID VALUE", "sets a parameter, or with `sample.` before its name an option of the sample"),
    ("technique", "NAME|FILE.toml", "takes a technique"),
    ("view", "NAME", "shows a view, by its name in view.mode"),
    ("show", "acne|aliasing|hole", "shows an artefact"),
    ("fix", "", "cures the artefact on show"),
    ("look", "X Y Z TO X Y Z", "puts the eye at a point and looks at another"),
    ("scrub", "SECONDS", "poses the scene at a time of its animation"),
    ("compare", "on|off", "compares two techniques"),
    ("split", "SHARE", "moves the bar between both"),
    ("swap", "", "swaps both techniques"),
    ("copy-to-other", "", "gives the other side this technique"),
    ("undo", "", "takes the last change back"),
    ("redo", "", "makes it again"),
    ("reset", "", "back to the start"),
    ("bookmark", "1..9", "remembers the view"),
    ("goto", "1..9", "goes to a remembered view"),
    ("focus", "X Y", "flies to what is there: shares of the picture from the top left"),
    ("tune", "", "searches a better technique"),
    ("cancel", "", "stops the search"),
    ("apply", "", "takes what was found"),
    ("discard", "", "forgets it"),
    ("preset", "NAME", "saves the technique as a preset"),
    ("theme", "dark|light", "changes the colours"),
    ("panel", "", "hides or shows the panel"),
    ("help", "", "shows or hides the table of the keys"),
    ("press", "KEY", "presses a key, such as w, Ctrl+Z or space"),
    ("hold", "KEY SECONDS", "holds a key"),
    ("type", "TEXT", "types into what has the focus"),
    ("hover", "X Y", "moves the pointer, in points of the window"),
    ("click", "X Y", "clicks"),
    ("doubleclick", "X Y", "clicks twice"),
    ("drag", "X Y X Y", "drags from a place to another"),
    ("wheel", "NOTCHES", "turns the wheel"),
    ("resize", "WIDTH HEIGHT", "resizes the window, in pixels"),
    ("wait", "SECONDS", "waits"),
    ("frames", "N", "waits for a number of frames"),
    ("await", "loaded|judged|tuned", "waits for something to be done"),
    ("picture", "FILE.png", "saves the picture without the panel"),
    ("window", "FILE.png", "saves the whole window"),
    ("figures", "FILE.csv", "saves the plotted figures"),
    ("monkey", "SECONDS SEED [FOLDER]", "does random things, and drops files of a folder"),
    ("quit", "", "ends the viewer"),
];

/// Reads a script; empty lines and what follows a `#` at the start of a word are ignored.
///
/// # Errors
///
/// For a line that is no action, with the name of the file, the number of the line and what would be one.
pub(crate) fn read(path: &Path) -> Result<Vec<Line>> {
    let name = path.display();
    let text = std::fs::read_to_string(path).with_context(|| format!("the script {name} cannot be read"))?;
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

/// Reads a line.
fn parse(line: &str) -> Result<Step> {
    let (action, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    let known = ACTIONS.iter().find(|(name, ..)| *name == action);
    let (_, takes, _) = known.ok_or_else(|| {
        let names: Vec<&str> = ACTIONS.iter().map(|(name, ..)| *name).collect();
        anyhow!("there is no action {action:?}; there are {}", names.join(", "))
    })?;
    let words = Words { rest: rest.trim() };
    let step = match words.command(action) {
        Some(command) => command.map(Step::Do),
        None => words.step(action),
    };
    step.with_context(|| format!("give {}", format!("{action} {takes}").trim_end()))
}

/// What follows an action's name.
#[derive(Clone, Copy)]
struct Words<'a> {
    rest: &'a str,
}

impl Words<'_> {
    /// A command; `None` for what is done with keys, pointer and time.
    fn command(self, action: &str) -> Option<Result<Command>> {
        Some(match action {
            "open" => self.one().map(|text| Command::Open(SceneSource::from_text(text))),
            "set" => self.assignment(),
            "technique" => self.one().and_then(|name| {
                NamedTechnique::find(name)?;
                Ok(Command::Technique(name.to_owned()))
            }),
            "view" => self.view(),
            "show" => self.artefact().map(Command::ShowArtefact),
            "look" => self.look(),
            "scrub" => self.numbers().map(|[seconds]| Command::Scrub(seconds)),
            "compare" => self.toggle().map(Command::Compare),
            "split" => self.numbers().map(|[share]| Command::Split(share)),
            "bookmark" => self.digit().map(Command::SetBookmark),
            "goto" => self.digit().map(Command::GoToBookmark),
            "focus" => self.numbers().map(Command::Focus),
            "preset" => self.one().map(|name| Command::SavePreset(name.to_owned())),
            "theme" => self.theme(),
            "picture" => self.one().map(|file| Command::Picture(Some(file.into()))),
            "window" => self.one().map(|file| Command::Window(file.into())),
            "figures" => self.one().map(|file| Command::SaveFigures(Some(file.into()))),
            _ => return plain(action).map(|command| self.nothing().map(|()| command)),
        })
    }

    fn step(self, action: &str) -> Result<Step> {
        Ok(match action {
            "drop" => Step::Drop(self.one()?.to_owned()),
            "press" => Step::Press(chord(self.one()?)?),
            "hold" => self.hold()?,
            "type" => Step::Type(self.rest.to_owned()),
            "hover" => Step::Hover(self.numbers()?),
            "click" => Step::Click(self.numbers()?, 1),
            "doubleclick" => Step::Click(self.numbers()?, 2),
            "drag" => self.numbers().map(|[a, b, c, d]| Step::Drag([a, b], [c, d]))?,
            "wheel" => self.numbers().map(|[notches]| Step::Wheel(notches))?,
            "resize" => {
                self.numbers::<2>().map(|size| Step::Resize(size.map(|side| side.clamp(1.0, 8192.0) as u32)))?
            }
            "wait" => self.numbers().map(|[seconds]| Step::Wait(seconds))?,
            "frames" => self.numbers().map(|[frames]| Step::Frames(frames as u32))?,
            "await" => Step::Await(self.awaited()?),
            "monkey" => Step::Monkey(self.monkey()?),
            _ => bail!("there is no action {action:?}"),
        })
    }

    fn one(&self) -> Result<&str> {
        ensure!(!self.rest.is_empty(), "something is missing");
        Ok(self.rest)
    }

    fn nothing(self) -> Result<()> {
        ensure!(self.rest.is_empty(), "nothing follows it");
        Ok(())
    }

    fn numbers<const N: usize>(self) -> Result<[f32; N]> {
        let read = self.rest.split_whitespace().map(|word| {
            let number: f32 = word.parse().map_err(|_| anyhow!("{word:?} is no number"))?;
            ensure!(number.is_finite(), "{word} is no number");
            Ok(number)
        });
        let numbers: Vec<f32> = read.collect::<Result<_>>()?;
        let count = numbers.len();
        numbers.try_into().map_err(|_| anyhow!("{count} numbers instead of {N}"))
    }

    fn digit(self) -> Result<u8> {
        let [number] = self.numbers()?;
        ensure!((1.0..=9.0).contains(&number) && number.fract() == 0.0, "{number} is none of 1 to 9");
        Ok(number as u8)
    }

    /// A parameter and its value, of which the name is checked here; whether the value is possible depends on the
    /// settings at that time.
    fn assignment(self) -> Result<Command> {
        let (id, value) = self.rest.split_once(char::is_whitespace).context("a value is missing")?;
        let is_known = params::parameter(id).is_some() || id.starts_with(OPTION_PREFIX);
        ensure!(is_known, "there is no parameter {id:?}; `viewer --parameters` lists them");
        Ok(Command::Set(id.to_owned(), value.trim().to_owned()))
    }

    fn view(self) -> Result<Command> {
        let mut settings = Settings::default();
        params::set_from_str(&mut settings, "view.mode", self.rest)?;
        Ok(Command::View(settings.view.mode))
    }

    fn artefact(self) -> Result<Artefact> {
        match self.rest {
            "acne" => Ok(Artefact::Acne),
            "aliasing" => Ok(Artefact::Aliasing),
            "hole" => Ok(Artefact::ClippingHole),
            other => bail!("{other:?} is no artefact"),
        }
    }

    fn look(self) -> Result<Command> {
        let (eye, target) = self.rest.split_once("TO").or_else(|| self.rest.split_once("to")).context("no \"to\"")?;
        let point = |rest| Words { rest }.numbers().map(|point: [f32; 3]| DVec3::from_array(point.map(f64::from)));
        Ok(Command::LookAt(point(eye)?, point(target)?))
    }

    fn toggle(self) -> Result<Toggle> {
        match self.rest {
            "on" => Ok(Toggle::On),
            "off" => Ok(Toggle::Off),
            other => bail!("{other:?} is neither on nor off"),
        }
    }

    fn theme(self) -> Result<Command> {
        match self.rest {
            "dark" => Ok(Command::SetTheme(Theme::Dark)),
            "light" => Ok(Command::SetTheme(Theme::Light)),
            other => bail!("{other:?} is neither dark nor light"),
        }
    }

    fn hold(self) -> Result<Step> {
        let (key, seconds) = self.rest.split_once(char::is_whitespace).context("a number of seconds is missing")?;
        let [seconds] = Words { rest: seconds }.numbers()?;
        Ok(Step::Hold(chord(key)?, seconds))
    }

    fn awaited(self) -> Result<Awaited> {
        match self.rest {
            "loaded" => Ok(Awaited::Loaded),
            "judged" => Ok(Awaited::Judged),
            "tuned" => Ok(Awaited::Tuned),
            other => bail!("{other:?} is nothing to wait for"),
        }
    }

    fn monkey(self) -> Result<Monkey> {
        let mut words = self.rest.splitn(3, char::is_whitespace);
        let seconds = words.next().unwrap_or_default();
        let [seconds] = Words { rest: seconds }.numbers()?;
        let seed = words.next().context("a seed is missing")?;
        let seed = seed.parse().map_err(|_| anyhow!("{seed:?} is no whole number"))?;
        Ok(Monkey { seconds, seed, files: words.next().map(str::to_owned) })
    }
}

fn chord(text: &str) -> Result<Chord> {
    Chord::from_text(text).with_context(|| format!("there is no key {text:?}"))
}

/// Commands that nothing follows.
fn plain(action: &str) -> Option<Command> {
    Some(match action {
        "fix" => Command::Fix,
        "swap" => Command::SwapSides,
        "copy-to-other" => Command::CopyToOther,
        "undo" => Command::Undo,
        "redo" => Command::Redo,
        "reset" => Command::Reset,
        "tune" => Command::StartTune,
        "cancel" => Command::CancelTune,
        "apply" => Command::ApplyTune,
        "discard" => Command::DiscardTune,
        "panel" => Command::TogglePanel,
        "help" => Command::ToggleHelp,
        "quit" => Command::Quit,
        _ => return None,
    })
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
        let chord = Chord::from_text("w").expect("a key");
        let lines = read(&path).expect("a script");
        assert!(lines[1].place.ends_with("script.txt:4: await loaded"), "{}", lines[1].place);
        let steps: Vec<Step> = lines.into_iter().map(|line| line.step).collect();
        let expected = [
            Step::Do(Command::Open(SceneSource::from_text("forest"))),
            Step::Await(Awaited::Loaded),
            Step::Do(Command::View(ViewMode::Error)),
            Step::Do(Command::LookAt(DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.0, 1.5, -2.0))),
            Step::Do(Command::Set("bias.constant".to_owned(), "0.5".to_owned())),
            Step::Hold(chord, 0.5),
            Step::Drag([1.0, 2.0], [3.0, 4.0]),
            Step::Monkey(Monkey { seconds: 5.0, seed: 7, files: Some("some folder".to_owned()) }),
            Step::Do(Command::Window("a b.png".into())),
            Step::Do(Command::Quit),
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
            ("wait soon", &["\"soon\" is no number"]),
            ("wait inf", &["no number"]),
            ("press hyper+x", &["no key \"hyper+x\""]),
            ("bookmark 12", &["12 is none of 1 to 9"]),
            ("quit now", &["nothing follows it"]),
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
            "dark|light" => "light",
            "loaded|judged|tuned" => "judged",
            "SECONDS SEED [FOLDER]" => "1 2",
            other => panic!("no example for {other}"),
        };
        for (name, takes, help) in ACTIONS {
            assert!(parse(&format!("{name} {}", examples(takes))).is_ok(), "{name} {takes}");
            assert!(!help.is_empty());
        }
    }
}
