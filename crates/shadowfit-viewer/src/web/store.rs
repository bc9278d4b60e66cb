//! State that is saved from one visit to the next: the same text as in the file of the window's viewer, in the browser's
//! local storage.

use shadowfit_study::TRANSLATED;

use super::page;
use crate::saved::Saved;

/// The text that everything is saved in.
#[derive(Clone, Debug, Default)]
pub(crate) struct Store {
    /// The text of the last visit, until it is read.
    kept: Option<String>,
    /// What was saved last, so that nothing is written without need.
    written: Option<String>,
}

impl Store {
    pub(crate) fn new(kept: Option<String>) -> Self {
        Self { kept, written: None }
    }

    /// The saved state, and a message for the user. A text that makes no sense is put aside under another key.
    pub(crate) fn load(&mut self) -> (Option<Saved>, Option<String>) {
        let Some(text) = self.kept.take() else { return (None, None) };
        match Saved::from_toml(&text) {
            Ok(saved) => {
                let note = saved.is_translated.then(|| format!("The saved settings: {TRANSLATED}."));
                (Some(saved), note)
            }
            Err(error) => {
                page::tell("keep aside", &text);
                (None, Some(format!("The saved settings make no sense: {error:#}. The viewer starts afresh.")))
            }
        }
    }

    /// Saves what has changed. Returns a message for the user if it has no text.
    pub(crate) fn keep(&mut self, saved: &Saved) -> Option<String> {
        match saved.to_toml() {
            Ok(text) => {
                if self.written.as_ref() != Some(&text) {
                    page::tell("keep", &text);
                    self.written = Some(text);
                }
                None
            }
            Err(error) => Some(format!("The settings cannot be saved: {error:#}.")),
        }
    }
}
