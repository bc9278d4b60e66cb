//! Judged pictures: each surface shows the class of its own pixel, or of the pixel that showed it to another
//! camera.

use glam::{DVec2, DVec3, UVec2};
use shadowfit::{DepthConvention, PerspectiveCamera};
use shadowfit_params::figures::ERROR_COLORS;
use shadowfit_render::{Frame, JudgedPicture, Marks, Overlay, ProbeTargets, classes_texture};
use shadowfit_testing::subpixel_step;

use super::pictures::{SIZE, Stage, bits, cheap_technique, linear, random};

const PIXELS: usize = (SIZE[0] * SIZE[1]) as usize;

fn stage(samples: u32) -> Stage {
    Stage::new(&cheap_technique(), samples)
}

fn judged<'a>(classes: &'a wgpu::TextureView, camera: &PerspectiveCamera) -> JudgedPicture<'a> {
    JudgedPicture { classes, size: SIZE, camera: camera.into(), depth: None }
}

/// Returns the class of a pixel's colour; `None` for grey.
fn class_of([r, g, b]: [u8; 3]) -> Option<u32> {
    let is_gray = r.abs_diff(g) <= 1 && g.abs_diff(b) <= 1;
    let near = |color: &[u8; 3]| color.iter().zip([r, g, b]).all(|(a, b)| a.abs_diff(b) <= 1);
    let class = ERROR_COLORS.iter().position(near).map(|index| index as u32 + 2);
    assert!(is_gray || class.is_some(), "{r} {g} {b} is no colour of a class");
    class
}

#[test]
fn through_the_judged_camera_every_surface_has_the_class_of_its_own_pixel() {
    let Stage { mut pictures, seen } = stage(1);
    let probe = pictures.probe(&seen.frame());
    let drawn: Vec<u32> = random(PIXELS, 6).collect();
    let view = classes_texture(&pictures.gpu, &drawn, SIZE);
    let frame = Frame { overlay: Overlay::Error, judged: Some(judged(&view, &seen.camera)), ..seen.frame() };
    let picture = pictures.picture(&frame);
    let mut wrong = 0;
    for ((color, class), probed) in picture.into_iter().zip(drawn).zip(&probe.pixels) {
        let expected = (class >= 2 && probed.is_some()).then_some(class);
        assert_eq!(class_of(color), expected);
        wrong += usize::from(expected.is_some());
    }
    assert!(wrong > PIXELS / 3, "{wrong}");
}

#[test]
fn through_another_camera_every_surface_has_the_class_of_the_pixel_that_showed_it() {
    let Stage { mut pictures, seen } = stage(1);
    let before = PerspectiveCamera { eye: seen.camera.eye + DVec3::new(0.4, 0.15, -0.3), ..seen.camera };
    let of_before = ProbeTargets::new(&pictures.gpu.device, SIZE);
    let frame_before = Frame { camera: before.into(), ..seen.frame() };
    let shown =
        pictures.renderer.probe(&pictures.gpu, &mut pictures.scene, &frame_before, &of_before).expect("a probe");
    // Each triangle has its own class.
    let class = |triangle: u32| 2 + triangle.wrapping_mul(0x9E37_79B1) % 7 % 4;
    let bits: Vec<u32> = shown.pixels.iter().map(|pixel| pixel.map_or(0, |pixel| class(pixel.triangle))).collect();
    let view = classes_texture(&pictures.gpu, &bits, SIZE);
    let probe = pictures.probe(&seen.frame());
    let judged =
        JudgedPicture { classes: &view, size: SIZE, camera: before.into(), depth: Some(of_before.depth_view()) };
    let frame = Frame { overlay: Overlay::Error, judged: Some(judged), ..seen.frame() };
    let picture = pictures.picture(&frame);
    let clip = before.clip_from_world(DepthConvention::Reversed).as_dmat4();
    // A hundredth of a pixel for f32, and a step for the corners of each picture.
    let border = 0.012 + 2.0 * f64::from(subpixel_step(&pictures.gpu.adapter.get_info()));
    let [mut right, mut lost] = [0; 2];
    for (pixel, (color, probed)) in picture.into_iter().zip(&probe.pixels).enumerate() {
        let (found, Some(probed)) = (class_of(color), probed) else { continue };
        let point = pictures.point(&seen.camera, pixel, probed.triangle);
        let at = clip * (point + seen.camera.eye - before.eye).extend(1.0);
        let place = (at.truncate().truncate() / at.w * DVec2::new(0.5, -0.5) + 0.5) * UVec2::from(SIZE).as_dvec2();
        let is_beside = place.min_element() < 0.0 || place.cmpge(UVec2::from(SIZE).as_dvec2()).any();
        let near_border = (place - place.round()).abs().min_element() < border;
        if is_beside || near_border {
            assert!(found.is_none() || near_border, "{place}");
            continue;
        }
        let there = place.y as usize * SIZE[0] as usize + place.x as usize;
        match found {
            Some(found) => {
                assert_eq!(found, bits[there], "{place}");
                right += 1;
            }
            // Hidden surfaces have no class. Surfaces that were visible to the judged camera have one.
            None => lost += usize::from(shown.pixels[there].is_some_and(|there| there.triangle == probed.triangle)),
        }
    }
    println!("{right} right, {lost} lost");
    // Borders of steps of 1/16 pixel exclude half of the pixels.
    assert!(right > PIXELS / 4 && lost * 100 < right, "{right} and {lost}");
}

