//! Options of a frame apart from its scene: maps that stay, parts of pictures, insets, quadrilaterals, and
//! overlays with every kind of map.

use glam::{DVec3, Vec2, Vec3, Vec4};
use shadowfit::settings::{FilterKind, MapSelection};
use shadowfit::{PerspectiveCamera, Technique};
use shadowfit_render::{
    Culling, Frame, Inset, JudgedPicture, Marks, Overlay, PassTimes, ProbeTargets, Quad, Statistics, classes_texture,
};
use shadowfit_scene::Scene;

use super::pictures::{Pictures, SIZE, Stage, cheap_technique, encoded, linear, random};

const WIDTH: usize = SIZE[0] as usize;

#[test]
fn a_picture_of_maps_that_stay_is_that_of_maps_that_are_drawn() {
    let Stage { mut pictures, seen } = Stage::new(&cheap_technique(), 1);
    let alone = pictures.picture(&seen.frame());
    let stay = Frame { maps_stay: true, ..seen.frame() };
    // `maps` is ignored; the last drawn maps are used.
    assert_eq!(pictures.picture(&Frame { maps: &[], ..stay }), alone);
    // A probe draws the maps for the picture that follows.
    pictures.renderer.sun_mut().invalidate_all();
    pictures.probe(&seen.frame());
    assert_eq!(pictures.picture(&stay), alone);
    // From another camera. Both times the maps hold all their casters.
    let camera = PerspectiveCamera { eye: seen.camera.eye + DVec3::new(-2.0, 1.0, 1.0), ..seen.camera };
    let reader = Some((seen.camera.eye, seen.camera.forward));
    let culling = Culling::WholeMap;
    let elsewhere = Frame { camera: camera.into(), reader, culling, ..seen.frame() };
    let drawn = pictures.picture(&elsewhere);
    pictures.draw(&Frame { culling, ..seen.frame() });
    let stayed = pictures.picture(&Frame { maps_stay: true, ..elsewhere });
    let different = drawn.iter().zip(&stayed).filter(|(a, b)| a != b).count();
    // When casters are drawn, they are rounded relative to the camera's eye.
    assert!(different * 500 < drawn.len(), "{different} of {}", drawn.len());
}

#[test]
fn maps_that_may_stay_are_drawn_once_and_pictures_and_statistics_are_the_same() {
    let Stage { mut pictures, seen } = Stage::new(&cheap_technique().with_count(2), 1);
    let (drawn, alone) = (pictures.draw(&seen.frame()), pictures.read());
    let may = Frame { maps_may_stay: true, ..seen.frame() };
    assert_eq!((pictures.draw(&may), pictures.read()), (drawn, alone.clone()));
    // Skipped passes do not change their times.
    let times = pictures.renderer.pass_times();
    for _ in 0..3 {
        assert_eq!((pictures.draw(&may), pictures.read()), (drawn, alone.clone()));
    }
    assert!(times.shadow_ms.is_some() && pictures.renderer.pass_times() == times);
    // Each change of an input of the maps draws them again.
    let camera = PerspectiveCamera { eye: seen.camera.eye + DVec3::new(-2.0, 1.0, 1.0), ..seen.camera };
    let moved = Frame { camera: camera.into(), ..may };
    let lit = Frame { direction: Vec3::new(-0.4, -0.6, 0.3).normalize(), ..may };
    let fewer = Frame { maps: &seen.maps[1..], ..may };
    let whole = Frame { culling: Culling::WholeMap, ..may };
    for other in [moved, lit, fewer, whole, may] {
        let anew = pictures.draw(&Frame { maps_may_stay: false, ..other });
        let expected = pictures.read();
        pictures.draw(&Frame { maps: &[], maps_may_stay: false, ..may });
        assert_eq!((pictures.draw(&other), pictures.read()), (anew, expected));
    }
    let pose = pictures.scene.pose();
    let scene = shadowfit_scene::builtin::default_scene();
    let walking = scene.pose(Some(0), 0.8);
    pictures.scene.set_pose(&pictures.gpu, &scene, &walking);
    assert_ne!(pictures.scene.pose(), pose);
    let posed = pictures.picture(&may);
    assert_eq!(posed, pictures.picture(&seen.frame()));
}

