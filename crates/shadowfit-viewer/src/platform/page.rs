//! A page in a browser. The viewer runs in a worker, and sends the page a message for everything that only a
//! page can do.

pub(crate) mod files;

use std::io;
use std::path::{Path, PathBuf};
use std::sync::mpsc::Receiver;

use anyhow::Result;
use js_sys::Uint8Array;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

use super::BusyBar;
pub(crate) use files::{load_gltf, read};

/// Bytes of a page of WebAssembly's memory.
const MEMORY_PAGE: u64 = 1 << 16;

#[wasm_bindgen]
extern "C" {
    /// Sends the page a message of a kind, with a value. `web/worker.js` defines it.
    #[wasm_bindgen(js_name = tellPage)]
    fn tell_page(kind: &str, value: &JsValue, name: &str);
}

/// Sends a message of a kind, with a text.
pub(crate) fn tell(kind: &str, text: &str) {
    tell_page(kind, &text.into(), "");
}

/// Saves a file in the user's folder for downloads.
#[expect(clippy::unnecessary_wraps, reason = "files of other systems may not be writable")]
pub(crate) fn save_file(path: &Path, bytes: &[u8]) -> Result<()> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    tell_page("download", &Uint8Array::from(bytes).into(), &name);
    Ok(())
}

/// Lets the user choose files. They arrive later through calls of the page.
pub(crate) fn choose_file() -> Option<Receiver<Option<PathBuf>>> {
    tell("choose", "");
    None
}

/// Shows a bar that the page moves while this worker computes; `None` removes it.
pub(crate) fn busy(bar: Option<BusyBar>) {
    tell("busy", &bar.map_or(String::new(), |BusyBar { from, to, seconds }| format!("{from} {to} {seconds}")));
}

/// Returns the size of the module's memory, in bytes.
#[expect(clippy::unnecessary_wraps, reason = "other systems may not know")]
pub(crate) fn memory() -> Option<u64> {
    Some(core::arch::wasm32::memory_size(0) as u64 * MEMORY_PAGE)
}

/// A folder for temporary files. A page has no folders.
pub(crate) struct TemporaryFolder;

/// Returns a folder for temporary files.
#[expect(clippy::unnecessary_wraps, reason = "folders of other systems may not be writable")]
pub(crate) fn temporary_folder() -> io::Result<TemporaryFolder> {
    Ok(TemporaryFolder)
}

impl TemporaryFolder {
    #[expect(clippy::unused_self, reason = "folders of other systems have a path")]
    pub(crate) fn path(&self) -> &Path {
        Path::new("")
    }
}

/// The viewer's state in the browser's local storage. Changes by other pages are not seen.
#[derive(Clone, Debug)]
pub(crate) struct StateFile {
    /// The text that this page last read or wrote.
    text: Option<String>,
}

#[expect(clippy::unnecessary_wraps, clippy::unused_self, reason = "files of other systems may fail")]
impl StateFile {
    /// Takes the text of the last visit.
    pub(crate) fn of_text(text: Option<String>) -> Self {
        Self { text }
    }

    /// Returns the name of the storage for messages.
    pub(crate) fn name(&self) -> Option<String> {
        Some("the browser's storage".to_owned())
    }

    /// Returns the text, `None` at a first visit.
    pub(crate) fn read(&self) -> io::Result<Option<Result<String>>> {
        Ok(self.text.clone().map(Ok))
    }

    /// Runs `work`: no other page waits for it.
    pub(crate) fn locked<T>(&mut self, work: impl FnOnce(&mut Self) -> Result<T>) -> Result<T> {
        work(self)
    }

    /// Replaces the text.
    pub(crate) fn write(&mut self, text: &str) -> Result<()> {
        tell("keep", text);
        self.text = Some(text.to_owned());
        Ok(())
    }

    /// Puts a damaged text under another key. Returns a sentence about that, with the consequence `then`.
    pub(crate) fn set_aside(&mut self, then: &str) -> String {
        tell("keep aside", &self.text.take().unwrap_or_default());
        format!("They are set aside, and {then}.")
    }
}
