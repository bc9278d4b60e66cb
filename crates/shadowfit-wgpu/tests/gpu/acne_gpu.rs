//! Slanted planes do not shadow themselves with the automatic bias, with any filter and format.
//!
//! One map contains patches of planes with many slopes, far enough apart that no filter reads two of them.

use shadowfit::DepthConvention;
use shadowfit::glam::{DVec3, Vec3};
use shadowfit::settings::{BiasSettings, FilterKind, MapFormat, SoftRadius, Softness};
use shadowfit_testing::pairs::{all_pairs, full_product};
use shadowfit_wgpu::ShadowMapDescriptor;

use super::engine::Engine;
use super::engine::points::Point;
use super::exact_counts_gpu::box_fit;
use super::harness::{Harness, ROW};

/// Half the width of a patch across the light, in metres: ten texels.
const HALF: f32 = 0.6;
/// Slopes of the patches, in degrees from level.
const TILTS: [f32; 5] = [0.0, 20.0, 45.0, 65.0, 74.0];
/// Azimuths of the slopes, in degrees.
const AZIMUTHS: [f32; 5] = [0.0, 26.0, 45.0, 160.0, 290.0];

/// Returns the centre and unit normal of each patch.
fn patches() -> Vec<(Vec3, Vec3)> {
    let places = [-6.0, -3.0, 0.0, 3.0, 6.0];
    let patch = |row: usize, column: usize| {
        let (tilt, azimuth) = (TILTS[row].to_radians(), AZIMUTHS[column].to_radians());
        let normal = Vec3::new(tilt.sin() * azimuth.cos(), tilt.cos(), tilt.sin() * azimuth.sin());
        (Vec3::new(places[column] + 0.01, 1.5, places[row] + 0.02), normal)
    };
    (0..5).flat_map(|row| (0..5).map(move |column| patch(row, column))).collect()
}

/// Returns the point of a patch's plane at a position across the light, relative to its centre.
fn on_plane((middle, normal): (Vec3, Vec3), x: f32, z: f32) -> Vec3 {
    middle + Vec3::new(x, -(normal.x * x + normal.z * z) / normal.y, z)
}

fn casters() -> Vec<Vec3> {
    let corners =
        |patch| [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, z]| on_plane(patch, x * HALF, z * HALF));
    patches().into_iter().map(corners).flat_map(|[a, b, c, d]| [a, b, c, a, c, d]).collect()
}

fn points() -> Vec<Point> {
    let step = |i: u16, ratio: f32| ((f32::from(i) * ratio).fract() * 2.0 - 1.0) * (HALF - 0.02);
    let of_patch = |patch: (Vec3, Vec3)| {
        let point = move |i: u16| Point {
            position: on_plane(patch, step(i, 0.754_877_7), step(i, 0.569_840_3)).to_array(),
            normal: patch.1.to_array(),
        };
        (0..400).map(point)
    };
    patches().into_iter().flat_map(of_patch).collect()
}

/// Number of formats, filters and depth conventions.
const COUNTS: [usize; 3] = [MapFormat::ALL.len(), FilterKind::ALL.len(), 2];

#[test]
fn slanted_planes_are_lit_with_the_automatic_bias_of_every_filter_and_format() {
    assert_lit(&all_pairs(&COUNTS));
}

#[test]
#[ignore = "the full product of formats, filters and depths: cargo xtask test --all"]
fn slanted_planes_are_lit_in_the_full_product_of_formats_filters_and_depths() {
    assert_lit(&full_product(&COUNTS));
}

/// Least factor of a fully lit point: the mean of samples is a division, exact to 2.5 ULP.
const LIT: f32 = 1.0 - 2.5 * f32::EPSILON;

/// Asserts that slanted planes are lit in maps of the given formats, filters and depth conventions, by index.
fn assert_lit(rows: &[Vec<usize>]) {
    let gpu = Engine::shared();
    let (points, casters) = (points(), casters());
    for row in rows {
        let (format, filter) = (MapFormat::ALL[row[0]], FilterKind::ALL[row[1]]);
        let depth = [DepthConvention::ZeroToOne, DepthConvention::Reversed][row[2]];
        let softness = Softness::default().with_radius(SoftRadius::SunAngle(0.02));
        let map = ShadowMapDescriptor {
            resolution: [ROW; 2],
            maps: 1,
            format,
            filter,
            depth,
            softness,
            ..ShadowMapDescriptor::default()
        };
        let (fit, bias) = (box_fit(depth), BiasSettings::automatic(filter));
        let harness = Harness::new(&gpu, &map, DVec3::ZERO, &[fit], &bias, std::slice::from_ref(&casters));
        let factors = harness.turned(&points);
        let dark: Vec<_> = factors.iter().zip(&points).filter(|(factor, _)| **factor < LIT).collect();
        assert!(dark.is_empty(), "{format:?} {filter:?} {depth:?}: {} points, as {:?}", dark.len(), dark[0]);
    }
}

#[test]
fn the_same_planes_shadow_themselves_without_a_bias() {
    let gpu = Engine::shared();
    let none = BiasSettings { constant: 0.0, slope: 0.0, normal_offset: 0.0, receiver_plane: 0.0, depth_steps: 0.0 };
    for filter in FilterKind::ALL {
        let map = ShadowMapDescriptor { resolution: [ROW; 2], maps: 1, filter, ..ShadowMapDescriptor::default() };
        let harness = Harness::new(&gpu, &map, DVec3::ZERO, &[box_fit(map.depth)], &none, &[casters()]);
        let dark = harness.turned(&points()).iter().filter(|factor| **factor < 1.0).count();
        assert!(dark > 2000, "{filter:?}: {dark} points");
    }
}
