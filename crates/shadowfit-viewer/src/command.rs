//! What can be asked of the viewer: by a key, a button, a gamepad or a line of a script, all in the same words.

use std::path::PathBuf;

use glam::DVec3;
use shadowfit_egui::{Action, Artefact};
use shadowfit_params::tool::ViewMode;

use crate::saved::Theme;
use crate::source::SceneSource;

/// Something to do.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Command {
    /// Shows a view.
    View(ViewMode),
    /// Shows the view from outside, or the final picture where it is shown.
    ToggleOutside,
    /// The next way of marking wrong pixels.
    NextMarks,
    /// The next choice of maps in the inset.
    NextInset,
    /// Freezes the fit, or lets it go on.
    ToggleFreeze,
    /// Plays or pauses the animation.
    TogglePlay,
    /// Lets the sun move or stand.
    ToggleSun,
    /// Poses the scene at a time of its animation, in seconds.
    Scrub(f32),
    /// Shows an artefact.
    ShowArtefact(Artefact),
    /// Cures the artefact on show.
    Fix,
    /// Stops showing an artefact; settings and camera stay.
    CloseArtefact,
    /// Compares two techniques, or stops it.
    Compare(Toggle),
    /// Where the bar between both pictures stands, as a share of the width.
    Split(f32),
    /// Swaps both techniques.
    SwapSides,
    /// Gives the other side this technique.
    CopyToOther,
    /// Takes the last change back.
    Undo,
    /// Makes the change again that was taken back.
    Redo,
    /// Back to the settings and the view of the start.
    Reset,
    /// Back to the view of the start.
    ResetCamera,
    /// Opens a scene.
    Open(SceneSource),
    /// Lets a person choose a file.
    ChooseFile,
    /// Opens a scene, a technique, a screenshot or saved settings, whatever a file is.
    OpenFile(PathBuf),
    /// Sets a parameter.
    Set(String, String),
    /// Takes a technique by name or from a file.
    Technique(String),
    /// Puts the eye somewhere and looks at a point.
    LookAt(DVec3, DVec3),
    /// Flies to what is at a point of the picture: shares of its width and height from the top left.
    Focus([f32; 2]),
    /// Remembers the view under a number.
    SetBookmark(u8),
    /// Goes to the view of a number.
    GoToBookmark(u8),
    /// Shows a variant of the sample by its index, or the sample as its source has it.
    SampleVariant(Option<usize>),
    /// Sets an option of the sample by its index.
    SampleOption(usize, f32),
    /// Judges the sample and modern maps against rays.
    MeasureSample,
    /// Searches a better technique.
    StartTune,
    /// Stops the search.
    CancelTune,
    /// Takes what was found.
    ApplyTune,
    /// Forgets what was found.
    DiscardTune,
    /// Saves the picture, under a name of its own if none is given.
    Picture(Option<PathBuf>),
    /// Saves the whole window.
    Window(PathBuf),
    /// Saves the plotted figures.
    SaveFigures(Option<PathBuf>),
    /// Saves this text, figures as comma-separated values.
    SaveCsv(String),
    /// Copies the technique as Rust code.
    CopyRust,
    /// Copies the command line that starts with these settings.
    CopyCommandLine,
    /// Saves the technique as a preset.
    SavePreset(String),
    /// Deletes a preset.
    DeletePreset(String),
    /// Shows or hides the table of the keys.
    ToggleHelp,
    /// Shows or hides the panel.
    TogglePanel,
    /// Dark or light.
    SetTheme(Theme),
    /// Ends the viewer.
    Quit,
    /// Closes the menu or the help that is open; ends the viewer where none is.
    Escape,
}

/// On, off, or the other one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Toggle {
    On,
    Off,
    Other,
}

impl Toggle {
    /// What comes of it where it was `on`.
    pub(crate) fn apply(self, on: bool) -> bool {
        match self {
            Self::On => true,
            Self::Off => false,
            Self::Other => !on,
        }
    }
}

impl Command {
    /// What a button of the panel asks for; `None` for what this viewer does not know yet.
    pub(crate) fn from_action(action: Action) -> Option<Self> {
        Some(match action {
            Action::ShowArtefact(artefact) => Self::ShowArtefact(artefact),
            Action::FixArtefact(_) => Self::Fix,
            Action::CloseArtefact => Self::CloseArtefact,
            Action::StartCompare => Self::Compare(Toggle::On),
            Action::StopCompare => Self::Compare(Toggle::Off),
            Action::SwapSides => Self::SwapSides,
            Action::CopyToOther => Self::CopyToOther,
            Action::ShowSampleVariant(variant) => Self::SampleVariant(variant),
            Action::SetSampleOption { index, bits } => Self::SampleOption(index, f32::from_bits(bits)),
            Action::MeasureSample => Self::MeasureSample,
            Action::StartTune => Self::StartTune,
            Action::CancelTune => Self::CancelTune,
            Action::ApplyTune => Self::ApplyTune,
            Action::DiscardTune => Self::DiscardTune,
            Action::Undo => Self::Undo,
            Action::Redo => Self::Redo,
            Action::SavePreset(name) => Self::SavePreset(name),
            Action::DeletePreset(name) => Self::DeletePreset(name),
            Action::CopyRust => Self::CopyRust,
            Action::CopyCommandLine => Self::CopyCommandLine,
            Action::SaveCsv(text) => Self::SaveCsv(text),
            Action::Screenshot => Self::Picture(None),
            Action::Reset => Self::Reset,
            Action::ResetCamera => Self::ResetCamera,
            Action::SetTheme(theme) => Self::SetTheme(theme.into()),
            Action::OpenHelp => Self::ToggleHelp,
            _ => return None,
        })
    }
}
