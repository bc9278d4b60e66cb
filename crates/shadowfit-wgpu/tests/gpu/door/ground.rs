//! Boxes that cast shadows, look-ups on the ground, and a device that must not report errors.

use shadowfit::glam::{DVec3, Vec3};
use shadowfit::{Aabb, Boxes, PerspectiveCamera, ViewFrustum};
use shadowfit_wgpu::{SunFrame, SunShadows, WgslOptions};

use crate::engine::casters::{CasterShader, Casters, Shape, look_up_wgsl};
use crate::engine::picture::{READ_BACK, WHOLE, draw_whole};
use crate::engine::{Engine, Pipeline};

/// Position of the camera's eye.
pub(super) const EYE: DVec3 = DVec3::new(0.0, 6.0, 9.0);

/// Directions of travel of the light of two suns.
pub(super) const SUN: Vec3 = Vec3::new(0.5, -1.0, 0.0);
pub(super) const MOON: Vec3 = Vec3::new(-0.5, -1.0, 0.0);

/// The ground, a block over its centre, and a post at its side.
pub(super) const BOXES: [Aabb; 3] = [
    Aabb { min: Vec3::new(-10.0, -0.5, -10.0), max: Vec3::new(10.0, 0.0, 10.0) },
    Aabb { min: Vec3::new(-0.75, 1.5, -0.75), max: Vec3::new(0.75, 2.5, 0.75) },
    Aabb { min: Vec3::new(-6.0, 0.0, -4.0), max: Vec3::new(-5.0, 2.0, -3.0) },
];

/// Width of an image in pixels, and of the ground in metres.
pub(super) const SIDE: u32 = 64;
const GROUND: f32 = 16.0;

/// Format of an image: one factor for each of up to four suns.
pub(super) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// WGSL that returns the factors at a pixel of the ground.
const FACTORS_WGSL: &str = "
fn factors(pixel: vec2<f32>) -> vec4<f32> {
    let place = (pixel / SIDE - 0.5) * GROUND;
    let position = vec3<f32>(place.x, 0.0, place.y);
    let normal = vec3<f32>(0.0, 1.0, 0.0);
    return vec4<f32>(FACTORS);
}
";

const GROUND_WGSL: &str = "
@fragment fn fs(@builtin(position) pixel: vec4<f32>) -> @location(0) vec4<f32> {
    return factors(pixel.xy);
}
";

pub(super) fn camera(eye: DVec3) -> PerspectiveCamera {
    PerspectiveCamera {
        eye,
        forward: (-eye).as_vec3().normalize(),
        up: Vec3::Y,
        fov_y: 1.2,
        aspect: 1.5,
        near: 0.1,
        far: 60.0,
    }
}

/// Returns a frame of static boxes that all cast and receive shadows. Positions in shaders are in world
/// space.
pub(super) fn frame_of<'a>(views: &'a [ViewFrustum], direction: Vec3, boxes: &'a [Aabb]) -> SunFrame<'a> {
    let boxes = Boxes { origin: DVec3::ZERO, boxes };
    SunFrame::new(views, direction, boxes, shadowfit_wgpu::Casters::fixed(boxes)).with_origin(DVec3::ZERO)
}

impl Engine {
    /// Opens a device with WebGL2's limits.
    pub(super) fn with_webgl2_limits() -> Self {
        let engine = Self::open(wgpu::Limits::downlevel_webgl2_defaults());
        assert_eq!(engine.device.features(), wgpu::Features::empty());
        assert_eq!(engine.device.limits().max_compute_workgroups_per_dimension, 0);
        engine
    }

    /// Creates a depth buffer for the image of the ground.
    pub(super) fn depth_texture(&self) -> wgpu::TextureView {
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT;
        self.texture([SIDE; 2], 1, wgpu::TextureFormat::Depth32Float, usage)
    }
}

/// Error scopes of a device.
pub(super) struct Quiet {
    memory: wgpu::ErrorScopeGuard,
    validation: wgpu::ErrorScopeGuard,
    internal: wgpu::ErrorScopeGuard,
}

impl Quiet {
    pub(super) fn new(engine: &Engine) -> Self {
        let scope = |filter| engine.device.push_error_scope(filter);
        let memory = scope(wgpu::ErrorFilter::OutOfMemory);
        let validation = scope(wgpu::ErrorFilter::Validation);
        Self { memory, validation, internal: scope(wgpu::ErrorFilter::Internal) }
    }

    /// Asserts that the device reported no error.
    pub(super) fn assert(self, what: &str) {
        for scope in [self.internal, self.validation, self.memory] {
            let error = pollster::block_on(scope.pop());
            assert!(error.is_none(), "{what}: {error:?}");
        }
    }
}

/// Returns the WGSL options of a sun.
fn options(group: u32, prefix: &str) -> WgslOptions<'_> {
    WgslOptions::group(group).with_prefix(prefix).expect("a prefix")
}

