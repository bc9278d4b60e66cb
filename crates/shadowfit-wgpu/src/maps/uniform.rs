//! The uniforms that the WGSL reads. Their layout is compared with naga's reflection of the
//! shaders in the tests, so that the two cannot drift apart.

use bytemuck::{Pod, Zeroable};
use shadowfit::glam::{DVec3, Vec2, Vec3};
use shadowfit::selection::MapOrder;
use shadowfit::settings::Softness;
use shadowfit::{DepthConvention, FittedMap, LightProjection};

use crate::{MAX_MAPS, MapView, ShadowMapDescriptor};

/// Pixels by which the pattern that turns discs moves from frame to frame, and frames after which it begins again
/// (J. Jimenez, "Next generation post processing in Call of Duty: Advanced Warfare", 2014).
const FRAME_SHIFT: f32 = 5.588_238;
const FRAMES: u32 = 64;

/// The uniform of the shadow pass's vertex shader: `shadowfit_Caster` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct CasterUniform {
    /// Clip space of the map from world positions relative to the origin.
    pub clip_from_world: [[f32; 4]; 4],
    /// 1 where fragment shaders clamp depth, since the device does not.
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
    /// Texture coordinates (x right, y down, z the stored depth) from world positions relative to
    /// the origin.
    pub uv_from_world: [[f32; 4]; 4],
    /// The depth of a plane changes by `dot(this, normal) / cos θ` over one texel along u, for its
    /// unit normal; zero without receiver-plane bias.
    pub depth_per_texel_u: [f32; 3],
    /// Depth bias that does not depend on the slope, signed so that adding it moves the receiver
    /// toward the light.
    pub constant_depth: f32,
    /// As `depth_per_texel_u`, along v.
    pub depth_per_texel_v: [f32; 3],
    /// Depth bias times tan θ, signed likewise.
    pub slope_depth: f32,
    /// Width and height in use, from the corner of the layer, in texels.
    pub size: [f32; 2],
    /// Offset along the normal times sin θ, in metres.
    pub normal_offset: f32,
    /// Depth bias to be multiplied by the plane's depth change over a texel, in texels, signed
    /// likewise.
    pub receiver_plane: f32,
    /// View depth at which the map ends, in metres: by view depth, points from there on do not read it.
    pub far: f32,
    /// View depth from which points of the map in front are blended into this one, in metres; by view depth.
    pub blend_near: f32,
    /// Layer that the map is stored in: its index.
    pub layer: u32,
    /// Puts the next field at a multiple of 8 bytes.
    pub padding_0: u32,
    /// Where the map's first texel lies in its layer, in texels: the rest follows it, and wraps around.
    pub texel_offset: [f32; 2],
    /// Radii along u and v of the disc that look-ups are spread over, in texels: the greatest where it follows the
    /// caster.
    pub disc: [f32; 2],
    /// Radii of the penumbra in texels, for each unit of stored depth from the caster to its shadow; negative with
    /// reversed depth.
    pub penumbra: [f32; 2],
    /// Keeps the struct a multiple of 16 bytes.
    pub padding_1: u32,
    /// As above.
    pub padding_2: u32,
}

/// The uniform of the look-up: `shadowfit_Receiver` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ReceiverUniform {
    /// Unit direction toward the light.
    pub to_light: [f32; 3],
    /// Number of `maps` that are in use.
    pub map_count: u32,
    /// View depth of a position relative to the origin, in metres, is `dot(xyz, position) + w`.
    pub view: [f32; 4],
    /// View depth from which on shadows fade, in metres.
    pub fade_near: f32,
    /// Metres over which they fade.
    pub fade_width: f32,
    /// Radius that discs have at least, in texels.
    pub least_disc: f32,
    /// Radius that discs have at most, in texels.
    pub greatest_disc: f32,
    /// Pixels by which the pattern that turns discs is moved in this frame.
    pub frame_shift: f32,
    /// 1 for a light that gives nothing: all factors are 0.
    pub is_off: u32,
    /// Keeps the maps at a multiple of 16 bytes.
    pub padding_0: u32,
    /// As above.
    pub padding_1: u32,
    /// The maps, in the order in which points try them: that of [`shadowfit::selection::MapOrder`].
    pub maps: [MapUniform; MAX_MAPS],
}

/// The uniform of a look-up that [cross-fades](ShadowMapDescriptor::cross_fades): `shadowfit_Fading` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct FadingUniform {
    /// The maps of the sun's present direction.
    pub now: ReceiverUniform,
    /// Those of the direction before, while they are faded out; none otherwise.
    pub before: ReceiverUniform,
    /// Share of the former in the factor, 0 to 1.
    pub share: f32,
    /// Layer of the first of the present maps.
    pub first_layer: u32,
    /// Keeps the struct a multiple of 16 bytes.
    pub padding_0: u32,
    /// As above.
    pub padding_1: u32,
}

impl CasterUniform {
    /// The uniform for a fit, with positions relative to `origin` (world space, metres).
    pub fn new(fit: &LightProjection, origin: DVec3) -> Self {
        Self { clip_from_world: fit.relative_to(origin).clip_from_world.to_cols_array_2d(), ..Self::default() }
    }
}

impl MapUniform {
    /// The uniform for a map in layer 0, with positions relative to `origin` (world space, metres), read as `descriptor`
    /// says.
    pub fn new(map: &FittedMap, origin: DVec3, descriptor: &ShadowMapDescriptor) -> Self {
        let made = Self::on_plane(map, origin, descriptor);
        if map.bias.receiver_plane == 0.0 {
            Self { depth_per_texel_u: [0.0; 3], depth_per_texel_v: [0.0; 3], ..made }
        } else {
            made
        }
    }

    /// The same, with the change of a plane's depth whatever the bias.
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

/// Vectors whose dot product with a plane's unit normal n gives the change of its depth over one texel along u and
/// v: the plane's height falls by n·x / n·z along the map's x, and v runs against its y. It is
/// [`shadowfit::bias::depth_gradient`] without the division by n·z, the cosine.
fn depth_per_texel(fit: &LightProjection) -> [Vec3; 2] {
    let away_from_light = if fit.depth == DepthConvention::Reversed { -1.0 } else { 1.0 };
    let scale = fit.texel_size * (away_from_light / fit.depth_range);
    let row = |index: usize| fit.light_from_world.row(index).truncate();
    [row(0) * scale.x, row(1) * -scale.y]
}

impl ReceiverUniform {
    /// The uniform for a light that gives nothing.
    pub fn off() -> Self {
        Self { is_off: 1, ..Self::default() }
    }

    /// The same with maps that are stored from a layer on.
    pub(crate) fn in_layers(mut self, first: u32) -> Self {
        self.maps.iter_mut().for_each(|map| map.layer += first);
        self
    }

    /// As [`Self::new`], with the change of a plane's depth in each map, whatever the bias.
    #[cfg(feature = "rays")]
    pub(crate) fn on_planes(maps: &[FittedMap], view: &MapView, descriptor: &ShadowMapDescriptor) -> Self {
        let mut uniform = Self::new(maps, view, descriptor);
        for slot in uniform.maps.iter_mut().take(uniform.map_count as usize) {
            let on_plane = MapUniform::on_plane(&maps[slot.layer as usize], view.origin, descriptor);
            *slot = MapUniform { layer: slot.layer, ..on_plane };
        }
        uniform
    }

    /// The uniform for maps of one light, with positions relative to the view's origin. Those that no point reads by
    /// the descriptor's choice ([`MapOrder`]), and maps past [`MAX_MAPS`], are left out; without any, everything is lit.
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
