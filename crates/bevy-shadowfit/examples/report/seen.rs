//! What is true of a frame: which surface each pixel shows, whether light reaches it, and how bright it would be
//! without shadows. The picture without shadows is checked against it, pixel by pixel.

use std::error::Error;

use shadowfit::glam::DVec3;
use shadowfit_truth::peers::Frame;
use shadowfit_truth::{PixelCamera, Tracer, Truth, TruthSettings};

/// Greatest share of the pixels whose brightness may differ from that of the surface that the truth sees: silhouettes,
/// where the rasteriser and a ray decide differently.
pub(crate) const MAX_DIFFERENT: f64 = 0.01;
/// Brightnesses differ when they do by more than this share of the brightest surface.
const BRIGHTNESS_TOLERANCE: f64 = 0.01;
/// Least cosine toward the eye in Bevy's shader.
const MIN_TO_EYE: f64 = 1e-4;
/// Pictures are bright from here on: factors of darker pixels would be made of rounding errors.
const DARK: f32 = 1e-4;

/// The truth of a frame, and its picture without shadows.
pub(crate) struct Seen {
    pub(crate) truth: Truth,
    /// Red channels, rows from the top.
    unshadowed: Vec<f32>,
    /// The same picture as the maps of the frame before are drawn with.
    unshadowed_before: Option<Vec<f32>>,
    /// Share of the pixels where Bevy and the truth see different surfaces, 0..=1; they are left out.
    pub(crate) different: f64,
}

impl Seen {
    /// Traces the truth of a frame.
    ///
    /// # Errors
    ///
    /// When the picture shows other surfaces than the rays of the truth find: it belongs to another frame then, or its
    /// pixels lie elsewhere.
    pub(crate) fn new(
        tracer: &Tracer,
        frame: &Frame,
        size: [u32; 2],
        unshadowed: Vec<f32>,
    ) -> Result<Self, Box<dyn Error>> {
        let camera = PixelCamera::new(frame.camera(), size);
        let mut seen = Truth::seen_by_rays(tracer, &camera);
        let expected = expected(tracer, &camera, frame.to_light(), &seen);
        let different = differences(&expected, &unshadowed);
        for pixel in &different {
            seen[*pixel] = None;
        }
        let share = different.len() as f64 / camera.pixels() as f64;
        if share > MAX_DIFFERENT {
            let id = &frame.id;
            let percent = 100.0 * share;
            return Err(format!(
                "{id}: Bevy's picture and the rays show different surfaces at {percent:.1}% of the \
                                pixels"
            )
            .into());
        }
        let settings = TruthSettings { max_distance: frame.far, ..TruthSettings::new(frame.to_light()) };
        let truth = Truth::trace(tracer, &camera, &settings, &seen);
        Ok(Self { truth, unshadowed, unshadowed_before: None, different: share })
    }

    /// Adds the same picture with the view depths of the frame before.
    ///
    /// # Errors
    ///
    /// When it shows other surfaces.
    pub(crate) fn with_before(self, unshadowed: Vec<f32>) -> Result<Self, Box<dyn Error>> {
        let pairs = self.unshadowed.iter().zip(&unshadowed);
        let different = pairs.filter(|(now, then)| (**now > DARK) != (**then > DARK)).count();
        let share = different as f64 / unshadowed.len() as f64;
        if share > MAX_DIFFERENT {
            let percent = 100.0 * share;
            return Err(format!("with the view depths of the frame before, {percent:.1}% of the pixels differ").into());
        }
        Ok(Self { unshadowed_before: Some(unshadowed), ..self })
    }

    /// The share of the light that the maps of a picture let through at each pixel, 0..=1.
    pub(crate) fn factors(&self, picture: &[f32]) -> Vec<f32> {
        factors(picture, &self.unshadowed)
    }

    /// The same for a picture with the view depths of the frame before; `None` if that was not given.
    pub(crate) fn factors_before(&self, picture: &[f32]) -> Option<Vec<f32>> {
        self.unshadowed_before.as_ref().map(|unshadowed| factors(picture, unshadowed))
    }

    /// The picture without shadows.
    pub(crate) fn unshadowed(&self) -> &[f32] {
        &self.unshadowed
    }
}

fn factors(shadowed: &[f32], unshadowed: &[f32]) -> Vec<f32> {
    let of_pixel = |(shadowed, lit): (&f32, &f32)| if *lit > DARK { (shadowed / lit).clamp(0.0, 1.0) } else { 1.0 };
    shadowed.iter().zip(unshadowed).map(of_pixel).collect()
}

/// Brightness of each pixel without shadows, in any unit; `None` where only triangles beyond the far plane are seen,
/// which Bevy may draw or not.
fn expected(tracer: &Tracer, camera: &PixelCamera, to_light: DVec3, seen: &[Option<u32>]) -> Vec<Option<f64>> {
    let of_pixel = |(pixel, seen): (usize, &Option<u32>)| {
        let ray = camera.ray_of(pixel).direction;
        match seen {
            Some(triangle) => Some(brightness(tracer.normal(*triangle).as_dvec3(), -ray.normalize(), to_light)),
            None => tracer.first_hit(camera.eye.as_vec3(), ray.as_vec3()).is_none().then_some(0.0),
        }
    };
    seen.iter().enumerate().map(of_pixel).collect()
}

/// Brightness of a white, fully rough surface in Bevy's shader: Burley's diffuse reflection ("Physically based shading
/// at Disney", 2012). The directions are unit vectors; the surface is seen from the side of the eye.
fn brightness(normal: DVec3, to_eye: DVec3, to_light: DVec3) -> f64 {
    let normal = if normal.dot(to_eye) < 0.0 { -normal } else { normal };
    let (light, eye) = (normal.dot(to_light).clamp(0.0, 1.0), normal.dot(to_eye).max(MIN_TO_EYE));
    let half = (to_light + to_eye).normalize_or_zero().dot(to_light).clamp(0.0, 1.0);
    let f90 = 0.5 + 2.0 * half * half;
    let scatter = |cosine: f64| 1.0 + (f90 - 1.0) * (1.0 - cosine).powi(5);
    light * scatter(light) * scatter(eye)
}

/// Pixels whose brightness is not the expected one. The unit is the picture's, by the median of its bright pixels.
fn differences(expected: &[Option<f64>], unshadowed: &[f32]) -> Vec<usize> {
    let pairs = || expected.iter().zip(unshadowed).enumerate();
    let ratio = |(_, (expected, found)): (usize, (&Option<f64>, &f32))| {
        let expected = expected.filter(|brightness| *brightness > 0.1)?;
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
