//! Every reason, in a court of a few objects with known distances. The picture's middle pixel shows the
//! explained point. The light falls straight down unless a test says otherwise.

use glam::dcamera::rh::{proj::directx::orthographic, view::look_to_mat4};
use shadowfit::selection::DepthRange;
use shadowfit::settings::{FilterKind, MapSelection};
use shadowfit::{Bias, DepthConvention, FittedMap, LightProjection, PerspectiveCamera};
use shadowfit_scene::builtin::default_scene;

use super::*;

const SIZE: [u32; 2] = [101, 101];
/// Depth range of the maps, in metres.
const RANGE: f64 = 20.0;

/// A court, a view of one of its points, and maps of the court.
struct Court {
    things: Vec<(&'static str, Vec<[Vec3; 3]>)>,
    target: DVec3,
    eye: DVec3,
    up: Vec3,
    fov_y: f32,
    direction: Vec3,
    judging: Judging,
    technique: Technique,
    maps: Vec<FittedMap>,
    descriptor: ShadowMapDescriptor,
    factor: Option<f32>,
    stored: Option<StoredTexels>,
}

/// Returns a rectangle at a height, between two corners (x, z).
fn level(height: f32, from: [f32; 2], to: [f32; 2]) -> Vec<[Vec3; 3]> {
    let [a, b, c, d] =
        [[from[0], from[1]], [from[0], to[1]], [to[0], to[1]], [to[0], from[1]]].map(|[x, z]| Vec3::new(x, height, z));
    vec![[a, b, c], [a, c, d]]
}

/// Returns a block on the floor.
fn block(from: [f32; 2], to: [f32; 2], height: f32) -> Vec<[Vec3; 3]> {
    let side = |a: [f32; 2], b: [f32; 2]| {
        let [a, b] = [a, b].map(|[x, z]| Vec3::new(x, 0.0, z));
        let up = Vec3::Y * height;
        [[a, b, b + up], [a, b + up, a + up]]
    };
    let corners = [from, [from[0], to[1]], to, [to[0], from[1]]];
    let sides = (0..4).flat_map(|corner| side(corners[corner], corners[(corner + 1) % 4]));
    sides.chain(level(height, from, to)).collect()
}

/// Returns a square map of `texels` per side around `centre`, whose near plane lies `before` metres before
/// it.
fn map(centre: DVec3, direction: Vec3, width: f64, before: f64, texels: u32) -> FittedMap {
    let (travel, half) = (direction.as_dvec3(), width * 0.5);
    let light_from_world = look_to_mat4(centre - travel * before, travel, DVec3::NEG_Z);
    let clip_from_world = orthographic(-half, half, -half, half, 0.0, RANGE) * light_from_world;
    let fit = LightProjection::from_clip_from_world(
        &clip_from_world,
        DepthConvention::ZeroToOne,
        direction,
        glam::UVec2::splat(texels),
        centre,
    );
    FittedMap::new(fit.expect("an orthographic map"), constant(1e-4))
}

/// One map with texels of 10 cm that holds everything up to 10 m over the floor, and one comparison.
impl Default for Court {
    fn default() -> Self {
        let technique = Technique::default().with_filter(FilterKind::Point);
        let descriptor = ShadowMapDescriptor {
            maps: 1,
            selection: MapSelection::Coverage { blend: 0.0 },
            depth: DepthConvention::ZeroToOne,
            ..ShadowMapDescriptor::from(&technique)
        };
        Self {
            things: Vec::new(),
            target: DVec3::ZERO,
            eye: DVec3::new(0.0, 1.0, 2.0),
            up: Vec3::Y,
            fov_y: 0.8,
            direction: Vec3::NEG_Y,
            judging: Judging { size: SIZE, ..Judging::default() },
            technique,
            maps: vec![map(DVec3::ZERO, Vec3::NEG_Y, 10.0, 10.0, 100)],
            descriptor,
            factor: None,
            stored: None,
        }
    }
}

impl Court {
    fn with(name: &'static str, thing: Vec<[Vec3; 3]>) -> Self {
        Self { things: vec![(name, thing)], ..Self::default() }
    }

