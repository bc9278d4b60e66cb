//! The picture set: the views of the window, rendered to PNG files without one.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use shadowfit::tool::{InsetMaps, ViewMode};
use shadowfit_egui::Artefact;
use shadowfit_render::Gpu;

use crate::cli::Arguments;
use crate::files::write_png;
use crate::interface::Interface;
use crate::stage::Stage;

/// Samples per pixel of headless pictures.
const SAMPLES: u32 = 4;
/// Time of the animation at which the pictures are taken, in seconds.
const PICTURE_TIME: f32 = 0.0;

/// Renders the picture set that the arguments ask for and says where it is. What import noted of the scene goes to the
/// standard error.
pub(crate) fn run(arguments: &Arguments, folder: &Path) -> Result<()> {
    let scene = arguments.load_scene()?;
    if let Some(file) = &arguments.scene {
        scene.warnings(file).for_each(|warning| eprintln!("{warning}"));
    }
    let gpu = pollster::block_on(Gpu::headless(arguments.adapter()))?;
    let mut stage = Stage::new(gpu, scene, SAMPLES)?;
    arguments.apply(&mut stage.settings)?;
    stage.animation = arguments.animation;
    stage.set_home();
    let written = render_pictures(&mut stage, folder, arguments.size)?;
    println!(
        "{} pictures of {} by {}, in {}:",
        written.len(),
        stage.scene().name,
        stage.gpu().name(),
        folder.display()
    );
    for path in written {
        println!("  {}", path.file_name().unwrap_or_default().to_string_lossy());
    }
    Ok(())
}

/// Renders the views of a stage into a folder, which is made if it is missing: the final view, each
/// artefact shown and fixed, the view from outside, and the whole interface. Returns the files.
///
/// # Errors
///
/// If a file cannot be written.
pub fn render_pictures(stage: &mut Stage, folder: &Path, size: [u32; 2]) -> Result<Vec<PathBuf>> {
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
    let target = stage.target(size);
    let mut written = Vec::new();
    let mut save = |stage: &mut Stage, name: &str| -> Result<()> {
        stage.draw(&target);
        let path = folder.join(name).with_extension("png");
        write_png(&path, size, &target.read(stage.gpu())?)?;
        written.push(path);
        Ok(())
    };
    stage.reset();
    if stage.settings.view.play {
        stage.set_time(PICTURE_TIME);
    }
    let inset = stage.settings.view.inset;
    stage.settings.view.inset = InsetMaps::Off;
    save(stage, "final")?;
    stage.settings.view.inset = InsetMaps::One;
    save(stage, "inset")?;
    stage.settings.view.inset = inset;
    stage.settings.view.mode = ViewMode::Outside;
    save(stage, "outside")?;
    for (artefact, name) in
        [(Artefact::Acne, "acne"), (Artefact::Aliasing, "aliasing"), (Artefact::ClippingHole, "hole")]
    {
        stage.show_artefact(artefact);
        stage.settings.view.inset = InsetMaps::Off;
        save(stage, name)?;
        stage.fix_artefact(artefact);
        stage.settings.view.inset = InsetMaps::Off;
        save(stage, &format!("{name}-fixed"))?;
    }
    stage.reset();
    stage.show_artefact(Artefact::Acne);
    let path = folder.join("viewer.png");
    render_interface(stage, &path, size)?;
    written.push(path);
    stage.reset();
    Ok(written)
}

/// Renders panel and picture as the window shows them.
fn render_interface(stage: &mut Stage, path: &Path, size: [u32; 2]) -> Result<()> {
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let mut interface = Interface::new(stage, format);
    let whole = stage.target(size);
    let input = || egui::RawInput {
        screen_rect: Some(egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(size[0] as f32, size[1] as f32))),
        ..Default::default()
    };
    // egui settles its layout over a few frames.
    for _ in 0..4 {
        interface.frame(stage, input(), &whole.encoded_view(), size);
    }
    write_png(path, size, &whole.read(stage.gpu())?)
}
