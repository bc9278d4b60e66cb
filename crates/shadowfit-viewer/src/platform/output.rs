//! Text for the standard output and the standard error.

pub(crate) use shadowfit_study::{print, tell};
