//! The first edge pass equals its twin in plain Rust, pixel by pixel.

use std::sync::OnceLock;

use shadowfit::glam::{DVec3, Vec3};
use shadowfit::settings::{FilterKind, MapFormat};
use shadowfit::{DepthConvention, PerspectiveCamera, Technique};
use shadowfit_scene::Lens;
use shadowfit_scene::builtin::BuiltinScene;
use shadowfit_testing::pairs::{all_pairs, full_product};
use shadowfit_wgpu::exact_edges::NormalEncoding;

use super::stage::{Look, Stage, Thing, traced};
use super::twin::{Classified, NEXT_TO, Twin, Verdict};

const SIZE: [u32; 2] = [160, 90];
/// Number of triangles that are drawn together.
const TOGETHER: usize = 1000;
/// Pixels of an image's 14,400 whose verdict may differ, because compilers may round products and sums
/// differently. Each must lie next to a threshold. One was found in all images.
const OTHERS: usize = 3;

/// A built-in scene for these tests.
struct Built {
    things: Vec<Thing>,
    camera: PerspectiveCamera,
    direction: Vec3,
}

/// Returns a built-in scene. It is cached, because building it takes longer than most images.
fn built(scene: BuiltinScene) -> &'static Built {
    static BUILT: [OnceLock<Built>; BuiltinScene::ALL.len()] = [const { OnceLock::new() }; BuiltinScene::ALL.len()];
    let index = BuiltinScene::ALL.iter().position(|other| *other == scene).expect("all scenes are listed");
    BUILT[index].get_or_init(|| build(scene))
}

fn build(scene: BuiltinScene) -> Built {
    let scene = scene.build();
    let pose = scene.pose(None, 0.0);
    let corners: Vec<Vec3> = pose.triangles(&scene).iter().flat_map(|triangle| triangle.vertices).collect();
    let thing = |corners: &[Vec3]| Thing { corners: corners.to_vec(), ..Thing::default() };
    let camera = scene.cameras.first().expect("a camera");
    let Lens::Perspective { fov_y, near, far } = camera.lens else { panic!("a perspective camera") };
    let [_, up, back, eye] =
        pose.world_from_node[camera.node].to_cols_array_2d().map(|[x, y, z, _]| Vec3::new(x, y, z));
    let camera = PerspectiveCamera {
        eye: eye.as_dvec3(),
        forward: -back.normalize(),
        up: up.normalize(),
        fov_y,
        aspect: Look::aspect(SIZE),
        near,
        far: far.expect("a far plane"),
    };
    let things = corners.chunks(3 * TOGETHER).map(thing).collect();
    Built { things, camera, direction: scene.sun.expect("a sun").direction }
}

/// Returns the triangles of a built-in scene without the holes of its leaves.
pub(super) fn things(scene: BuiltinScene) -> Vec<Thing> {
    built(scene).things.clone()
}

/// Returns a view of the courtyard.
pub(super) fn look(samples: u32, convention: DepthConvention, normals: Option<NormalEncoding>) -> Look {
    let (eye, target) = (Vec3::new(4.0, 2.5, 7.0), Vec3::new(0.0, 1.0, 0.0));
    let camera = PerspectiveCamera {
        eye: eye.as_dvec3(),
        forward: (target - eye).normalize(),
        up: Vec3::Y,
        fov_y: 0.9,
        aspect: Look::aspect(SIZE),
        near: 0.1,
        far: 100.0,
    };
    let direction = Vec3::new(-0.5, -0.7, -0.35).normalize();
    let format = wgpu::TextureFormat::Depth32Float;
    Look { camera, direction, size: SIZE, samples, convention, format, normals, number: 0 }
}

/// Returns the view of a scene's own camera under its own sun.
pub(super) fn start(scene: BuiltinScene, normals: Option<NormalEncoding>) -> Look {
    let Built { camera, direction, .. } = *built(scene);
    Look { camera, direction, ..look(1, DepthConvention::Reversed, normals) }
}

/// Compares the image that a stage draws with its twin's, and returns the number of sure pixels, and of
/// unsure ones.
pub(super) fn compare(what: &str, stage: &mut Stage, look: &Look) -> [usize; 2] {
    let drawn = stage.draw(look);
    let (sure, none) = stage.traced(look, &drawn, |view| view.budget = Some(0));
    let (all, counts) = stage.traced(look, &drawn, |_| ());
    let mut twin = Twin::new(stage, look, &drawn);
    let verdicts = twin.verdicts();
    let agrees = |index: usize, found: Classified| match found.verdict {
        Verdict::NoSurface | Verdict::Filtered | Verdict::TooWide => sure[index] == -1.0 && all[index] == -1.0,
        Verdict::Unsure => sure[index] == -1.0 && all[index] >= 0.0,
        Verdict::Beyond => sure[index] == 1.0,
        Verdict::FacesAway => sure[index] == 0.0,
        Verdict::Lit | Verdict::Shadowed => (sure[index] - found.factor).abs() <= 1e-5,
    };
    let others: Vec<usize> = (0..verdicts.len()).filter(|index| !agrees(*index, verdicts[*index])).collect();
    println!("{what}: {} of {} pixels are others; {counts:?}", others.len(), verdicts.len());
    assert!(others.len() <= OTHERS, "{what}: {} pixels", others.len());
    for index in &others {
        let nearby = twin.nearby(*index, NEXT_TO);
        let is_next_to = nearby.iter().any(|verdict| agrees(*index, *verdict));
        assert!(
            is_next_to,
            "{what}, pixel {index}: {:?} {nearby:?}, {} {}",
            verdicts[*index], sure[*index], all[*index]
        );
    }
    let count = |is: fn(Classified) -> bool| verdicts.iter().filter(|found| is(**found)).count();
    let unsure = count(|found| found.verdict == Verdict::Unsure);
    let sure = count(Classified::is_sure);
    let filtered = count(|found| found.verdict == Verdict::Filtered);
    let near = |a: u32, b: usize| (a as usize).abs_diff(b) <= others.len();
    assert!(near(counts.unsure, unsure) && near(counts.filtered, filtered), "{what}: {counts:?}");
    assert!(near(counts.facing, sure + unsure + filtered) && counts.traced == counts.unsure, "{what}: {counts:?}");
    assert_eq!([none.traced, none.unsure, none.facing], [0, counts.unsure, counts.facing], "{what}");
    [sure, unsure]
}

