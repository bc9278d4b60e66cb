//! Culling of casters with invisible shadows: the shadow factor of every pixel stays bit-identical, and fewer
//! casters are drawn.

use std::path::PathBuf;

use glam::{DVec2, DVec3, UVec2, Vec3};
use shadowfit::bias::XNA_DEPTH_BIAS;
use shadowfit::settings::{
    BiasSettings, CasterPolicy, FilterKind, FitKind, FitSettings, MapFormat, MapSelection, MapSettings, Shape,
    SplitScheme, Stabilise,
};
use shadowfit::{
    Aabb, Bias, Boxes, Cascades, DepthConvention, FitInput, FitState, FittedMap, LightProjection, Maps,
    PerspectiveCamera, Scratch, Technique, fit,
};
use shadowfit_render::passes::material_layout;
use shadowfit_render::{Atmosphere, Culling, Frame, Gpu, GpuScene, ProbePixel, ProbeTargets, Renderer};
use shadowfit_report::peers::Scenarios;
use shadowfit_scene::{Scene, builtin, load_gltf};
use shadowfit_testing::pairs::all_pairs;
use shadowfit_testing::{package_folder, renderer_gpu};
use shadowfit_wgpu::{MAX_MAPS, ShadowMapDescriptor};

/// Size of the pictures, in pixels.
const SIZE: [u32; 2] = [160, 90];
/// Width and height of the maps, in texels.
const TEXELS: u32 = 512;

/// The light's directions of travel: high, half-way up, and grazing the ground.
const DIRECTIONS: [Vec3; 3] = [Vec3::new(0.2, -1.0, 0.1), Vec3::new(0.5, -0.6, -0.4), Vec3::new(-0.9, -0.2, 0.3)];

/// Eye of the town's view, in metres.
const TOWN_EYE: Vec3 = Vec3::new(-6.0, 5.0, 30.0);

/// Maps and the way they are read.
struct Case {
    name: &'static str,
    technique: Technique,
    filter: FilterKind,
    format: MapFormat,
    bias: fn(&LightProjection, FilterKind) -> Bias,
    /// Whether all maps except the last leave out the sides of their slices, as fits of other code may.
    is_narrow: bool,
}

fn in_texels(fit: &LightProjection, filter: FilterKind) -> Bias {
    Bias::from_texels(&BiasSettings::automatic(filter), MapFormat::Depth32Float, fit)
}

fn automatic(fit: &LightProjection, filter: FilterKind) -> Bias {
    Bias::automatic(filter, shadowfit::diagnostics::DepthStorage::from(MapFormat::Depth32Float), fit).expect("a bias")
}

fn away_from_the_light(_: &LightProjection, _: FilterKind) -> Bias {
    Bias::fixed(-XNA_DEPTH_BIAS).expect("a bias")
}