#[test]
fn truth_shades_with_the_light_of_rays_and_with_that_of_the_maps_where_nothing_was_judged() {
    let Stage { mut pictures, seen } = stage(1);
    let lit = pictures.picture(&Frame { shadows: false, ..seen.frame() });
    let plain = pictures.picture(&seen.frame());
    let mut truth = |bits: u32| {
        let view = classes_texture(&pictures.gpu, &vec![bits; PIXELS], SIZE);
        let frame = Frame { overlay: Overlay::Truth, judged: Some(judged(&view, &seen.camera)), ..seen.frame() };
        pictures.picture(&frame)
    };
    assert_eq!(truth(bits(1, true)), lit);
    let dark = truth(bits(1, false));
    let unjudged = truth(bits(0, false));
    let luminance = |color: [u8; 3]| color.map(linear).iter().sum::<f32>();
    let (mut darker, mut hatched) = (0, 0);
    for (((dark, lit), plain), unjudged) in dark.iter().zip(&lit).zip(&plain).zip(&unjudged) {
        assert!(luminance(*dark) <= luminance(*lit) + 0.01);
        darker += usize::from(luminance(*dark) < 0.8 * luminance(*lit));
        // Hatching darkens. Apart from it, the picture equals the maps' picture.
        assert!(luminance(*unjudged) <= luminance(*plain) + 0.01);
        hatched += usize::from(unjudged != plain);
    }
    println!("{darker} darker, {hatched} hatched");
    assert!(darker > PIXELS / 4 && hatched > PIXELS / 20 && hatched < PIXELS / 2, "{darker} and {hatched}");
}

/// The only wrong pixel of a picture with marks. It shows a surface.
const MARKED: usize = 60 * SIZE[0] as usize + 70;

/// Draws a picture with marks of one wrong pixel.
fn marked(stage: &mut Stage, marks: Marks, same_camera: bool) -> Vec<[u8; 3]> {
    let mut drawn = vec![1; PIXELS];
    drawn[MARKED] = 3;
    let Stage { pictures, seen } = stage;
    let view = classes_texture(&pictures.gpu, &drawn, SIZE);
    // A different camera with the same picture.
    let camera = PerspectiveCamera { far: if same_camera { seen.camera.far } else { 130.0 }, ..seen.camera };
    pictures.picture(&Frame { marks: Some(marks), judged: Some(judged(&view, &camera)), ..seen.frame() })
}

/// Returns the distance between two pixels.
fn distance(pixel: usize, other: usize) -> f64 {
    let width = SIZE[0] as usize;
    let [x, y] = [(pixel % width).abs_diff(other % width), (pixel / width).abs_diff(other / width)];
    ((x * x + y * y) as f64).sqrt()
}

#[test]
fn a_single_wrong_pixel_has_a_ring_in_the_colour_of_its_class() {
    for samples in [1, 4] {
        let mut stage = stage(samples);
        let plain = stage.picture(|_| ());
        for same_camera in [true, false] {
            let marked = marked(&mut stage, Marks::default(), same_camera);
            let mut ring = 0;
            for (pixel, (marked, plain)) in marked.iter().zip(&plain).enumerate() {
                let away = distance(pixel, MARKED);
                if (3.5..=4.5).contains(&away) {
                    assert_eq!(class_of(*marked), Some(3), "{away}");
                    ring += 1;
                } else if !(1.4..7.0).contains(&away) {
                    assert_eq!(marked, plain, "{away}");
                }
            }
            assert!(ring > 15, "{ring}");
        }
    }
}

#[test]
fn filled_marks_cover_a_wrong_pixel_and_those_beside_it_by_their_strength() {
    let marks = Marks { outline: false, ..Marks::default() };
    let mut stage = stage(1);
    let plain = stage.picture(|_| ());
    let full = marked(&mut stage, marks, true);
    let half = marked(&mut stage, Marks { strength: 0.5, ..marks }, true);
    let none = marked(&mut stage, Marks { classes: [true, false, true, true], ..marks }, true);
    assert_eq!(none, plain);
    for (pixel, (full, plain)) in full.iter().zip(&plain).enumerate() {
        match distance(pixel, MARKED) {
            away if away <= 1.0 => assert_eq!(class_of(*full), Some(3)),
            away if away >= 2.0 => assert_eq!(full, plain),
            _ => {}
        }
    }
    for channel in 0..3 {
        let [plain, half, full] = [&plain, &half, &full].map(|picture| linear(picture[MARKED][channel]));
        assert!((half - 0.5 * (plain + full)).abs() < 0.01, "{plain} {half} {full}");
    }
}
