//! Import errors. Each states the file, the element, the reason and a remedy.

use std::path::{Path, PathBuf};

/// Reason for which import refused a scene file. No part of the scene is loaded then.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The file cannot be read.
    #[error("{}: cannot be read: {reason}. {hint}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Reason.
        reason: String,
        /// Remedy.
        hint: &'static str,
    },
    /// The file is not glTF 2.0: truncated, not JSON, or of another version.
    #[error("{}: is not valid glTF 2.0: {element}: {reason}. {hint}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// The part of the file, such as `GLB header`.
        element: String,
        /// Reason.
        reason: String,
        /// Remedy.
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
        /// Remedy.
        hint: &'static str,
    },
    /// One element of the file is invalid.
    #[error("{}: {element}: {reason}. {hint}", path.display())]
    Element {
        /// The file.
        path: PathBuf,
        /// The element, such as `meshes[3].primitives[0].attributes.POSITION, accessor 7`.
        element: String,
        /// Reason.
        reason: String,
        /// Remedy.
        hint: &'static str,
    },
    /// The file has no triangles to draw.
    #[error("{}: nothing to draw: {reason}. {hint}", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
        /// Reason.
        reason: String,
        /// Remedy.
        hint: &'static str,
    },
}

impl SceneError {
    /// Returns the path of the refused file.
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

/// Remedy for data that the specification does not allow.
const RE_EXPORT: &str = "Export the file again, or look at it with the Khronos glTF validator";

/// Returns an entry of a list by its index in the file. If it does not exist, returns a problem of `element`,
/// which contains the index.
pub(crate) fn entry<'a, T>(list: &'a [T], index: usize, kind: &str, element: &str) -> Result<&'a T, Problem> {
    list.get(index).ok_or_else(|| Problem::new(element, format!("there is no {kind} {index}")))
}

impl Problem {
    /// Creates a problem that a correct export does not have.
    pub(crate) fn new(element: impl Into<String>, reason: impl Into<String>) -> Self {
        Self { element: element.into(), reason: reason.into(), hint: RE_EXPORT }
    }

    /// Replaces the hint.
    pub(crate) fn hint(self, hint: &'static str) -> Self {
        Self { hint, ..self }
    }

    /// Returns the reason, for problems that become notes.
    pub(crate) fn reason(&self) -> &str {
        &self.reason
    }

    /// Converts the problem to an error of a file.
    pub(crate) fn at(self, path: &Path) -> SceneError {
        let Self { element, reason, hint } = self;
        SceneError::Element { path: path.to_owned(), element, reason, hint }
    }
}
