//! Uniforms that the WGSL reads. Tests compare their layout with naga's reflection of the shaders.

use bytemuck::{Pod, Zeroable};
use shadowfit::FittedMap;
pub use shadowfit::uniform::{CasterUniform, MapUniform, ReceiverUniform};

use super::view::MapView;
use crate::ShadowMapDescriptor;

/// Uniform of a look-up that [cross-fades](ShadowMapDescriptor::cross_fades): `shadowfit_Fading` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct FadingUniform {
    /// Maps of the present direction.
    pub now: ReceiverUniform,
    /// Maps of the previous direction while they fade out; otherwise none.
    pub before: ReceiverUniform,
    /// Share of `now` in the factor, 0 to 1.
    pub share: f32,
    /// Layer of the first present map.
    pub first_layer: u32,
    /// Keeps the struct a multiple of 16 bytes.
    pub padding_0: u32,
    /// As above.
    pub padding_1: u32,
}

/// Returns the uniform for maps of one light, with positions relative to the view's origin.
pub(crate) fn receiver(maps: &[FittedMap], view: &MapView, descriptor: &ShadowMapDescriptor) -> ReceiverUniform {
    let uniform = ReceiverUniform::new(maps, &view.reader(), &descriptor.reading());
    uniform.with_fade(descriptor.fade).with_frame(view.frame)
}
