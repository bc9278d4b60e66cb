//! The proof that a map has no holes.

use shadowfit::glam::DVec3;
use shadowfit::proof::{CoverageProof, CoverageQuery, prove};

use crate::error::Failure;
use crate::fit::{Frame, Gathered};
use crate::state::Memory;
use crate::types::{
    SHADOWFIT_CASTER_LOST, SHADOWFIT_DEPTH_TOO_COARSE, SHADOWFIT_PROVEN, SHADOWFIT_UNCOVERED, ShadowfitProof,
};

/// Proves a map of the last fit for the frame that it was fitted to.
pub(crate) fn proof(memory: Memory<'_>, frame: &Frame, map: u32) -> Result<ShadowfitProof, Failure> {
    let Memory { state, scratch, boxes, .. } = memory;
    let map = state.map(map)?.relative_to(frame.origin);
    let Gathered { input, mut scratch } = frame.gather(scratch, boxes)?;
    let technique = &state.technique;
    let radius = technique.filter_radius_in(&map.projection);
    let query = CoverageQuery::of_map(&map, technique, radius).with_normal_offset(map.bias.normal_offset);
    let written = |result: u32, point: DVec3, missing: f32| ShadowfitProof {
        size: size_of::<ShadowfitProof>() as u32,
        result,
        point: point.to_array(),
        missing,
    };
    Ok(match prove(&input, &map.projection, &query, &mut scratch)? {
        CoverageProof::Proven(_) => written(SHADOWFIT_PROVEN, DVec3::ZERO, 0.0),
        CoverageProof::Uncovered { point, by, .. } => written(SHADOWFIT_UNCOVERED, point, by),
        CoverageProof::MarkedEmpty { point } => written(SHADOWFIT_UNCOVERED, point, 0.0),
        CoverageProof::CasterLost { point, by } => written(SHADOWFIT_CASTER_LOST, point, by),
        CoverageProof::DepthTooCoarse(_) => written(SHADOWFIT_DEPTH_TOO_COARSE, DVec3::ZERO, 0.0),
    })
}
