//! The visible surface at each pixel of a frame, checked against the renderer's picture without shadows, and
//! the light that truly reaches it.

use anyhow::{Result, ensure};
use glam::DVec3;
use shadowfit_truth::{FlipReference, PixelCamera, Tracer, Truth, TruthPoint, TruthSettings};

use crate::peers::Frame;

/// Greatest share of pixels that may show another surface than rays hit. Rasterisers and rays decide
/// differently at silhouettes.
pub(super) const MAX_DIFFERENT: f64 = 0.01;
/// Greatest difference of brightness between a pixel and its surface, as a share of the brightest surface.
const BRIGHTNESS_TOLERANCE: f64 = 0.01;
/// Least brightness, as a share of the unit, of pixels that define the unit of brightness.
const BRIGHT: f64 = 0.1;
/// Least brightness of pixels whose light factor is defined. In darker pixels the division would amplify
/// rounding errors.
const DARK: f32 = 1e-4;

/// A surface under the sun. All directions are unit vectors, world axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LitSurface {
    /// Normal on the side of the eye.
    pub normal: DVec3,
    /// Direction toward the eye.
    pub to_eye: DVec3,
    /// Direction toward the light.
    pub to_light: DVec3,
}

/// The truth of a frame, and the renderer's picture without shadows.
pub(super) struct Surfaces {
    pub(super) truth: Truth,
    /// Picture without shadows, if the renderer's pictures are brightness.
    pub(super) unshadowed: Option<Vec<f32>>,
    /// The same picture with maps selected by the view depths of the previous frame.
    pub(super) unshadowed_before: Option<Vec<f32>>,
    /// White surfaces under the sun alone, with true shadows.
    reference: FlipReference,
    /// Share of pixels that are left out, 0..=1, because the picture and rays show different surfaces.
    pub(super) different: f64,
}

impl Surfaces {
    /// Traces the truth of a frame. `unshadowed` is the renderer's picture without shadows, and `brightness`
    /// is its brightness of each surface.
    ///
    /// # Errors
    ///
    /// If the picture and rays show different surfaces: the picture belongs to another frame, or its pixels
    /// are misplaced.
    pub(super) fn new(
        tracer: &Tracer,
        frame: &Frame,
        size: [u32; 2],
        unshadowed: Option<Vec<f32>>,
        brightness: &dyn Fn(&LitSurface) -> f64,
    ) -> Result<Self> {
        let camera = PixelCamera::new(frame.camera(), size);
        let mut seen = Truth::seen_by_rays(tracer, &camera);
        let mut different = 0.0;
        if let Some(unshadowed) = &unshadowed {
            let expected = expected(tracer, &camera, frame.to_light(), &seen, brightness);
            let differences = differences(&expected, unshadowed);
            for pixel in &differences {
                seen[*pixel] = None;
            }
            different = differences.len() as f64 / camera.pixels() as f64;
            let (id, percent) = (&frame.id, 100.0 * different);
            ensure!(
                different <= MAX_DIFFERENT,
                "{id}: the picture and rays show different surfaces at {percent:.1}% of the pixels"
            );
        }
        let settings = TruthSettings { max_distance: frame.far, ..TruthSettings::new(frame.to_light()) };
        let truth = Truth::trace(tracer, &camera, &settings, &seen);
        let reference = FlipReference::new(&white(&truth, |_, point| point.lit), size);
        Ok(Self { truth, unshadowed, unshadowed_before: None, reference, different })
    }

    /// Returns the mean ꟻLIP error of white surfaces under the sun alone with these shadow factors.
    pub(super) fn flip(&self, factors: &[f32]) -> f64 {
        self.reference.mean_error(&white(&self.truth, |pixel, _| factors[pixel]))
    }

