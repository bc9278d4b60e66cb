//! Draws the pictures of docs/MATHS.md that show results of the core crate's fits, for `cargo xtask
//! generate`.
//!
//! Sizes and counts in these pictures are results, which change with the code. The core gives the same bits
//! on every machine, and so do these drawings: `generate` compares the committed files with new drawings. The
//! page's other pictures show definitions and are edited by hand.

mod canvas;
mod family;
mod hold;
mod scene;
mod windows;
mod windows_pan;

use anyhow::{Context, Result};

/// Folder of the pictures, relative to the workspace's folder.
const IMAGES: &str = "docs/images/maths";

/// A picture's file name without extension, and the function that draws it.
type Picture = (&'static str, fn() -> Result<String>);

/// All pictures, in the order of the page.
const PICTURES: [Picture; 4] =
    [("family", family::draw), ("windows", windows::draw), ("windows_pan", windows_pan::draw), ("hold", hold::draw)];

/// Draws the pictures. Returns their file names, relative to the workspace's folder, and their contents.
///
/// # Errors
/// If a fit fails.
pub(crate) fn pictures() -> Result<Vec<(String, String)>> {
    let drawn = PICTURES.into_iter().map(|(name, draw)| {
        let svg = draw().with_context(|| format!("cannot draw {name}"))?;
        Ok((format!("{IMAGES}/{name}.svg"), svg))
    });
    drawn.collect()
}