#[test]
fn statistics_and_times_of_a_frame_have_what_its_probe_drew() {
    let Stage { mut pictures, seen } = Stage::new(&cheap_technique().with_count(2), 1);
    let alone = pictures.draw(&seen.frame());
    let texels = 256 * 256 * seen.maps.len() as u64;
    assert_eq!((alone.shadow_texels, alone.maps[0].texels), (texels, 256 * 256));
    let targets = ProbeTargets::new(&pictures.gpu.device, SIZE);
    let stay = Frame { maps_stay: true, ..seen.frame() };
    for _ in 0..8 {
        pictures.renderer.draw_probe(&pictures.gpu, &mut pictures.scene, &seen.frame(), &targets).expect("a probe");
        assert_eq!(pictures.draw(&stay), alone);
        pictures.read();
        let again = pictures.draw(&stay);
        let Statistics { shadow_draws, shadow_texels, scene_draws, .. } = again;
        assert_eq!((shadow_draws, shadow_texels, scene_draws), (0, 0, alone.scene_draws));
        pictures.read();
    }
    let times = pictures.renderer.pass_times();
    assert!(times.probe_ms.is_some() && times.scene_ms.is_some() && times.shadow_ms.is_some(), "{times:?}");
    assert_eq!(times.maps_ms.map(|map| map.is_some()), core::array::from_fn(|map| map < seen.maps.len()));
}

#[test]
fn a_probe_of_other_maps_leaves_the_times_of_the_picture_as_they_are() {
    let Stage { mut pictures, seen } = Stage::new(&cheap_technique(), 1);
    let targets = ProbeTargets::new(&pictures.gpu.device, SIZE);
    // Each probe ends the frame of the previous one, so that its times cover the previous probe and the
    // picture.
    let probe = |pictures: &mut Pictures| {
        pictures.renderer.draw_probe(&pictures.gpu, &mut pictures.scene, &seen.frame(), &targets).expect("a probe");
        targets.read(&pictures.gpu).expect("it is finished");
        pictures.renderer.pass_times()
    };
    pictures.draw(&seen.frame());
    pictures.read();
    let told = [(); 4].map(|()| probe(&mut pictures));
    let of_picture = |times: &PassTimes| (times.scene_ms, times.shadow_ms, times.maps_ms);
    for times in &told[1..] {
        assert!(times.probe_ms.is_some() && times.scene_ms.is_some() && times.shadow_ms.is_some(), "{told:?}");
        assert_eq!(of_picture(times), of_picture(&told[1]), "{told:?}");
    }
    // A picture that draws its maps itself is a frame without the probe. The further picture makes its times
    // available.
    pictures.draw(&seen.frame());
    pictures.read();
    pictures.draw(&Frame { maps_stay: true, ..seen.frame() });
    let picture = pictures.renderer.pass_times();
    assert!(picture.scene_ms.is_some() && picture.shadow_ms.is_some() && picture.probe_ms.is_none(), "{picture:?}");
}

#[test]
fn a_part_of_a_picture_is_drawn_as_in_the_whole_and_the_rest_stays() {
    for (samples, overlay) in [(1, Overlay::TexelGrid), (4, Overlay::None)] {
        let Stage { mut pictures, seen } = Stage::new(&cheap_technique(), samples);
        let drawn: Vec<u32> = random(WIDTH * SIZE[1] as usize, 40).collect();
        let view = classes_texture(&pictures.gpu, &drawn, SIZE);
        let insets = [Inset { rectangle: [50.0, 10.0, 40.0, 30.0], depth_range: [0.0, 1.0], map: 0, border: Vec3::X }];
        let quads = [Quad::rectangle([60.5, 30.0, 50.0, 30.0], Vec4::new(0.0, 1.0, 0.5, 0.5))];
        let judged = Some(JudgedPicture { classes: &view, size: SIZE, camera: seen.camera.into(), depth: None });
        let marks = Some(Marks { classes: [true, false, false, true], ..Marks::default() });
        let (insets, quads) = (insets.as_slice(), quads.as_slice());
        let whole = Frame { insets, quads, judged, marks, overlay, ..seen.frame() };
        let expected = pictures.picture(&whole);
        let before = pictures.picture(&Frame { shadows: false, overlay, ..seen.frame() });
        assert_ne!(before, expected);
        let [x, y, width, height] = [37, 11, 71, 60];
        let part = pictures.picture(&Frame { scissor: Some([x, y, width, height]), ..whole });
        for (pixel, color) in part.iter().enumerate() {
            let [column, row] = [(pixel % WIDTH) as u32, (pixel / WIDTH) as u32];
            let is_inside = (x..x + width).contains(&column) && (y..y + height).contains(&row);
            let expected = if is_inside { expected[pixel] } else { before[pixel] };
            assert_eq!(*color, expected, "{samples} samples, {column} {row}");
        }
        // A part outside the picture, and a part larger than the picture.
        assert_eq!(pictures.picture(&Frame { scissor: Some([500, 2, 9, 9]), ..seen.frame() }), part);
        let all = pictures.picture(&Frame { scissor: Some([0, 0, 999, 999]), ..whole });
        assert_eq!(all, expected);
    }
}