fn technique() -> Technique {
    Technique::default().with_resolution(512, 512).with_max_distance(60.0)
}

#[test]
fn every_pixel_of_the_built_in_scenes_has_the_verdict_of_the_twin() {
    for scene in BuiltinScene::ALL {
        let mut stage = Stage::new(&traced(technique(), 1), things(scene));
        stage.gpu.require_fine_steps();
        for normals in [None, Some(NormalEncoding::Signed)] {
            let look = start(scene, normals);
            let [sure, unsure] = compare(&format!("{scene:?} {normals:?}"), &mut stage, &look);
            assert!(sure > 800 && unsure > 100, "{scene:?}: {sure} and {unsure}");
        }
    }
}

/// Number of ray counts, sample counts and normal encodings.
const COUNTS: [usize; 3] = [2, 2, 3];

#[test]
fn verdicts_are_the_twin_s_for_four_samples_and_four_rays() {
    assert_twins(&all_pairs(&COUNTS));
}

#[test]
#[ignore = "the full product of rays, samples and normals: cargo xtask test --all"]
fn verdicts_are_the_twin_s_for_the_full_product_of_rays_samples_and_normals() {
    assert_twins(&full_product(&COUNTS));
}

/// Compares verdicts with the twin's for rays, samples and normals, by index.
fn assert_twins(rows: &[Vec<usize>]) {
    let mut stage = Stage::new(&traced(technique(), 1), things(BuiltinScene::Courtyard));
    for row in rows {
        let (rays, samples) = ([1, 4][row[0]], [1, 4][row[1]]);
        let normals = [None, Some(NormalEncoding::Signed), Some(NormalEncoding::Unsigned)][row[2]];
        stage.sun.set_technique(&traced(technique(), rays)).expect("a good technique");
        let look = look(samples, DepthConvention::Reversed, normals);
        compare(&format!("{rays} rays, {samples} samples, {normals:?}"), &mut stage, &look);
    }
}

#[test]
fn verdicts_are_the_twin_s_by_coverage_and_by_view_depth_in_plain_and_reversed_depth() {
    for convention in [DepthConvention::ZeroToOne, DepthConvention::Reversed] {
        for selection in ["windows-4", "stable-4"] {
            let mut technique = Technique::preset(selection).expect("a preset").with_resolution(512, 512);
            technique.fit.depth = convention;
            technique.fit.max_distance = 30.0;
            let technique = technique.with_fade(0.3);
            let mut stage = Stage::new(&traced(technique, 1), things(BuiltinScene::Courtyard));
            let look = look(1, convention, Some(NormalEncoding::Signed));
            compare(&format!("{convention:?} {selection}"), &mut stage, &look);
        }
    }
}

#[test]
fn verdicts_are_the_twin_s_in_colours_and_with_other_filters() {
    for (format, filter) in [
        (MapFormat::R32Float, FilterKind::Pcf5x5),
        (MapFormat::R16Float, FilterKind::Hardware2x2),
        (MapFormat::Depth16Unorm, FilterKind::Pcf3x3),
    ] {
        let technique = technique().with_format(format).with_filter(filter);
        let mut stage = Stage::new(&traced(technique, 1), things(BuiltinScene::Courtyard));
        let look = look(1, DepthConvention::Reversed, None);
        compare(&format!("{format:?} {filter:?}"), &mut stage, &look);
    }
}

#[test]
fn verdicts_are_the_twin_s_in_maps_that_wrap_around() {
    let mut stage = Stage::new(&traced(technique(), 1), things(BuiltinScene::Courtyard));
    let mut wrapped = 0;
    for step in 0..6_u16 {
        let mut look = look(1, DepthConvention::Reversed, None);
        look.camera.eye += DVec3::new(0.7, 0.0, -0.4) * f64::from(step);
        compare(&format!("step {step}"), &mut stage, &look);
        wrapped += stage.sun.maps().iter().filter(|map| map.texel_offset.max_element() > 0).count();
    }
    assert!(wrapped > 0, "no map wraps around");
}
