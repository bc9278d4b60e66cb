//! The headlight street and the comparison sampler: what their maps hold, what they light, and how wrong they are.

use shadowfit::glam::{DVec2, DVec3, Vec4};
use shadowfit_render::samples::formula::image_uv;
use shadowfit_render::samples::{LightPlace, SampleFrame};
use shadowfit_study::samples::{SampleDrawing, SampleValues, SampleVariant};

use super::bench::{Bench, distinct};

const SIZE: [u32; 2] = [180, 180];

/// The frame of values, as a variant's camera sees it.
fn frame(bench: &Bench, variant: Option<&SampleVariant>, values: &SampleValues) -> SampleFrame<'static> {
    let camera = bench.sample.seen_by(variant, 1.0);
    match bench.sample.drawing(values, &camera) {
        Ok(SampleDrawing::Mapped(frame)) => frame,
        other => panic!("{other:?}"),
    }
}

/// Where a world point lies in the light's image, and its w.
fn in_image(frame: &SampleFrame<'_>, point: DVec3) -> (DVec2, f32) {
    let clip: Vec4 = frame.light.clip_from_world * (point - frame.camera.eye).as_vec3().extend(1.0);
    (image_uv(clip).as_dvec2(), clip.w)
}

/// The pixel of a world point in a square picture.
fn pixel(frame: &SampleFrame<'_>, point: DVec3, size: u32) -> usize {
    let clip = frame.camera.clip_from_world(shadowfit::DepthConvention::Reversed);
    let clip = clip * (point - frame.camera.eye).as_vec3().extend(1.0);
    let uv = image_uv(clip) * size as f32;
    (uv.y as u32 * size + uv.x as u32) as usize
}

#[test]
fn eight_bits_have_256_depths_and_a_float_has_thousands_on_the_same_view() {
    let mut bench = Bench::new("headlight-real-shadow");
    let grey = bench.values(None, &[]);
    bench.picture(None, &grey, SIZE);
    let levels = distinct(bench.map_bytes().chunks_exact(4).map(|texel| texel[0]));
    assert!((2..=256).contains(&levels), "{levels}");
    let floats = bench.values(None, &[("format", "r32f")]);
    bench.picture(None, &floats, SIZE);
    let levels = distinct(bench.map_of_floats().iter().map(|depth| depth.to_bits()));
    assert!(levels > 10_000, "{levels}");
}

#[test]
fn outside_of_the_headlights_image_there_is_ambient_light_alone() {
    let mut bench = Bench::new("headlight-real-shadow");
    let lit = bench.values(None, &[]);
    let dark = bench.values(None, &[("power", "0")]);
    let [with, without] = [&lit, &dark].map(|values| bench.picture(None, values, SIZE));
    let frame = frame(&bench, None, &lit);
    // Points of the road, which is level at y = 0, some in the image and some beside it.
    let mut seen = [0, 0];
    for x in -15..=1 {
        for z in -20..=5 {
            let point = DVec3::new(f64::from(x) + 0.3, 0.0, f64::from(z) + 0.4);
            let (uv, w) = in_image(&frame, point);
            let at = pixel(&frame, point, SIZE[0]);
            let beside = w < 0.0 || (uv - 0.5).abs().max_element() > 0.53;
            let is_inside = w > 0.0 && (uv - 0.5).abs().max_element() < 0.47;
            let clip = frame.camera.clip_from_world(shadowfit::DepthConvention::Reversed)
                * (point - frame.camera.eye).as_vec3().extend(1.0);
            if (clip.truncate() / clip.w).truncate().abs().max_element() > 0.95 || clip.w < 5.0 {
                continue;
            }
            if beside {
                assert_eq!(with[at], without[at], "{point} at {uv}");
                seen[0] += 1;
            } else if is_inside {
                seen[1] += usize::from(with[at][0] > without[at][0].saturating_add(10));
            }
        }
    }
    assert!(seen.iter().all(|count| *count > 20), "{seen:?}");
}

#[test]
fn a_light_image_takes_the_corners_off_the_square() {
    let mut bench = Bench::new("headlight-real-shadow");
    let brightness = |picture: &[[u8; 4]]| picture.iter().map(|pixel| u64::from(pixel[1])).sum::<u64>();
    let mut drawn = |image| {
        let values = bench.values(None, &[("image", image)]);
        bench.picture(None, &values, SIZE)
    };
    let (square, round) = (drawn("square"), drawn("round"));
    assert!(brightness(&round) < brightness(&square));
    // Nothing gets brighter by it.
    assert!(round.iter().zip(&square).all(|(round, square)| round[0] <= square[0].saturating_add(1)));
}