/// Returns the cases with `count` maps, except for one case with a single map.
fn cases(count: u32) -> Vec<Case> {
    let maps = |kind, splits, stabilise, casters| {
        let fit = MapSettings { casters, resolution: UVec2::splat(TEXELS), ..MapSettings::default() };
        let cascades = Cascades { count, shape: Shape::new(kind), splits, stabilise, ..Cascades::default() };
        Technique::default().with_maps(cascades).with_fit(fit)
    };
    let list = CasterPolicy::PerObject;
    let case = |name, maps| Case {
        name,
        technique: maps,
        filter: FilterKind::Pcf5x5,
        format: MapFormat::Depth32Float,
        bias: in_texels,
        is_narrow: false,
    };
    let focused = maps(FitKind::Focused, SplitScheme::FromBoxes, Stabilise::Off, list);
    let aabb = maps(FitKind::FrustumAabb, SplitScheme::Logarithmic, Stabilise::Off, list);
    let mut reversed = focused;
    reversed.fit.depth = DepthConvention::Reversed;
    let clamped = maps(FitKind::Focused, SplitScheme::FromBoxes, Stabilise::Off, CasterPolicy::DepthClamp);
    let chosen = |technique: Technique, selection| match technique.maps {
        Maps::Cascades(cascades) => technique.with_maps(cascades.with_selection(selection)),
        _ => technique,
    };
    let mut all = vec![
        case("focused", focused),
        case("held", maps(FitKind::Focused, SplitScheme::FromBoxes, Stabilise::default(), list)),
        case(
            "spheres",
            maps(FitKind::Sphere, SplitScheme::Practical(0.7), Stabilise::Snap { max_oversize: 1.8 }, list),
        ),
        case("boxes of the cascades", aabb),
        Case { bias: automatic, ..case("boxes of the cascades, normal offset", aabb) },
        Case { bias: away_from_the_light, filter: FilterKind::Point, ..case("focused, biased away", focused) },
        Case { format: MapFormat::R32Float, filter: FilterKind::Pcf3x3, ..case("focused, reversed", reversed) },
        case("focused, depth clamp", clamped),
        Case { is_narrow: true, ..case("narrow", aabb) },
        case("one map", aabb.with_count(1)),
        case("without a blend", chosen(focused, MapSelection::Coverage { blend: 0.0 })),
        Case { filter: FilterKind::Vogel16, ..case("focused, soft", focused) },
        Case {
            filter: FilterKind::Pcss,
            format: MapFormat::R16Float,
            ..case("focused, wide as its penumbrae", focused)
        },
    ];
    let also = ["focused", "boxes of the cascades", "boxes of the cascades, normal offset", "narrow"];
    let others: Vec<Case> = all
        .iter()
        .filter(|case| also.contains(&case.name))
        .map(|case| Case { technique: chosen(case.technique, MapSelection::ViewDepth { overlap: 0.0 }), ..*case })
        .collect();
    all.extend(others);
    all.push(case("overlapping", chosen(aabb, MapSelection::ViewDepth { overlap: 0.3 })));
    all
}

/// A scene and a camera position.
struct View {
    name: &'static str,
    scene: Scene,
    eye: Vec3,
    target: Vec3,
}

fn views() -> [View; 2] {
    let (eye, target) = builtin::default_camera();
    [
        View { name: "courtyard", scene: builtin::default_scene(), eye, target },
        View {
            name: "town",
            scene: Scene::from_objects("town", &town()),
            eye: TOWN_EYE,
            target: Vec3::new(5.0, 1.0, 0.0),
        },
    ]
}

/// Returns blocks of many heights on a ground of tiles.
fn town() -> Vec<Vec<[Vec3; 3]>> {
    let mut objects = Vec::new();
    for i in 0..400_i16 {
        let share = |step: f32| (f32::from(i) * step).fract();
        let (x, z) = (share(0.754_877_7) * 120.0 - 60.0, share(0.569_840_3) * 120.0 - 60.0);
        let half = Vec3::new(0.3 + share(0.37) * 1.2, 0.5 + share(0.19).powi(4) * 9.0, 0.3 + share(0.83) * 1.2);
        // No blocks around the eye.
        if Vec3::new(x, TOWN_EYE.y, z).distance(TOWN_EYE) > 6.0 {
            objects.push(solid(Vec3::new(x, half.y, z), half));
        }
    }
    for tile in 0..144_i16 {
        let (x, z) = (f32::from(tile % 12) * 12.0 - 66.0, f32::from(tile / 12) * 12.0 - 66.0);
        objects.push(solid(Vec3::new(x, -0.2, z), Vec3::new(6.0, 0.2, 6.0)));
    }
    objects
}

fn solid(centre: Vec3, half: Vec3) -> Vec<[Vec3; 3]> {
    let corner = |index: usize| {
        let side = |bit: usize| if index >> bit & 1 == 0 { -1.0 } else { 1.0 };
        centre + half * Vec3::new(side(0), side(1), side(2))
    };
    let faces = [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]];
    let halves = |face: [usize; 4]| {
        let [a, b, c, d] = face.map(corner);
        [[a, b, c], [a, c, d]]
    };
    faces.into_iter().flat_map(halves).collect()
}

