//! The overlay that tints surfaces by the map that they read. Each pixel of a plane has the colour of the map
//! that this test computes for it.

use glam::{DVec2, DVec3, Vec3};
use shadowfit::selection::DepthRange;
use shadowfit::settings::{FilterKind, MapSelection, SplitScheme};
use shadowfit::{Bias, FitInput, FitState, FittedMap, PerspectiveCamera, Scratch, Technique};
use shadowfit_params::figures::MAP_TINTS;
use shadowfit_render::{Atmosphere, Frame, Gpu, GpuScene, Overlay, RenderTarget, Renderer};
use shadowfit_scene::Scene;
use shadowfit_wgpu::ShadowMapDescriptor;

use shadowfit_testing::renderer_gpu;

/// Size of the picture, in pixels.
const SIZE: [u32; 2] = [160, 90];
/// View depths at which all maps except the last end, in metres.
const ENDS: [f32; 7] = [3.0, 4.0, 5.5, 7.5, 10.0, 14.0, 20.0];
/// View depth at which the last map ends, in metres. The floor continues behind it.
const LAST_END: f32 = 28.0;
/// The light's direction of travel.
const DIRECTION: Vec3 = Vec3::new(0.48, -0.8, -0.36);

fn camera() -> PerspectiveCamera {
    PerspectiveCamera {
        eye: DVec3::new(0.0, 2.0, 0.0),
        forward: Vec3::new(0.0, -0.28, -0.96),
        up: Vec3::Y,
        fov_y: 0.9,
        aspect: SIZE[0] as f32 / SIZE[1] as f32,
        near: 0.1,
        far: 60.0,
    }
}

/// Fits `count` maps to the camera's view. The floor continues behind the last one.
fn maps(camera: &PerspectiveCamera, count: u32) -> Vec<FittedMap> {
    let cascades = Technique::preset("calm-4").expect("a preset");
    let mut settings =
        cascades.with_maps(cascades.maps.as_cascades().with_count(count).with_splits(SplitScheme::Manual(ENDS)));
    (settings.fit.max_distance, settings.fit.resolution) = (LAST_END, glam::UVec2::splat(256));
    let views = [camera.frustum().expect("a camera")];
    let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
    let input = FitInput::new(&views, DIRECTION);
    let fitted = FitState::new().fit(&input, &settings, &mut Scratch::new(&mut storage)).expect("maps");
    let range = |map: &FittedMap| map.depths.map(|range| DepthRange { covered_from: None, ..range });
    let map = |map: &FittedMap| FittedMap { depths: range(map), ..FittedMap::new(map.projection, Bias::default()) };
    fitted.iter().map(map).collect()
}

/// Result of reading the floor's point behind a position in the picture, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Seen {
    /// A map, by its index.
    Map(usize),
    /// No map: the point lies outside all of them.
    NoMap,
    /// No floor.
    Sky,
}

fn seen_at(camera: &PerspectiveCamera, maps: &[FittedMap], [x, y]: [f64; 2]) -> Seen {
    let forward = camera.forward.as_dvec3();
    let right = forward.cross(DVec3::Y).normalize();
    let up = right.cross(forward);
    let half_height = (f64::from(camera.fov_y) * 0.5).tan();
    let [u, v] = [x / f64::from(SIZE[0]) * 2.0 - 1.0, 1.0 - y / f64::from(SIZE[1]) * 2.0];
    let ray = forward + right * (u * half_height * f64::from(camera.aspect)) + up * (v * half_height);
    let distance = -camera.eye.y / ray.y;
    let point = camera.eye + ray * distance;
    let depth = (point - camera.eye).dot(forward);
    if ray.y >= 0.0 || depth >= f64::from(camera.far) {
        return Seen::Sky;
    }
    let read = maps
        .iter()
        .position(|map| map.depths.is_some_and(|range| range.ends_beyond(depth)) && map.projection.covers(point));
    read.map_or(Seen::NoMap, Seen::Map)
}

/// A floor on the GPU and its renderer.
struct Floor {
    gpu: Gpu,
    renderer: Renderer,
    scene: GpuScene,
    target: RenderTarget,
}

