//! An image that can be counted by hand: a rectangle over a plane under a vertical light, all on texel
//! boundaries.
//!
//! ```text
//!        light │││││││││││
//!              ▼▼▼▼▼▼▼▼▼▼▼
//!   y = 2      ── caster ──            80 × 48 texels of 1/16 m
//!   y = 0   ──────plane──────────      256 × 256 texels
//! ```

use shadowfit::glam::{DVec3, UVec2, Vec2, Vec3};
use shadowfit::settings::{BiasSettings, FilterKind, FitKind, FitSettings, MapFormat};
use shadowfit::{DepthConvention, LightProjection, ViewFrustum, fit};
use shadowfit_testing::pairs::{all_pairs, full_product};
use shadowfit_wgpu::ShadowMapDescriptor;

use super::engine::Engine;
use super::engine::points::Point;
use super::harness::{Answer, Harness, ROW};

/// Width of the map in texels.
const TEXELS: u32 = ROW;
/// Size of a texel, in metres. Like every number here it is exact in f32.
const TEXEL: f32 = 1.0 / 16.0;
/// Greatest share of its extent by which a fit widens its box against rounding: on both sides 28 · 2⁻²⁴ of
/// the extent, twice in depth, and of the farthest corner's distance, which is 12 m for an extent of at least
/// 5 m.
const WIDENED: f32 = 2.0 * 28.0 / 16_777_216.0 * (2.0 + 12.0 / 5.0);
/// Corners of the caster, in metres: x, then z.
const CASTER: [[f32; 2]; 2] = [[-2.0, 3.0], [-1.0, 2.0]];
/// Height of the caster over the plane, in metres.
const HEIGHT: f32 = 2.0;
/// Texels of the caster's shadow: 5 m × 3 m.
const SHADOWED: usize = 80 * 48;

/// Returns the fit of a box of 16 m × 5 m × 16 m around the origin, viewed from the box's centre along -z.
pub(super) fn box_fit(depth: DepthConvention) -> LightProjection {
    let corner = |x: f32, y: f32, z: f32| Vec3::new(x * 8.0, if y > 0.0 { 4.0 } else { -1.0 }, z * 8.0);
    let face = |z| [corner(-1.0, 1.0, z), corner(1.0, 1.0, z), corner(1.0, -1.0, z), corner(-1.0, -1.0, z)];
    let [near, far] = [face(1.0), face(-1.0)];
    let corners = core::array::from_fn(|i| if i < 4 { near[i] } else { far[i - 4] });
    let frustum = ViewFrustum { origin: DVec3::ZERO, corners, near: -8.0, far: 8.0, forward: Vec3::NEG_Z };
    let settings = FitSettings::default()
        .with_kind(FitKind::FrustumAabb)
        .with_caster_extension(0.0)
        .with_border(0.0)
        .with_resolution(UVec2::splat(TEXELS))
        .with_depth(depth);
    fit(&frustum, Vec3::NEG_Y, &settings).expect("a good fit")
}

fn caster(height: f32) -> Vec<Vec3> {
    let [[left, right], [back, front]] = CASTER;
    let corner = |x, z| Vec3::new(x, height, z);
    let (a, b, c, d) = (corner(left, back), corner(right, back), corner(right, front), corner(left, front));
    vec![a, b, c, a, c, d]
}

/// Returns points of the plane at the centres of the map's texels, in rows from the map's top, which is -z.
fn plane() -> Vec<Point> {
    let middle = |index: u32| (index as f32 + 0.5) * TEXEL - 8.0;
    (0..TEXELS * TEXELS)
        .map(|index| Point { position: [middle(index % TEXELS), 0.0, middle(index / TEXELS)], normal: [0.0, 1.0, 0.0] })
        .collect()
}

fn answers(format: MapFormat, filter: FilterKind, depth: DepthConvention) -> Vec<Answer> {
    let descriptor =
        ShadowMapDescriptor { resolution: [TEXELS; 2], format, filter, depth, ..ShadowMapDescriptor::default() };
    answers_under(HEIGHT, &descriptor)
}

fn answers_under(height: f32, descriptor: &ShadowMapDescriptor) -> Vec<Answer> {
    let bias = BiasSettings { constant: 0.0, slope: 0.0, normal_offset: 0.0, receiver_plane: 0.0, depth_steps: 0.0 };
    let (gpu, fit) = (Engine::shared(), box_fit(descriptor.depth));
    Harness::new(&gpu, descriptor, DVec3::ZERO, &[fit], &bias, &[caster(height)]).ask(0, &plane())
}

fn is_under_the_caster(point: &Point) -> bool {
    let [x, _, z] = point.position;
    let [[left, right], [back, front]] = CASTER;
    (left..right).contains(&x) && (back..front).contains(&z)
}