fn camera(view: &View) -> PerspectiveCamera {
    PerspectiveCamera {
        eye: view.eye.as_dvec3(),
        forward: (view.target - view.eye).normalize(),
        up: Vec3::Y,
        fov_y: 0.8,
        aspect: SIZE[0] as f32 / SIZE[1] as f32,
        near: 0.1,
        far: 90.0,
    }
}

/// Returns the world boxes of all instances, in metres.
fn boxes(scene: &Scene, gpu_scene: &GpuScene) -> Vec<Aabb> {
    let bounds = (0..scene.instances().len()).filter_map(|index| gpu_scene.instance_bounds(index));
    bounds.map(|bounds| Aabb::new(bounds.min, bounds.max)).collect()
}

fn descriptor(case: &Case) -> ShadowMapDescriptor {
    ShadowMapDescriptor {
        resolution: [TEXELS; 2],
        maps: case.technique.maps.count(),
        format: case.format,
        filter: case.filter,
        softness: case.technique.softness,
        selection: case.technique.maps.selection(),
        depth: case.technique.fit.depth,
        depth_clamp: case.technique.fit.casters == CasterPolicy::DepthClamp,
        ..ShadowMapDescriptor::default()
    }
}

/// Fits the maps of a case to the boxes in the camera's view.
fn fitted(case: &Case, camera: &PerspectiveCamera, boxes: &[Aabb], direction: Vec3) -> Vec<FittedMap> {
    let frustum = camera.frustum().expect("a camera");
    let boxes = Boxes { origin: DVec3::ZERO, boxes };
    let input =
        FitInput { views: &[frustum], receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&[], direction) };
    let mut storage = vec![DVec2::ZERO; Scratch::required(boxes.boxes.len(), 3)];
    let fitted = FitState::new().fit(&input, &case.technique, &mut Scratch::new(&mut storage)).expect("maps");
    let narrow = PerspectiveCamera { fov_y: camera.fov_y * 0.5, ..*camera }.frustum().expect("a camera");
    let last = fitted.len() - 1;
    let map = |(index, map): (usize, &FittedMap)| {
        let is_narrow = case.is_narrow && index < last;
        let shape = case.technique.maps.shape().expect("cascades or one map");
        let settings = FitSettings { shape, map: case.technique.fit };
        let settings = settings.with_max_distance(map.shader_end()).with_casters(CasterPolicy::Extend);
        let light = if is_narrow { fit(&narrow, direction, &settings).expect("a fit") } else { map.projection };
        let converted = *map;
        FittedMap { projection: light, bias: (case.bias)(&light, case.filter), ..converted }
    };
    fitted.iter().enumerate().map(map).collect()
}

/// A frame drawn with one way of culling.
struct Drawn {
    pixels: Vec<Option<ProbePixel>>,
    /// Casters in each map.
    casters: [usize; MAX_MAPS],
}

impl Drawn {
    fn new(gpu: &Gpu, renderer: &mut Renderer, scene: &mut GpuScene, frame: &Frame<'_>, culling: Culling) -> Self {
        let frame = Frame { culling, ..*frame };
        let targets = ProbeTargets::new(&gpu.device, SIZE);
        let pixels = renderer.probe(gpu, scene, &frame, &targets).expect("a probe").pixels;
        let mut casters = [0; MAX_MAPS];
        for region in renderer.sun().passes().flat_map(|pass| pass.regions()) {
            casters[region.map] += region.casters.len();
        }
        Self { pixels, casters }
    }
}

/// A view on the GPU.
struct Shown {
    view: View,
    scene: GpuScene,
    boxes: Vec<Aabb>,
}

impl Shown {
    fn new(gpu: &Gpu, view: View) -> Self {
        let pose = view.scene.pose(None, 0.0);
        let scene = GpuScene::new(gpu, &material_layout(&gpu.device), &view.scene, &pose).expect("memory");
        let boxes = boxes(&view.scene, &scene);
        Self { view, scene, boxes }
    }
}

