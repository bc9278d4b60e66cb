//! Width of penumbrae: a straight edge over a plane across the light, from 5% to 95% of the light, compared
//! with the closed form for a light of uniform brightness.
//!
//! ```text
//!          light │││││││││││
//!                ▼▼▼▼▼▼▼▼▼▼▼
//!   y = h  ─────edge              what the light's disc shows of the sky beside the edge
//!                  ╲╱             is a segment of a circle of radius h · tan α
//!   y = 0  ────────plane────
//! ```

use shadowfit::glam::{DVec3, UVec2, Vec3};
use shadowfit::settings::{BiasSettings, FilterKind, FitKind, FitSettings, MapFormat, SoftRadius, Softness};
use shadowfit::{DepthConvention, LightProjection, ViewFrustum, fit};
use shadowfit_wgpu::ShadowMapDescriptor;

use super::engine::Engine;
use super::engine::points::Point;
use super::harness::{Harness, ROW};

/// Width of the map in texels.
const TEXELS: u32 = 512;
/// Rows of points across the edge.
const ROWS: usize = 160;

/// Returns the fit of a box of 6 m height under a vertical light, with texels of this size, rotated about the
/// light by an angle in radians.
fn turned_fit(texel: f32, angle: f32, depth: DepthConvention) -> LightProjection {
    let half = texel * TEXELS as f32 * 0.5;
    let (sine, cosine) = angle.sin_cos();
    let corner = |x: f32, y: f32, z: f32| {
        Vec3::new((x * cosine - z * sine) * half, if y > 0.0 { 5.0 } else { -1.0 }, (x * sine + z * cosine) * half)
    };
    let face = |z| [corner(-1.0, 1.0, z), corner(1.0, 1.0, z), corner(1.0, -1.0, z), corner(-1.0, -1.0, z)];
    let [near, far] = [face(1.0), face(-1.0)];
    let corners = core::array::from_fn(|i| if i < 4 { near[i] } else { far[i - 4] });
    let frustum = ViewFrustum { origin: DVec3::ZERO, corners, near: -half, far: half, forward: Vec3::NEG_Z };
    let settings = FitSettings::default()
        .with_kind(FitKind::Oriented)
        .with_caster_extension(0.0)
        .with_border(0.0)
        .with_resolution(UVec2::splat(TEXELS))
        .with_depth(depth);
    fit(&frustum, Vec3::NEG_Y, &settings).expect("a good fit")
}

/// Returns the half-plane x < 0 at a height, limited to the map.
fn edge(height: f32, texel: f32) -> Vec<Vec3> {
    let far = texel * TEXELS as f32;
    let corner = |x: f32, z: f32| Vec3::new(x, height, z);
    let [a, b, c, d] = [corner(-far, -far), corner(0.0, -far), corner(0.0, far), corner(-far, far)];
    vec![a, b, c, a, c, d]
}

/// A filter, and the map that it reads.
#[derive(Clone, Copy, Debug)]
struct Case {
    filter: FilterKind,
    softness: Softness,
    format: MapFormat,
    depth: DepthConvention,
    texel: f32,
    angle: f32,
}

/// Returns the width of the penumbra from 5% to 95% of the light, in metres, from means over the pixels along
/// the edge. `radius` is roughly the penumbra's radius.
fn width(case: &Case, height: f32, radius: f32) -> f32 {
    let Case { filter, softness, format, depth, texel, angle } = *case;
    let gpu = Engine::shared();
    let fit = turned_fit(texel, angle, depth);
    let map = ShadowMapDescriptor {
        resolution: [TEXELS; 2],
        maps: 1,
        format,
        filter,
        softness,
        depth,
        ..ShadowMapDescriptor::default()
    };
    let bias = BiasSettings::automatic(filter);
    let harness = Harness::new(&gpu, &map, DVec3::ZERO, &[fit], &bias, &[edge(height, texel)]);
    let reach = radius * 1.6 + texel;
    let across = |row: usize| ((row as f32 + 0.5) / ROWS as f32 * 2.0 - 1.0) * reach;
    let points: Vec<Point> = (0..ROWS * ROW as usize)
        .map(|i| {
            // Along the edge, no two points of a row have the same texel phase.
            let along = (i % ROW as usize) as f32 / ROW as f32 * 37.3 * texel;
            Point { position: [across(i / ROW as usize), 0.0, along], normal: [0.0, 1.0, 0.0] }
        })
        .collect();
    let factors = harness.turned(&points);
    let means: Vec<f32> = factors.chunks(ROW as usize).map(|row| row.iter().sum::<f32>() / ROW as f32).collect();
    let crossing = |level: f32| {
        let after = means.iter().position(|mean| *mean > level).expect("the edge is among the points");
        assert!(after > 0, "{case:?} at {height} m: the points begin inside the penumbra: {means:?}");
        let share = (level - means[after - 1]) / (means[after] - means[after - 1]);
        across(after - 1) + share * (across(after) - across(after - 1))
    };
    crossing(0.95) - crossing(0.05)
}