impl Floor {
    /// Creates a floor. `maps` is the greatest number of maps in a frame.
    fn new(maps: u32) -> Self {
        let gpu = renderer_gpu();
        let descriptor = ShadowMapDescriptor {
            resolution: [256; 2],
            maps,
            filter: FilterKind::Point,
            selection: MapSelection::ViewDepth { overlap: 0.0 },
            ..ShadowMapDescriptor::default()
        };
        let renderer = Renderer::new(&gpu, &descriptor, 1).expect("a renderer");
        let corner = |x: f32, z: f32| Vec3::new(x * 200.0, 0.0, z * 200.0);
        let [a, b, c, d] = [corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
        let scene = Scene::from_objects("floor", &[vec![[a, b, c], [a, c, d]]]);
        let scene = GpuScene::new(&gpu, renderer.material_layout(), &scene, &scene.pose(None, 0.0)).expect("memory");
        let target = renderer.target(&gpu, SIZE);
        Self { gpu, renderer, scene, target }
    }

    /// Draws the floor and returns the linear colours of its pixels.
    fn picture(&mut self, camera: &PerspectiveCamera, maps: &[FittedMap], overlay: Overlay) -> Vec<Vec3> {
        let atmosphere = Atmosphere::default();
        let frame = Frame { overlay, ..Frame::new(camera, DIRECTION.normalize(), maps, &atmosphere) };
        self.renderer.draw(&self.gpu, &mut self.scene, &frame, &self.target).expect("a frame");
        let bytes = self.target.read(&self.gpu).expect("pixels");
        bytes.as_chunks::<4>().0.iter().map(|[r, g, b, _]| linear([*r, *g, *b])).collect()
    }
}

/// Returns a linear colour from sRGB bytes.
fn linear(bytes: [u8; 3]) -> Vec3 {
    Vec3::from(bytes.map(|byte| {
        let encoded = f32::from(byte) / 255.0;
        if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
    }))
}

/// Returns the map whose tint a colour has; `None` if the colour is unchanged.
fn tint_of(plain: Vec3, tinted: Vec3) -> Option<usize> {
    let luminance = plain.dot(Vec3::new(0.2126, 0.7152, 0.0722));
    let shown = |map: usize| linear(MAP_TINTS[map]) * (0.12 + 1.5 * luminance) * 0.75 + plain * 0.25;
    let difference = |map: usize| shown(map).min(Vec3::ONE).distance(tinted);
    let nearest = (0..MAP_TINTS.len()).min_by(|a, b| difference(*a).total_cmp(&difference(*b)));
    nearest.filter(|_| tinted.distance(plain) > 0.02)
}

/// Asserts that each pixel of the floor is tinted by the map that it reads.
fn assert_tinted(count: u32) {
    let camera = camera();
    let maps = maps(&camera, count);
    let mut floor = Floor::new(count);
    let [plain, tinted] = [Overlay::None, Overlay::MapTint].map(|overlay| floor.picture(&camera, &maps, overlay));
    let mut met = [0; 9];
    for (index, (plain, tinted)) in plain.iter().zip(&tinted).enumerate() {
        let (x, y) = (index % SIZE[0] as usize, index / SIZE[0] as usize);
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.5, 0.5]];
        let around = corners.map(|[dx, dy]| seen_at(&camera, &maps, [x as f64 + dx, y as f64 + dy]));
        // Pixels on a border between two maps may go either way.
        let is_plain = around.iter().all(|seen| *seen == around[0]);
        let expected = match around[0] {
            Seen::Map(map) if is_plain => Some(map),
            Seen::NoMap if is_plain => None,
            _ => continue,
        };
        assert_eq!(tint_of(*plain, *tinted), expected, "pixel {x}, {y}: {plain} became {tinted}");
        met[expected.unwrap_or(8)] += 1;
    }
    let mut counted = met[..count as usize].iter().chain(&met[8..]);
    assert!(counted.all(|count| *count > 30), "pixels by map, and outside: {met:?}");
}

#[test]
fn every_pixel_of_a_floor_is_tinted_by_the_map_that_it_reads_and_none_beyond_the_maps() {
    assert_tinted(4);
}

#[test]
#[ignore = "eight maps, whose look-up takes long to compile: cargo xtask test --all"]
fn every_pixel_of_a_floor_is_tinted_by_that_of_eight_maps_that_it_reads() {
    assert_tinted(8);
}

#[test]
fn tints_are_told_apart_and_lit_and_shadowed_stay_apart_under_each() {
    for (index, tint) in MAP_TINTS.iter().enumerate() {
        for other in &MAP_TINTS[..index] {
            assert!(linear(*tint).distance(linear(*other)) > 0.15, "{tint:?} and {other:?}");
        }
    }
    let camera = camera();
    let maps = maps(&camera, 4);
    // The same floor, fully lit and fully shadowed: a bias beyond the map's depth puts it in shadow.
    let shadowed: Vec<FittedMap> =
        maps.iter().map(|map| FittedMap { bias: Bias { constant_depth: -1.0, ..Bias::default() }, ..*map }).collect();
    let mut floor = Floor::new(4);
    let [lit, dark] = [&maps, &shadowed].map(|maps| floor.picture(&camera, maps, Overlay::MapTint));
    let luminance = |color: Vec3| color.dot(Vec3::new(0.2126, 0.7152, 0.0722));
    let mut compared = 0;
    for (index, (lit, dark)) in lit.iter().zip(&dark).enumerate() {
        let at = [index % SIZE[0] as usize, index / SIZE[0] as usize].map(|side| side as f64 + 0.5);
        if matches!(seen_at(&camera, &maps, at), Seen::Map(_)) && lit != dark {
            assert!(luminance(*lit) > 1.3 * luminance(*dark), "{lit} and {dark}");
            compared += 1;
        }
    }
    println!("{compared} pixels are in shadow in one picture alone");
    assert!(compared > 1000, "{compared}");
}
