//! Pictures with their errors marked, plots over the camera path, and the page that shows both.
//!
//! [`Output`] writes all of it into a folder, from a finished [`Run`](crate::run::Run).

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
