//! Where the near plane stands, so that every caster that can throw a shadow into view is kept.
//!
//! What can do so stands over the footprint, toward the light; [`Outline`] finds the part of each
//! caster's box that does.
//!
//! ```text
//!    toward the light          ┌──────┐
//!           ▲                  │caster│   only the part over the outline counts,
//!    near ──┼───────────────●──┤- - - │   so the plane stands at ●
//!           │     outline   │  └──────┘
//!           └───────────────┘
//! ```

use glam::{DVec2, DVec3};

use super::Content;
use super::outline::{Outline, Scratch};
use super::volume::ROUNDING;
use crate::axes::LightAxes;
use crate::light_fit::Constraint;
use crate::settings::{CasterPolicy, FitSettings};
use crate::view::moved;
use crate::{Aabb, Boxes};

/// Coordinate of the near plane along the light's z, and what set it if not the footprint.
pub(crate) struct NearPlane {
    pub(crate) z: f64,
    pub(crate) set_by: Option<Constraint>,
}

/// Places the near plane of a volume that so far ends at `covered` along the light's z.
///
/// `outline` is the convex outline of what is covered, anticlockwise, in the plane of `axes`;
/// casters that stand no farther beside it than `reach` (in metres) count too.
#[inline(always)]
pub(crate) fn place(
    covered: f64,
    axes: &LightAxes,
    outline: &[DVec2],
    content: &Content,
    settings: &FitSettings,
    reach: f64,
) -> NearPlane {
    let over = || Outline::new(axes, outline, reach);
    let extended = (covered + f64::from(settings.caster_extension), Constraint::CasterExtension);
    let (z, moved) = match (settings.casters, &content.casters) {
        (CasterPolicy::None | CasterPolicy::DepthClamp, _) => (covered, Constraint::Casters),
        (CasterPolicy::Extend, _) | (CasterPolicy::SceneBounds | CasterPolicy::List, None) => extended,
        (CasterPolicy::SceneBounds, Some(casters)) => {
            let all = casters.boxes.iter().filter(|b| !b.is_empty()).fold(Aabb::EMPTY, |a, b| a.union(*b));
            let all = Boxes { boxes: &[all], ..*casters };
            (highest(&over(), &all, content.origin, covered), Constraint::Casters)
        }
        (CasterPolicy::List, Some(casters)) => {
            (highest(&over(), casters, content.origin, covered), Constraint::Casters)
        }
    };
    NearPlane { z, set_by: if z > covered { Some(moved) } else { None } }
}

/// The greatest z of all casters over the outline, or `covered` where none reaches higher.
fn highest(over: &Outline, casters: &Boxes, origin: DVec3, covered: f64) -> f64 {
    let (offset, mut scratch) = (casters.origin - origin, Scratch::new());
    let mut z = covered;
    for aabb in casters.boxes.iter().filter(|aabb| !aabb.is_empty()) {
        let (min, max) = moved(aabb, offset);
        let farthest = min.abs().max(max.abs()).element_sum();
        let floor = z - farthest * ROUNDING;
        over.parts_over(min, max, floor, &mut scratch, |corner| {
            z = z.max(corner.z + corner.abs().element_sum() * ROUNDING);
        });
    }
    z
}

/// How far beside the outline casters are read by a filter that the kernel's margin is enough for,
/// in metres: a filter of reach E needs E - 1/2 texels of margin, and half a texel more is for the
/// rasteriser. `rounding` is what receivers and casters may be shifted by, each.
pub(crate) fn filter_reach(texel: DVec2, settings: &FitSettings, rounding: f64) -> f64 {
    let texels = (f64::from(settings.border_texels()) + 1.0) * texel.max_element();
    (texels + 2.0 * rounding) * ANY_AXES + f64::from(settings.margin)
}

/// How far an outline must be [widened](Outline) to hold it widened by the diagonal of a unit
/// square, whatever is held beyond that: √2 each.
const ANY_AXES: f64 = 2.0;
