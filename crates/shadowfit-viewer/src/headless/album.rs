//! The pictures of a scene: every view, each artefact, and the whole interface.

use std::path::Path;

use anyhow::Result;
use shadowfit_egui::Artefact;
use shadowfit_params::tool::{ErrorMarks, InsetMaps, ViewMode};
use shadowfit_study::make_folder;

use super::{FORMAT, FRAME, input};
use crate::interface::{Canvas, Interface, InterfaceInput};
use crate::keep::picture_file::write_png;
use crate::keep::saved::Saved;
use crate::stage::{Stage, compared_with};

/// Number of pictures of a scene.
pub const PICTURES: usize = 24;
/// Animation time of the pictures, in seconds.
const PICTURE_TIME: f32 = 0.0;
/// Frames that egui needs for a stable layout.
const SETTLING: u32 = 4;

/// A picture set being written into a folder.
struct Album<'a> {
    /// Called with each written picture.
    tell: &'a mut dyn FnMut(&Path),
    stage: &'a mut Stage,
    interface: Interface,
    folder: &'a Path,
    size: [u32; 2],
    canvas: Canvas,
}

/// Renders the picture set of a stage into a folder, which is made if missing: every view, the inset, two
/// techniques side by side, each artefact shown, marked and fixed, and the whole interface dark and light.
/// Calls `tell` with the path of each of these [`PICTURES`] files when it is written.
///
/// # Errors
///
/// If a file cannot be written.
pub fn render_pictures(stage: &mut Stage, folder: &Path, size: [u32; 2], tell: &mut dyn FnMut(&Path)) -> Result<()> {
    make_folder(folder)?;
    stage.reset();
    stage.wait_for_rays();
    if stage.settings.view.play {
        stage.set_time(PICTURE_TIME);
    }
    let canvas = Canvas::new(&stage.gpu().device, size, FORMAT);
    let interface = Interface::new(stage, FORMAT);
    // No picture may show an element that is fading in.
    interface.context.all_styles_mut(|style| style.animation_time = 0.0);
    let mut album = Album { tell, stage, interface, folder, size, canvas };
    album.views()?;
    album.artefacts()?;
    album.windows()?;
    album.stage.reset();
    Ok(())
}

impl Album<'_> {
    /// Saves every view under its name.
    fn views(&mut self) -> Result<()> {
        self.interface.bare = true;
        self.judge_what_shows_it();
        let names = [
            "final",
            "truth",
            "errors",
            "pixels-per-texel",
            "maps",
            "texel-grid",
            "demand",
            "updates",
            "outside",
            "traced",
        ];
        for (mode, name) in ViewMode::ALL.into_iter().zip(names) {
            self.stage.settings.view.mode = mode;
            self.stage.settings.view.inset = InsetMaps::Off;
            self.save(name)?;
        }
        self.stage.settings.view.mode = ViewMode::Final;
        for (inset, name) in [(InsetMaps::One, "inset"), (InsetMaps::All, "inset-all")] {
            self.stage.settings.view.inset = inset;
            self.save(name)?;
        }
        self.stage.settings.view.inset = InsetMaps::Off;
        self.stage.settings.view.mode = ViewMode::Error;
        self.stage.compare_with(Some(compared_with(&self.stage.settings.technique)));
        self.save("split")?;
        self.stage.compare_with(None);
        self.stage.reset();
        Ok(())
    }

    /// Saves each artefact: shown, with its wrong pixels marked, and fixed.
    fn artefacts(&mut self) -> Result<()> {
        for (artefact, name) in
            [(Artefact::Acne, "acne"), (Artefact::Aliasing, "aliasing"), (Artefact::ClippingHole, "hole")]
        {
            self.stage.show_artefact(artefact);
            self.judge_what_shows_it();
            self.stage.settings.view.inset = InsetMaps::Off;
            self.save(name)?;
            self.stage.settings.view.marks = ErrorMarks::Outline;
            self.save(&format!("{name}-marked"))?;
            self.stage.settings.view.marks = ErrorMarks::Off;
            self.stage.fix_artefact(artefact);
            self.save(&format!("{name}-fixed"))?;
        }
        self.stage.reset();
        Ok(())
    }

    /// Turns off judging for views that do not show it. Without the panel no figures are visible, and judging
    /// takes as long as drawing, so the first picture is ready in half the time.
    fn judge_what_shows_it(&mut self) {
        self.stage.settings.view.judge = false;
    }

    /// Saves the whole interface.
    fn windows(&mut self) -> Result<()> {
        self.interface.bare = false;
        for (theme, name) in [(egui::Theme::Dark, "viewer"), (egui::Theme::Light, "viewer-light")] {
            self.interface.context.set_theme(theme);
            self.stage.reset();
            self.stage.show_artefact(Artefact::Acne);
            self.stage.settings.view.marks = ErrorMarks::Outline;
            self.save(name)?;
        }
        Ok(())
    }

    /// Draws until the layout is stable, and saves the frame.
    fn save(&mut self, name: &str) -> Result<()> {
        let saved = Saved::default();
        let shown = InterfaceInput::at_rest(&saved);
        for frame in 0..SETTLING {
            let clock = f64::from(frame) * f64::from(FRAME);
            let (_, layout, _) = self.interface.layout(self.stage, &shown, input(self.size, clock));
            // Verdicts arrive with the next frame, and the legend moves into its corner in the frame after
            // that.
            if (SETTLING - 3..SETTLING - 1).contains(&frame) {
                self.interface.pictures.draw(self.stage);
            }
            self.interface.paint(self.stage, &layout, &self.canvas.view, self.size);
        }
        let path = self.folder.join(name).with_extension("png");
        write_png(&path, self.size, &self.canvas.read(self.stage.gpu())?, None)?;
        (self.tell)(&path);
        Ok(())
    }
}
