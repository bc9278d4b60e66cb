//! Terrain with vehicles: the darkness of its shadows, its casters and receivers, and the content of its
//! formats.

use shadowfit::glam::DVec3;
use shadowfit_classics::mapped::point::image_uv;

use super::bench::{Bench, distinct};

const ID: &str = "terrain-vehicles";
const SIZE: [u32; 2] = [450, 300];

/// Diffuse light of the sample, and its light in shadow.
const DIFFUSE: f64 = 0.6;
const IN_SHADOW: f64 = 0.3;

#[test]
fn shadow_has_three_tenths_over_one_and_six_tenths_of_the_cosine_of_full_light() {
    let mut bench = Bench::new(ID);
    let plain = &[("inset", "off")];
    let shadowed = bench.values(None, plain);
    let with = bench.picture(None, &shadowed, SIZE);
    let lit = bench.values(None, &[("inset", "off"), ("shadows", "off")]);
    let without = bench.picture(None, &lit, SIZE);
    let camera = bench.sample.seen_by(None, 1.5);
    let clip_from_world = camera.clip_from_world(shadowfit::DepthConvention::Reversed);
    // Level ground around the helicopter and the tractor, at y = 0: N is up, and N·L follows from the light's
    // position.
    let light = DVec3::new(128.0, 100.0, 0.0);
    let mut measured = 0;
    for x in 100..170 {
        for z in 90..165 {
            let point = DVec3::new(f64::from(x) + 0.5, 0.0, f64::from(z) + 0.5);
            let clip = clip_from_world * (point - camera.eye).as_vec3().extend(1.0);
            let uv = image_uv(clip);
            if clip.w < 1.0 || (uv - 0.5).abs().max_element() > 0.49 {
                continue;
            }
            let at = (uv.y * SIZE[1] as f32) as usize * SIZE[0] as usize + (uv.x * SIZE[0] as f32) as usize;
            let ([dark, ..], [bright, ..]) = (with[at], without[at]);
            // Only ground pixels, not a vehicle before it: grass is green. White is clamped.
            let is_grass = |[r, g, b, _]: [u8; 4]| g > r && r > b && g < 250;
            if dark == bright || !is_grass(without[at]) || !is_grass(with[at]) || bright < 60 {
                continue;
            }
            let cosine = (light - point).normalize().y;
            let ratio = IN_SHADOW / (1.0 + DIFFUSE * cosine);
            let expected = f64::from(bright) * ratio;
            // The picture has no samples between pixels; both values are rounded to a byte.
            assert!((f64::from(dark) - expected).abs() <= 1.0, "{point}: {bright} becomes {dark}, not {expected:.1}");
            measured += 1;
        }
    }
    assert!(measured > 60, "{measured} points of the ground are in shadow");
}

#[test]
fn eight_bits_have_256_depths_and_a_float_has_thousands() {
    let mut bench = Bench::new(ID);
    let grey = bench.values(None, &[("format", "grey8")]);
    bench.picture(None, &grey, SIZE);
    assert!(distinct(bench.map_bytes().chunks_exact(4).map(|texel| texel[0])) <= 256);
    let floats = bench.values(None, &[]);
    bench.picture(None, &floats, SIZE);
    let map = bench.map_of_floats();
    assert_eq!(map.len(), 4096 * 4096);
    // Comparing all 16 million texels takes long, and a part of them also has thousands of depths.
    assert!(distinct(map.iter().step_by(37).map(|depth| depth.to_bits())) > 10_000);
    // Stored reversed: near the light is near 1, and texels without a caster are 0, which is far.
    assert!(map.iter().all(|depth| (0.0..1.0).contains(depth)) && map.iter().any(|depth| *depth > 0.2));
}

#[test]
fn vehicles_cast_on_the_ground_on_themselves_and_on_each_other() {
    let mut bench = Bench::new(ID);
    let mut darker = |variant: &str, is_part: &dyn Fn([u8; 4]) -> bool| {
        let variant = bench.variant(variant);
        let values = |bench: &Bench, shadows| bench.values(Some(variant), &[("shadows", shadows), ("inset", "off")]);
        let [with, without] = ["source", "off"].map(|shadows| {
            let values = values(&bench, shadows);
            bench.picture(Some(variant), &values, SIZE)
        });
        let both = with.iter().zip(&without);
        both.filter(|(with, without)| is_part(**without) && with[0].saturating_add(40) < without[0]).count()
    };
    let is_red = |[r, g, b, _]: [u8; 4]| r > 120 && g < 80 && b < 80;
    let is_sand = |[r, g, b, _]: [u8; 4]| r > 150 && g > 110 && b > 60 && r > g && g > b;
    let is_grass = |[r, g, b, _]: [u8; 4]| g > r && r > b;
    assert!(darker("on-itself", &is_red) > 100, "the tractor on itself");
    assert!(darker("on-another", &is_sand) > 100, "the helicopter's blade on the jeep");
    assert!(darker("on-itself", &is_grass) > 500, "on the ground");
}

#[test]
fn our_map_by_the_same_light_has_fewer_wrong_pixels() {
    let bench = Bench::new(ID);
    let [source, ours] = bench.figures(None, &bench.values(None, &[])).shadows().expect("shadows");
    assert!(ours.wrong < 0.5 * source.wrong, "{} {}", ours.wrong, source.wrong);
}

#[test]
fn with_a_bias_below_their_step_eight_bits_fall_into_bands_and_floats_do_not() {
    let bench = Bench::new(ID);
    let source = |options: &[(&str, &str)]| {
        let figures = bench.figures(None, &bench.values(None, options));
        figures.shadows().expect("shadows").map(|figures| figures.false_shadow)[0]
    };
    let [floats, grey] = [source(&[("from", "0.9705")]), source(&[("from", "0.9705"), ("format", "grey8")])];
    assert!(grey > 5.0 && floats < 0.2 * grey, "8 bits: {grey}, 32 bits: {floats}");
    // With the source's bias the two hardly differ.
    let [floats, grey] = [source(&[]), source(&[("format", "grey8")])];
    assert!((grey - floats).abs() < 0.1, "8 bits: {grey}, 32 bits: {floats}");
}