/// Returns the number of pixels whose factors differ.
fn different(one: &[Option<ProbePixel>], other: &[Option<ProbePixel>]) -> usize {
    let bits = |pixel: &Option<ProbePixel>| pixel.map(|pixel| (pixel.triangle, pixel.factor.to_bits()));
    one.iter().zip(other).filter(|(a, b)| bits(a) != bits(b)).count()
}

/// Casters of a case's frames with and without swept culling.
#[derive(Default)]
struct Counted {
    swept: usize,
    whole: usize,
}

/// Compares a case's frame with and without swept culling, and counts the casters.
fn compare(gpu: &Gpu, renderer: &mut Renderer, case: &Case, shown: &mut Shown, direction: Vec3, counted: &mut Counted) {
    let camera = camera(&shown.view);
    let maps = fitted(case, &camera, &shown.boxes, direction);
    let atmosphere = Atmosphere::default();
    let frame = Frame::new(camera, direction, &maps, &atmosphere);
    let [swept, whole] =
        [Culling::Swept, Culling::WholeMap].map(|culling| Drawn::new(gpu, renderer, &mut shown.scene, &frame, culling));
    let at = (case.name, case.technique.maps.selection(), shown.view.name, direction);
    let count = different(&swept.pixels, &whole.pixels);
    assert_eq!(count, 0, "{at:?}: pixels with another factor");
    let shadowed = whole.pixels.iter().flatten().filter(|pixel| pixel.factor < 0.5).count();
    assert!(shadowed > 100, "{at:?}: {shadowed} pixels in shadow, too few to tell");
    assert!(swept.casters.iter().zip(&whole.casters).all(|(swept, whole)| swept <= whole));
    counted.swept += swept.casters.iter().sum::<usize>();
    counted.whole += whole.casters.iter().sum::<usize>();
}

#[test]
fn swept_casters_give_every_pixel_the_same_factor_and_are_fewer() {
    let gpu = renderer_gpu();
    let mut shown = views().map(|view| Shown::new(&gpu, view));
    let cases = cases(2);
    let rows = all_pairs(&[cases.len(), shown.len(), DIRECTIONS.len()]);
    for (number, case) in cases.iter().enumerate() {
        let mut renderer = Renderer::new(&gpu, &descriptor(case), 1).expect("a renderer");
        let mut counted = Counted::default();
        for row in rows.iter().filter(|row| row[0] == number) {
            let direction = DIRECTIONS[row[2]].normalize();
            compare(&gpu, &mut renderer, case, &mut shown[row[1]], direction, &mut counted);
        }
        let Counted { swept, whole } = counted;
        println!("{}, {:?}: {swept} of {whole} casters", case.name, case.technique.maps.selection());
        assert!(swept < whole, "{}: nothing was left out", case.name);
    }
}

#[test]
#[ignore = "the full product of maps, views and lights: cargo xtask test --all"]
fn swept_casters_of_the_full_product_give_every_pixel_the_same_factor_and_are_fewer() {
    let gpu = renderer_gpu();
    let mut shown = views().map(|view| Shown::new(&gpu, view));
    for case in cases(4) {
        let mut renderer = Renderer::new(&gpu, &descriptor(&case), 1).expect("a renderer");
        for shown in &mut shown {
            let mut counted = Counted::default();
            for direction in DIRECTIONS.map(Vec3::normalize) {
                compare(&gpu, &mut renderer, &case, shown, direction, &mut counted);
            }
            assert!(counted.swept < counted.whole, "{}, {}: nothing was left out", case.name, shown.view.name);
        }
    }
}

#[test]
fn maps_that_are_looked_up_from_another_eye_keep_what_the_picture_shows() {
    let gpu = renderer_gpu();
    let atmosphere = Atmosphere::default();
    for case in cases(2).iter().filter(|case| case.name == "boxes of the cascades") {
        from_other_eyes(&gpu, &atmosphere, case);
    }
}

