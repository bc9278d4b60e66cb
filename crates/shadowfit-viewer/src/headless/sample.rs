//! The pictures of a classic sample, and its figures, without a window.

use std::path::Path;

use anyhow::{Context, Result};
use shadowfit_classics::{OptionKind, Sample, SampleFigures, SampleValues, SampleVariant};
use shadowfit_render::Gpu;

use super::SAMPLES;
use super::progress::Progress;
use crate::arguments::Arguments;
use crate::keep::picture_file::write_png;
use crate::platform::output;
use crate::stage::Stage;

/// Renders the pictures of a sample: the technique as in its source, without shadows, beside its comparison,
/// and each variant; or only the named variant. Then prints how the sample compares with modern maps.
pub(super) fn run(
    arguments: &Arguments,
    sample: &'static Sample,
    named: Option<&'static SampleVariant>,
    folder: &Path,
) -> Result<()> {
    let gpu = pollster::block_on(Gpu::headless(&arguments.adapter()))?;
    let mut stage = Stage::new(gpu, sample.scene(), SAMPLES)?;
    stage.wait_for_rays();
    let size = arguments.size.unwrap_or(sample.size);
    let variants = sample.variants.iter().filter(|variant| named.is_none_or(|named| named == *variant));
    let own = if named.is_some() { Vec::new() } else { SamplePicture::of_options(sample) };
    let pictures: Vec<_> = own.into_iter().chain(variants.map(|variant| SamplePicture::of(sample, variant))).collect();
    let mut progress = Progress::begin(pictures.len(), sample.title, &stage, folder)?;
    for SamplePicture { name, variant, options } in pictures {
        stage.set_sample(sample, variant);
        for (option, text) in arguments.sample_options().chain(options) {
            stage.set_sample_text(option, text).with_context(|| format!("--set sample.{option}={text}"))?;
        }
        arguments.apply_what_is_there(&mut stage.settings)?;
        let path = folder.join(name).with_extension("png");
        write_picture(&mut stage, &path, size)?;
        progress.wrote(&path);
    }
    progress.end()?;
    if sample.is_measurable {
        tell_figures(arguments, sample, named, size)?;
    }
    Ok(())
}

/// A picture of a sample.
struct SamplePicture {
    /// Name of the file, without its extension.
    name: String,
    variant: Option<&'static SampleVariant>,
    /// Options and their values, as on the command line.
    options: Vec<(&'static str, &'static str)>,
}

impl SamplePicture {
    /// Returns the picture of a variant.
    fn of(sample: &Sample, variant: &'static SampleVariant) -> Self {
        Self { name: format!("{}-{}", sample.id, variant.id), variant: Some(variant), options: Vec::new() }
    }

    /// Returns the pictures of the technique itself: as in its source, beside its comparison, and without
    /// shadows.
    fn of_options(sample: &Sample) -> Vec<Self> {
        let mut all = vec![Self { name: sample.id.to_owned(), variant: None, options: Vec::new() }];
        for option in sample.options {
            let OptionKind::Choice(choices) = option.kind else { continue };
            if option.id == "beside" {
                for (id, _) in &choices[1..] {
                    let name = format!("{}-beside-{}", sample.id, id.replace('=', "-"));
                    all.push(Self { name, variant: None, options: vec![("beside", *id)] });
                }
            } else if option.id == "shadows" && choices.iter().any(|(id, _)| *id == "off") {
                let name = format!("{}-no-shadows", sample.id);
                all.push(Self { name, variant: None, options: vec![("shadows", "off")] });
            }
        }
        all
    }
}

fn write_picture(stage: &mut Stage, path: &Path, size: [u32; 2]) -> Result<()> {
    let target = stage.target(size);
    stage.draw(&target);
    if let Some(problem) = stage.problem() {
        output::tell(format_args!("{}: {problem}", path.display()));
    }
    let mut pixels = target.read(stage.gpu())?;
    if stage.sample_halves().is_some() {
        draw_line(&mut pixels, size, stage.split);
    }
    write_png(path, size, &pixels, None)
}

/// Draws a line between both halves of a picture: white beside black, so that it is visible on any picture.
fn draw_line(pixels: &mut [u8], [width, _]: [u32; 2], split: f32) {
    let column = (split * width as f32) as usize;
    for row in pixels.chunks_exact_mut(width as usize * 4) {
        for (x, level) in [(column.saturating_sub(1), 0), (column, 255)] {
            row[x * 4..x * 4 + 3].fill(level);
        }
    }
}

/// Prints how a sample, or a variant of it, compares with modern maps.
fn tell_figures(arguments: &Arguments, sample: &Sample, variant: Option<&SampleVariant>, size: [u32; 2]) -> Result<()> {
    let mut values = SampleValues::of_variant(sample, variant)?;
    for (option, text) in arguments.sample_options() {
        values.set_from_str(option, text)?;
    }
    let camera = sample.seen_by(variant, size[0] as f32 / size[1] as f32);
    let gpu = pollster::block_on(Gpu::headless(&arguments.adapter()))?;
    for (name, value) in SampleFigures::measure(gpu, sample, &values, &camera, 0.0)?.lines() {
        output::print(format_args!("{name}: {value}\n"))?;
    }
    Ok(())
}
