//! Biases of the technique's filter and of other filters.

use shadowfit::bias::FilterRadius;
use shadowfit::diagnostics::DepthStorage;
use shadowfit::glam::Vec2;
use shadowfit::{Bias, LightProjection};

use crate::error::{Failure, ShadowfitResult as Code};
use crate::types::{
    SHADOWFIT_BIAS_CONSTANT, SHADOWFIT_BIAS_NORMAL_OFFSET, SHADOWFIT_BIAS_RECEIVER_PLANE, SHADOWFIT_FORMAT_FLOAT32,
    SHADOWFIT_FORMAT_UNORM16, SHADOWFIT_FORMAT_UNORM24, ShadowfitBias, ShadowfitFilter,
};

/// Returns a bias as plain data.
pub(crate) const fn written(bias: &Bias) -> ShadowfitBias {
    let Bias { constant_depth, slope_depth, normal_offset, receiver_plane } = *bias;
    ShadowfitBias { constant_depth, slope_depth, normal_offset, receiver_plane }
}

/// Returns the smallest bias that clears planes for a filter of the caller's shader.
pub(crate) fn of_filter(
    filter: &ShadowfitFilter,
    map: &LightProjection,
    up: shadowfit::glam::Vec3,
) -> Result<Bias, Failure> {
    let ShadowfitFilter { bias, format, taps, disc, .. } = *filter;
    if !(taps.is_finite() && disc.is_finite()) {
        return Err(Failure::new(
            Code::ShadowfitBadInput,
            format_args!("the filter's radii are {taps} and {disc}; give finite numbers"),
        ));
    }
    let radius = FilterRadius { taps, disc: Vec2::splat(disc) };
    let storage = match format {
        SHADOWFIT_FORMAT_FLOAT32 => DepthStorage::Float32,
        SHADOWFIT_FORMAT_UNORM24 => DepthStorage::Unorm24,
        SHADOWFIT_FORMAT_UNORM16 => DepthStorage::Unorm16,
        _ => return Err(unknown("format", format, "SHADOWFIT_FORMAT_...")),
    };
    Ok(match bias {
        // Each comparison uses the plane's depth at its own place, so only its own radius counts.
        SHADOWFIT_BIAS_RECEIVER_PLANE => {
            let one = FilterRadius::taps(taps.min(FilterRadius::HARDWARE_2X2.taps));
            Bias::automatic_receiver_plane(one, storage, map)?
        }
        SHADOWFIT_BIAS_NORMAL_OFFSET => Bias::automatic(radius, storage, map)?,
        SHADOWFIT_BIAS_CONSTANT => Bias::automatic_constant(radius, storage, map, up)?,
        _ => return Err(unknown("bias", bias, "SHADOWFIT_BIAS_...")),
    })
}

fn unknown(member: &str, value: u32, constants: &str) -> Failure {
    Failure::new(Code::ShadowfitBadInput, format_args!("{member} is {value}; give a constant {constants}"))
}