/// Returns WGSL of the function `factors`, which looks up to four suns up, each with its bind group and its
/// prefix.
pub(super) fn factors_wgsl(suns: &[(&SunShadows, u32, &'static str)]) -> String {
    let look_up = |(sun, group, prefix): &(&SunShadows, u32, &str)| {
        look_up_wgsl(sun.map().descriptor(), &options(*group, prefix))
    };
    let mut factors: Vec<String> =
        suns.iter().map(|(_, _, prefix)| format!("{prefix}_factor(position, normal)")).collect();
    factors.resize(4, "1.0".to_owned());
    let wgsl = FACTORS_WGSL
        .replace("FACTORS", &factors.join(", "))
        .replace("SIDE", &format!("{SIDE}.0"))
        .replace("GROUND", &format!("{GROUND:?}"));
    suns.iter().map(look_up).collect::<String>() + &wgsl
}

/// Pipelines that draw the casters of up to four suns, and the ground with their factors.
pub(super) struct Painter {
    casters: Vec<wgpu::RenderPipeline>,
    ground: wgpu::RenderPipeline,
}

/// Image with the factors of each sun over the ground.
#[derive(Debug, PartialEq)]
pub(super) struct Picture(Vec<[u8; 4]>);

impl Picture {
    /// Submits commands, and returns the image that they draw.
    pub(super) fn read(engine: &Engine, encoder: wgpu::CommandEncoder, picture: &wgpu::TextureView) -> Self {
        engine.submit(encoder);
        Self(engine.texels(picture.texture()))
    }

    /// Returns the factors at a position on the ground, in metres.
    pub(super) fn at(&self, place: [f32; 2]) -> [u8; 4] {
        let [x, y] = place.map(|metres| ((metres / GROUND + 0.5) * SIDE as f32) as usize);
        self.0[y * SIDE as usize + x]
    }

    /// Returns all factors.
    pub(super) fn values(&self) -> impl Iterator<Item = u8> {
        self.0.iter().flatten().copied()
    }

    /// Returns the factors of one sun.
    pub(super) fn of(&self, sun: usize) -> impl Iterator<Item = u8> {
        self.0.iter().map(move |factors| factors[sun])
    }

    /// Returns the greatest difference from another image.
    pub(super) fn difference(&self, other: &Self) -> u8 {
        let pixels = self.0.iter().flatten().zip(other.0.iter().flatten());
        pixels.map(|(a, b)| a.abs_diff(*b)).max().unwrap_or_default()
    }
}

impl Painter {
    /// Creates pipelines for suns with these prefixes. One module contains the WGSL of all suns. Each sun has
    /// a separate bind group.
    pub(super) fn new(engine: &Engine, suns: &[(&SunShadows, &'static str)]) -> Self {
        let at_groups: Vec<_> = (0..).zip(suns).map(|(group, (sun, prefix))| (*sun, group, *prefix)).collect();
        let groups: Vec<_> = suns.iter().map(|(sun, _)| Some(sun.map().receiver_layout())).collect();
        Self::with_layout(engine, &at_groups, &engine.layout(&groups))
    }

    /// Creates pipelines like [`Self::new`], for suns at any bind groups.
    pub(super) fn with_layout(
        engine: &Engine,
        suns: &[(&SunShadows, u32, &'static str)],
        layout: &wgpu::PipelineLayout,
    ) -> Self {
        if suns.len() > 1 {
            engine.require_bindings();
        }
        let shaders: Vec<_> = suns
            .iter()
            .map(|(sun, _, prefix)| CasterShader { prefix, ..CasterShader::new(sun.map(), Shape::Boxes) })
            .collect();
        let wgsl: String = shaders.iter().map(CasterShader::wgsl).collect();
        let casters = shaders.iter().map(|shader| shader.pipeline_of(engine, &wgsl)).collect();
        let wgsl = [&factors_wgsl(suns), WHOLE, GROUND_WGSL].concat();
        let targets = [Some(FORMAT.into())];
        let ground = Pipeline { layout: Some(layout), targets: &targets, ..Pipeline::new(&wgsl) }.make(engine);
        Self { casters, ground }
    }

    /// Draws a frame of suns, each with its boxes.
    pub(super) fn draw(&self, engine: &Engine, suns: &[(&SunShadows, &[Aabb])]) -> Picture {
        let groups: Vec<_> = suns.iter().map(|(sun, _)| sun.receiver_group()).collect();
        self.draw_with(engine, suns, &groups)
    }

    /// Draws a frame like [`Self::draw`], with these bind groups for the ground.
    pub(super) fn draw_with(
        &self,
        engine: &Engine,
        suns: &[(&SunShadows, &[Aabb])],
        groups: &[&wgpu::BindGroup],
    ) -> Picture {
        let mut encoder = engine.encoder();
        for index in 0..suns.len() {
            self.draw_one(engine, &mut encoder, suns, index);
        }
        let picture = engine.texture([SIDE; 2], 1, FORMAT, READ_BACK);
        draw_whole(&mut encoder, &self.ground, groups, &picture);
        Picture::read(engine, encoder, &picture)
    }

    /// Draws the casters of one sun.
    pub(super) fn draw_one(
        &self,
        engine: &Engine,
        encoder: &mut wgpu::CommandEncoder,
        suns: &[(&SunShadows, &[Aabb])],
        index: usize,
    ) {
        let (sun, boxes) = suns[index];
        let corners: Vec<[Vec3; 2]> = boxes.iter().map(|aabb| [aabb.min, aabb.max]).collect();
        Casters::boxes(engine, &corners).draw_sun(encoder, &self.casters[index], sun);
    }
}
