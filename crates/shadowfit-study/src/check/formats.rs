//! Compares maps of other formats with maps of 32-bit depth: their texels, and the factors that the device
//! looks up in them.

use anyhow::Result;
use shadowfit::FittedMap;
use shadowfit::diagnostics::depth_step;
use shadowfit::settings::{FilterKind, MapFormat};
use shadowfit_render::Renderer;
use shadowfit_wgpu::{ShadowMapDescriptor, ShadowMapError};

use super::bench::{Bench, technique};
use super::look_up::Compared;
use super::numbers::{Point, factors, texels};
use super::outcome::Outcome;
use super::texels::{Difference, Texels};
use super::twin::Twin;
use crate::View;

pub(super) const NAME: &str = "Map formats";
pub(super) const ABOUT: &str = "Compares maps in 16-bit depth and in four colour formats, one of them packed into \
                                bytes, with maps in 32-bit depth: their texels and the factors that are looked up in \
                                them.";
pub(super) const TOLERANCE: &str = "A step of the format for a stored depth, and 2/256 for a factor, as for the \
                                    look-up. Comparisons closer than a step may go either way.";

/// Bilinear look-ups, which all formats support.
const FILTER: FilterKind = FilterKind::Hardware2x2;

/// Reference that all formats are compared with.
struct Reference {
    view: View,
    points: Vec<Point>,
    maps: Vec<FittedMap>,
    texels: Vec<Texels>,
}

/// Sums over all formats.
#[derive(Default)]
struct Found {
    difference: Difference,
    compared: Compared,
    formats: usize,
    refused: Vec<String>,
    /// Formats whose texels or factors differ.
    wrong: Vec<&'static str>,
}

/// Runs the check.
pub(super) async fn run(bench: &mut Bench<'_>) -> Result<Outcome> {
    run_with(bench, &formats(), precision).await
}

/// Returns all formats except the reference format.
fn formats() -> Vec<MapFormat> {
    MapFormat::ALL.into_iter().filter(|format| *format != MapFormat::Depth32Float).collect()
}

/// Returns the greatest rounding of a stored depth of 0..=1: one step, because drivers may round or truncate.
fn precision(format: MapFormat) -> f32 {
    depth_step(format, 1.0)
}

/// Runs the check for some formats, with other roundings.
async fn run_with(
    bench: &mut Bench<'_>,
    formats: &[MapFormat],
    precision: impl Fn(MapFormat) -> f32,
) -> Result<Outcome> {
    let technique = technique().with_filter(FILTER).with_format(MapFormat::Depth32Float);
    let view = Bench::view(0);
    let maps = bench.fit(&technique, Default::default(), &view)?;
    let descriptor = ShadowMapDescriptor::from(&technique);
    let mut renderer = bench.renderer(&descriptor)?;
    bench.draw_maps(&mut renderer, &view, &maps)?;
    let texels = texels(bench.gpu, renderer.shadow_map()).await?;
    let reference = Reference { view, points: bench.points(&view), maps, texels };
    let mut found = Found::default();
    for format in formats.iter().copied() {
        bench.pause().await?;
        let descriptor = ShadowMapDescriptor { format, ..descriptor };
        match bench.renderer(&descriptor) {
            Ok(renderer) => compare(bench, &reference, renderer, precision(format), &mut found).await?,
            Err(error) => found.refused.push(refusal(format, &error)),
        }
    }
    Ok(found.outcome())
}

fn refusal(format: MapFormat, error: &ShadowMapError) -> String {
    format!("; {} not available: {error}", name(format))
}

async fn compare(
    bench: &mut Bench<'_>,
    reference: &Reference,
    mut renderer: Box<Renderer>,
    precision: f32,
    found: &mut Found,
) -> Result<()> {
    let Reference { view, points, maps, texels: expected } = reference;
    bench.draw_maps(&mut renderer, view, maps)?;
    let descriptor = *renderer.shadow_map().descriptor();
    let mut difference = Difference::default();
    for (map, expected) in texels(bench.gpu, renderer.shadow_map()).await?.iter().zip(expected) {
        difference.add(map, expected, precision);
    }
    let factors = factors(bench.gpu, renderer.shadow_map(), points).await?;
    let maps: Vec<FittedMap> = maps.iter().map(|map| map.relative_to(view.camera.eye)).collect();
    let twin = Twin { descriptor: &descriptor, maps: &maps, texels: expected, precision: precision.into() };
    let mut compared = Compared::default();
    compared.add(&twin, points, &factors);
    if !difference.is_explained() || compared.wrong > 0 {
        found.wrong.push(name(descriptor.format));
    }
    found.add(&difference, &compared);
    Ok(())
}

impl Found {
    fn add(&mut self, difference: &Difference, compared: &Compared) {
        self.formats += 1;
        self.difference.texels += difference.texels;
        self.difference.moved += difference.moved;
        self.difference.wrong += difference.wrong;
        self.compared.factors += compared.factors;
        self.compared.wrong += compared.wrong;
        self.compared.worst = self.compared.worst.max(compared.worst);
    }

    fn outcome(&self) -> Outcome {
        let Self { difference, compared, formats, refused, wrong } = self;
        let named = if wrong.is_empty() { String::new() } else { format!(" in {}", wrong.join(", ")) };
        let refused = refused.concat();
        Outcome::of(
            *formats > 0 && wrong.is_empty(),
            format!(
                "{formats} formats: {} of {:.1} million texels and {} of {} factors differ{named}; greatest \
                 difference of a factor {:.4}{refused}",
                difference.wrong,
                difference.texels as f64 / 1e6,
                compared.wrong,
                compared.factors,
                compared.worst,
            ),
        )
    }
}

/// Returns the format's display name.
const fn name(format: MapFormat) -> &'static str {
    match format {
        MapFormat::Depth32Float => "32-bit depth",
        MapFormat::Depth24Unorm => "24-bit depth",
        MapFormat::Depth16Unorm => "16-bit depth",
        MapFormat::R32Float => "32-bit colour",
        MapFormat::R16Float => "16-bit colour",
        MapFormat::Rgba8Packed => "packed bytes",
        MapFormat::R8Grey => "8-bit grey",
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicBool;

    use super::*;

    fn checked(formats: &[MapFormat], precision: impl Fn(MapFormat) -> f32) -> Outcome {
        let (gpu, is_cancelled) = (shadowfit_testing::renderer_gpu(), AtomicBool::new(false));
        let mut bench = Bench::new(&gpu, &is_cancelled).expect("a scene");
        pollster::block_on(run_with(&mut bench, formats, precision)).expect("it runs")
    }

    // Six formats with their shaders: 10 s on the software adapter.
    #[test]
    fn gpu_formats_agree_within_their_steps_and_not_within_those_of_finer_ones() {
        let found = checked(&formats(), precision);
        assert!(matches!(found, Outcome::Passed(_)), "{found:?}");
        let found = checked(&[MapFormat::Depth16Unorm], |_| 0.0);
        let Outcome::Failed(found) = found else { panic!("{found:?}") };
        assert!(found.contains("differ in 16-bit depth;"), "{found}");
    }
}
