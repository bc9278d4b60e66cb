//! The headlight street: the content of its maps, the projected picture, and the end of the light.

use shadowfit::PerspectiveCamera;
use shadowfit::glam::{DMat4, DVec3, Vec3};
use shadowfit_classics::mapped::SampleFrame;
use shadowfit_classics::{SampleDrawing, SampleValues};

use super::bench::{Bench, distinct};

const PROJECTIVE: &str = "headlight-projective";
const REAL_SHADOW: &str = "headlight-real-shadow";
/// Size of the original sample's window.
const SIZE: [u32; 2] = [500; 2];
/// Near and far distance of the projective lamp. Depths after the division by w depend on the distance along
/// its axis.
const NEAR_FAR: [f64; 2] = [5.0, 100.0];

/// Returns the frame that is drawn.
fn frame(bench: &Bench, values: &SampleValues, camera: &PerspectiveCamera) -> SampleFrame {
    match bench.sample.drawing(values, camera).expect("a lamp that can be fitted") {
        SampleDrawing::Mapped(frame) => frame,
        _ => panic!("a lamp's sample is drawn by the samples' renderer"),
    }
}

/// Returns the pixel that shows a world position. Panics if it is outside the picture.
fn pixel_of(camera: &PerspectiveCamera, point: DVec3) -> usize {
    let clip =
        camera.clip_from_world(shadowfit::DepthConvention::ZeroToOne).as_dmat4() * (point - camera.eye).extend(1.0);
    let [x, y] = [clip.x / clip.w * 0.5 + 0.5, 0.5 - clip.y / clip.w * 0.5].map(|share| (share * 500.0) as usize);
    assert!(x < 500 && y < 500 && clip.w > 0.0, "{point} is out of view");
    y * 500 + x
}

/// Returns the intersection of a pixel's line of sight with the road, y = 0.
fn on_road(camera: &PerspectiveCamera, pixel: usize) -> Option<DVec3> {
    let clip_from_world = camera.clip_from_world(shadowfit::DepthConvention::ZeroToOne).as_dmat4();
    let world_from_clip: DMat4 = clip_from_world.inverse();
    let [x, y] = [pixel % 500, pixel / 500].map(|at| (at as f64 + 0.5) / 500.0);
    let far = world_from_clip.project_point3(DVec3::new(x * 2.0 - 1.0, 1.0 - y * 2.0, 1.0));
    (far.y < 0.0).then(|| camera.eye + far * (camera.eye.y / -far.y))
}

#[test]
fn eight_bits_store_no_more_than_256_depths_and_floats_more_than_ten_thousand() {
    for id in [PROJECTIVE, REAL_SHADOW] {
        let mut bench = Bench::new(id);
        let mut map = |format| {
            let values = bench.values(None, &[("format", format)]);
            bench.picture(None, &values, [100; 2]);
            bench.map_bytes()
        };
        let (grey, floats) = (map("grey8"), map("r32f"));
        assert_eq!((grey.len(), floats.len()), (500 * 500 * 4, 500 * 500 * 4), "a map as large as the window");
        let greys = distinct(grey.as_chunks::<4>().0.iter().map(|texel| texel[0]));
        assert!((20..=256).contains(&greys), "{id}: {greys}");
        let depths = distinct(floats.as_chunks::<4>().0.iter().copied());
        assert!(depths > 10_000, "{id}: {depths}");
    }
}

#[test]
fn the_wall_behind_a_lamp_post_has_the_lamp_posts_grey() {
    let mut bench = Bench::new(PROJECTIVE);
    let values = bench.values(None, &[]);
    let picture = bench.picture(None, &values, SIZE);
    let camera = bench.sample.lens(1.0);
    let light = frame(&bench, &values, &camera).light;
    let lamp = DVec3::new(-18.0, 5.0, -2.0);
    // The axis of the post at (4, 1, -5), eight units above its foot, and the end of the lamp's ray behind
    // it: at x = 13.
    let post = DVec3::new(4.0, 9.0, -5.0);
    let wall = lamp + (post - lamp) * ((13.0 - lamp.x) / (post.x - lamp.x));
    let grey_of = |point: DVec3| {
        let w = (light.clip_from_world * (point - camera.eye).as_vec3().extend(1.0)).w;
        let [near, far] = NEAR_FAR;
        far / (far - near) * (1.0 - near / f64::from(w)) * 255.0
    };
    let shown = |point: DVec3| f64::from(picture[pixel_of(&camera, point)][0]);
    // The map stores the near side of the shaft, a third of a unit before its axis: less than a level of 255.
    assert!((shown(wall) - grey_of(post)).abs() <= 2.0, "{} {}", shown(wall), grey_of(post));
    assert!(grey_of(wall) - shown(wall) > 10.0, "{} {}", shown(wall), grey_of(wall));
    // Three units beside it, the wall has its own grey.
    let beside = wall + DVec3::Z * 3.0;
    assert!((shown(beside) - grey_of(beside)).abs() <= 1.5, "{} {}", shown(beside), grey_of(beside));
}

