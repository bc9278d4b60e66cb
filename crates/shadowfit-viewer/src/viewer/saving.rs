//! Saving of pictures. A picture is saved once its pixels have arrived from the GPU: at once, or in browsers,
//! which cannot wait, some frames later.

use std::path::{Path, PathBuf};

use anyhow::Result;
use shadowfit_render::ReadBack;
use shadowfit_study::settings_to_toml;

use super::Viewer;
use crate::interface::{Canvas, Layout, red_first};
use crate::keep::picture_file::write_png;
use crate::platform::{IS_PAGE, save_file, temporary_folder};

/// The file of a picture.
pub(super) struct Destination {
    pub(super) path: PathBuf,
    /// The line of the script that requested it.
    pub(super) line: Option<String>,
}

/// A picture that waits for its pixels.
pub(super) struct Saving {
    pixels: ReadBack,
    size: [u32; 2],
    is_blue_first: bool,
    pub(super) destination: Destination,
    /// The settings of the picture.
    settings: String,
}

impl Viewer {
    /// Saves the picture without bars and panel.
    pub(super) fn save_picture(&mut self, path: Option<PathBuf>) -> Result<()> {
        let path = self.place(path, "png")?;
        let (pixels, size) = (self.interface.pictures.read_back(&self.stage), self.interface.pictures.size());
        self.save_later(Destination { path, line: self.line.clone() }, pixels, size, false);
        Ok(())
    }

    /// Returns the path of a file to save, with a new name if none is given. Random actions save into a folder that is
    /// removed at the end.
    fn place(&mut self, path: Option<PathBuf>, extension: &str) -> Result<PathBuf> {
        if let Some(path) = path {
            return Ok(self.start.place(path));
        }
        if self.player.is_random() && self.start.folder().is_none() {
            let litter = self.litter.take().map_or_else(temporary_folder, Ok)?;
            return Ok(free_name(self.litter.insert(litter).path(), extension));
        }
        Ok(free_name(self.start.folder().unwrap_or(Path::new("")), extension))
    }

    /// Saves a text as a file of figures.
    pub(super) fn save_text(&mut self, path: Option<PathBuf>, text: &str) -> Result<String> {
        let path = self.place(path, "csv")?;
        save_file(&path, text.as_bytes())?;
        Ok(format!("Saved {}", path.display()))
    }

    /// Returns the text in a saved picture: the scene and all settings, as [`Self::open_picture`] reads them.
    pub(super) fn text_of_settings(&self) -> String {
        let scene = toml::Value::from(self.source.text());
        let line = toml::Value::from(self.command_line());
        let settings = settings_to_toml(&self.stage.settings, "settings.");
        format!("scene = {scene}\ncommand = {line}\n\n{settings}")
    }

    /// Requests a picture of the next frame of the whole window.
    pub(super) fn ask_for_window(&mut self, path: PathBuf) {
        let path = self.start.place(path);
        self.shots.push(Destination { path, line: self.line.clone() });
    }

    /// Saves a frame of the whole window as a picture.
    pub(super) fn save_window(&mut self, layout: &Layout, destination: Destination, size: [u32; 2]) {
        let whole = Canvas::new(&self.stage.gpu().device, size, self.interface.format());
        self.interface.paint(&self.stage, layout, &whole.view, size);
        self.save_later(destination, whole.read_back(self.stage.gpu()), size, whole.is_blue_first());
    }

    /// Saves pixels as a picture with the current settings.
    pub(super) fn save_later(
        &mut self,
        destination: Destination,
        pixels: ReadBack,
        size: [u32; 2],
        is_blue_first: bool,
    ) {
        let settings = self.text_of_settings();
        self.saving.push(Saving { pixels, size, is_blue_first, destination, settings });
        self.take_saved();
    }

    /// Saves the pictures whose pixels have arrived.
    pub(super) fn take_saved(&mut self) {
        for saving in std::mem::take(&mut self.saving) {
            let gpu = self.stage.gpu();
            let pixels = if IS_PAGE { saving.pixels.take(gpu) } else { Some(saving.pixels.wait(gpu)) };
            let Some(pixels) = pixels else {
                self.saving.push(saving);
                continue;
            };
            let Saving { size, is_blue_first, destination: Destination { path, line }, settings, .. } = saving;
            let saved = pixels.map_err(anyhow::Error::from).and_then(|mut pixels| {
                if is_blue_first {
                    red_first(&mut pixels);
                }
                write_png(&path, size, &pixels, Some(&settings))
            });
            // No message for scripts, since it would be visible in the script's next picture of the window.
            if saved.is_ok() && line.is_some() {
                continue;
            }
            let before = std::mem::replace(&mut self.line, line);
            self.tell(saved.map(|()| format!("Saved {}", path.display())));
            self.line = before;
        }
    }
}

/// Returns the first name that no file in a folder has: `shadowfit-001.png`. The empty path is the working folder.
fn free_name(folder: &Path, extension: &str) -> PathBuf {
    let name = |number: u32| folder.join(format!("shadowfit-{number:03}.{extension}"));
    (1..=u32::from(u16::MAX)).map(name).find(|path| !path.exists()).unwrap_or_else(|| name(0))
}
