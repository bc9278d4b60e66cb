//! Pictures with marked errors, plots along the camera path, and the page that shows both.
//!
//! [`Output`] writes them into a folder, from a finished [`Run`](crate::run::Run).

mod heat;
mod html;
mod output;
mod overlay;
mod plots;
pub mod plotting;
mod png;
mod strip;

pub use heat::heat;
pub use output::{FileWriter, Output, PAGE, PATH, PictureName};
pub use overlay::overlay;
