//! Draws the pictures of docs/MATHS.md that show results of the core crate's fits, for `cargo xtask generate`.
//!
//! Sizes and counts in them are results, which change with the code. The core gives the same bits on every machine, and so
//! do these drawings: `generate` compares the committed files with new drawings. The page's other pictures show
//! definitions, and are kept as they are.

mod canvas;
mod family;
mod hold;
mod scene;
mod windows;
mod windows_pan;

use anyhow::{Context, Result};

/// Where the pictures are kept, relative to the workspace's folder.
const IMAGES: &str = "docs/images/maths";

/// A picture's file name without its ending, and what draws it.
type Picture = (&'static str, fn() -> Result<String>);

/// The pictures that are drawn, in the order of the page.
const PICTURES: [Picture; 4] =
    [("family", family::draw), ("windows", windows::draw), ("windows_pan", windows_pan::draw), ("hold", hold::draw)];

/// Draws them, and returns their files' names, relative to the workspace's folder, with what these contain.
///
/// # Errors
/// When a fit is refused.
pub(crate) fn pictures() -> Result<Vec<(String, String)>> {
    let drawn = PICTURES.into_iter().map(|(name, draw)| {
        let svg = draw().with_context(|| format!("cannot draw {name}"))?;
        Ok((format!("{IMAGES}/{name}.svg"), svg))
    });
    drawn.collect()
}
