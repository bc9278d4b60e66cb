//! What a map provably holds of the views, and so which part of them reads a map by coverage: what no finer one holds.

use glam::{DVec2, DVec3, DVec4, Vec3};

use crate::base::numbers::VIEW_DEPTH_ROUNDING;
use crate::fits::LightFit;
use crate::map::FittedMap;
use crate::selection::{MapOrder, MapReading};
use crate::technique::settings::{MAX_MAPS, MapChoice};
use crate::view::ViewFrustum;

/// Greatest rounding error of texture coordinates in a shader, as a share of the terms that they are summed from:
/// eight roundings of 2⁻²⁴, two of the position, one each of the matrix and the product, and four of the sum.
const UV_ROUNDING: f64 = 8.0 / 16_777_216.0;

/// Halvings of the views' depths in the search for what a finer map holds: to a four thousandth of them.
const HALVINGS: u32 = 12;

/// From where maps are read: what the positions and view depths in a shader are counted from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reader {
    /// World position that the shader's positions are relative to, in metres.
    pub origin: DVec3,
    /// World position of the eye that view depths are counted from, in metres.
    pub eye: DVec3,
    /// Unit direction in which that eye looks, world axes.
    pub forward: Vec3,
}

impl Reader {
    /// Positions and view depths relative to an eye that looks along `forward` (unit, world axes).
    pub const fn from_eye(eye: DVec3, forward: Vec3) -> Self {
        Self { origin: eye, eye, forward }
    }
}

/// For each map the view depths, in metres, from which points of the views read it, in the order of `maps`; `None`
/// where no point does.
///
/// Points nearer than that are held by a finer map, with the filter's reach and the blend, whatever a shader rounds.
/// From there on a map is read at any depth, wherever it holds a point that the finer ones leave out.
pub(super) fn read_from(
    maps: &[FittedMap],
    reader: &Reader,
    views: &[ViewFrustum],
    reading: &MapReading,
) -> [Option<f32>; MAX_MAPS] {
    let free = f64::from(reading.softness.reach(reading.filter) + reading.blend);
    let mut from = [None; MAX_MAPS];
    // Up to where the finer maps hold all.
    let mut held = f32::MIN;
    for index in MapOrder::new(MapChoice::Coverage, maps.iter().map(|map| &map.fit)).iter() {
        from[index] = (held < f32::MAX).then_some((held - held.abs() * VIEW_DEPTH_ROUNDING).max(f32::MIN));
        held = held_to(&maps[index], reader, views, free, held);
    }
    from
}

/// View depth up to which a map holds all that the views have from a depth on, in metres, with so many texels around
/// it; that depth where it does not.
fn held_to(map: &FittedMap, reader: &Reader, views: &[ViewFrustum], free: f64, from: f32) -> f32 {
    let fit = map.fit.relative_to(reader.origin);
    let holds = |far: f32| holds_slice(&fit, reader, views, [from, far], free);
    let near = views.iter().map(|view| view.near).fold(f32::MAX, f32::min);
    let far = views.iter().map(|view| view.far).fold(f32::MIN, f32::max);
    if holds(far) {
        return f32::MAX;
    }
    let near = near.max(from);
    let (mut held, mut beyond) = (near, far);
    for _ in 0..HALVINGS {
        let middle = held + (beyond - held) * 0.5;
        *(if holds(middle) { &mut held } else { &mut beyond }) = middle;
    }
    // Where it holds nothing, no depth has been found.
    if held > near { held } else { from }
}

/// Whether a map, relative to the reader's origin, provably holds everything that the views have between two view depths,
/// with so many texels around it.
pub(super) fn holds_slice(
    fit: &LightFit,
    reader: &Reader,
    views: &[ViewFrustum],
    [near, far]: [f32; 2],
    free: f64,
) -> bool {
    let holds_part = |frustum: &ViewFrustum| {
        let offset = frustum.origin - reader.origin;
        // A view without a part between these depths has no point to be held.
        frustum
            .slice(near, far)
            .map_or(true, |part| part.corners.iter().all(|corner| covers(fit, corner.as_dvec3() + offset, free)))
    };
    views.iter().all(holds_part)
}

/// Whether a map holds a point, relative to its origin, with so many texels around it, for any rounding in a shader.
/// The map is convex, so that with the corners of a slice it holds the slice.
fn covers(fit: &LightFit, point: DVec3, free: f64) -> bool {
    let m = fit.uv_from_world.as_dmat4();
    let terms = [m.x_axis * point.x, m.y_axis * point.y, m.z_axis * point.z, m.w_axis].map(DVec4::truncate);
    let uv: DVec3 = terms.iter().sum();
    let rounding = terms.iter().map(|term| term.abs()).sum::<DVec3>() * UV_ROUNDING;
    let border = rounding + (DVec2::splat(free) / fit.resolution.as_dvec2()).extend(0.0);
    uv.cmpge(border).all() && uv.cmple(DVec3::ONE - border).all()
}
