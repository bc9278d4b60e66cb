//! The casters to draw into a map.

use shadowfit::glam::{DVec3, UVec2};
use shadowfit::scroll::TexelRect;
use shadowfit::settings::CasterPolicy;
use shadowfit::{CasterVolume, Technique};

use crate::error::{Failure, ShadowfitResult as Code};
use crate::state::State;
use crate::types::{SHADOWFIT_CASTERS_ALL, SHADOWFIT_CASTERS_VISIBLE, ShadowfitRect};

/// Returns the volume of the casters to draw into a map, or into a rectangle of it, relative to an origin.
pub(crate) fn volume(
    state: &mut State,
    map: u32,
    rect: Option<&ShadowfitRect>,
    which: u32,
    origin: DVec3,
) -> Result<CasterVolume, Failure> {
    let fitted = *state.map(map)?;
    let policy = policy(&state.technique);
    let volume = match which {
        SHADOWFIT_CASTERS_VISIBLE => {
            let volume = visible(state)?[map as usize];
            if policy == CasterPolicy::DepthClamp { volume } else { volume.cut_at_near_plane(&fitted.projection) }
        }
        SHADOWFIT_CASTERS_ALL => match rect {
            None => CasterVolume::of_map(&fitted.projection, policy),
            Some(rect) => CasterVolume::of_part(&fitted.projection, policy, window(rect)?),
        },
        _ => {
            return Err(Failure::new(
                Code::ShadowfitBadInput,
                format_args!("which is {which}; give a constant SHADOWFIT_CASTERS_..."),
            ));
        }
    };
    Ok(volume.relative_to(origin))
}

/// Returns the caster policy of the maps. The XNA sample's fit has none.
pub(crate) fn policy(technique: &Technique) -> CasterPolicy {
    if technique.maps.are_exact() { CasterPolicy::None } else { technique.fit.casters }
}

/// Returns the volumes of the casters with a visible shadow, computed once per frame.
fn visible(state: &mut State) -> Result<&[CasterVolume], Failure> {
    let Some(frame) = &mut state.frame else { return Err(Code::ShadowfitCallFitFirst.into()) };
    let volumes = match frame.volumes {
        Some(volumes) => volumes,
        None => state.fitted.caster_volumes(frame.views(), &state.technique)?,
    };
    Ok(frame.volumes.insert(volumes))
}

/// Returns the texels of the map that a rectangle of its texture belongs to.
fn window(rect: &ShadowfitRect) -> Result<TexelRect, Failure> {
    let first = |stored: u32, viewport: i32| u32::try_from(i64::from(stored) - i64::from(viewport)).ok();
    let first = |stored, viewport| first(stored, viewport).map(|texel| texel.min(MOST));
    let corner = first(rect.x, rect.viewport_x).zip(first(rect.y, rect.viewport_y));
    let (x, y) = corner.ok_or_else(|| {
        Failure::new(Code::ShadowfitBadInput, "a rectangle lies outside its viewport; pass one of shadowfit_update")
    })?;
    Ok(TexelRect { min: UVec2::new(x, y), size: UVec2::new(rect.width.min(MOST), rect.height.min(MOST)) })
}

/// Greatest width and height of a rectangle. No texture is larger.
const MOST: u32 = 65_536;
