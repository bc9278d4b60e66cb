//! What a host gives the panel in each frame, and what the panel gives back.

use shadowfit::Technique;
use shadowfit_params::figures::{Figures, JudgedFigures};
use shadowfit_params::tool::Settings;

use crate::{Artefact, Command};

/// What the panel shows and edits in one frame. Begin with [`PanelInput::new`] and set what the host has besides.
#[derive(Debug)]
pub struct PanelInput<'a> {
    /// The settings that the controls edit.
    pub settings: &'a mut Settings,
    /// The figures of the last frame.
    pub figures: &'a Figures,
    /// What is being looked at.
    pub scene: SceneLine<'a>,
    /// The artefact that is being shown, if any.
    pub artefact: Option<ShownArtefact<'a>>,
    /// The card of the scene, if it has one.
    pub card: Option<Card<'a>>,
    /// The second technique, where two are compared.
    pub compare: Option<Compare<'a>>,
    /// How far the search for better settings is.
    pub tune: Tune<'a>,
    /// What can be undone and done again.
    pub changes: Changes<'a>,
    /// Techniques that a person saved, in the order that they are offered.
    pub presets: &'a [UserPreset],
    /// Why no picture can be judged against rays, where that is so.
    pub unjudged: Option<&'a str>,
    /// A readable message, such as the outcome of the last command.
    pub message: Option<&'a str>,
}

impl<'a> PanelInput<'a> {
    /// A panel of the settings, figures and scene alone.
    pub fn new(settings: &'a mut Settings, figures: &'a Figures, scene: SceneLine<'a>) -> Self {
        Self {
            settings,
            figures,
            scene,
            artefact: None,
            card: None,
            compare: None,
            tune: Tune::Idle,
            changes: Changes::default(),
            presets: &[],
            unjudged: None,
            message: None,
        }
    }
}

/// The scene, in a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SceneLine<'a> {
    /// Its name.
    pub name: &'a str,
    /// Number of its triangles.
    pub triangles: u64,
    /// Notes about it, such as parts that could not be shown.
    pub notes: &'a [String],
}

/// An artefact that is being shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShownArtefact<'a> {
    /// Which one.
    pub artefact: Artefact,
    /// Whether its cure is applied.
    pub fixed: bool,
    /// What to look for in this scene and view, in a sentence or two; empty where there is nothing to add.
    pub narration: &'a str,
    /// What the cure changed, a line each, such as "Constant bias: 0 → 1 texel".
    pub changes: &'a [String],
}

impl<'a> ShownArtefact<'a> {
    /// An artefact without a cure, with a sentence about this scene and view.
    pub fn new(artefact: Artefact, narration: &'a str) -> Self {
        Self { artefact, fixed: false, narration, changes: &[] }
    }
}

/// A scene with a card: what it teaches, what it can show, and options of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Card<'a> {
    /// Its name.
    pub title: &'a str,
    /// What it teaches.
    pub text: &'a str,
    /// What it does badly.
    pub flaw: &'a str,
    /// Whether a technique of the settings draws it at present, so that the rest of the panel applies.
    pub is_technique: bool,
    /// What it shows at first, by name.
    pub first: &'a str,
    /// What else it can show.
    pub variants: &'a [CardChoice<'a>],
    /// Which of them is on show; `None` for what it shows at first.
    pub shown: Option<usize>,
    /// Its options.
    pub rows: &'a [CardRow<'a>],
    /// What measuring it does, if it can be measured.
    pub measure: Option<&'a str>,
    /// What was measured, a line each.
    pub figures: &'a [CardFigure],
}

/// Something that a scene with a card can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CardChoice<'a> {
    /// Its name.
    pub label: &'a str,
    /// What is to be seen.
    pub text: &'a str,
}

/// An option of a scene with a card.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CardRow<'a> {
    /// Its name.
    pub label: &'a str,
    /// What it does.
    pub help: &'a str,
    /// What sets it.
    pub control: CardControl<'a>,
    /// The number, the index of the choice, or 1 for on.
    pub value: f32,
}

/// What sets an option.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CardControl<'a> {
    /// One of several, by name and label.
    Choice(&'a [(&'a str, &'a str)]),
    /// A number.
    Number {
        /// Least value.
        min: f32,
        /// Greatest value.
        max: f32,
        /// Unit, possibly empty.
        unit: &'a str,
    },
    /// On or off.
    Toggle,
}

/// A figure of a scene with a card.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CardFigure {
    /// What was measured.
    pub name: String,
    /// The figure with its unit.
    pub value: String,
}

/// The other one of two techniques, A | B: A is that of the settings, B is [`Self::other`].
#[derive(Debug)]
pub struct Compare<'a> {
    /// Technique B.
    pub other: &'a mut Technique,
    /// Whether the controls edit B. The panel sets it when a person chooses a side.
    pub edits_other: &'a mut bool,
}

/// How far a search for settings with a lower error is. Errors are in per cent, as those of [`JudgedFigures`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Tune<'a> {
    /// None was begun.
    #[default]
    Idle,
    /// It is running.
    Running {
        /// Techniques that were judged so far.
        tried: u32,
        /// Most that are judged.
        at_most: u32,
        /// Error of the technique that it began with; NaN until it was judged, and nothing but `what` is shown.
        start_error: f32,
        /// Least error so far.
        best_error: f32,
        /// What is being tried, in a few words, such as "Constant bias 1.5 texels".
        what: &'a str,
    },
    /// It has ended.
    Done {
        /// Figures of the technique that it began with.
        before: JudgedFigures,
        /// Figures of the best one.
        after: JudgedFigures,
        /// What the best one changes, a line each; empty where none was better.
        changes: &'a [String],
        /// Whether the settings have the changes.
        is_applied: bool,
    },
    /// It could not be done, with the reason.
    Failed(&'a str),
}

/// What the next undo and redo would do, by name, such as "Constant bias"; `None` where there is nothing to do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Changes<'a> {
    /// What would be undone.
    pub undo: Option<&'a str>,
    /// What would be done again.
    pub redo: Option<&'a str>,
}

/// A technique that a person saved by name.
#[derive(Clone, Debug, PartialEq)]
pub struct UserPreset {
    /// Its name.
    pub name: String,
    /// The technique.
    pub technique: Technique,
}

/// What the person asked for in this frame, beside the settings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PanelOutput {
    /// The command, if any.
    pub command: Option<Command>,
}

/// A part of the panel that a host can leave out, see [`Panel::without`](crate::Panel::without).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Part {
    /// The buttons that show an artefact, and their card.
    Artefacts,
    /// The figures of the picture against rays.
    Quality,
    /// The search for better settings.
    Tune,
    /// Two techniques, A | B.
    Compare,
    /// Saving and deleting techniques by name.
    UserPresets,
    /// Undo and redo.
    Undo,
    /// Copying as a link, as Rust code or as a command line.
    Copy,
    /// Saving the picture.
    Screenshot,
    /// The choice of dark and light.
    Theme,
    /// The check of the graphics device.
    DeviceCheck,
    /// The plots over time.
    Plots,
}