#[test]
fn probes_of_a_part_are_those_of_the_whole_and_sky_elsewhere() {
    let Stage { mut pictures, seen } = Stage::new(&cheap_technique(), 1);
    let whole = pictures.probe(&seen.frame());
    let part = pictures.probe(&Frame { scissor: Some([20, 40, 50, 30]), ..seen.frame() });
    for (pixel, (part, whole)) in part.pixels.iter().zip(&whole.pixels).enumerate() {
        let is_inside = (20..70).contains(&(pixel % WIDTH)) && (40..70).contains(&(pixel / WIDTH));
        assert_eq!(*part, whole.filter(|_| is_inside));
    }
}

#[test]
fn insets_lie_on_their_pixels_each_with_its_map_and_its_border() {
    let Stage { mut pictures, seen } = Stage::new(&cheap_technique().with_count(2), 1);
    let plain = pictures.picture(&seen.frame());
    let borders = [Vec3::X, Vec3::Y];
    let inset = |map: u32| Inset {
        rectangle: [10.0 + 60.0 * map as f32, 20.0, 48.0, 32.0],
        depth_range: [1.0, 0.0],
        map,
        border: borders[map as usize],
    };
    let insets = [inset(0), inset(1)];
    let drawn = pictures.picture(&Frame { insets: &insets, ..seen.frame() });
    let (mut shown, mut grays) = ([0; 2], [Vec::new(), Vec::new()]);
    for (pixel, color) in drawn.iter().enumerate() {
        let (x, y) = (pixel % WIDTH, pixel / WIDTH);
        let at = |map: usize| (10 + 60 * map..58 + 60 * map).contains(&x) && (20..52).contains(&y);
        let Some(map) = (0..2).find(|map| at(*map)) else {
            assert_eq!(*color, plain[pixel], "{x} {y}");
            continue;
        };
        let left = 10 + 60 * map;
        if x == left || x == left + 47 || y == 20 || y == 51 {
            assert_eq!(color.map(linear), borders[map].to_array(), "{x} {y}");
        } else {
            assert!(color[0] == color[1] && color[1] == color[2], "{color:?}");
            shown[map] += 1;
            grays[map].push(color[0]);
        }
    }
    assert_eq!(shown, [46 * 30; 2]);
    assert_ne!(grays[0], grays[1], "each shows its own map");
}

#[test]
fn quadrilaterals_cover_their_pixels_and_no_others() {
    let Stage { mut pictures, seen } = Stage::new(&cheap_technique(), 1);
    let plain = pictures.picture(&seen.frame());
    let color = Vec4::new(0.2, 0.9, 0.1, 1.0);
    let triangle =
        Quad { corners: [[100.0, 10.0], [140.0, 10.0], [100.0, 50.0], [100.0, 50.0]].map(Vec2::from), color };
    let mut backward = triangle;
    backward.corners.reverse();
    let mut quads = vec![
        Quad::rectangle([10.0, 20.0, 30.0, 7.0], color),
        Quad::rectangle([10.5, 40.0, 29.0, 7.0], color),
        Quad { color: color.with_w(0.25), ..Quad::rectangle([50.0, 60.0, 4.0, 4.0], color) },
    ];
    quads.extend(Quad::outline([60.0, 60.0, 20.0, 12.0], 2.0, color));
    let with = |quads: &[Quad], pictures: &mut Pictures| pictures.picture(&Frame { quads, ..seen.frame() });
    let drawn = with(&quads, &mut pictures);
    let full = color.truncate().to_array().map(|channel| encoded(channel).round() as u8);
    let blended = |pixel: usize, share: f32| {
        core::array::from_fn(|i| encoded(share * color[i] + (1.0 - share) * linear(plain[pixel][i])).round() as u8)
    };
    for (pixel, drawn) in drawn.iter().enumerate() {
        let (x, y) = (pixel % WIDTH, pixel / WIDTH);
        let within = |left: usize, top: usize, width: usize, height: usize| {
            (left..left + width).contains(&x) && (top..top + height).contains(&y)
        };
        let expected: [u8; 3] = if within(10, 20, 30, 7) || within(11, 40, 28, 7) {
            full
        } else if within(10, 40, 30, 7) {
            blended(pixel, 0.5)
        } else if within(50, 60, 4, 4) {
            blended(pixel, 0.25)
        } else if within(60, 60, 20, 12) && !within(62, 62, 16, 8) {
            full
        } else {
            plain[pixel]
        };
        assert!((0..3).all(|i| drawn[i].abs_diff(expected[i]) <= 1), "{x} {y}: {drawn:?}, not {expected:?}");
    }
    let forward = with(&[triangle], &mut pictures);
    assert_eq!(with(&[backward], &mut pictures), forward, "either way around");
    let covered = forward.iter().filter(|color| **color == full).count();
    // Half of 40 × 40 pixels, minus pixels that the slanted side cuts.
    assert!((740..=800).contains(&covered), "{covered}");
}

