//! How wrong sun shadows are, measured against rays: the library of the program `shadowfit-report`.
//!
//! | module | purpose |
//! |---|---|
//! | [`contestant`] | judges the pictures of any renderer, or its matrices |
//! | [`peers`] | reads files of scenarios and of fits, and ranks the fits by what their maps cover and sample |
//! | [`geometry`] | reads the triangles of the scenarios |
//! | [`run`], [`tables`] | the data of a finished report, as Markdown and as JSON |
//! | `page` (feature `page`) | marked pictures, plots, and the page that shows them |
//!
//! The feature `program`, which is on by default, builds the program, which draws with the renderer of the viewer.
//! Other renderers turn it off:
//!
//! ```toml
//! shadowfit-report = { path = "../shadowfit-report", default-features = false, features = ["page"] }
//! ```

pub mod contestant;
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
    //! Functions that fuzzing calls; no other build has them.
    pub use crate::peers::fuzzed::fit_file;
}

pub use markdown::{markdown_table, readable};