#[test]
fn the_wall_behind_a_lamp_post_carries_the_lamp_posts_grey() {
    let mut bench = Bench::new("headlight-projective");
    let values = bench.values(None, &[("format", "r32f")]);
    let size = [500, 500];
    let picture = bench.picture(None, &values, size);
    let map = bench.map_of_floats();
    let frame = frame(&bench, None, &values);
    let LightPlace::At(light) = frame.light.place else { panic!("a lamp") };
    // The line from the headlight through the shaft of the nearer lamp post, eight units up, meets the wall at x = 13.
    let shaft = DVec3::new(4.0, 8.0, -5.0);
    let way = shaft - light;
    let on_wall = light + way * ((13.0 - light.x) / way.x);
    let (uv, _) = in_image(&frame, on_wall);
    let depth_of = |point: DVec3| {
        let clip = frame.light.clip_from_world * (point - frame.camera.eye).as_vec3().extend(1.0);
        clip.z / clip.w
    };
    let texel = (uv * 500.0).as_uvec2();
    let stored = map[(texel.y * 500 + texel.x) as usize];
    assert!((stored - depth_of(shaft)).abs() < 0.01, "the map holds the lamp post there: {stored}");
    assert!(depth_of(on_wall) - stored > 0.01, "and not the wall behind it");
    let shown = f32::from(picture[pixel(&frame, on_wall, 500)][0]) / 255.0;
    assert!((shown - stored).abs() < 0.02, "the wall shows {shown}, the map has {stored}");
}

#[test]
fn outside_of_the_comparison_samplers_image_everything_is_lit() {
    let mut bench = Bench::new("comparison-sampler");
    // From above, so that the whole floor and what is beside the light's image are seen.
    let values = bench.values(None, &[]);
    let size = [320, 240];
    let shadowed = bench.picture(None, &values, size);
    let lit = bench.picture(None, &bench.values(None, &[("shadows", "off")]), size);
    let camera = bench.sample.seen_by(None, 320.0 / 240.0);
    let Ok(SampleDrawing::Mapped(frame)) = bench.sample.drawing(&values, &camera) else { panic!("a mapped frame") };
    let clip_from_world = camera.clip_from_world(shadowfit::DepthConvention::Reversed);
    let mut outside = 0;
    for x in -60..=60 {
        for z in -60..=60 {
            let point = DVec3::new(f64::from(x) * 0.1, 0.0, f64::from(z) * 0.1);
            let (uv, w) = in_image(&frame, point);
            let clip = clip_from_world * (point - camera.eye).as_vec3().extend(1.0);
            let screen = image_uv(clip);
            if clip.w < 0.5 || (screen - 0.5).abs().max_element() > 0.49 {
                continue;
            }
            if w > 0.0 && (uv - 0.5).abs().max_element() > 0.52 {
                let at = (screen.y * 240.0) as usize * 320 + (screen.x * 320.0) as usize;
                assert_eq!(shadowed[at], lit[at], "{point}");
                outside += 1;
            }
        }
    }
    assert!(outside > 20, "{outside}");
}

#[test]
fn our_map_by_the_same_lamp_has_fewer_wrong_pixels_than_each_source() {
    for id in ["headlight-real-shadow", "comparison-sampler"] {
        let bench = Bench::new(id);
        let [source, ours] = bench.figures(None, &bench.values(None, &[])).shadows().expect("shadows");
        assert!(ours.wrong < 0.6 * source.wrong && ours.wrong < 0.3, "{id}: {} {}", ours.wrong, source.wrong);
        assert!(ours.false_shadow < 0.02, "{id}: {}", ours.false_shadow);
    }
}

#[test]
fn the_angles_bias_leaves_light_behind_thin_things_and_ours_does_not() {
    let bench = Bench::new("comparison-sampler");
    let front = bench.variant("front");
    let [source, ours] = bench.figures(Some(front), &bench.values(Some(front), &[])).shadows().expect("shadows");
    assert!(source.false_light > 1.0 && ours.false_light < 0.1, "{} {}", source.false_light, ours.false_light);
}
