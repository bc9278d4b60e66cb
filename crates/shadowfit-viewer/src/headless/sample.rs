//! The pictures of a classic sample, and its figures, without a window.

use std::path::Path;

use anyhow::{Context, Result};
use shadowfit_classics::{OptionKind, Sample, SampleFigures, SampleValues, SampleVariant};
use shadowfit_render::Gpu;

use super::{Progress, SAMPLES};
use crate::arguments::Arguments;
use crate::keep::picture_file::write_png;
use crate::platform::output;
use crate::stage::Stage;

/// Renders the pictures of a sample: the technique as its source has it, without shadows, and beside its comparison,
/// and each of its variants; or one variant alone, if it is named. Then prints how the sample compares with modern
/// maps.
pub(super) fn run(
    arguments: &Arguments,
    (sample, named): (&'static Sample, Option<&'static SampleVariant>),
    folder: &Path,
) -> Result<()> {
    let gpu = pollster::block_on(Gpu::headless(&arguments.adapter()))?;
    let mut stage = Stage::new(gpu, sample.scene(), SAMPLES)?;
    stage.wait_for_rays();
    let size = arguments.size.unwrap_or(sample.size);
    let pictures = if named.is_some() { Vec::new() } else { pictures(sample) };
    let count = if named.is_some() { 1 } else { pictures.len() + sample.variants.len() };
    let mut progress = Progress::begin(count, sample.title, &stage, folder)?;
    let mut save =
        |stage: &mut Stage, variant: Option<&'static SampleVariant>, name: &str, options: &[(&str, &str)]| {
            stage.set_sample(sample, variant);
            for (option, text) in arguments.sample_options().chain(options.iter().copied()) {
                stage.set_sample_text(option, text).with_context(|| format!("--set sample.{option}={text}"))?;
            }
            arguments.apply_what_is_there(&mut stage.settings)?;
            let path = folder.join(name).with_extension("png");
            write_picture(stage, &path, size)?;
            progress.wrote(&path);
            anyhow::Ok(())
        };
    let file = |variant: &SampleVariant| format!("{}-{}", sample.id, variant.id);
    if let Some(variant) = named {
        save(&mut stage, named, &file(variant), &[])?;
    } else {
        for (name, options) in pictures {
            save(&mut stage, None, &name, &options)?;
        }
        for variant in sample.variants {
            save(&mut stage, Some(variant), &file(variant), &[])?;
        }
    }
    progress.end()?;
    if sample.is_measurable {
        tell_figures(arguments, (sample, named), size)?;
    }
    Ok(())
}

/// Names and options of the pictures of the technique itself: as its source has it, and beside its comparison.
fn pictures(sample: &Sample) -> Vec<(String, Vec<(&'static str, &'static str)>)> {
    let mut all = vec![(sample.id.to_owned(), Vec::new())];
    for option in sample.options {
        let OptionKind::Choice(choices) = option.kind else { continue };
        if option.id == "beside" {
            for (id, _) in &choices[1..] {
                let name = id.replace('=', "-");
                all.push((format!("{}-beside-{name}", sample.id), vec![("beside", *id)]));
            }
        } else if option.id == "shadows" && choices.iter().any(|(id, _)| *id == "off") {
            all.push((format!("{}-no-shadows", sample.id), vec![("shadows", "off")]));
        }
    }
    all
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

/// A line between both halves of a picture: white beside black, so that it shows on any picture.
fn draw_line(pixels: &mut [u8], [width, _]: [u32; 2], split: f32) {
    let column = (split * width as f32) as usize;
    for row in pixels.chunks_exact_mut(width as usize * 4) {
        for (x, level) in [(column.saturating_sub(1), 0), (column, 255)] {
            row[x * 4..x * 4 + 3].fill(level);
        }
    }
}

/// Prints how a sample, or a variant of it, compares with modern maps.
fn tell_figures(
    arguments: &Arguments,
    (sample, variant): (&Sample, Option<&SampleVariant>),
    size: [u32; 2],
) -> Result<()> {
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
