//! Ambient occlusion of scenes with known occlusion.

use glam::Vec3;
use shadowfit_classics::occlusion::{
    OcclusionFrame, OcclusionLight, OcclusionMethod, OcclusionSettings, OcclusionView,
};
use shadowfit_render::{Atmosphere, Frame, ProbeTargets};

use crate::scenes::{Pictures, SIZE, camera, cube, floor, frame, wall};

const DEPTH_ONLY: OcclusionMethod = OcclusionMethod::DepthOnly;

fn plain() -> OcclusionSettings {
    OcclusionSettings { blur: false, ..OcclusionSettings::default() }
}

/// Returns the mean of the middle half of a picture, each way.
fn middle(values: &[f32]) -> f32 {
    let [width, height] = SIZE.map(|side| side as usize);
    let inside = |index: usize, side: usize| (side / 4..side * 3 / 4).contains(&index);
    let taken = |index: &usize| inside(index % width, width) && inside(index / width, height);
    let taken: Vec<f32> = (0..values.len()).filter(taken).map(|index| values[index]).collect();
    taken.iter().sum::<f32>() / taken.len() as f32
}

fn row(values: &[f32], row: u32) -> f32 {
    let width = SIZE[0] as usize;
    let taken = &values[row as usize * width + width / 4..row as usize * width + width * 3 / 4];
    taken.iter().sum::<f32>() / taken.len() as f32
}

#[test]
fn a_plane_at_an_angle_stays_white_with_normals_and_turns_grey_by_depth_alone() {
    let mut pictures = Pictures::new(&[floor()], 1);
    let camera = camera();
    // No bias is needed: neighbours on a plane do not occlude it.
    let normals = pictures.occlusion(&camera, OcclusionSettings { bias: 0.0, ..plain() });
    let depth_only = pictures.occlusion(&camera, OcclusionSettings { method: DEPTH_ONLY, ..plain() });
    println!("normals {}, depth alone {}", middle(&normals), middle(&depth_only));
    assert!(middle(&normals) < 0.002, "{}", middle(&normals));
    // Half of the sphere lies behind it.
    assert!((middle(&depth_only) - 0.5).abs() < 0.05, "{}", middle(&depth_only));
}

#[test]
fn a_corner_is_darker_than_the_open_floor() {
    let camera = camera();
    let mut open = Pictures::new(&[floor()], 1);
    let mut corner = Pictures::new(&[floor(), wall(0.0)], 1);
    for settings in [plain(), OcclusionSettings::default(), OcclusionSettings { level_of_detail: true, ..plain() }] {
        let open = open.occlusion(&camera, settings);
        let corner = corner.occlusion(&camera, settings);
        // The floor meets the wall in the middle row. A quarter of the picture farther down, the floor is
        // open again.
        let [at, near, far] = [48, 50, 72].map(|line| row(&corner, line));
        println!("at the wall {at}, nearer to the eye {near}, far from it {far}, without it {}", row(&open, 48));
        assert!(row(&open, 48) < 0.01 && at > 0.15 && at > near && near > 0.05 && far < 0.01);
    }
}

#[test]
fn back_faces_add_occlusion_and_never_take_any() {
    let mut quads = cube(0.8);
    quads.push(floor());
    let mut pictures = Pictures::new(&quads, 1);
    let front = pictures.occlusion(&camera(), plain());
    let both = pictures.occlusion(&camera(), OcclusionSettings { back_faces: true, ..plain() });
    assert!(front.iter().zip(&both).all(|(front, both)| both >= front));
    let more = front.iter().zip(&both).filter(|(front, both)| **both > *front + 0.01).count();
    println!("{more} pixels are darker by back faces");
    assert!(more > 200, "{more}");
}

#[test]
fn a_wall_has_a_pale_halo_around_an_object_by_depth_alone() {
    // A plate that hovers 3 m in front of a wall. The camera looks at the wall.
    let plate = [(-0.7, -0.7), (0.7, -0.7), (0.7, 0.7), (-0.7, 0.7)].map(|(x, y)| Vec3::new(x, y + 3.0, 0.0));
    let camera = shadowfit::PerspectiveCamera { forward: Vec3::NEG_Z, ..camera() };
    let mut pictures = Pictures::new(&[plate, wall(-3.0)], 1);
    let values = pictures.occlusion(&camera, OcclusionSettings { method: DEPTH_ONLY, ..plain() });
    let at = |column: u32| values[(48 * SIZE[0] + column) as usize];
    let mean = |columns: core::ops::Range<u32>| columns.clone().map(at).sum::<f32>() / columns.len() as f32;
    // The plate's rim: 0.7 m at 5 m are 0.7 / 5 / (2 tan 0.4) · 96 = 16 pixels from the middle column.
    let [beside, open] = [mean(81..85), mean(116..126)];
    println!("beside the plate {beside}, on the open wall {open}");
    assert!(beside < open - 0.05, "{beside} {open}");
}

