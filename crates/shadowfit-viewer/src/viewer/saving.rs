//! Pictures are saved once their pixels have come back from the GPU: at once, or in browsers, where nothing can wait, some
//! frames later.

use std::path::PathBuf;

use shadowfit_render::ReadBack;

use super::Viewer;
use crate::files::write_png;
use crate::interface::{Canvas, Layout, red_first};

/// A picture whose pixels are on their way.
pub(super) struct Saving {
    pixels: ReadBack,
    size: [u32; 2],
    is_blue_first: bool,
    pub(super) path: PathBuf,
    /// The settings that it was made with.
    settings: String,
    /// The line of the script that asked for it.
    pub(super) line: Option<String>,
}

impl Viewer {
    /// Saves a frame of the whole window as a picture.
    pub(super) fn save_window(&mut self, layout: &Layout, place: (PathBuf, Option<String>), size: [u32; 2]) {
        let whole = Canvas::new(&self.stage.gpu().device, size, self.interface.format());
        self.interface.paint(&self.stage, layout, &whole.view, size);
        self.save_later(place, whole.read_back(self.stage.gpu()), size, whole.is_blue_first());
    }

    /// Saves pixels as a picture with the present settings. `place` is its path, and the line of the script that asked
    /// for it.
    pub(super) fn save_later(
        &mut self,
        (path, line): (PathBuf, Option<String>),
        pixels: ReadBack,
        size: [u32; 2],
        is_blue_first: bool,
    ) {
        let settings = self.text_of_settings();
        self.saving.push(Saving { pixels, size, is_blue_first, path, settings, line });
        self.take_saved();
    }

    /// Saves the pictures whose pixels have come.
    pub(super) fn take_saved(&mut self) {
        for saving in std::mem::take(&mut self.saving) {
            let gpu = self.stage.gpu();
            let pixels =
                if cfg!(target_family = "wasm") { saving.pixels.take(gpu) } else { Some(saving.pixels.wait(gpu)) };
            let Some(pixels) = pixels else {
                self.saving.push(saving);
                continue;
            };
            let Saving { size, is_blue_first, path, settings, line, .. } = saving;
            let saved = pixels.map_err(anyhow::Error::from).and_then(|mut pixels| {
                if is_blue_first {
                    red_first(&mut pixels);
                }
                write_png(&path, size, &pixels, Some(&settings))
            });
            // A script's next picture of the window would show that its last one was saved.
            if saved.is_ok() && line.is_some() {
                continue;
            }
            let before = std::mem::replace(&mut self.line, line);
            self.tell(saved.map(|()| format!("Saved {}", path.display())));
            self.line = before;
        }
    }
}