#[test]
fn the_fit_has_texels_of_a_sixteenth_metre_on_the_grid() {
    for depth in [DepthConvention::ZeroToOne, DepthConvention::Reversed] {
        let fit = box_fit(depth);
        assert!((fit.texel_size / TEXEL - 1.0).abs().max_element() < WIDENED, "{:?}", fit.texel_size);
        for (corner, uv) in [(Vec3::new(-8.0, 4.0, -8.0), [0.0, 0.0]), (Vec3::new(8.0, 4.0, 8.0), [1.0, 1.0])] {
            let is = fit.uv_from_world.transform_point3(corner).truncate();
            assert!((is - Vec2::from(uv)).abs().max_element() < WIDENED, "{is}");
        }
    }
}

/// Number of formats, filters and depth conventions.
const COUNTS: [usize; 3] = [MapFormat::ALL.len(), 2, 2];

#[test]
fn the_shadow_has_the_caster_s_area_to_the_texel_in_every_format_filter_and_depth() {
    assert_exact(&all_pairs(&COUNTS));
}

#[test]
#[ignore = "the full product of formats, filters and depths: cargo xtask test --all"]
fn the_shadow_has_the_caster_s_area_in_the_full_product_of_formats_filters_and_depths() {
    assert_exact(&full_product(&COUNTS));
}

/// Asserts that the shadow covers exactly the texels under the caster, for formats, filters and depth
/// conventions by index.
fn assert_exact(rows: &[Vec<usize>]) {
    let plane = plane();
    let expected: Vec<f32> = plane.iter().map(|point| if is_under_the_caster(point) { 0.0 } else { 1.0 }).collect();
    assert_eq!(expected.iter().filter(|factor| **factor == 0.0).count(), SHADOWED);
    for row in rows {
        let format = MapFormat::ALL[row[0]];
        // At texel centres the 2×2 filter reads a single texel, except for the share by which the box is
        // widened.
        let filter = [FilterKind::Point, FilterKind::Hardware2x2][row[1]];
        let depth = [DepthConvention::ZeroToOne, DepthConvention::Reversed][row[2]];
        let factors: Vec<f32> = answers(format, filter, depth).iter().map(|answer| answer.factor).collect();
        let count = factors.iter().filter(|factor| **factor < 0.5).count();
        assert_eq!(count, SHADOWED, "{format:?} {filter:?} {depth:?}");
        let is_near = |(factor, expected): (&f32, &f32)| (factor - expected).abs() <= WIDENED * TEXELS as f32;
        let is_in_place = factors.iter().zip(&expected).all(is_near);
        assert!(is_in_place, "{format:?} {filter:?} {depth:?}: the shadow lies elsewhere");
    }
}

#[test]
fn the_map_stores_the_caster_s_depth_in_its_texels_and_the_far_plane_elsewhere() {
    // The caster lies 2 m under the near plane, of 5 m: the depth is 0.4, or 0.6 reversed.
    for (depth, near, far) in [(DepthConvention::ZeroToOne, 0.4, 1.0), (DepthConvention::Reversed, 0.6, 0.0)] {
        let [as_depth, as_color] =
            [MapFormat::Depth32Float, MapFormat::R32Float].map(|format| answers(format, FilterKind::Point, depth));
        for (point, (a, b)) in plane().iter().zip(as_depth.iter().zip(&as_color)) {
            let expected: f32 = if is_under_the_caster(point) { near } else { far };
            // The box is widened about its centre, and depths are interpolated with a few roundings of 2⁻²⁴.
            let tolerance = (expected - 0.5).abs() * WIDENED + 4.0 / 16_777_216.0;
            assert!((a.stored - expected).abs() <= tolerance, "{depth:?} {point:?}: {a:?}");
            assert_eq!(a.stored.to_bits(), b.stored.to_bits(), "{depth:?} {point:?}: both formats store one depth");
        }
    }
}

#[test]
fn depth_clamp_alone_keeps_a_caster_before_the_near_plane_and_stores_it_there() {
    const BEFORE_THE_NEAR_PLANE: f32 = 7.0;
    for format in [MapFormat::Depth32Float, MapFormat::R32Float] {
        for (depth, near, far) in [(DepthConvention::ZeroToOne, 0.0, 1.0), (DepthConvention::Reversed, 1.0, 0.0)] {
            for depth_clamp in [false, true] {
                let filter = FilterKind::Point;
                let resolution = [TEXELS; 2];
                let other = ShadowMapDescriptor::default();
                let descriptor =
                    ShadowMapDescriptor { resolution, maps: 1, format, filter, depth, depth_clamp, ..other };
                for (point, answer) in plane().iter().zip(answers_under(BEFORE_THE_NEAR_PLANE, &descriptor)) {
                    let is_kept = depth_clamp && is_under_the_caster(point);
                    let (factor, stored) = if is_kept { (0.0, near) } else { (1.0, far) };
                    // Shaders may treat denormal numbers as zero. Where they find a depth by comparisons, a
                    // stored zero may come back as any denormal number.
                    let is_there = (answer.stored - stored).abs() < f32::MIN_POSITIVE;
                    assert!(answer.factor == factor && is_there, "{descriptor:?} {point:?}: {answer:?}");
                }
            }
        }
    }
}
