//! The commands that the panel's buttons, keys and menus give to the host.

use std::path::PathBuf;

use egui::ThemePreference;
use shadowfit_params::tool::ViewMode;

use crate::Artefact;

/// The keys of the views, in the order of [`ViewMode::ALL`].
pub(crate) const VIEW_KEYS: [&str; ViewMode::ALL.len()] = ["1", "2", "3", "4", "5", "6", "7", "8", "9", "0"];

/// A user's request to the host. The panel only returns commands of its enabled [parts](crate::Part), marked
/// in their docs. All others come from the table of keys ([`KEYS`](crate::KEYS)) and from controls that a
/// host adds around the panel. A host ignores commands that it does not support.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Command {
    /// Show a view.
    View(ViewMode),
    /// Show the view from outside, or the final picture if that view is shown already.
    ToggleOutside,
    /// Mark wrong pixels in the next way: off, outlined, blinking.
    NextMarks,
    /// Show the next choice of shadow maps in the inset: none, one, all.
    NextInset,
    /// Freeze the fit, or let it follow the camera again.
    ToggleFreeze,
    /// Play or pause the animation.
    TogglePlay,
    /// Let the sun move, or stop it.
    ToggleSun,
    /// Pose the scene at a time of its animation, in seconds.
    Scrub(f32),
    /// Move camera and settings so that the artefact is clearly visible. A button of the panel.
    ShowArtefact(Artefact),
    /// Apply the cure of the shown artefact. A button of the panel.
    FixArtefact,
    /// Stop showing the artefact; settings and camera stay as they are. A button of the panel.
    CloseArtefact,
    /// Show two techniques beside each other, or only the first. The host chooses the initial second
    /// technique. A button of the panel.
    Compare(Toggle),
    /// Move the bar between the two pictures of a comparison to this share of the width.
    Split(f32),
    /// Swap the two techniques. A button of the panel.
    SwapSides,
    /// Copy the technique that the controls edit to the other side. A button of the panel.
    CopyToOther,
    /// Undo the last change. A button of the panel.
    Undo,
    /// Redo the change that was undone last. A button of the panel.
    Redo,
    /// Restore the initial settings and camera. A button of the panel.
    Reset,
    /// Restore the initial camera. A button of the panel.
    ResetCamera,
    /// Remove the camera's roll.
    LevelCamera,
    /// Put the eye at a point and look at another, both in metres.
    LookAt {
        /// Position of the eye.
        eye: [f64; 3],
        /// The point to look at.
        target: [f64; 3],
    },
    /// Fly toward the surface at a point of the picture, given as shares of its width and height from the top
    /// left.
    Focus([f32; 2]),
    /// Save the view under a number from 1 to 9.
    SetBookmark(u8),
    /// Go to the view that was saved under a number.
    GoToBookmark(u8),
    /// Open a scene by its name or path.
    Open(String),
    /// Open a file: a scene, a technique, or a picture that carries settings.
    OpenFile(PathBuf),
    /// Let the person choose a file to open.
    ChooseFile,
    /// Set a parameter, named by its id, to a value.
    Set(String, String),
    /// Use a technique, named by a preset or a file.
    Technique(String),
    /// Show a variant of the sample by its index, or the sample as in its source. A menu of the panel.
    ShowSampleVariant(Option<usize>),
    /// Set an option of the sample. A control of the panel.
    SetSampleOption {
        /// Index of the option.
        index: usize,
        /// The number, the index of the choice, or 1 for on.
        value: f32,
    },
    /// Judge the sample, and modern maps in the same view, against rays. A button of the panel.
    MeasureSample,
    /// Start the search for settings with a lower error. A button of the panel.
    StartTune,
    /// End the search early and keep its best result. A button of the panel.
    CancelTune,
    /// Use the result of the search. A button of the panel.
    ApplyTune,
    /// Discard the result of the search. If it was applied, the settings stay. A button of the panel.
    DiscardTune,
    /// Check the graphics device, and show the report. A menu of the panel.
    CheckDevice,
    /// End the check early. The report marks the checks that have not run. A button of the report.
    CancelCheck,
    /// Copy the report as text. A button of the report.
    CopyCheck,
    /// Close the report, and end a running check. A button of the report.
    CloseCheck,
    /// Save the technique that the controls edit under this name, replacing one of the same name. A button of the panel.
    SavePreset(String),
    /// Delete the saved technique of this name. A button of the panel.
    DeletePreset(String),
    /// Copy the technique as Rust code. A menu of the panel.
    CopyRust,
    /// Copy a link to the current scene and settings. A menu of the panel.
    CopyLink,
    /// Copy the command line that starts with this scene and these settings. A menu of the panel.
    CopyCommandLine,
    /// Save the picture to a file, or to a new one if none is named. A button of the panel.
    Screenshot(Option<PathBuf>),
    /// Save the whole window to a file.
    SaveWindow(PathBuf),
    /// Save the plotted figures, [`Panel::figures_csv`](crate::Panel::figures_csv), to a file, or to a new one if none
    /// is named. A button of the panel.
    SaveFigures(Option<PathBuf>),
    /// Use the dark or the light theme, or the system's. [`egui::Context::set_theme`] applies it. A menu of
    /// the panel.
    SetTheme(ThemePreference),
    /// Show or hide the table of keys, see [`help_overlay`](crate::help_overlay). A button of the panel.
    ToggleHelp,
    /// Show or hide the panel.
    TogglePanel,
    /// Close the open menu or the table of keys; quit if neither is open.
    Escape,
    /// Quit the application.
    Quit,
}

/// A request to turn something on, off, or over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Toggle {
    /// Turn it on.
    On,
    /// Turn it off.
    Off,
    /// Turn it on if it is off, and off if it is on.
    Switch,
}

impl Toggle {
    /// Returns the new state.
    pub fn apply(self, is_on: bool) -> bool {
        match self {
            Self::On => true,
            Self::Off => false,
            Self::Switch => !is_on,
        }
    }
}
