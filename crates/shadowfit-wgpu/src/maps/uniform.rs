//! Uniforms that the WGSL reads. Tests compare their layout with naga's reflection of the shaders.

use bytemuck::{Pod, Zeroable};
use shadowfit::glam::{DVec3, Vec2, Vec3};
use shadowfit::selection::MapOrder;
use shadowfit::settings::Softness;
use shadowfit::{DepthConvention, FittedMap, LightProjection};

use crate::{MAX_MAPS, MapView, ShadowMapDescriptor};

/// Shift of the rotation pattern of discs from frame to frame, in pixels, and period of the pattern, in
/// frames (J. Jimenez, "Next generation post processing in Call of Duty: Advanced Warfare", 2014).
const FRAME_SHIFT: f32 = 5.588_238;
const FRAMES: u32 = 64;

/// Uniform of the shadow pass's vertex shader: `shadowfit_Caster` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct CasterUniform {
    /// Matrix from world positions relative to the origin to the map's clip space.
    pub clip_from_world: [[f32; 4]; 4],
    /// 1 if fragment shaders clamp depth because the device cannot.
    pub clamps_in_fragment: u32,
    /// Keeps the struct a multiple of 16 bytes.
    pub padding_0: u32,
    /// As above.
    pub padding_1: u32,
    /// As above.
    pub padding_2: u32,
}

/// One map in the uniform of the look-up: `shadowfit_Map` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct MapUniform {
    /// Matrix from world positions relative to the origin to texture coordinates (x right, y down, z the
    /// stored depth).
    pub uv_from_world: [[f32; 4]; 4],
    /// Vector whose dot product with a plane's unit normal, divided by cos θ, is the change of the plane's
    /// depth over one texel along u. θ is the angle between the normal and the direction to the light. Zero
    /// without receiver-plane bias.
    pub depth_per_texel_u: [f32; 3],
    /// Depth bias that does not depend on the slope, in units of the stored depth. Its sign moves the
    /// receiver toward the light when it is added.
    pub constant_depth: f32,
    /// As `depth_per_texel_u`, along v.
    pub depth_per_texel_v: [f32; 3],
    /// Depth bias to be multiplied by tan θ, with the same sign convention.
    pub slope_depth: f32,
    /// Width and height of the used corner of the layer, in texels.
    pub size: [f32; 2],
    /// Offset along the normal to be multiplied by sin θ, in metres.
    pub normal_offset: f32,
    /// Receiver-plane bias in texels, with the same sign convention. It is multiplied by the plane's depth
    /// change over a texel.
    pub receiver_plane: f32,
    /// View depth at which the map ends, in metres. With selection by view depth, points from there on do not
    /// read it.
    pub far: f32,
    /// View depth where the blend from the previous map into this one begins, in metres. Used with selection
    /// by view depth.
    pub blend_near: f32,
    /// Index of the layer that contains the map.
    pub layer: u32,
    /// Aligns the next field to 8 bytes.
    pub padding_0: u32,
    /// Position of the map's first texel in its layer, in texels. The map wraps around from there.
    pub texel_offset: [f32; 2],
    /// Radii along u and v of the disc of look-ups, in texels. If the disc depends on the caster's distance,
    /// these are the greatest radii.
    pub disc: [f32; 2],
    /// Radii of the penumbra, in texels per unit of stored depth between the caster and its shadow. Negative
    /// with reversed depth.
    pub penumbra: [f32; 2],
    /// Keeps the struct a multiple of 16 bytes.
    pub padding_1: u32,
    /// As above.
    pub padding_2: u32,
}

/// Uniform of the look-up: `shadowfit_Receiver` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ReceiverUniform {
    /// Unit direction toward the light.
    pub to_light: [f32; 3],
    /// Number of used `maps`.
    pub map_count: u32,
    /// Coefficients of the view depth: for a position relative to the origin it is `dot(xyz, position) + w`,
    /// in metres.
    pub view: [f32; 4],
    /// View depth where shadows begin to fade, in metres.
    pub fade_near: f32,
    /// Width of the fade, in metres.
    pub fade_width: f32,
    /// Least radius of discs, in texels.
    pub least_disc: f32,
    /// Greatest radius of discs, in texels.
    pub greatest_disc: f32,
    /// Shift of the rotation pattern of discs in this frame, in pixels.
    pub frame_shift: f32,
    /// 1 if the light is off: all factors are 0.
    pub is_off: u32,
    /// Aligns the maps to 16 bytes.
    pub padding_0: u32,
    /// As above.
    pub padding_1: u32,
    /// Maps in selection order; see [`shadowfit::selection::MapOrder`].
    pub maps: [MapUniform; MAX_MAPS],
}

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

impl CasterUniform {
    /// Returns the uniform for a fit, with positions relative to `origin` (world space, metres).
    pub fn new(fit: &LightProjection, origin: DVec3) -> Self {
        Self { clip_from_world: fit.relative_to(origin).clip_from_world.to_cols_array_2d(), ..Self::default() }
    }
}

