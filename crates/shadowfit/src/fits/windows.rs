//! Windows: rectangles of the plane across the light that never turn, each where it helps most of what
//! is visible.
//!
//! ```text
//!   ┌───────────────────────────────┐ the last window holds everything in view
//!   │            ┌───────────────┐  │
//!   │  ┌─────┐   │               │  │ each of the others has finer texels than the next one,
//!   │  │ ┌─┐ │   │               │  │ and stands where visible points would read coarser
//!   │  │ └─┘ │   │               │  │ texels than they ask for
//!   │  └─────┘   └───────────────┘  │
//!   └───────────────────────────────┘
//! ```
//!
//! They are the maps of a whole [technique](crate::Technique), made by a
//! [`MapFitter`](crate::MapFitter) and read by [coverage](crate::choice): a point reads the finest window
//! that holds it.
//!
//! - **Texels** lie on a grid that is fixed to the world. Their width is a power of two in eighths of an
//!   octave; they are finer up the light's plane than along the horizon, by the sine of the light's
//!   elevation to the power of 0.62, since ground under a low sun is foreshortened so. Both depend on
//!   the light alone, so that windows neither turn nor stretch with the camera.
//! - **Need** says how fine a texel each visible point asks for, and where it lies: a
//!   [grid](crate::need::NeedGrid) of the last frame's depth buffer, or an estimate from the receivers'
//!   boxes ([`NeedSource`](crate::settings::NeedSource)).
//! - **The search** tries other texels for one window at a time, frame after frame, and puts each where it
//!   takes most of the cost; nobody sees it. A window that is drawn keeps its texels and stays where it
//!   is while it holds nearly as much as it could, and then makes the least move by whole texels.
//!   Only where the search has found something better by enough are windows replaced, one at a time.
//! - **Depth** reaches over all that casts and receives above and below a window, and is held too, so that
//!   what stands still need not be drawn again.
//!
//! What is not known costs sharpness, never coverage: the last window is made from the boxes in view,
//! whatever the need.
//!
//! [`fit`](crate::fit) and [`fit_scene`](crate::fits::fit_scene), which remember nothing and make one map,
//! put it tight around what is in view, along the light's own axes.
