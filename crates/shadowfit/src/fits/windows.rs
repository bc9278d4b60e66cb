//! Windows: maps that are no slices of the view, but squares of the plane across the light, each put
//! where it helps most of what is visible. Sharp, and still: the
//! [recommended technique](crate::Technique) has four of them.
//!
//! ```text
//!   ┌───────────────────────────────────┐ last window: every receiver in view
//!   │            ┌─────────┐            │
//!   │   ┌────────┼─┐       │            │ a point reads the finest
//!   │   │  ┌──┐  │ │       │            │ window that holds it,
//!   │   │  │  │eye│        │            │ whatever its view depth
//!   │   │  └──┘  │ │       │            │
//!   │   └────────┼─┘       │            │
//!   │            └─────────┘            │
//!   └───────────────────────────────────┘
//! ```
//!
//! **Still.** A window never turns: its axes follow from the light alone. Its texels have a width from
//! a fixed ladder, 2^(k/8) metres, which it keeps as long as it serves, and lie on lines that are counted
//! from the world's origin in f64. So a window moves by whole texels, and what is in two frames of it is
//! rasterised alike. Depth ranges are held too. Under a low sun ground is foreshortened along one axis, so
//! texels are finer up the light's plane than along the horizon, by the sine of the light's elevation to the
//! power of 0.62, at least a quarter, rounded to eighths of an octave; the roll follows the horizon of
//! [`up`](crate::settings::FitSettings::up) then, and the shortest arc from straight down where
//! texels are square.
//!
//! **Sharp.** Each visible point asks for a texel that is as wide as the point's pixel along its
//! narrower axis, as the light sees it; [`need`](crate::need) counts points by place and by that
//! width s. A point that reads texels of width t costs (t / s)^(3/2), and the windows are to make the
//! sum small. Since t and s are separate factors, the best place for a window of a given size is where
//! the sum of s^(-3/2) over the points inside, those in finer windows left out, is greatest, whatever
//! its texels; all places are compared by sums over a raster. The sizes are searched one at a time,
//! frame after frame, in a plan that nobody sees, and in a second one that begins anew again and again. The
//! windows that are drawn move as little as they can, when they hold less than 98.5% of what they could, and
//! one of them is replaced by its counterpart in the plan when they cost 1.35 times as much as the plan, or 1.1
//! times for a second at 60 frames a second. Only in the frame in which it becomes known what is visible may
//! more of them be replaced at once.
//!
//! **Whole.** The last window holds the boxes of all receivers in view, and every window's depth range
//! holds all receivers' and casters' boxes over it, seen or not: what stands still need not be drawn
//! again ([`scroll`](crate::scroll)), and a late or wrong grid of need costs sharpness, never coverage.
//! Without a grid (the first frame, a camera cut, no depth buffer) what is visible is estimated by rays
//! through the boxes.
//!
//! Fitted by [`MapFitter`](crate::MapFitter), with
//! [`FitKind::Windows`](crate::settings::FitKind::Windows), and read by
//! [coverage](crate::choice). [`fit`](crate::fit) and [`fit_scene`](super::fit_scene), which know a
//! single map and no frame before, give that kind the rectangle of
//! [`FitKind::Focused`](crate::settings::FitKind::Focused) along the light's axes.
//!
//! The idea of maps nested around the eye on a grid fixed to the world is that of clipmaps (C. Tanner,
//! C. Migdal, M. Jones, "The clipmap: a virtual mipmap", 1998; F. Losasso and H. Hoppe, "Geometry
//! clipmaps", 2004); here sizes and places follow what is visible.
