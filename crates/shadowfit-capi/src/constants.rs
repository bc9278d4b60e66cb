//! The constant blocks of the shaders. They are `shadowfit::uniform` in C.
#![allow(missing_docs, reason = "members whose names say all have no comment in the header")]

use shadowfit::FittedMap;
use shadowfit::culling::Reader;
use shadowfit::settings::MAX_MAPS;
use shadowfit::uniform::{CasterUniform, ReceiverUniform};

use crate::error::{Failure, ShadowfitResult as Code};
use crate::state::State;

/// Block of the caster shader, one for each map.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ShadowfitCasterConstants {
    pub clip_from_world: [f32; 16],
    /// 1 if the fragment shader clamps depth because the device cannot.
    pub clamps_in_fragment: u32,
    pub padding: [u32; 3],
}

/// One map in the block of the look-up.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ShadowfitMapConstants {
    pub uv_from_world: [f32; 16],
    /// A plane's change of depth per texel: the dot product with its normal, divided by the cosine to the light.
    pub depth_per_texel_u: [f32; 3],
    /// Added to the stored depth. Its sign moves the receiver toward the light.
    pub constant_depth: f32,
    pub depth_per_texel_v: [f32; 3],
    /// As `constant_depth`, times the tangent to the light.
    pub slope_depth: f32,
    pub resolution: [f32; 2],
    pub normal_offset: f32,
    pub receiver_plane: f32,
    pub end_depth: f32,
    /// View depth at which the blend into this map begins.
    pub blend_depth: f32,
    pub layer: u32,
    pub padding_0: u32,
    pub texel_offset: [f32; 2],
    pub disc: [f32; 2],
    pub penumbra: [f32; 2],
    pub padding_1: [u32; 2],
}

/// Block of the look-up. Each map's texels are in the layer of its index.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ShadowfitReceiverConstants {
    pub to_light: [f32; 3],
    pub map_count: u32,
    /// View depth of a position: dot(xyz, position) + w.
    pub view: [f32; 4],
    /// View depth at which shadows begin to fade.
    pub fade_depth: f32,
    pub fade_length: f32,
    pub least_disc: f32,
    pub greatest_disc: f32,
    /// Shift of the noise in this frame, in pixels.
    pub frame_shift: f32,
    pub is_off: u32,
    pub padding: [u32; 2],
    /// The maps, in the order of selection: a point reads the first one that covers it.
    pub maps: [ShadowfitMapConstants; crate::types::SHADOWFIT_MAX_MAPS],
}

/// Block of the demand shader, a compute shader that counts the visible surfaces. One workgroup counts 32 x 32 points.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ShadowfitDemandConstants {
    pub words: [u32; 44],
}

/// Returns the block of the look-up for the last fit.
pub(crate) fn receiver(state: &State) -> Result<ReceiverUniform, Failure> {
    let frame = state.last()?;
    let view = frame.views().first().ok_or(Failure::from(Code::ShadowfitCallFitFirst))?;
    let mut maps = [FittedMap::default(); MAX_MAPS];
    for (map, (fitted, kept)) in maps.iter_mut().zip(state.fitted.iter().zip(&state.kept)) {
        if state.keeps && !kept.is_current {
            return Err(Code::ShadowfitCallUpdateFirst.into());
        }
        let texel_offset = kept.map.map_or(fitted.texel_offset, |kept| kept.texel_offset);
        *map = FittedMap { texel_offset, ..*fitted };
    }
    let reader = Reader { origin: frame.origin, eye: view.origin, forward: view.forward };
    let uniform = ReceiverUniform::new(&maps[..state.fitted.len()], &reader, &state.technique.reading());
    Ok(uniform.with_fade(state.technique.fade_depths()).with_frame(frame.number))
}

/// Returns the block of the caster shader for a map of the last fit.
pub(crate) fn caster(state: &State, map: u32) -> Result<CasterUniform, Failure> {
    Ok(CasterUniform::new(&state.map(map)?.projection, state.last()?.origin))
}

#[cfg(test)]
mod tests {
    use core::mem::offset_of;

    use shadowfit::uniform::MapUniform;

    use super::*;

    #[test]
    fn the_blocks_have_the_same_layout_in_c_as_in_rust() {
        macro_rules! same {
            ($c:ty, $rust:ty, $($member:ident = $field:ident),+) => {
                assert_eq!((size_of::<$c>(), align_of::<$c>()), (size_of::<$rust>(), align_of::<$rust>()));
                $(assert_eq!(offset_of!($c, $member), offset_of!($rust, $field), stringify!($member));)+
            };
        }
        assert_eq!(size_of::<ShadowfitDemandConstants>(), size_of::<shadowfit::uniform::DemandUniform>());
        assert_eq!(crate::types::SHADOWFIT_COUNTS, shadowfit::demand::COUNTS);
        same!(
            ShadowfitCasterConstants,
            CasterUniform,
            clip_from_world = clip_from_world,
            clamps_in_fragment = clamps_in_fragment
        );
        same!(
            ShadowfitMapConstants,
            MapUniform,
            uv_from_world = uv_from_world,
            depth_per_texel_u = depth_per_texel_u,
            constant_depth = constant_depth,
            depth_per_texel_v = depth_per_texel_v,
            slope_depth = slope_depth,
            resolution = size,
            normal_offset = normal_offset,
            receiver_plane = receiver_plane,
            end_depth = far,
            blend_depth = blend_near,
            layer = layer,
            texel_offset = texel_offset,
            disc = disc,
            penumbra = penumbra
        );
        same!(
            ShadowfitReceiverConstants,
            ReceiverUniform,
            to_light = to_light,
            map_count = map_count,
            view = view,
            fade_depth = fade_near,
            fade_length = fade_width,
            least_disc = least_disc,
            greatest_disc = greatest_disc,
            frame_shift = frame_shift,
            is_off = is_off,
            maps = maps
        );
    }
}
