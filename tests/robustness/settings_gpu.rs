//! Settings that no panel would allow: every number in turn NaN, infinite, zero, negative, tiny and huge.

use shadowfit::Maps;
use shadowfit::glam::{DVec3, UVec2};
use shadowfit::settings::{CasterPolicy, FilterKind, FitKind, MapFormat, SoftRadius, Softness};
use shadowfit::{DepthConvention, Technique};
use shadowfit_params::tool::{Settings, ViewMode};
use shadowfit_render::FlyInput;
use shadowfit_scene::builtin::default_scene;
use shadowfit_scene::{Mesh, Scene};
use shadowfit_viewer::{Artefact, Stage};

use crate::support::test_gpu;

/// Size of the pictures, in pixels.
const SIZE: [u32; 2] = [64, 36];

/// Triangle limit of a mesh in the scene for these tests.
const MOST_TRIANGLES: usize = 300;

/// Number of random techniques.
const ROUNDS: usize = 24;

/// Test values of each number.
const ABSURD: [f32; 9] =
    [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, -1.0, f32::MIN_POSITIVE, f32::MAX, f32::MIN, 1e-20];

/// Name of a number of the settings, and a function that sets it.
type Field = (&'static str, fn(&mut Settings, f32));

/// Every number that is a float.
const FIELDS: [Field; 26] = [
    ("fit.max_distance", |s, x| s.technique.fit.max_distance = x),
    ("fit.margin", |s, x| s.technique.fit.margin = x),
    ("fit.border", |s, x| s.technique.fit.border = Some(x)),
    ("fit.caster_extension", |s, x| s.technique.fit.caster_extension = x),
    ("bias.constant", |s, x| s.technique.bias.constant = x),
    ("bias.slope", |s, x| s.technique.bias.slope = x),
    ("bias.normal_offset", |s, x| s.technique.bias.normal_offset = x),
    ("bias.receiver_plane", |s, x| s.technique.bias.receiver_plane = x),
    ("bias.depth_steps", |s, x| {
        s.technique.format = MapFormat::Depth16Unorm;
        s.technique.bias.depth_steps = x;
    }),
    ("fit.least_texel", |s, x| s.technique.fit.least_texel = x),
    ("map.fade", |s, x| {
        s.technique.fit.max_distance = 20.0;
        s.technique.fade = x;
    }),
    ("softness.metres", |s, x| soft(s, FilterKind::Vogel16).radius = SoftRadius::Metres(x)),
    ("softness.metres of pcss", |s, x| soft(s, FilterKind::Pcss).radius = SoftRadius::Metres(x)),
    ("softness.angle", |s, x| soft(s, FilterKind::Vogel8).radius = SoftRadius::SunAngle(x)),
    ("softness.angle of pcss", |s, x| soft(s, FilterKind::Pcss).radius = SoftRadius::SunAngle(x)),
    ("softness.floor", |s, x| soft(s, FilterKind::Vogel16).floor = x),
    ("softness.ceiling", |s, x| soft(s, FilterKind::Pcss).ceiling = x),
    ("softness of a filter that ignores it", |s, x| soft(s, FilterKind::Pcf5x5).floor = x),
    ("light.azimuth", |s, x| s.light.azimuth = x),
    ("light.elevation", |s, x| s.light.elevation = x),
    ("light.animate_speed", |s, x| s.light.animate_speed = x),
    ("camera.fov_y", |s, x| s.camera.fov_y = x),
    ("camera.near", |s, x| s.camera.near = x),
    ("camera.far", |s, x| s.camera.far = x),
    ("camera.speed", |s, x| s.camera.speed = x),
    // Both at once, so that the fit is refused independent of the order of its checks.
    ("camera.near and far", |s, x| (s.camera.near, s.camera.far) = (x, x)),
];

/// Fields whose NaN makes fitting or look-ups impossible, so that the stage must report a problem.
const REFUSED: [&str; 24] = [
    "fit.max_distance",
    "fit.margin",
    "fit.border",
    "fit.caster_extension",
    "bias.constant",
    "bias.slope",
    "bias.normal_offset",
    "bias.receiver_plane",
    "bias.depth_steps",
    "fit.least_texel",
    "map.fade",
    "softness.metres",
    "softness.metres of pcss",
    "softness.angle",
    "softness.angle of pcss",
    "softness.floor",
    "softness.ceiling",
    "softness of a filter that ignores it",
    "light.azimuth",
    "light.elevation",
    "camera.fov_y",
    "camera.near",
    "camera.far",
    "camera.near and far",
];

/// Sets a filter and returns the softness of the settings.
fn soft(settings: &mut Settings, filter: FilterKind) -> &mut Softness {
    settings.technique = settings.technique.with_filter(filter);
    &mut settings.technique.softness
}

/// Returns the default scene without meshes of many triangles, since hundreds of frames are drawn here.
fn light_scene() -> Scene {
    let mut scene = default_scene();
    let triangles = |mesh: &Mesh| mesh.primitives.iter().map(|primitive| primitive.indices.len() / 3).sum::<usize>();
    let is_light: Vec<bool> = scene.meshes.iter().map(|mesh| triangles(mesh) <= MOST_TRIANGLES).collect();
    for node in &mut scene.nodes {
        node.mesh = node.mesh.filter(|mesh| is_light[*mesh]);
    }
    scene
}

fn stage() -> Stage {
    let mut stage = Stage::new(test_gpu(), light_scene(), 1).expect("the default scene");
    // Small maps: these tests do not depend on the map size.
    stage.settings.technique.fit.resolution = UVec2::splat(256);
    stage.set_home();
    stage
}

/// Draws, and calls everything else that a frame of the window does.
fn frame(stage: &mut Stage) {
    let picture = stage.target(SIZE);
    stage.draw(&picture);
    let _ = stage.figures(SIZE, None);
    stage.update(&FlyInput::default(), 0.016);
}

#[test]
fn every_absurd_number_is_drawn_without_a_panic_and_refused_fits_are_told() {
    assert_survives(|turn| &[[false], [true]][turn % 2]);
}

#[test]
#[ignore = "each number from both sides: cargo xtask test --all"]
fn every_absurd_number_is_drawn_from_the_camera_and_from_outside() {
    assert_survives(|_| &[false, true]);
}

/// Draws with every absurd number, in each turn from the camera, from outside, or both.
fn assert_survives(sides: impl Fn(usize) -> &'static [bool]) {
    let mut stage = stage();
    for (field, (name, write)) in FIELDS.into_iter().enumerate() {
        for (number, value) in ABSURD.into_iter().enumerate() {
            for &outside in sides(field + number) {
                stage.reset();
                stage.settings.view.mode = if outside { ViewMode::Outside } else { ViewMode::Final };
                stage.settings.light.animate = true;
                write(&mut stage.settings, value);
                let picture = stage.target(SIZE);
                stage.draw(&picture);
                let problem = stage.problem().map(str::to_owned);
                if !value.is_finite() && REFUSED.contains(&name) {
                    let problem = problem.unwrap_or_else(|| panic!("{name} = {value}: no word about it"));
                    assert!(problem.len() > 20, "{name} = {value}: {problem}");
                }
                let _ = stage.figures(SIZE, None);
                stage.update(&FlyInput::default(), 0.016);
            }
        }
    }
    stage.reset();
    frame(&mut stage);
    assert_eq!(stage.problem(), None, "after all that a reset brings the picture back");
}

#[test]
fn random_soft_filters_fades_and_formats_are_drawn_or_refused_with_a_reason() {
    let mut stage = stage();
    let mut random = Random(7);
    let mut drawn = 0;
    for round in 0..ROUNDS {
        stage.reset();
        let technique = random_technique(&mut random, &stage.settings.technique);
        stage.settings.technique = technique;
        let picture = stage.target(SIZE);
        stage.draw(&picture);
        match stage.problem() {
            Some(problem) => {
                println!("{round}: {problem}");
                assert!(problem.len() > 20, "{round}: {technique:?}: {problem}");
            }
            None => drawn += 1,
        }
    }
    // If hardly any technique were drawn, the test would prove little.
    assert!(drawn * 4 > ROUNDS, "{drawn} of {ROUNDS}");
}

/// Returns a technique with random filter and format, and with softness, fade and least texel inside, at and
/// beyond their ranges.
fn random_technique(random: &mut Random, technique: &Technique) -> Technique {
    let mut technique = technique
        .with_filter(random.one_of(&FilterKind::ALL))
        .with_format(random.one_of(&MapFormat::ALL))
        .with_max_distance(random.one_of(&[0.5, 20.0, f32::MAX]))
        .with_fade(random.one_of(&[0.0, 1e-20, 0.1, 1.0, 1.5]))
        .with_softness(Softness {
            radius: random.one_of(&[
                SoftRadius::Metres(0.0),
                SoftRadius::Metres(0.1),
                SoftRadius::Metres(1000.0),
                SoftRadius::SunAngle(0.0),
                SoftRadius::SunAngle(0.03),
                SoftRadius::SunAngle(0.785),
            ]),
            floor: random.one_of(&[0.0, 1.0, 8.0]),
            ceiling: random.one_of(&[1.0, 16.0, 40.0, 64.0]),
        });
    let kinds = [None, Some(FitKind::Focused), Some(FitKind::Sphere), Some(FitKind::XnaSample)];
    technique.maps = of_kind(technique.maps, random.one_of(&kinds));
    technique.fit.least_texel = random.one_of(&[0.0, 1e-30, 0.01, 5.0, 1e6]);
    technique.bias.depth_steps = random.one_of(&[0.0, 1.0, 16.0]);
    technique
}

/// Returns the same number of maps with a kind of fit, or windows.
fn of_kind(maps: Maps, kind: Option<FitKind>) -> Maps {
    kind.map_or(maps.as_windows().into(), |kind| maps.with_kind(kind))
}

/// Pseudo-random numbers that are the same in every run (G. Marsaglia, "Xorshift RNGs", 2003).
struct Random(u64);

impl Random {
    fn one_of<T: Copy>(&mut self, values: &[T]) -> T {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        values[(self.0 >> 33) as usize % values.len()]
    }
}

#[test]
fn absurd_numbers_are_judged_and_demonstrated_without_a_panic() {
    let mut stage = stage();
    for (name, write) in FIELDS {
        for value in [f32::NAN, f32::INFINITY, 0.0, f32::MAX] {
            stage.reset();
            write(&mut stage.settings, value);
            let Some(judged) = stage.judge([16, 9], false) else {
                // If the look-up refuses the settings, there is nothing to judge.
                let problem = stage.problem().unwrap_or_else(|| panic!("{name} = {value}: no word about it"));
                assert!(name.starts_with("bias.") && problem.contains("map 0"), "{name} = {value}: {problem}");
                continue;
            };
            let tally = judged.tally;
            assert!(tally.all.wrong <= tally.all.facing, "{name} = {value}: {tally:?}");
        }
    }
    for (name, write) in FIELDS {
        stage.reset();
        write(&mut stage.settings, f32::NAN);
        stage.fix_artefact(Artefact::ClippingHole);
        let picture = stage.target([16, 9]);
        stage.draw(&picture);
        println!("{name}: {:?}", stage.problem());
    }
}

#[test]
fn impossible_maps_keep_the_old_one_and_say_why() {
    let mut stage = stage();
    for resolution in [UVec2::ZERO, UVec2::new(0, 2048), UVec2::ONE, UVec2::new(100_000, 512), UVec2::MAX] {
        stage.reset();
        stage.settings.technique.fit.resolution = resolution;
        frame(&mut stage);
        let problem = stage.problem().unwrap_or_else(|| panic!("{resolution}: no word about it"));
        assert!(problem.contains("texel") || problem.contains("resolution"), "{resolution}: {problem}");
    }
    stage.reset();
    stage.settings.technique.fit.depth = DepthConvention::NegativeOneToOne;
    frame(&mut stage);
    assert!(stage.problem().is_some_and(|problem| problem.contains("OpenGL")), "{:?}", stage.problem());
}

#[test]
fn absurd_places_of_the_eye_are_drawn_without_a_panic() {
    let mut stage = stage();
    let places = [f64::NAN, f64::INFINITY, 1e300, 1e30, 1e15, -1e7].map(DVec3::splat);
    for kind in [
        Some(FitKind::FrustumAabb),
        Some(FitKind::XnaSample),
        Some(FitKind::Oriented),
        Some(FitKind::Sphere),
        Some(FitKind::Focused),
        None,
    ] {
        for eye in places {
            for angle in [f32::NAN, f32::INFINITY, 0.0, 1e30] {
                stage.reset();
                let technique = &mut stage.settings.technique;
                (technique.maps, technique.fit.casters) = (of_kind(technique.maps, kind), CasterPolicy::PerObject);
                stage.camera.position = eye;
                (stage.camera.yaw, stage.camera.pitch) = (angle, angle);
                frame(&mut stage);
            }
        }
    }
}

#[test]
fn absurd_times_and_animations_are_posed_without_a_panic() {
    let mut stage = stage();
    for animation in [0, 1, usize::MAX] {
        stage.animation = animation;
        for seconds in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -3.0, 1e30, 0.5] {
            stage.set_time(seconds);
            frame(&mut stage);
            assert!(stage.bounds().min.is_finite() && stage.bounds().max.is_finite(), "{animation} at {seconds} s");
        }
    }
}

#[test]
fn pictures_of_one_pixel_and_of_odd_sizes_are_drawn() {
    let mut stage = stage();
    for size in [[1, 1], [0, 0], [1, 500], [700, 3], [33, 17]] {
        let picture = stage.target(size);
        stage.draw(&picture);
        let [width, height] = picture.size;
        assert_eq!([width, height], size.map(|side: u32| side.max(1)));
        let bytes = picture.read(stage.gpu()).expect("pixels");
        let (pixels, rest) = bytes.as_chunks::<4>();
        assert_eq!((pixels.len(), rest.len()), ((width * height) as usize, 0), "{size:?}");
        // Sky and scene cover every pixel, and none is transparent.
        assert!(pixels.iter().all(|[r, g, b, a]| *a == 255 && (*r, *g, *b) != (0, 0, 0)), "{size:?}");
        let colours: std::collections::HashSet<&[u8; 4]> = pixels.iter().collect();
        assert!(colours.len() > 1 || pixels.len() == 1, "{size:?} is one flat colour");
    }
}
