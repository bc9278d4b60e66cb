//! Judges the picture by rays.

use shadowfit_truth::{PixelCamera, Tracer, Truth, TruthSettings};

use crate::courtyard::Courtyard;

/// Returns the percentage of wrong pixels among the pixels that face the sun. A pixel is wrong if rays to the sun and its
/// factor disagree on whether it gets at least half of the light. `factors` has rows from the top.
pub(crate) fn wrong(courtyard: &Courtyard, size: [u32; 2], factors: &[f32]) -> f64 {
    let tracer = Tracer::new(courtyard.objects.iter().flatten().copied());
    let camera = PixelCamera::new(courtyard.camera, size);
    let settings = TruthSettings::new(-courtyard.sun.as_dvec3().normalize());
    let truth = Truth::trace(&tracer, &camera, &settings, &Truth::seen_by_rays(&tracer, &camera));
    let (mut wrong, mut all) = (0, 0);
    for (pixel, factor) in factors.iter().enumerate() {
        let Some(is_lit) = truth.verdict(pixel) else { continue };
        all += 1;
        wrong += i32::from(is_lit != (*factor >= 0.5));
    }
    100.0 * f64::from(wrong) / f64::from(all)
}
