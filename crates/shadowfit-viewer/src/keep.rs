//! State as text: the viewer's own file, links, command lines and pictures. Also undo.

pub(crate) mod command_line;
#[cfg(test)]
mod killed_tests;
pub(crate) mod link;
pub(crate) mod picture_file;
pub(crate) mod saved;
pub(crate) mod store;
pub(crate) mod undo;