#[test]
fn beside_the_lamps_image_the_borders_of_the_map_smear() {
    let mut bench = Bench::new(PROJECTIVE);
    let values = bench.values(None, &[("format", "r32f")]);
    let smear = bench.variant("smear");
    let picture = bench.picture(Some(smear), &values, SIZE);
    let map = bench.map_of_floats();
    let camera = bench.sample.seen_by(Some(smear), 1.0);
    let light = frame(&bench, &values, &camera).light;
    let mut smeared = 0;
    for (pixel, shown) in picture.iter().enumerate() {
        let Some(road) = on_road(&camera, pixel).filter(|at| (-19.0..1.0).contains(&at.x) && at.z < 9.5) else {
            continue;
        };
        let clip = light.clip_from_world * (road - camera.eye).as_vec3().extend(1.0);
        let (x, row) = (clip.x / clip.w, (0.5 - clip.y / clip.w * 0.5) * 500.0 - 0.5);
        if clip.w < 0.0 || x < 1.01 || !(0.0..498.0).contains(&row) {
            continue;
        }
        let column = |row: f32| map[row as usize * 500 + 499];
        let (above, below) = (column(row), column(row + 1.0));
        let grey = (above + (below - above) * row.fract()) * 255.0;
        assert!((grey - f32::from(shown[0])).abs() <= 1.5, "{pixel}: {grey} {shown:?}");
        smeared += 1;
    }
    assert!(smeared > 2000, "{smeared}");
}

#[test]
fn outside_of_the_lamps_image_there_is_ambient_light_alone() {
    let mut bench = Bench::new(REAL_SHADOW);
    let [lit, dark] = [("2", "0.5"), ("0", "0.5")].map(|(power, ambient)| {
        let values = bench.values(None, &[("power", power), ("ambient", ambient)]);
        bench.picture(None, &values, SIZE)
    });
    let camera = bench.sample.lens(1.0);
    let light = frame(&bench, &bench.values(None, &[]), &camera).light;
    let (mut outside, mut inside) = (0, 0);
    for (pixel, (lit, dark)) in lit.iter().zip(&dark).enumerate() {
        let Some(road) = on_road(&camera, pixel).filter(|at| (-20.0..2.0).contains(&at.x) && at.z < 10.0) else {
            continue;
        };
        let clip = light.clip_from_world * (road - camera.eye).as_vec3().extend(1.0);
        let edge = clip.x.abs().max(clip.y.abs()) / clip.w;
        if clip.w <= 0.0 || edge > 1.02 {
            assert_eq!(lit, dark, "{road}");
            outside += 1;
        } else if edge < 0.98 {
            inside += u32::from(lit != dark);
        }
    }
    assert!(outside > 10_000 && inside > 10_000, "{outside} {inside}");
    // The light's position matters, not its axis.
    assert!(
        matches!(light.place, shadowfit_classics::mapped::LightPlace::At(at) if at.as_vec3() == Vec3::new(-18.0, 5.0, -2.0))
    );
}

#[test]
fn close_to_a_shadow_eight_bits_are_coarse_and_from_afar_the_formats_hardly_differ() {
    let mut bench = Bench::new(REAL_SHADOW);
    let mut differing = |variant: &str| {
        let view = bench.variant(variant);
        let [eight, floats] = ["grey8", "r32f"].map(|format| {
            let values = bench.values(None, &[("format", format)]);
            bench.picture(Some(view), &values, SIZE)
        });
        eight.iter().zip(&floats).filter(|(a, b)| a[0].abs_diff(b[0]) > 24).count() as f64 / 2500.0
    };
    let (afar, close) = (differing("formats"), differing("close-formats"));
    assert!(afar < 1.0, "{afar}%");
    assert!(close > 2.0 && close > 3.0 * afar, "{close}% {afar}%");
}

#[test]
fn shaped_light_images_hide_the_corners_of_the_square() {
    let mut bench = Bench::new(REAL_SHADOW);
    let view = bench.variant("corners");
    let camera = bench.sample.seen_by(Some(view), 1.0);
    let [dark, square, round, headlights] = [("0", "square"), ("2", "square"), ("2", "round"), ("2", "headlights")]
        .map(|(power, image)| {
            let values = bench.values(None, &[("power", power), ("image", image)]);
            bench.picture(Some(view), &values, SIZE)
        });
    let light = frame(&bench, &bench.values(None, &[]), &camera).light;
    let mut corners = 0;
    for pixel in 0..dark.len() {
        let Some(road) = on_road(&camera, pixel).filter(|at| (-19.0..1.0).contains(&at.x) && at.z < 9.0) else {
            continue;
        };
        let clip = light.clip_from_world * (road - camera.eye).as_vec3().extend(1.0);
        let (x, y) = (clip.x.abs() / clip.w, clip.y.abs() / clip.w);
        if clip.w > 0.0 && x.max(y) < 0.98 && x.min(y) > 0.8 && square[pixel] != dark[pixel] {
            assert_eq!((round[pixel], headlights[pixel]), (dark[pixel], dark[pixel]), "{road}");
            corners += 1;
        }
    }
    assert!(corners > 100, "{corners}");
}

#[test]
fn modern_maps_are_wrong_at_fewer_pixels() {
    let bench = Bench::new(REAL_SHADOW);
    for id in ["formats", "close-8-bit", "acne", "corners"] {
        let variant = bench.variant(id);
        let figures = bench.figures(Some(variant), &bench.values(Some(variant), &[]));
        let [source, modern] = figures.shadows().expect("shadows were judged");
        assert!(modern.wrong < 0.5 * source.wrong, "{id}: {source:?} {modern:?}");
    }
}
