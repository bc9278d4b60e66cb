//! Ray-traced reference shadows, and the errors of a shadow map judged against them.
//!
//! It takes plain triangle slices (world space, right-handed, metres) and an alpha test, so that
//! any engine can be judged: [`Tracer`] answers rays, [`judge`] sorts the pixels of a picture into
//! right ones and the named kinds of wrong ones, and [`peers`] ranks fits by what their maps give to
//! many frames.

mod camera;
mod classes;
mod edges;
pub mod peers;
mod tracer;

pub use camera::PixelCamera;
pub use classes::{Class, JudgeSettings, Judged, Shares, Surface, judge};
pub use tracer::{Hit, Tracer};
