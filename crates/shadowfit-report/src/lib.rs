//! Measures the errors of sun shadows against rays: the library of the program `shadowfit-report`.
//!
//! | module | purpose |
//! |---|---|
//! | [`contestant`] | judges the pictures of any renderer, or its matrices |
//! | [`engines`] | the shadow fits of Bevy, three.js and Babylon.js |
//! | [`peers`] | reads files of scenarios and of fits, and ranks the fits by how well their maps cover and sample |
//! | [`geometry`] | reads the triangles of the scenarios |
//! | [`run`], [`tables`] | the data of a finished report, as Markdown and as JSON |
//! | `page` (feature `page`) | marked pictures, plots, and the page that shows them |
//!
//! The default feature `program` builds the program, which uses the viewer's renderer. Other renderers turn
//! it off:
//!
//! ```toml
//! shadowfit-report = { path = "../shadowfit-report", default-features = false, features = ["page"] }
//! ```

pub mod contestant;
pub mod engines;
pub mod geometry;
mod markdown;
#[cfg(feature = "page")]
pub mod page;
pub mod peers;
pub mod run;
pub mod tables;

#[cfg(any(test, fuzzing))]
#[doc(hidden)]
pub mod fuzzed {
    //! Functions for fuzzing. Other builds do not contain them.
    pub use crate::peers::fuzzed::fit_file;
}

pub use markdown::{markdown_table, readable};