impl MapUniform {
    /// Returns the uniform for a map in layer 0, with positions relative to `origin` (world space, metres)
    /// and the settings of `descriptor`.
    pub fn new(map: &FittedMap, origin: DVec3, descriptor: &ShadowMapDescriptor) -> Self {
        let made = Self::on_plane(map, origin, descriptor);
        if map.bias.receiver_plane == 0.0 {
            Self { depth_per_texel_u: [0.0; 3], depth_per_texel_v: [0.0; 3], ..made }
        } else {
            made
        }
    }

    /// Returns the same uniform, with `depth_per_texel_u` and `depth_per_texel_v` even without receiver-plane
    /// bias.
    fn on_plane(map: &FittedMap, origin: DVec3, descriptor: &ShadowMapDescriptor) -> Self {
        let ShadowMapDescriptor { filter, softness, .. } = descriptor;
        let FittedMap { projection: fit, bias, .. } = map.relative_to(origin);
        let toward_light = if fit.depth == DepthConvention::Reversed { 1.0 } else { -1.0 };
        let [u, v] = depth_per_texel(&fit);
        Self {
            uv_from_world: fit.uv_from_world.to_cols_array_2d(),
            depth_per_texel_u: u.to_array(),
            constant_depth: toward_light * bias.constant_depth,
            depth_per_texel_v: v.to_array(),
            slope_depth: toward_light * bias.slope_depth,
            size: fit.resolution.as_vec2().to_array(),
            normal_offset: bias.normal_offset,
            receiver_plane: toward_light * bias.receiver_plane,
            far: map.shader_end(),
            blend_near: map.shader_blend_start(),
            texel_offset: map.texel_offset.as_vec2().to_array(),
            disc: softness.texels(*filter, &fit).to_array(),
            penumbra: (Vec2::splat(-toward_light * softness.tangent() * fit.depth_range) / fit.texel_size).to_array(),
            ..Self::default()
        }
    }
}

/// Returns vectors whose dot product with a plane's unit normal n, divided by n·z, is the change of the
/// plane's depth over one texel along u and v. The plane's height falls by n·x / n·z along the map's x, and v
/// runs against its y. This is [`shadowfit::bias::depth_gradient`] without the division by n·z, the cosine.
fn depth_per_texel(fit: &LightProjection) -> [Vec3; 2] {
    let away_from_light = if fit.depth == DepthConvention::Reversed { -1.0 } else { 1.0 };
    let scale = fit.texel_size * (away_from_light / fit.depth_range);
    let row = |index: usize| fit.light_from_world.row(index).truncate();
    [row(0) * scale.x, row(1) * -scale.y]
}

impl ReceiverUniform {
    /// Returns the uniform for a light that is off.
    pub fn off() -> Self {
        Self { is_off: 1, ..Self::default() }
    }

    /// Returns this uniform for maps that are stored from layer `first` on.
    pub(crate) fn in_layers(mut self, first: u32) -> Self {
        self.maps.iter_mut().for_each(|map| map.layer += first);
        self
    }

    /// Returns the uniform of [`Self::new`], with the depth change per texel in each map even without
    /// receiver-plane bias.
    #[cfg(feature = "rays")]
    pub(crate) fn on_planes(maps: &[FittedMap], view: &MapView, descriptor: &ShadowMapDescriptor) -> Self {
        let mut uniform = Self::new(maps, view, descriptor);
        for slot in uniform.maps.iter_mut().take(uniform.map_count as usize) {
            let on_plane = MapUniform::on_plane(&maps[slot.layer as usize], view.origin, descriptor);
            *slot = MapUniform { layer: slot.layer, ..on_plane };
        }
        uniform
    }

    /// Returns the uniform for maps of one light, with positions relative to the view's origin. Maps that no
    /// point selects ([`MapOrder`]) and maps past [`MAX_MAPS`] are left out. Without any map, all points are
    /// lit.
    pub fn new(maps: &[FittedMap], view: &MapView, descriptor: &ShadowMapDescriptor) -> Self {
        let [fade_near, fade_far] = descriptor.fade;
        let Softness { floor, ceiling, .. } = descriptor.softness;
        let mut uniform = Self {
            fade_near,
            fade_width: fade_far - fade_near,
            least_disc: floor,
            greatest_disc: ceiling,
            frame_shift: (view.frame % FRAMES) as f32 * FRAME_SHIFT,
            ..Self::default()
        };
        let order = MapOrder::new(descriptor.selection, maps.iter().map(|map| &map.projection));
        for (slot, index) in uniform.maps.iter_mut().zip(order.iter()) {
            *slot = MapUniform { layer: index as u32, ..MapUniform::new(&maps[index], view.origin, descriptor) };
            uniform.map_count += 1;
        }
        uniform.to_light = maps.first().map_or([0.0, 1.0, 0.0], |map| (-map.projection.direction).to_array());
        let at_origin = view.forward.as_dvec3().dot(view.origin - view.eye) as f32;
        uniform.view = view.forward.extend(at_origin).to_array();
        uniform
    }
}
