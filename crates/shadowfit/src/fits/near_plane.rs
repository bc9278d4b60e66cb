//! Placement of the near plane, so that every caster that can cast a shadow into view is kept.
//!
//! Such casters lie over the covered region, toward the light. [`Outline`] finds the part of each caster's
//! box over it.
//!
//! ```text
//!    toward the light          ┌──────┐
//!           ▲                  │caster│   only the part over the outline counts,
//!    near ──┼───────────────●──┤- - - │   so the plane stands at ●
//!           │     outline   │  └──────┘
//!           └───────────────┘
//! ```

use glam::{DVec2, DVec3, Vec2Swizzles};

use crate::base::checks::ROUNDING;
use crate::content::{Bounds, Content, Found, Query, Visit};
use crate::fits::covered::Shadowed;
use crate::fits::{Alignment, Depth, FitRule};
use crate::light::{BoundSource, LightAxes, Outline, OutlineScratch, Volume};

/// Coordinate of the near plane along the light's z, and its source unless it is the covered region.
pub(crate) struct NearPlane {
    pub(crate) z: f64,
    pub(crate) from: Option<BoundSource>,
}

/// Moves the near plane of a volume from the covered region to the position that the rule gives, and the
/// light with it. `rounding` is the greatest shift of receivers, and of casters, by rounding, in metres.
#[inline(always)]
pub(crate) fn place(volume: &mut Volume, rule: &FitRule, shadowed: Shadowed, rounding: f64, content: &Content) {
    if rule.depth == Depth::Doubled {
        volume.light_z = volume.min.z;
        volume.depth_range = 2.0 * (volume.max.z - volume.min.z);
        return;
    }
    let texel = (volume.max - volume.min).truncate() / rule.resolution.as_dvec2();
    let reach = filter_reach(texel, rule, rounding);
    let (min, max) = (volume.min.truncate(), volume.max.truncate());
    let near = match shadowed {
        Shadowed::Outline(axes, outline) if !rule.serves_all => {
            find(volume.max.z, &axes, outline, content, rule.depth, reach)
        }
        _ => find_over(volume.max.z, &volume.axes, min, max, content, rule.depth, reach),
    };
    if rule.serves_all {
        let far = find_far(volume.min.z, &volume.axes, min, max, content);
        volume.bounds_from[4] = if far < volume.min.z { BoundSource::Receivers } else { volume.bounds_from[4] };
        volume.min.z = far;
    }
    (volume.max.z, volume.bounds_from[5]) = (near.z, near.from.unwrap_or(volume.bounds_from[5]));
    if rule.form.alignment != Alignment::OnGrid {
        // Rounding of the depth range, which casters may make far longer than the covered region. On the grid
        // the steps include it.
        let depth = (volume.max.z - volume.min.z) * ROUNDING;
        (volume.min.z, volume.max.z) = (volume.min.z - depth, volume.max.z + depth);
    }
    volume.light_at_near_plane();
}

/// Finds the near plane for a covered region that ends at `covered` along the light's z.
///
/// `outline` is the convex outline of the covered region, anticlockwise, in the plane of `axes`. Casters up
/// to `reach` metres outside it count too.
#[inline(always)]
pub(crate) fn find(
    covered: f64,
    axes: &LightAxes,
    outline: &[DVec2],
    content: &Content,
    depth: Depth,
    reach: f64,
) -> NearPlane {
    let (z, from) = match depth {
        Depth::AtCovered | Depth::Doubled => return NearPlane { z: covered, from: None },
        Depth::Extended(metres) => (covered + metres, BoundSource::CasterExtension),
        Depth::AtCasterBounds => {
            let mut highest = Highest::new(axes, outline, reach, covered);
            if let Some((min, max)) = content.caster_bounds() {
                highest.add(min, max);
            }
            (highest.z, BoundSource::Casters)
        }
        Depth::AtCasters => {
            let mut highest = Highest::new(axes, outline, reach, covered);
            content.visit(Query::Casters, &mut highest);
            (highest.z, BoundSource::Casters)
        }
    };
    NearPlane { z, from: (z > covered).then_some(from) }
}

