//! The XNA Shadow Mapping sample: its shading, its map, each documented flaw and its cure.

use super::bench::{Bench, distinct};

const ID: &str = "xna-shadow-mapping";
/// A small size with the aspect of the original window.
const SIZE: [u32; 2] = [300, 180];

/// End of the figure's depths, and the step of 16-bit floats below it, of 11 significant bits: 2⁻¹⁵.
const FIGURE_END: f32 = 1.0 / 16.0;
const HALF_FLOAT_STEP: f32 = FIGURE_END / 2048.0;

#[test]
fn a_shadow_has_half_of_the_whole_light() {
    let mut bench = Bench::new(ID);
    let [with, without] = ["source", "off"].map(|shadows| {
        let values = bench.values(None, &[("shadows", shadows), ("inset", "off")]);
        bench.picture(None, &values, SIZE)
    });
    let mut shadowed = 0;
    for (with, without) in with.iter().zip(&without) {
        for (with, without) in with.iter().zip(without).take(3) {
            // Half of a byte, rounded either way; the shaded pass rounds once more.
            let half = f32::from(*without) * 0.5;
            let is_half = (f32::from(*with) - half).abs() <= 1.0;
            assert!(is_half || with == without, "{without} becomes {with}");
            shadowed += u32::from(is_half && with != without);
        }
    }
    // The character's shadow on the floor: a hundredth of the picture or more.
    assert!(shadowed / 3 > SIZE[0] * SIZE[1] / 100, "{shadowed}");
}

#[test]
fn the_map_holds_the_character_alone_in_the_half_toward_the_light() {
    let mut bench = Bench::new(ID);
    let values = bench.values(None, &[]);
    bench.picture(None, &values, SIZE);
    let map = bench.map_of_floats();
    assert_eq!(map.len(), 2048 * 2048);
    let drawn: Vec<f32> = map.iter().copied().filter(|depth| *depth < 1.0).collect();
    // The frustum is 1000 units deep, the figure 65 high: a small part of the map.
    assert!((100..20_000).contains(&drawn.len()), "{}", drawn.len());
    assert!(drawn.iter().all(|depth| (0.0..0.5).contains(depth)), "beyond 0.5 the box is empty");
}

#[test]
fn without_a_bias_the_character_shadows_itself_and_the_floor_does_not() {
    let mut bench = Bench::new(ID);
    let acne = bench.variant("acne");
    let [plain, without_bias] =
        [&[("bias", "0.001"), ("inset", "off")], &[("bias", "0"), ("inset", "off")]].map(|options| {
            let values = bench.values(Some(acne), options);
            bench.picture(Some(acne), &values, SIZE)
        });
    let darker = |row: std::ops::Range<usize>| {
        let pixels = row.start * SIZE[0] as usize..row.end * SIZE[0] as usize;
        pixels.filter(|pixel| without_bias[*pixel][1] + 8 < plain[*pixel][1]).count()
    };
    assert!(darker(0..180) > 1500, "stripes over the figure: {}", darker(0..180));
    // The floor at the right and left border is not a caster, so it has no acne.
    let border = (0..180).flat_map(|y| [0, 1, 298, 299].map(|x| y * 300 + x));
    assert_eq!(border.filter(|pixel| without_bias[*pixel] != plain[*pixel]).count(), 0);
}

#[test]
fn eight_bits_store_256_depths_and_sixteen_bit_floats_are_within_a_step() {
    let mut bench = Bench::new(ID);
    let mut map = |format| {
        let values = bench.values(None, &[("format", format)]);
        bench.picture(None, &values, SIZE);
        bench.map_bytes()
    };
    let (floats, halves, grey, packed) = (map("r32f"), map("r16f"), map("grey8"), map("rgba8"));
    let floats: Vec<f32> = floats.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
    assert!(distinct(grey.chunks_exact(4).map(|texel| texel[0])) <= 256);
    assert!(distinct(floats.iter().map(|depth| depth.to_bits())) > 500, "one for almost each texel of the figure");
    // Four channels hold the bits of the float.
    assert!(packed.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).eq(floats.iter().copied()));
    let half = |bits: u16| {
        let exponent = i32::from(bits >> 10 & 31) - 15;
        (1.0 + f32::from(bits & 1023) / 1024.0) * 2.0_f32.powi(exponent)
    };
    let drawn = halves.as_chunks().0.iter().zip(&floats).filter(|(_, depth)| **depth < 1.0);
    assert!(drawn.clone().all(|(_, depth)| (0.0..FIGURE_END).contains(depth)), "halves have larger steps there");
    let worst = drawn.map(|(bytes, depth)| (half(u16::from_le_bytes(*bytes)) - depth).abs()).fold(0.0, f32::max);
    // A device may store either of the two neighbours of a depth: Mesa's truncates, SwiftShader rounds to the
    // nearest.
    assert!(worst <= HALF_FLOAT_STEP && worst > HALF_FLOAT_STEP * 0.25, "{worst}");
}

#[test]
fn each_flaw_has_its_number_and_modern_maps_have_hardly_any() {
    let bench = Bench::new(ID);
    let check = |id: &str, is_shown: &dyn Fn(&shadowfit_truth::PictureFigures) -> bool| {
        let variant = bench.variant(id);
        let figures = bench.figures(Some(variant), &bench.values(Some(variant), &[]));
        let [source, modern] = figures.shadows().expect("shadows were judged");
        assert!(is_shown(&source), "{id}: {source:?}");
        assert!(modern.wrong < 0.2 && modern.wrong < 0.5 * source.wrong, "{id}: {modern:?}");
    };
    check("acne", &|source| source.false_shadow > 2.0);
    check("acne-8-bit", &|source| source.false_shadow > 1.0);
    check("acne-16-bit", &|source| source.false_shadow < 0.1);
    check("aliasing", &|source| source.edge > 1.0);
    check("hole", &|source| source.hole > 1.0);
    check("missing-caster", &|source| source.hole > 10.0);
    check("wasted-resolution", &|source| source.edge > 0.5);
    check("larger-map", &|source| source.edge < 2.0);
    check("larger-box", &|source| source.hole == 0.0);
}
