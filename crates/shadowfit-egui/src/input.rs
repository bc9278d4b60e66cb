//! The panel's input from the host in each frame, and its output.

use shadowfit::Technique;
use shadowfit_params::figures::{Figures, JudgedFigures};
use shadowfit_params::tool::Settings;

use crate::{Artefact, Command};

/// The panel's input for one frame. Start with [`PanelInput::new`] and set the other fields that the host
/// supports.
#[derive(Debug)]
pub struct PanelInput<'a> {
    /// The settings that the controls edit.
    pub settings: &'a mut Settings,
    /// The figures of the last frame.
    pub figures: &'a Figures,
    /// The current scene.
    pub scene: SceneLine<'a>,
    /// The shown artefact, if any.
    pub artefact: Option<ShownArtefact<'a>>,
    /// The card of the scene, if it has one.
    pub card: Option<Card<'a>>,
    /// The second technique of a comparison.
    pub compare: Option<Compare<'a>>,
    /// State of the search for better settings.
    pub tune: Tune<'a>,
    /// Names of the changes that undo and redo would make.
    pub changes: Changes<'a>,
    /// Techniques that the user saved, in display order.
    pub presets: &'a [UserPreset],
    /// Reason why no picture can be judged against rays, if there is one.
    pub unjudged: Option<&'a str>,
    /// A message for the user, such as the result of the last command.
    pub message: Option<&'a str>,
}

impl<'a> PanelInput<'a> {
    /// Makes an input with only settings, figures and scene.
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
    /// Name.
    pub name: &'a str,
    /// Number of triangles.
    pub triangles: u64,
    /// Notes, such as parts that could not be shown.
    pub notes: &'a [String],
}

/// A demonstrated artefact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShownArtefact<'a> {
    /// The artefact.
    pub artefact: Artefact,
    /// Whether the cure is applied.
    pub fixed: bool,
    /// Hint where to look in this scene and view, in a sentence or two; may be empty.
    pub narration: &'a str,
    /// Changes by the cure, a line each, such as "Constant bias: 0 → 1 texel".
    pub changes: &'a [String],
}

impl<'a> ShownArtefact<'a> {
    /// Makes an artefact without its cure, with a sentence about this scene and view.
    pub fn new(artefact: Artefact, narration: &'a str) -> Self {
        Self { artefact, fixed: false, narration, changes: &[] }
    }
}

/// A scene with its own card, such as a classic sample: lesson, variants, and options.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Card<'a> {
    /// Name.
    pub title: &'a str,
    /// Lesson of the scene.
    pub text: &'a str,
    /// Weakness of the shown technique.
    pub flaw: &'a str,
    /// Whether it is currently drawn with a technique of the settings, so that the rest of the panel applies.
    pub is_technique: bool,
    /// Name of the initial variant.
    pub first: &'a str,
    /// Further variants.
    pub variants: &'a [CardChoice<'a>],
    /// Index of the shown variant; `None` for the initial one.
    pub shown: Option<usize>,
    /// Options.
    pub rows: &'a [CardRow<'a>],
    /// Help of the measurement, if the scene can be measured.
    pub measure: Option<&'a str>,
    /// Measured figures, a line each.
    pub figures: &'a [CardFigure],
}

/// A variant of a scene with a card.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CardChoice<'a> {
    /// Name.
    pub label: &'a str,
    /// Text on the visible effect.
    pub text: &'a str,
}

/// An option of a scene with a card.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CardRow<'a> {
    /// Name.
    pub label: &'a str,
    /// Effect.
    pub help: &'a str,
    /// Control.
    pub control: CardControl<'a>,
    /// The number, the index of the choice, or 1 for on.
    pub value: f32,
}

/// Control of an option.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CardControl<'a> {
    /// One of several options, by name and label.
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
    /// Name of the figure.
    pub name: String,
    /// The figure with its unit.
    pub value: String,
}

/// The second technique of a comparison, A | B. A is the technique of the settings, B is [`Self::other`].
#[derive(Debug)]
pub struct Compare<'a> {
    /// Technique B.
    pub other: &'a mut Technique,
    /// Whether the controls edit B. The panel sets it when the user chooses a side.
    pub edits_other: &'a mut bool,
}

/// State of a search for settings with a lower error. Errors are in per cent, as in [`JudgedFigures`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Tune<'a> {
    /// No search.
    #[default]
    Idle,
    /// A running search.
    Running {
        /// Number of techniques judged so far.
        tried: u32,
        /// Greatest number of techniques to judge.
        at_most: u32,
        /// Error of the initial technique. NaN until it was judged; then only `what` is shown.
        start_error: f32,
        /// Least error so far.
        best_error: f32,
        /// Current candidate in a few words, such as "Constant bias 1.5 texels".
        what: &'a str,
    },
    /// A finished search.
    Done {
        /// Figures of the initial technique.
        before: JudgedFigures,
        /// Figures of the best technique.
        after: JudgedFigures,
        /// Changes to the best technique, a line each; empty if none was better.
        changes: &'a [String],
        /// Whether the settings have the changes.
        is_applied: bool,
    },
    /// A failed search, with the reason.
    Failed(&'a str),
}

/// Names of the changes that undo and redo would make, such as "Constant bias"; `None` if there is none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Changes<'a> {
    /// Next change to undo.
    pub undo: Option<&'a str>,
    /// Next change to redo.
    pub redo: Option<&'a str>,
}

/// A technique that the user saved by name.
#[derive(Clone, Debug, PartialEq)]
pub struct UserPreset {
    /// Name.
    pub name: String,
    /// The technique.
    pub technique: Technique,
}

/// The user's requests in this frame, besides changes of the settings.
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
    /// The figures of the picture, judged against rays.
    Quality,
    /// The search for better settings.
    Tune,
    /// Comparison of two techniques, A | B.
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