    /// Adds the picture without shadows whose maps are selected by the view depths of the previous frame.
    ///
    /// # Errors
    ///
    /// If it shows other surfaces.
    pub(super) fn with_before(self, unshadowed: Vec<f32>) -> Result<Self> {
        let now = self.unshadowed.as_deref().unwrap_or_default();
        let different = now.iter().zip(&unshadowed).filter(|(now, then)| (**now > DARK) != (**then > DARK)).count();
        let share = different as f64 / unshadowed.len() as f64;
        let percent = 100.0 * share;
        ensure!(share <= MAX_DIFFERENT, "with the view depths of the frame before, {percent:.1}% of the pixels differ");
        Ok(Self { unshadowed_before: Some(unshadowed), ..self })
    }
}

/// Returns sRGB pixels of white surfaces under the sun alone. `factor` returns the share of the light at a pixel.
/// Pixels that are not judged are black.
fn white(truth: &Truth, factor: impl Fn(usize, &TruthPoint) -> f32) -> Vec<u8> {
    let of_pixel = |(pixel, point): (usize, &Option<TruthPoint>)| {
        let light = point.filter(|point| point.is_judged).map_or(0.0, |point| {
            let factor = factor(pixel, &point);
            if factor.is_nan() { 0.0 } else { point.facing * f64::from(factor.clamp(0.0, 1.0)) }
        });
        let encoded = if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 };
        let byte = (255.0 * encoded).round() as u8;
        [byte, byte, byte, 255]
    };
    truth.points.iter().enumerate().flat_map(of_pixel).collect()
}

/// Returns the share of the light that reaches each pixel, 0..=1: the brightness with shadows over that without.
pub(super) fn factors(shadowed: &[f32], unshadowed: &[f32]) -> Vec<f32> {
    let of_pixel = |(shadowed, lit): (&f32, &f32)| if *lit > DARK { (shadowed / lit).clamp(0.0, 1.0) } else { 1.0 };
    shadowed.iter().zip(unshadowed).map(of_pixel).collect()
}

/// Returns the brightness of each pixel without shadows. Returns `None` where rays hit only triangles beyond
/// the far plane, which the renderer may or may not draw.
fn expected(
    tracer: &Tracer,
    camera: &PixelCamera,
    to_light: DVec3,
    seen: &[Option<u32>],
    brightness: &dyn Fn(&LitSurface) -> f64,
) -> Vec<Option<f64>> {
    let of_pixel = |(pixel, seen): (usize, &Option<u32>)| {
        let ray = camera.ray_of(pixel).direction;
        let Some(triangle) = seen else {
            return tracer.first_hit(camera.eye.as_vec3(), ray.as_vec3()).is_none().then_some(0.0);
        };
        let (normal, to_eye) = (tracer.normal(*triangle).as_dvec3(), -ray.normalize());
        let normal = if normal.dot(to_eye) < 0.0 { -normal } else { normal };
        Some(brightness(&LitSurface { normal, to_eye, to_light }))
    };
    seen.iter().enumerate().map(of_pixel).collect()
}

/// Returns the pixels with an unexpected brightness. The median of the bright pixels defines the unit.
fn differences(expected: &[Option<f64>], unshadowed: &[f32]) -> Vec<usize> {
    let pairs = || expected.iter().zip(unshadowed).enumerate();
    let ratio = |(_, (expected, found)): (usize, (&Option<f64>, &f32))| {
        let expected = expected.filter(|brightness| *brightness > BRIGHT)?;
        Some(f64::from(*found) / expected)
    };
    let mut ratios: Vec<f64> = pairs().filter_map(ratio).collect();
    ratios.sort_by(f64::total_cmp);
    let unit = ratios.get(ratios.len() / 2).copied().unwrap_or(1.0).max(f64::from(DARK));
    let differs = |expected: &Option<f64>, found: f32| {
        expected.is_some_and(|expected| (f64::from(found) / unit - expected).abs() > BRIGHTNESS_TOLERANCE)
    };
    pairs().filter(|(_, (expected, found))| differs(expected, **found)).map(|(pixel, _)| pixel).collect()
}