#[test]
fn occlusion_darkens_the_ambient_light_alone() {
    let camera = camera();
    let mut pictures = Pictures::new(&[floor(), wall(0.0)], 1);
    let lit = |ambient: f32, diffuse: f32| OcclusionLight {
        ambient: Vec3::splat(ambient),
        diffuse: Vec3::splat(diffuse),
        ..OcclusionLight::new(Vec3::new(0.0, 0.8, 0.6))
    };
    let settings = Some(OcclusionSettings { intensity: 5.0, ..OcclusionSettings::default() });
    for view in [OcclusionView::Classic, OcclusionView::Modern] {
        let sunlit = OcclusionFrame { light: lit(0.0, 0.7), view, ..frame(None) };
        let without = pictures.draw(&camera, &sunlit);
        assert_eq!(pictures.draw(&camera, &OcclusionFrame { settings, ..sunlit }), without, "{view:?}");
    }
    // White surfaces in ambient light show (1 - occlusion) times that light, up to rounding to a byte.
    let picture = pictures.draw(&camera, &OcclusionFrame { light: lit(0.8, 0.0), ..frame(settings) });
    let occlusion = pollster::block_on(pictures.passes.read_occlusion(&pictures.gpu)).expect("occlusion");
    assert!(occlusion.iter().any(|occlusion| *occlusion > 0.5));
    let probe = shown(&mut pictures, &camera);
    for ((pixel, occlusion), _) in picture.iter().zip(&occlusion).zip(&probe).filter(|(_, shown)| **shown) {
        let expected = 255.0 * 0.8 * (1.0 - occlusion);
        assert!(pixel.iter().all(|byte| (f32::from(*byte) - expected).abs() <= 0.51), "{pixel:?} {expected}");
    }
}

/// Returns whether each pixel shows a triangle, according to the renderer's probe.
fn shown(pictures: &mut Pictures, camera: &shadowfit::PerspectiveCamera) -> Vec<bool> {
    let targets = ProbeTargets::new(&pictures.gpu.device, SIZE);
    let atmosphere = Atmosphere::default();
    let frame = Frame::new(camera, Vec3::NEG_Y, &[], &atmosphere);
    let Pictures { gpu, renderer, scene, .. } = pictures;
    let probe = renderer.probe(gpu, scene, &frame, &targets).expect("a probe");
    probe.pixels.iter().map(Option::is_some).collect()
}

#[test]
fn pixels_show_surfaces_where_the_probe_does() {
    // A rotated view of a box in front of the sky. By depth alone, every surface has some occlusion.
    let camera = shadowfit::PerspectiveCamera { up: Vec3::new(0.3, 1.0, 0.0), ..camera() };
    let mut pictures = Pictures::new(&cube(0.9), 1);
    let settings = OcclusionSettings { method: DEPTH_ONLY, radius: 0.2, ..plain() };
    let occlusion = pictures.occlusion(&camera, settings);
    let probe = shown(&mut pictures, &camera);
    let count = probe.iter().filter(|shown| **shown).count();
    assert!(count > 1000 && count < probe.len() / 2, "{count}");
    let differ = occlusion.iter().zip(&probe).filter(|(occlusion, shown)| (**occlusion > 0.0) != **shown).count();
    assert_eq!(differ, 0);
}

#[test]
fn of_two_radii_the_greater_occlusion_counts() {
    let mut pictures = Pictures::new(&[floor(), wall(0.0)], 1);
    let camera = camera();
    let [wide, narrow] = [0.5, 0.1].map(|radius| pictures.occlusion(&camera, OcclusionSettings { radius, ..plain() }));
    let both = pictures.occlusion(&camera, OcclusionSettings { second_radius: Some(0.1), ..plain() });
    let greater: Vec<f32> = wide.iter().zip(&narrow).map(|(wide, narrow)| wide.max(*narrow)).collect();
    assert_eq!(both, greater);
    assert!(wide.iter().zip(&narrow).any(|(wide, narrow)| narrow > wide));
}

#[test]
fn the_blur_averages_the_random_vectors_away() {
    let mut pictures = Pictures::new(&[floor(), wall(0.0)], 1);
    let camera = camera();
    let raw = pictures.occlusion(&camera, plain());
    let blurred = pictures.occlusion(&camera, OcclusionSettings::default());
    // Along a row beside the wall, occlusion is almost constant, so differences between columns are noise.
    let noise = |values: &[f32]| {
        let line = &values[50 * SIZE[0] as usize + 32..][..64];
        line.array_windows().map(|[a, b]| (a - b).abs()).sum::<f32>() / 63.0
    };
    println!("noise {} raw, {} blurred", noise(&raw), noise(&blurred));
    assert!(noise(&blurred) < 0.1 * noise(&raw), "{} {}", noise(&blurred), noise(&raw));
    assert!((middle(&raw) - middle(&blurred)).abs() < 0.01);
}

#[test]
fn a_picture_of_four_samples_has_the_same_surfaces_and_the_grey_view_shows_occlusion() {
    let camera = camera();
    let mut single = Pictures::new(&[floor(), wall(0.0)], 1);
    let mut smooth = Pictures::new(&[floor(), wall(0.0)], 4);
    let grey = frame(Some(OcclusionSettings::default()));
    let picture = smooth.draw(&camera, &grey);
    let reference = single.draw(&camera, &grey);
    // Away from the edges, which are antialiased.
    let at = (80 * SIZE[0] + 64) as usize;
    assert_eq!(picture[at], reference[at]);
    let grey = single.draw(&camera, &OcclusionFrame { view: OcclusionView::Occlusion, ..grey });
    let occlusion = pollster::block_on(single.passes.read_occlusion(&single.gpu)).expect("occlusion");
    for (pixel, occlusion) in grey.iter().zip(&occlusion) {
        assert!((f32::from(pixel[0]) - 255.0 * (1.0 - occlusion)).abs() <= 0.51 && pixel[0] == pixel[2]);
    }
}
