//! A shadow map without other parts of an engine: it draws triangles as casters, and evaluates the receiver's
//! WGSL at given points.

use shadowfit::glam::{DVec3, Vec2, Vec3};
use shadowfit::selection::DepthRange;
use shadowfit::settings::BiasSettings;
use shadowfit::{Bias, FittedMap, LightProjection};
use shadowfit_wgpu::{MapView, ShadowMap, ShadowMapDescriptor, WgslOptions, stored_wgsl};

use super::engine::Engine;
use super::engine::casters::{CasterShader, Casters, Shape, look_up_wgsl};
use super::engine::points::{Bound, Point, Values};

/// Results of the WGSL at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Answer {
    /// Texture coordinates and depth from `shadowfit_project` in the requested map.
    pub(super) projected: Vec3,
    /// Change of the plane's depth over a texel.
    pub(super) gradient: Vec2,
    /// `shadowfit_factor` over all maps.
    pub(super) factor: f32,
    /// `shadowfit_stored` at the texel with the point's index, in rows.
    pub(super) stored: f32,
}

/// Map that the WGSL reads at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Selection {
    /// `shadowfit_map_index`.
    pub(super) map: i32,
    /// `shadowfit_view_depth`, in metres.
    pub(super) view_depth: f32,
}

/// Points per row of the answers' texture. A power of two keeps the pixels' centres exact.
pub(super) const ROW: u32 = 256;

/// WGSL of [`Harness::ask`].
const LOOK_UP: &str = "
fn answer(position: vec3<f32>, normal: vec3<f32>, pixel: vec2<f32>) -> Answer {
    let found = shadowfit_project(shadowfit_receiver.maps[MAP], position, normal);
    let projected = vec3<f32>(found.texel / shadowfit_receiver.maps[MAP].size, found.depth);
    let stored = shadowfit_stored(i32(MAP), vec2<i32>(pixel));
    return Answer(vec4<f32>(projected, shadowfit_factor(position, normal)), vec4<f32>(stored, found.gradient, 0.0));
}
";

/// WGSL of [`Harness::turned`].
const TURNED: &str = "
fn answer(position: vec3<f32>, normal: vec3<f32>, pixel: vec2<f32>) -> Answer {
    return Answer(vec4<f32>(shadowfit_factor_at(position, normal, pixel)), vec4<f32>(0.0));
}
";

/// WGSL of [`Harness::selections`].
const SELECTION: &str = "
fn answer(position: vec3<f32>, normal: vec3<f32>, pixel: vec2<f32>) -> Answer {
    let map = f32(shadowfit_map_index(position));
    return Answer(vec4<f32>(map, shadowfit_view_depth(position), 0.0, 0.0), vec4<f32>(0.0));
}
";

/// WGSL of [`Harness::stored`].
const STORED: &str = "
fn answer(position: vec3<f32>, normal: vec3<f32>, pixel: vec2<f32>) -> Answer {
    return Answer(vec4<f32>(shadowfit_stored(i32(MAP), vec2<i32>(pixel))), vec4<f32>(0.0));
}
";

/// A shadow map with drawn casters.
pub(super) struct Harness<'a> {
    gpu: &'a Engine,
    map: ShadowMap,
}

impl<'a> Harness<'a> {
    /// Draws `casters[i]`, triangles relative to `origin`, into map i. Points of all view depths read the
    /// first map that covers them.
    pub(super) fn new(
        gpu: &'a Engine,
        descriptor: &ShadowMapDescriptor,
        origin: DVec3,
        fits: &[LightProjection],
        bias: &BiasSettings,
        casters: &[Vec<Vec3>],
    ) -> Self {
        let map = |fit: &LightProjection| {
            FittedMap::new(*fit, Bias::from_texels(bias, descriptor.format, fit))
                .with_depths(DepthRange::new(0.0, None))
        };
        let maps: Vec<FittedMap> = fits.iter().map(map).collect();
        Self::with_maps(gpu, descriptor, &MapView::from_eye(origin, Vec3::NEG_Z), &maps, casters)
    }

    /// Draws casters into maps that are selected by view depth.
    pub(super) fn with_maps(
        gpu: &'a Engine,
        descriptor: &ShadowMapDescriptor,
        view: &MapView,
        maps: &[FittedMap],
        casters: &[Vec<Vec3>],
    ) -> Self {
        Self::with_caster_group(gpu, descriptor, view, maps, casters, 0)
    }

    /// Draws casters with the map's matrix at this bind group of the shadow pass.
    pub(super) fn with_caster_group(
        gpu: &'a Engine,
        descriptor: &ShadowMapDescriptor,
        view: &MapView,
        maps: &[FittedMap],
        casters: &[Vec<Vec3>],
        group: u32,
    ) -> Self {
        gpu.require_map(descriptor);
        let mut map = ShadowMap::new(&gpu.device, descriptor).expect("a possible shadow map");
        map.prepare(&gpu.queue, view, maps).expect("fits of this map");
        let pipeline = CasterShader { group, ..CasterShader::new(&map, Shape::Triangles) }.pipeline(gpu);
        let casters = Casters::triangles(gpu, casters);
        let mut encoder = gpu.encoder();
        map.render(&mut encoder, group, |pass, index, _volume| casters.draw(pass, &pipeline, &[index as u32]));
        gpu.submit(encoder);
        Self { gpu, map }
    }

    /// Evaluates the WGSL at points, at most [`ROW`]². Projections are into map `index`.
    pub(super) fn ask(&self, index: u32, points: &[Point]) -> Vec<Answer> {
        let answer = |Values { one: [x, y, z, factor], other: [stored, across, down, _] }: Values| Answer {
            projected: Vec3::new(x, y, z),
            gradient: Vec2::new(across, down),
            factor,
            stored,
        };
        self.draw(&LOOK_UP.replace("MAP", &format!("{index}u")), points).into_iter().map(answer).collect()
    }

    /// Evaluates `shadowfit_factor_at` at points, at most [`ROW`]². Point i is pixel (i mod [`ROW`], i /
    /// [`ROW`]).
    pub(super) fn turned(&self, points: &[Point]) -> Vec<f32> {
        self.draw(TURNED, points).iter().map(|values| values.one[0]).collect()
    }

    /// Returns the stored depths of a map of [`ROW`]² texels, in rows from the top.
    pub(super) fn stored(&self, index: u32) -> Vec<f32> {
        let nowhere = vec![Point { position: [0.0; 3], normal: [0.0, 1.0, 0.0] }; (ROW * ROW) as usize];
        self.draw(&STORED.replace("MAP", &format!("{index}u")), &nowhere).iter().map(|values| values.one[0]).collect()
    }

    /// Returns the map that the WGSL reads at each point, for at most [`ROW`]² points.
    pub(super) fn selections(&self, points: &[Point]) -> Vec<Selection> {
        let selection = |values: &Values| Selection { map: values.one[0] as i32, view_depth: values.one[1] };
        self.draw(SELECTION, points).iter().map(selection).collect()
    }

    fn draw(&self, answer: &str, points: &[Point]) -> Vec<Values> {
        let (map, options) = (self.map.descriptor(), WgslOptions::group(0));
        let backend = self.gpu.adapter.get_info().backend;
        let wgsl = look_up_wgsl(map, &options) + &stored_wgsl(map, &options, backend) + answer;
        let bound = Bound { layout: self.map.receiver_layout(), group: self.map.receiver_group() };
        self.gpu.ask(&wgsl, &[bound], points, ROW)
    }
}