    fn why(&self) -> Why {
        let floor = ("floor", level(0.0, [-200.0, -200.0], [200.0, 211.0]));
        let things: Vec<_> = std::iter::once(&floor).chain(&self.things).collect();
        let triangles: Vec<_> = things.iter().map(|(_, triangles)| triangles.clone()).collect();
        let mut scene = Scene::from_objects("court", &triangles);
        for (node, (name, _)) in scene.nodes.iter_mut().zip(&things) {
            (*name).clone_into(&mut node.name);
        }
        let rays = SceneRays::from_origin(&scene, &scene.pose(None, 0.0), DVec3::ZERO);
        let camera = PerspectiveCamera {
            eye: self.eye,
            forward: (self.target - self.eye).normalize().as_vec3(),
            up: self.up,
            fov_y: self.fov_y,
            aspect: 1.0,
            near: 1e-3,
            far: 300.0,
        };
        let found = why(&WhyInput {
            scene: Arc::new(scene),
            rays: Arc::new(rays),
            view: View { camera: camera.into(), direction: self.direction, is_first: true },
            judging: self.judging,
            pixel: [50.5, 50.5],
            technique: self.technique,
            maps: self.maps.clone(),
            descriptor: self.descriptor,
            factor: self.factor,
            stored: self.stored,
        })
        .expect("the floor");
        let tolerance = 1e-5 * (self.target - self.eye).length();
        assert!(found.position.distance(self.target) < tolerance, "{} is not {}", found.position, self.target);
        found
    }

    /// Looks straight down on the target, with this many pixels per metre.
    fn seen_from_above(self, height: f64, pixels: f64) -> Self {
        let fov_y = 2.0 * (0.5 * f64::from(SIZE[1]) / pixels / height).atan();
        Self { eye: self.target + DVec3::Y * height, up: Vec3::NEG_Z, fov_y: fov_y as f32, ..self }
    }

