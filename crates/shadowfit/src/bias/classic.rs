//! The biases of the classic techniques as plain depth numbers, with their flaws.

use crate::base::{FitError, checks};
use crate::technique::settings::FilterKind;

/// Depth bias of the XNA Shadow Mapping sample (Microsoft, 2008), in units of the stored depth. A point is in
/// shadow if `stored < depth - 0.001`. See [`Bias::fixed`](crate::Bias::fixed).
pub const XNA_DEPTH_BIAS: f32 = 0.001;

/// Greatest value of [`acos_bias`], in units of the stored depth.
pub const ACOS_BIAS_LIMIT: f32 = 0.1;

/// Returns epsilon of [`acos_bias`] for a filter, in units of the stored depth times radians: 0.001 for one
/// comparison, 0.0005 with the hardware's linear filtering.
pub const fn acos_epsilon(filter: FilterKind) -> f32 {
    if matches!(filter, FilterKind::Point) { 0.001 } else { 0.0005 }
}

/// Returns `epsilon / acos(saturate(N·L))` within 0..=[`ACOS_BIAS_LIMIT`], in units of the stored depth.
/// `cosine` is N·L, and `epsilon` is usually [`acos_epsilon`].
///
/// This formula dates from the first comparison samplers, and is kept to show its flaw. It is meant to
/// approximate `epsilon · tan(acos N·L)`, but it is *largest* head-on (the limit at 0°, 0.01 at 0.1 rad) and
/// *least* at grazing light (0.00064 at 90°), where acne is worst. Its source adds it to the depth of a map
/// that holds back faces. With front faces it has to be subtracted.
/// [`Bias::slope_depth`](crate::Bias::slope_depth) is the correct form.
///
/// # Errors
///
/// Returns [`FitError::NotFinite`], and [`FitError::OutOfRange`] for an epsilon below zero.
pub fn acos_bias(epsilon: f32, cosine: f32) -> Result<f32, FitError> {
    checks::within("epsilon", f64::from(epsilon), 0.0, checks::MAX_LENGTH)?;
    checks::finite("N·L", f64::from(cosine))?;
    let angle = libm::acosf(cosine.clamp(0.0, 1.0));
    // Head-on the angle is 0, so any epsilon but 0 gives the limit.
    Ok((epsilon / angle.max(f32::MIN_POSITIVE)).min(ACOS_BIAS_LIMIT))
}