fn from_other_eyes(gpu: &Gpu, atmosphere: &Atmosphere, case: &Case) {
    let mut renderer = Renderer::new(gpu, &descriptor(case), 1).expect("a renderer");
    let [_, view] = views();
    let mut scene =
        GpuScene::new(gpu, renderer.material_layout(), &view.scene, &view.scene.pose(None, 0.0)).expect("memory");
    let direction = DIRECTIONS[1].normalize();
    let inner = camera(&view);
    let maps = fitted(case, &inner, &[Aabb::new(Vec3::splat(-70.0), Vec3::splat(70.0))], direction);
    let turned = Vec3::new(-inner.forward.z, inner.forward.y, inner.forward.x);
    for (eye, forward) in [
        (inner.eye + DVec3::new(4.0, 2.0, 1.0), inner.forward),
        (inner.eye - inner.forward.as_dvec3() * 30.0, inner.forward),
        (inner.eye, turned),
    ] {
        let outer = PerspectiveCamera { eye, forward, ..inner };
        let frame =
            Frame { reader: Some((inner.eye, inner.forward)), ..Frame::new(outer, direction, &maps, atmosphere) };
        let [swept, all] = [Culling::Swept, Culling::WholeMap]
            .map(|culling| Drawn::new(gpu, &mut renderer, &mut scene, &frame, culling));
        let selection = case.technique.maps.selection();
        assert_eq!(different(&swept.pixels, &all.pixels), 0, "{selection:?}, from {eye} along {forward}");
    }
}

/// Returns a folder beside the workspace with external data, or `None` with a note if it is missing.
fn shared(name: &str) -> Option<PathBuf> {
    let folder = package_folder(env!("CARGO_MANIFEST_DIR")).join("../../../shared").join(name);
    if !folder.is_dir() {
        println!("SKIPPED: {} does not exist", folder.display());
    }
    folder.is_dir().then_some(folder)
}

#[test]
fn real_scenes_get_the_same_factor_in_every_pixel() {
    let (Some(assets), Some(peers)) = (shared("assets"), shared("peers")) else { return };
    let scenarios = Scenarios::read(&peers.join("scenarios.json")).expect("scenarios");
    let (gpu, atmosphere) = (renderer_gpu(), Atmosphere::default());
    let cases = cases(2);
    let mut renderers: Vec<(&Case, Renderer)> =
        cases[..3].iter().map(|case| (case, Renderer::new(&gpu, &descriptor(case), 1).expect("a renderer"))).collect();
    let mut compared = 0;
    for (index, of_file) in scenarios.scenes.iter().enumerate() {
        let scene = load_gltf(&assets.join(of_file.file.as_ref().expect("a scene of the collection")))
            .unwrap_or_else(|error| panic!("{error}"));
        let mut gpu_scene =
            GpuScene::new(&gpu, &material_layout(&gpu.device), &scene, &scene.pose(None, 0.0)).expect("memory");
        let boxes = boxes(&scene, &gpu_scene);
        for (case, renderer) in &mut renderers {
            // One frame of each path, a third of the way along it.
            for frame in scenarios.frames.iter().filter(|frame| frame.scene == index && frame.frame == 7) {
                let (camera, direction) = (frame.camera(), DVec3::from_array(frame.light_dir).as_vec3());
                let maps = fitted(case, &camera, &boxes, direction);
                let shown = Frame::new(camera, direction, &maps, &atmosphere);
                let [swept, whole] = [Culling::Swept, Culling::WholeMap]
                    .map(|culling| Drawn::new(&gpu, renderer, &mut gpu_scene, &shown, culling));
                assert_eq!(different(&swept.pixels, &whole.pixels), 0, "{}, {}", frame.id, case.name);
                compared += swept.pixels.iter().flatten().count();
            }
        }
    }
    println!("{compared} pixels compared");
    assert!(compared > 200_000, "{compared} pixels of scenes");
}