/// Finds the near plane like [`find`], over a whole map, given by its corners across the light.
pub(crate) fn find_over(
    covered: f64,
    axes: &LightAxes,
    min: DVec2,
    max: DVec2,
    content: &Content,
    depth: Depth,
    reach: f64,
) -> NearPlane {
    find(covered, axes, &corners(min, max), content, depth, reach)
}

/// Finds the far plane of a map, given by its corners across the light, whose covered region begins at
/// `covered` along the light's z. It is far enough for the receivers in view over the whole map, since points
/// of all view depths read it, but no farther than [`FARTHER`] allows.
pub(crate) fn find_far(covered: f64, axes: &LightAxes, min: DVec2, max: DVec2, content: &Content) -> f64 {
    let longer = (max - min).max_element();
    // Seen from below: the lowest point is the highest there, and x and y are swapped.
    let from_below = LightAxes { x: axes.y, y: axes.x, z: -axes.z };
    let corners = corners(min.yx(), max.yx());
    let mut lowest = Highest::new(&from_below, &corners, 0.0, -covered);
    content.whole_views().for_each(|part| content.visit(Query::Lit(&part), &mut lowest));
    (-lowest.z).max(covered - longer * FARTHER)
}

/// Greatest distance of the far plane beyond the covered region, in extents of the map. Under a low sun,
/// level ground continues this far below the map.
const FARTHER: f64 = 2.0;

/// Returns the corners of a rectangle along the axes, anticlockwise.
fn corners(min: DVec2, max: DVec2) -> [DVec2; 4] {
    [(min.x, min.y), (max.x, min.y), (max.x, max.y), (min.x, max.y)].map(|(x, y)| DVec2::new(x, y))
}

/// The greatest z of casters over an outline, or of the covered region if no caster reaches higher.
struct Highest<'a> {
    over: Outline<'a>,
    scratch: OutlineScratch,
    z: f64,
}

impl<'a> Highest<'a> {
    fn new(axes: &LightAxes, outline: &'a [DVec2], reach: f64, covered: f64) -> Self {
        Self { over: Outline::new(axes, outline, reach), scratch: OutlineScratch::new(), z: covered }
    }

    /// Returns the height that a box must exceed to count.
    fn floor(&self, min: DVec3, max: DVec3) -> f64 {
        self.z - min.abs().max(max.abs()).element_sum() * ROUNDING
    }

    fn add(&mut self, min: DVec3, max: DVec3) {
        let (floor, z) = (self.floor(min, max), &mut self.z);
        self.over.parts_over(min, max, floor, &mut self.scratch, |corner| {
            *z = z.max(corner.z + corner.abs().element_sum() * ROUNDING);
        });
    }
}

impl Visit for Highest<'_> {
    /// Returns whether a part of a box may lie higher than all parts so far.
    #[inline(always)]
    fn wants(&self, bounds: &Bounds) -> bool {
        self.over.may_hold(bounds.min, bounds.max, self.floor(bounds.min, bounds.max))
    }

    #[inline(always)]
    fn take(&mut self, Found { bounds, .. }: &Found) {
        self.add(bounds.min, bounds.max);
    }
}

/// Returns the distance outside the outline within which the widest filter that the border allows reads
/// casters, in metres. A filter of radius E needs E - 1/2 texels of border, and the rasteriser needs half a
/// texel more. `rounding` is the greatest shift of receivers, and of casters.
pub(crate) fn filter_reach(texel: DVec2, rule: &FitRule, rounding: f64) -> f64 {
    let texels = (rule.border + 1.0) * texel.max_element();
    (texels + 2.0 * rounding) * ANY_AXES + rule.margin
}

/// Factor for [widening an outline](Outline) so that it surely holds the outline widened by the diagonal of a
/// unit square: √2 each way.
const ANY_AXES: f64 = 2.0;
