//! Errors in input files: the file, the element, and the reason.

use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;

/// An error in a file of scenarios or fits.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}: {element}: {reason}", file.display())]
pub struct PeersError {
    /// The file.
    pub file: PathBuf,
    /// The wrong element, such as `frames[3].maps[0].view_proj`, or `file` for the whole file.
    pub element: String,
    /// The reason.
    pub reason: String,
}

/// A wrong element, without the name of its file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Problem {
    element: String,
    reason: String,
}

impl Problem {
    /// Creates a problem of `element` with a reason.
    pub(crate) fn new(element: impl Into<String>, reason: impl Into<String>) -> Self {
        Self { element: element.into(), reason: reason.into() }
    }

    /// Adds the file's name.
    pub(crate) fn at(self, file: &Path) -> PeersError {
        PeersError { file: file.to_owned(), element: self.element, reason: self.reason }
    }
}

/// Reads a JSON file.
pub(crate) fn read_json<T: DeserializeOwned>(file: &Path) -> Result<T, PeersError> {
    let text =
        std::fs::read(file).map_err(|error| Problem::new("file", format!("cannot be read: {error}")).at(file))?;
    parse_json(&text).map_err(|problem| problem.at(file))
}

/// Parses JSON. The element of a problem is its path, such as `frames[3].view`.
pub(crate) fn parse_json<T: DeserializeOwned>(text: &[u8]) -> Result<T, Problem> {
    let mut json = serde_json::Deserializer::from_slice(text);
    let value = serde_path_to_error::deserialize(&mut json)
        .map_err(|error| Problem::new(element(&error.path().to_string()), error.inner().to_string()))?;
    json.end().map_err(|error| Problem::new("file", error.to_string()))?;
    Ok(value)
}

/// Returns a readable name of a path in JSON. The path of the whole file is "." or, if nothing was read, "?".
fn element(path: &str) -> &str {
    if matches!(path, "." | "?") { "file" } else { path }
}

/// Returns a problem unless all `values` are finite.
pub(crate) fn check_finite(element: impl Fn() -> String, values: &[f64]) -> Result<(), Problem> {
    match values.iter().find(|value| !value.is_finite()) {
        Some(value) => Err(Problem::new(element(), format!("{value} is not finite"))),
        None => Ok(()),
    }
}
