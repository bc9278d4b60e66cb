//! What only a page can do: the viewer runs in a worker, and sends the page a message for each.

use js_sys::Uint8Array;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

#[wasm_bindgen]
extern "C" {
    /// Sends the page a message: its kind, and what it is about. `web/worker.js` defines it.
    #[wasm_bindgen(js_name = tellPage)]
    fn tell_page(kind: &str, value: &JsValue, name: &str);
}

/// Sends a message of a kind, with a text.
pub(crate) fn tell(kind: &str, text: &str) {
    tell_page(kind, &text.into(), "");
}

/// Saves a file in the user's folder for downloads.
pub(crate) fn download(name: &str, bytes: &[u8]) {
    tell_page("download", &Uint8Array::from(bytes).into(), name);
}

/// Lets the user choose files, which come as [`Page::file`](super::Page::file).
pub(crate) fn choose_file() {
    tell("choose", "");
}

/// Shows a bar that goes from one share to another within some seconds, whatever this worker does meanwhile; `None` takes
/// it away.
pub(crate) fn busy(bar: Option<[f32; 3]>) {
    tell("busy", &bar.map_or(String::new(), |[from, to, seconds]| format!("{from} {to} {seconds}")));
}