/// Returns the width of a penumbra for a disc of uniform brightness, in radii. The segment beyond a chord at
/// distance h from the centre has the share (acos h - h √(1 - h²)) / π.
fn closed_form() -> f32 {
    let (mut low, mut high) = (0.0_f64, 1.0_f64);
    for _ in 0..50 {
        let h = (low + high) * 0.5;
        let share = (h.acos() - h * (1.0 - h * h).sqrt()) / core::f64::consts::PI;
        *(if share > 0.05 { &mut low } else { &mut high }) = h;
    }
    (2.0 * low) as f32
}

/// Returns the softness of a sun with a radius in degrees, with wide bounds for the filter's radius.
fn sun(degrees: f32) -> Softness {
    Softness::default().with_radius(SoftRadius::SunAngle(degrees.to_radians())).with_floor(0.5).with_ceiling(64.0)
}

fn pcss(softness: Softness, texel: f32) -> Case {
    let (format, depth) = (MapFormat::Depth32Float, DepthConvention::ZeroToOne);
    Case { filter: FilterKind::Pcss, softness, format, depth, texel, angle: 0.0 }
}

/// Asserts that a penumbra has the width of the closed form, to 15%.
fn assert_physical(case: &Case, height: f32) {
    let radius = case.softness.tangent() * height;
    let ratio = width(case, height, radius) / (closed_form() * radius);
    println!("{case:?}, {height} m ({} texels): {ratio:.3} of the closed form", radius / case.texel);
    assert!((ratio - 1.0).abs() < 0.15, "{case:?}, {height} m: {ratio} of the closed form");
}

#[test]
fn pcss_penumbrae_are_as_wide_as_those_of_a_disc_of_light() {
    for (texel, heights) in [(0.005, &[0.5, 1.0, 2.0, 4.0][..]), (0.01, &[0.5, 1.0, 2.0, 4.0]), (0.02, &[2.0, 4.0])] {
        for height in heights {
            assert_physical(&pcss(sun(2.0), texel), *height);
        }
    }
}

#[test]
fn pcss_penumbrae_of_the_real_sun_are_as_wide_as_they_are() {
    for height in [0.5, 1.0, 2.0, 4.0] {
        assert_physical(&pcss(sun(0.267), 0.001_25), height);
    }
}

#[test]
fn pcss_penumbrae_are_the_same_in_every_format_depth_and_turn_of_the_map() {
    let plain = pcss(sun(2.0), 0.01);
    for format in [MapFormat::Depth16Unorm, MapFormat::R32Float, MapFormat::R16Float, MapFormat::Rgba8Packed] {
        assert_physical(&Case { format, ..plain }, 2.0);
    }
    assert_physical(&Case { depth: DepthConvention::Reversed, ..plain }, 2.0);
    for angle in [0.3, core::f32::consts::FRAC_PI_4] {
        assert_physical(&Case { angle, ..plain }, 2.0);
    }
}

#[test]
fn soft_edges_are_as_wide_in_maps_of_other_texels_and_turns() {
    let metres = Softness { radius: SoftRadius::Metres(0.08), ..sun(2.0) };
    for (filter, softness) in
        [(FilterKind::Vogel16, metres), (FilterKind::Vogel32, metres), (FilterKind::Pcss, sun(2.0))]
    {
        let width = |texel: f32, angle: f32| width(&Case { filter, angle, ..pcss(softness, texel) }, 2.5, 0.087);
        let widths = [(0.005, 0.0), (0.01, 0.0), (0.02, 0.0), (0.01, 0.3), (0.014, 0.8), (0.03, 0.5)]
            .map(|(texel, angle)| width(texel, angle));
        println!("{filter:?}: {widths:?} m");
        let (least, greatest) = widths.iter().fold((f32::MAX, 0.0_f32), |(low, high), w| (low.min(*w), high.max(*w)));
        assert!(greatest / least < 1.1, "{filter:?}: {widths:?}");
    }
}

#[test]
fn what_stands_on_the_plane_has_a_sharp_edge_and_shadows_of_what_is_high_are_soft_beside_it() {
    let case = pcss(sun(2.0), 0.01);
    let (low, high) = (width(&case, 0.05, 0.02), width(&case, 4.0, 0.14));
    assert!(low < 0.03 && high > 0.18, "{low} m and {high} m");
}