/// Returns the technique whose look-up has the fewest branches.
fn fewest_branches() -> Technique {
    Technique::preset("focused-1").expect("a preset").with_resolution(256, 256).with_filter(FilterKind::Point)
}

fn most_branches(count: u32) -> Technique {
    let technique = Technique::preset("stable-4").expect("a preset").with_count(count).with_resolution(256, 256);
    let by_coverage = technique.maps.as_cascades().with_selection(MapSelection::default());
    technique.with_maps(by_coverage).with_filter(FilterKind::Pcss)
}

/// Asserts that overlays change the picture of a floor.
fn assert_overlays_are_drawn(technique: &Technique, overlays: &[Overlay]) {
    let floor = [[-60.0, -60.0], [-60.0, 60.0], [60.0, 60.0], [60.0, -60.0]].map(|[x, z]| Vec3::new(x, 0.0, z));
    let [a, b, c, d] = floor;
    let scene = Scene::from_objects("floor", &[vec![[a, b, c], [a, c, d]]]);
    let Stage { mut pictures, seen } = Stage::of(technique, 1, &scene);
    let drawn: Vec<u32> = random(WIDTH * SIZE[1] as usize, 16).collect();
    let view = classes_texture(&pictures.gpu, &drawn, SIZE);
    let camera = PerspectiveCamera { eye: seen.camera.eye + DVec3::new(0.1, 0.0, 0.1), ..seen.camera };
    let judged = Some(JudgedPicture { classes: &view, size: SIZE, camera: camera.into(), depth: None });
    let plain = pictures.picture(&seen.frame());
    for &overlay in overlays {
        let shown = pictures.picture(&Frame { overlay, judged, ..seen.frame() });
        let different = shown.iter().zip(&plain).filter(|(shown, plain)| shown != plain).count();
        assert!(different > 500, "{:?} {overlay:?}: {different}", technique.filter);
    }
}

#[test]
fn every_overlay_can_be_drawn_with_the_cheapest_look_up_and_one_with_the_dearest() {
    assert_overlays_are_drawn(&fewest_branches(), &Overlay::ALL);
    assert_overlays_are_drawn(&most_branches(2), &[Overlay::TexelGrid]);
}

#[test]
#[ignore = "every overlay with the dearest look-up: cargo xtask test --all"]
fn every_overlay_can_be_drawn_with_the_dearest_look_up() {
    let by_view_depth = Technique::preset("stable-4").expect("a preset").with_resolution(256, 256);
    let cascades = by_view_depth.maps.as_cascades().with_selection(MapSelection::ViewDepth { overlap: 0.0 });
    assert_overlays_are_drawn(&by_view_depth.with_maps(cascades).with_filter(FilterKind::Point), &Overlay::ALL);
    assert_overlays_are_drawn(&most_branches(4), &Overlay::ALL);
}

#[test]
fn casters_that_no_map_holds_are_told_from_those_that_one_holds() {
    let box_at = |x: f32| {
        let corner = |x: f32, y: f32, z: f32| Vec3::new(x, y, z - 3.0);
        let face = [corner(x, 0.0, 0.0), corner(x + 1.0, 0.0, 0.0), corner(x + 1.0, 2.0, 0.0), corner(x, 2.0, 0.0)];
        vec![[face[0], face[1], face[2]], [face[0], face[2], face[3]]]
    };
    // Two walls before the camera. The maps of a narrow view hold only one.
    let scene = Scene::from_objects("walls", &[box_at(-0.5), box_at(40.0)]);
    let technique = Technique::preset("focused-1").expect("a preset").with_resolution(256, 256);
    let Stage { mut pictures, seen } = Stage::of(&technique, 1, &scene);
    pictures.draw(&seen.frame());
    let masks = pictures.renderer.sun().maps_by_caster(&pictures.scene.casters());
    assert_eq!(masks, [1, 0]);
    let shown = |pictures: &mut Pictures, x: f64| {
        let camera =
            PerspectiveCamera { eye: DVec3::new(x, 1.0, 0.0), forward: Vec3::NEG_Z, fov_y: 0.2, ..seen.camera };
        let frame = Frame { camera: camera.into(), maps_stay: true, overlay: Overlay::Casters, ..seen.frame() };
        pictures.picture(&frame)[SIZE[1] as usize / 2 * WIDTH + WIDTH / 2]
    };
    let [held, left_out] = [0.0, 40.5].map(|x| shown(&mut pictures, x));
    // The first map's tint is orange. The colour of surfaces that no map holds is bluish.
    assert!(held[0] > held[2] + 20, "{held:?}");
    assert!(left_out[2] > left_out[0], "{left_out:?}");
}