    fn with_bias(mut self, bias: Bias) -> Self {
        self.maps[0].bias = bias;
        self
    }
}

/// Returns a court with a roof over its left half.
fn roof(height: f32) -> Court {
    Court { target: DVec3::new(-1.0, 0.0, 0.0), ..Court::with("roof", level(height, [-4.0, -9.0], [0.0, 9.7])) }
}

/// Returns a constant bias, in metres.
fn constant(metres: f64) -> Bias {
    Bias { constant_depth: (metres / RANGE) as f32, ..Bias::default() }
}

/// Asserts class and reason of each court.
fn assert_reasons(courts: Vec<(Court, Class, &str)>) {
    for (court, class, reason) in courts {
        let why = court.why();
        assert_eq!((why.reason.as_str(), why.class), (reason, class));
    }
}

#[test]
fn right_pixels_say_what_throws_their_shadow_or_that_nothing_does() {
    let sun = Judging { sun_radius: 0.1, sun_rays: 64, size: SIZE, ..Judging::default() };
    let nameless = Court { things: vec![("", roof(3.4).things.remove(0).1)], ..roof(3.4) };
    let penumbra = |x: f64| Court { target: DVec3::X * x, judging: sun, ..roof(3.4) };
    assert_reasons(vec![
        (Court::default(), Class::Right, "correctly lit: nothing blocks the sun"),
        (roof(3.4), Class::Right, "correctly in shadow: \"roof\", 3.4 m toward the light, casts it"),
        (
            Court { factor: Some(1.0), ..penumbra(0.15) },
            Class::Right,
            "correctly lit: 77% of the sun is visible past \"roof\"",
        ),
        (
            Court { factor: Some(0.0), ..penumbra(-0.15) },
            Class::Right,
            "correctly in shadow: \"roof\", 3.4 m toward the light, casts it, but 23% of the sun is visible",
        ),
    ]);
    let reason = nameless.why().reason;
    assert_eq!(reason, "correctly in shadow: an object 3.4 m toward the light casts it");
}

#[test]
fn what_is_turned_away_is_not_judged() {
    let wall = Court {
        target: DVec3::new(0.0, 0.5, 1.0),
        eye: DVec3::new(0.0, 0.5, 3.0),
        ..Court::with("wall", block([-2.0, -1.0], [2.0, 1.0], 2.0))
    };
    let why = Court { direction: Vec3::new(0.0, -0.8, 0.6), ..wall }.why();
    assert_eq!((why.class, why.reason.as_str()), (Class::NotJudged, "facing away from the sun"));
    assert_eq!((why.texel, why.compared, why.factor), (None, None, None));
}

#[test]
fn holes_say_how_far_the_map_misses_the_occluder() {
    let low = |top: f64| vec![map(DVec3::ZERO, Vec3::NEG_Y, 10.0, top, 100)];
    let aslant = Vec3::new(1.0, -1.0, 0.0).normalize();
    // The map was fitted to another light, in which the roof is 2 m aside.
    let turned = vec![map(DVec3::new(-1.0, 0.0, 0.0), aslant, 1.2, 10.0, 100)];
    let beside = Court { maps: turned, factor: Some(1.0), ..roof(2.0 * core::f32::consts::SQRT_2) };
    let far =
        Court { target: DVec3::new(-3.0, 0.0, 0.0), maps: vec![map(DVec3::X, Vec3::NEG_Y, 2.0, 9.0, 20)], ..roof(3.4) };
    assert_reasons(vec![
        (
            Court { maps: low(2.0), ..roof(5.2) },
            Class::Hole,
            "wrongly lit: its occluder, \"roof\", is 3.2 m before the near plane of map 1",
        ),
        (beside, Class::Hole, "wrongly lit: its occluder, \"roof\", is 1.4 m beside map 1"),
        (far, Class::Hole, "wrongly lit: no map holds it, so \"roof\" cannot shadow it"),
        (Court { maps: Vec::new(), ..roof(3.4) }, Class::Hole, "wrongly lit: there is no map"),
    ]);
}

#[test]
fn shadows_that_end_with_the_technique_say_where() {
    let mut at_eight = Court { eye: DVec3::new(-1.0, 3.0, 55f64.sqrt()), factor: Some(1.0), ..roof(3.4) };
    at_eight.technique = at_eight.technique.with_max_distance(5.0);
    let no_map = Court { maps: vec![map(DVec3::X * 9.0, Vec3::NEG_Y, 2.0, 9.0, 20)], ..roof(3.4) };
    let no_map = Court { eye: at_eight.eye, technique: at_eight.technique, ..no_map };
    let fading = |fade: [f32; 2]| {
        let court = Court { eye: at_eight.eye, factor: Some(1.0), ..roof(3.4) };
        Court { descriptor: ShadowMapDescriptor { fade, ..court.descriptor }, ..court }
    };
    assert_reasons(vec![
        (no_map, Class::Hole, "wrongly lit: at 8 m it is beyond the shadow distance of 5 m"),
        (
            fading([6.0, 10.0]),
            Class::FalseLight,
            "wrongly lit: shadows fade out between 6 m and 10 m, and it is 8 m away",
        ),
        (fading([4.0, 5.0]), Class::FalseLight, "wrongly lit: at 8 m it is beyond the shadow distance of 5 m"),
    ]);
}

#[test]
fn light_that_leaks_says_through_what() {
    let thin =
        Court { eye: DVec3::new(0.1, 0.003, 0.0), ..Court::with("sheet", level(0.006, [-2.0, -2.0], [2.0, 2.5])) };
    let wire = Court::with("wire", level(2.0, [-0.01, -5.0], [0.01, 5.7])).seen_from_above(0.005, 25_000.0);
    let empty = StoredTexels { texel: [40, 50], depths: [[1.0; 3]; 3] };
    // The light hits a kerb of 5 cm at an angle, 3 cm beside the point, which the bias lifts by 4 cm.
    let aslant = Vec3::new(1.0, -1.0, 0.0).normalize();
    let offset = Bias { normal_offset: 0.04 * core::f32::consts::SQRT_2, ..Bias::default() };
    let kerb = Court {
        direction: aslant,
        maps: vec![map(DVec3::ZERO, aslant, 1.0, 10.0, 1000)],
        ..Court::with("kerb", block([-0.1, -1.0], [-0.03, 1.3], 0.05)).seen_from_above(1.0, 1000.0)
    };
    assert_reasons(vec![
        (
            thin.with_bias(constant(0.011)),
            Class::FalseLight,
            "wrongly lit: its occluder, \"sheet\", is only 6 mm in front of it, less than the bias of 11 mm",
        ),
        (
            kerb.with_bias(offset),
            Class::FalseLight,
            "wrongly lit: the bias looks it up 4 cm off its surface, where \"kerb\" is not in the way",
        ),
        (
            wire,
            Class::FalseLight,
            "wrongly lit: its occluder, \"wire\", lies between the centres of the texels of map 1, which are 10 cm \
             wide",
        ),
        (
            Court { stored: Some(empty), ..roof(3.4) },
            Class::FalseLight,
            "wrongly lit: map 1 should store \"roof\", 3.4 m toward the light, but does not",
        ),
        (
            Court { factor: Some(1.0), ..roof(3.4) },
            Class::FalseLight,
            "wrongly lit: map 1 holds \"roof\", 3.4 m toward the light, but the filter lets light through",
        ),
    ]);
}

#[test]
fn dark_spots_say_what_the_map_stored() {
    let range = RANGE as f32;
    let nearer = StoredTexels { texel: [50, 50], depths: [[(10.0 - 0.004) / range; 3]; 3] };
    let itself = Court { stored: Some(nearer), ..Court::default() };
    // A ramp that falls at 45 degrees, 3 cm downhill from a texel's centre.
    let corners = [[-3.0, -3.0], [-3.0, 3.3], [3.0, 3.3], [3.0, -3.0]].map(|[x, z]| Vec3::new(x, 3.0 - x, z));
    let ramp = vec![[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]];
    let ramp =
        Court { target: DVec3::new(0.08, 2.92, 0.0), eye: DVec3::new(2.0, 5.0, 1.0), ..Court::with("ramp", ramp) };
    // A block without a shadow, because the light falls along its sides. The texel beside it is mostly on the
    // block.
    let block = Court::with("block", block([-2.0, -2.0], [0.07, 2.0], 1.0));
    let crease = Court { target: DVec3::new(0.09, 0.0, 0.05), eye: DVec3::new(2.0, 1.5, 0.05), ..block };
    assert_reasons(vec![
        (
            itself.with_bias(constant(0.001)),
            Class::FalseShadow,
            "wrongly dark: the map stores this surface itself, 4 mm nearer to the light than the point, but the \
             bias is only 1 mm",
        ),
        (
            ramp.with_bias(constant(0.001)),
            Class::FalseShadow,
            "wrongly dark: the map stores this surface itself, 3 cm nearer to the light than the point, but the \
             bias is only 1 mm",
        ),
        (
            crease,
            Class::FalseShadow,
            "wrongly dark: the filter reads a texel 4 cm away, which stores \"block\", 1 m nearer to the light",
        ),
        (
            Court { factor: Some(0.0), ..Court::default() },
            Class::FalseShadow,
            "wrongly dark: the map stores something in front of it that no ray hits, such as an object that has moved",
        ),
    ]);
}

#[test]
fn edges_are_measured_in_texels_or_in_pixels_where_those_are_larger() {
    let beside = |x: f64, pixels: f64| {
        Court { target: DVec3::X * x, factor: Some(0.0), ..roof(3.4) }.seen_from_above(1.0, pixels)
    };
    assert_reasons(vec![
        (
            beside(0.04, 70.0),
            Class::Edge,
            "wrong by less than a texel: the true edge of the shadow is 0.4 texels away, and a texel covers 7 pixels here",
        ),
        (
            beside(0.11, 70.0),
            Class::Edge,
            "wrong beside an edge: the true edge of the shadow is 1.1 texels away, within the 1.5 texels that the filter \
             blurs over, and a texel covers 7 pixels here",
        ),
        (
            beside(0.04, 8.0),
            Class::Edge,
            "wrong by less than a pixel: the true edge of the shadow is 0.5 pixels away, and texels are finer than pixels \
             here",
        ),
    ]);
}

#[test]
fn the_map_by_coverage_is_the_finest_and_the_reason_says_where_the_finer_one_ends() {
    let around = |x: f64, width: f64, texels: u32| map(DVec3::X * x, Vec3::NEG_Y, width, 10.0, texels);
    let below = map(DVec3::NEG_Y * 12.0, Vec3::NEG_Y, 1.0, 10.0, 100);
    let coarse = around(0.0, 20.0, 100);
    let reason = |maps: Vec<FittedMap>, blend: f32| {
        let court = Court::default();
        Court {
            maps,
            descriptor: ShadowMapDescriptor { selection: MapSelection::Coverage { blend }, ..court.descriptor },
            ..court
        }
        .why()
        .map_reason
    };
    for (maps, blend, text) in [
        (vec![coarse], 0.0, "map 1 of 1: the only one, and it holds this point"),
        (vec![around(0.0, 2.0, 100), coarse], 0.0, "map 1 of 2: the finest of all, and it holds this point"),
        (
            vec![around(-4.1, 2.0, 100), coarse],
            0.0,
            "map 2 of 2: the finest that holds this point; map 1 ends 3.1 m to the left of it",
        ),
        (
            vec![below, coarse],
            0.0,
            "map 2 of 2: the finest that holds this point; map 1 begins 2 m behind it, seen from the light",
        ),
        (
            vec![around(0.98, 2.0, 10), coarse],
            0.0,
            "map 2 of 2: the finest that holds this point; map 1 ends 0.1 texels beside it, and the filter reads 0.5",
        ),
        (
            // 2.5 texels from the border: the filter takes 0.5 of them, and the blend is 8 wide.
            vec![around(0.75, 2.0, 20), coarse],
            8.0,
            "map 2 of 2: it takes over near the border of map 1, which is finer and counts 25% here",
        ),
        (
            vec![around(0.2, 2.0, 20), coarse],
            12.5,
            "map 1 of 2: the finest of all, and it holds this point; blended with map 2, which counts 40% here",
        ),
        (vec![around(0.99, 2.0, 20)], 0.0, "map 1 of 1: the only one, and it holds this point"),
        (vec![around(3.0, 2.0, 20)], 0.0, "no map: map 1 ends 2 m to the right of it"),
        (
            vec![around(9.0, 2.0, 20), around(-4.0, 2.0, 20)],
            0.0,
            "no map: none of the 2 holds this point, and map 2 ends 3 m to the left of it",
        ),
        (Vec::new(), 0.0, "no map: there are none"),
    ] {
        assert_eq!(reason(maps, blend), text);
    }
}

#[test]
fn the_map_by_view_depth_is_that_of_its_range() {
    let wide = |near: f64, far: Option<f64>| {
        let depths = DepthRange { near, far, covered_from: Some(near) };
        map(DVec3::ZERO, Vec3::NEG_Y, 300.0, 10.0, 1000).with_depths(depths)
    };
    let cascades = [wide(0.0, Some(10.0)), wide(10.0, Some(28.0)), wide(28.0, Some(77.0)), wide(77.0, None)];
    let reason = |depth: f64, maps: &[FittedMap]| {
        let court = Court { eye: DVec3::new(0.0, 0.6, 0.8) * depth, maps: maps.to_vec(), ..Court::default() };
        let descriptor =
            ShadowMapDescriptor { selection: MapSelection::ViewDepth { overlap: 0.0 }, ..court.descriptor };
        Court { descriptor, ..court }.why().map_reason
    };
    let mut narrow = cascades;
    narrow[2] = map(DVec3::X * 10.0, Vec3::NEG_Y, 4.0, 10.0, 100).with_depths(DepthRange::new(28.0, Some(77.0)));
    let mut overlapping = cascades;
    overlapping[3].depths.as_mut().expect("a range").covered_from = Some(37.0);
    for (depth, maps, text) in [
        (4.0, &cascades[..], "map 1 of 4: view depth 4 m lies before 10 m, where it ends"),
        (41.0, &cascades, "map 3 of 4: view depth 41 m lies between 28 m and 77 m"),
        (90.0, &cascades, "map 4 of 4: view depth 90 m lies beyond 77 m, where map 3 ends"),
        (41.0, &cascades[3..], "map 1 of 1: it covers every view depth"),
        (
            41.0,
            &narrow,
            "map 4 of 4: view depth 41 m belongs to map 3, which does not hold this point: map 3 ends 8 m to the right of it",
        ),
        (
            41.0,
            &overlapping,
            "map 3 of 4: view depth 41 m lies between 28 m and 77 m; blended with map 4, which counts 10% here",
        ),
    ] {
        assert_eq!(reason(depth, maps), text);
    }
}

#[test]
fn numbers_are_those_of_the_look_up_in_plain_and_in_reversed_depth() {
    let plain = roof(3.4).with_bias(constant(0.1));
    let why = plain.why();
    let near =
        |found: Option<f32>, wanted: f32| found.is_some_and(|found| (found - wanted).abs() < 2e-5 * wanted.max(1.0));
    assert_eq!((why.map, why.is_lit, why.factor), (Some(0), false, Some(0.0)));
    assert!((why.distance - 6f32.sqrt()).abs() < 1e-5 && why.normal.distance(Vec3::Y) < 1e-6);
    assert!(near(why.compared_metres, 9.9) && near(why.stored_metres, 6.6), "{why:?}");
    assert!(near(why.compared, 0.495) && near(why.stored, 0.33), "{why:?}");
    let texel = why.texel.expect("a map");
    assert!((texel[0] - 40.0).abs() < 1e-3 && (texel[1] - 50.0).abs() < 1e-3, "{texel:?}");
    let mut reversed = plain;
    for map in &mut reversed.maps {
        let flip = glam::DMat4::from_cols(
            glam::DVec4::X,
            glam::DVec4::Y,
            -glam::DVec4::Z,
            glam::DVec4::new(0.0, 0.0, 1.0, 1.0),
        );
        let clip = flip * map.projection.clip_from_world.as_dmat4();
        map.projection = LightProjection::from_clip_from_world(
            &clip,
            DepthConvention::Reversed,
            map.projection.direction,
            map.projection.resolution,
            DVec3::ZERO,
        )
        .expect("a map");
    }
    assert_eq!(reversed.maps[0].projection.depth, DepthConvention::Reversed);
    let why = reversed.why();
    assert!(near(why.compared_metres, 9.9) && near(why.compared, 0.505) && near(why.stored, 0.67), "{why:?}");
    assert_eq!(why.class, Class::Right);
    let lit = Court::default().why();
    assert_eq!((lit.factor, lit.class), (Some(1.0), Class::Right), "the floor does not shadow itself");
    assert!(near(lit.stored_metres, 10.0));
}

#[test]
fn the_sky_and_pixels_beyond_the_picture_have_no_reason() {
    assert_eq!([[-0.5, 3.0], [101.0, 3.0], [3.0, f32::NAN]].map(|pixel| pixel_index(pixel, SIZE)), [None; 3]);
    assert_eq!(pixel_index([100.9, 2.1], SIZE), Some(302));
}

#[test]
fn gpu_classes_are_those_of_the_judge_on_a_picture_of_the_default_scene() {
    use shadowfit_render::Renderer;
    use shadowfit_testing::renderer_gpu;

    use crate::{Evaluator, PreparedScene, SharedTruth};
    use shadowfit::ShadowFitter;

    let size = [160, 90];
    let gpu = renderer_gpu();
    for (name, texels) in [("windows-4", 512), ("calm-4", 256), ("xna-1", 512)] {
        let technique = Technique::preset(name).expect("a preset").with_resolution(texels, texels);
        let descriptor = ShadowMapDescriptor::from(&technique);
        let renderer = Renderer::new(&gpu, &descriptor, 1).expect("a renderer");
        let mut scene = PreparedScene::new(&gpu, renderer.material_layout(), default_scene()).expect("the scene");
        let camera = PerspectiveCamera {
            eye: DVec3::new(5.0, 2.5, 12.0),
            forward: Vec3::new(-0.35, -0.15, -0.9),
            up: Vec3::Y,
            fov_y: 0.9,
            aspect: 16.0 / 9.0,
            near: 0.1,
            far: 150.0,
        };
        let view = View { camera: camera.into(), direction: Vec3::new(0.4, -0.7, 0.3).normalize(), is_first: true };
        let judging = Judging { size, ..Judging::default() };
        let mut evaluator = Evaluator::new(renderer, judging);
        let maps = scene
            .fit_alone(&mut ShadowFitter::new(&technique), shadowfit_params::Inputs::default(), &view)
            .expect("maps");
        let rays = scene.shared_rays();
        let (job, _) = evaluator.judge_job(&gpu, &mut scene, &view, &maps, rays.clone()).expect("a picture");
        let truth = &mut SharedTruth::default();
        let judged = evaluator.judge(&gpu, &mut scene, &view, &maps, truth).expect("judged");
        let input = WhyInput {
            scene: scene.shared_scene(),
            rays,
            view,
            judging,
            pixel: [0.0; 2],
            technique,
            maps: maps.to_vec(),
            descriptor,
            factor: None,
            stored: None,
        };
        let (mut asked, mut same) = (0u32, 0u32);
        for pixel in (0..judged.classes.len()).step_by(3) {
            let Some(seen) = job.pixels[pixel] else { continue };
            let place = [pixel % size[0] as usize, pixel / size[0] as usize].map(|place| place as f32 + 0.5);
            let found = why(&WhyInput { pixel: place, factor: Some(seen.factor), ..input.clone() });
            asked += 1;
            same +=
                u32::from(found.is_some_and(|found| found.class == judged.classes[pixel] && !found.reason.is_empty()));
        }
        assert!(asked > 3000 && f64::from(same) >= 0.99 * f64::from(asked), "{name}: {same} of {asked}");
    }
}
