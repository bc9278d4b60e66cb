//! Errors of import, each with the file, the element, the reason and what to do.

use std::path::{Path, PathBuf};

/// Why a scene file was refused. No part of the scene is loaded then.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The file itself cannot be read.
    #[error("{}: cannot be read: {reason}. {hint}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What went wrong.
        reason: String,
        /// What to do about it.
        hint: &'static str,
    },
    /// The file is not glTF 2.0: truncated, not JSON, or of another version.
    #[error("{}: is not valid glTF 2.0: {element}: {reason}. {hint}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// The part of the file, such as `GLB header`.
        element: String,
        /// What is wrong with it.
        reason: String,
        /// What to do about it.
        hint: &'static str,
    },
    /// The file requires an extension that import does not support.
    #[error("{}: {element} requires {name}, which import does not support. {hint}", path.display())]
    Extension {
        /// The file.
        path: PathBuf,
        /// The entry that requires it, such as `extensionsRequired[0]`.
        element: String,
        /// Name of the extension.
        name: String,
        /// What to do about it.
        hint: &'static str,
    },
    /// One element of the file is invalid.
    #[error("{}: {element}: {reason}. {hint}", path.display())]
    Element {
        /// The file.
        path: PathBuf,
        /// The element, such as `meshes[3].primitives[0].attributes.POSITION, accessor 7`.
        element: String,
        /// What is wrong with it.
        reason: String,
        /// What to do about it.
        hint: &'static str,
    },
    /// The file holds nothing that could be drawn.
    #[error("{}: nothing to draw: {reason}. {hint}", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
        /// What is missing.
        reason: String,
        /// What to do about it.
        hint: &'static str,
    },
}

impl SceneError {
    /// The file that was refused.
    pub fn path(&self) -> &Path {
        match self {
            Self::Unreadable { path, .. }
            | Self::Malformed { path, .. }
            | Self::Extension { path, .. }
            | Self::Element { path, .. }
            | Self::Empty { path, .. } => path,
        }
    }
}

/// An invalid element, before the file's name is known.
#[derive(Clone, Debug)]
pub(crate) struct Problem {
    element: String,
    reason: String,
    hint: &'static str,
}

/// What to do about data that the specification does not allow.
const RE_EXPORT: &str = "Export the file again, or look at it with the Khronos glTF validator";

/// The entry of a list that an index in the file names; what names one that does not exist is the problem's element.
pub(crate) fn entry<'a, T>(list: &'a [T], index: usize, kind: &str, element: &str) -> Result<&'a T, Problem> {
    list.get(index).ok_or_else(|| Problem::new(element, format!("there is no {kind} {index}")))
}

impl Problem {
    /// A problem that a correct export does not have.
    pub(crate) fn new(element: impl Into<String>, reason: impl Into<String>) -> Self {
        Self { element: element.into(), reason: reason.into(), hint: RE_EXPORT }
    }

    /// The same problem with another hint.
    pub(crate) fn hint(self, hint: &'static str) -> Self {
        Self { hint, ..self }
    }

    /// The reason, for problems that become notes.
    pub(crate) fn reason(&self) -> &str {
        &self.reason
    }

    /// The error, with the name of the file.
    pub(crate) fn at(self, path: &Path) -> SceneError {
        let Self { element, reason, hint } = self;
        SceneError::Element { path: path.to_owned(), element, reason, hint }
    }
}
