//! `cargo xtask maths`: draws those pictures of docs/MATHS.md that show what the core crate's fits give.
//!
//! Sizes and counts in them are results, which change with the code. The core gives the same bits on every machine, and so
//! do these drawings: a test compares the committed files with new drawings. The page's other pictures show
//! definitions, and are kept as they are.

mod canvas;
mod family;
mod hold;
mod scene;
mod windows;
mod windows_pan;

use anyhow::{Context, Result};

use crate::process;

/// Where the pictures are kept, relative to the workspace's folder.
const IMAGES: &str = "docs/images/maths";

/// A picture's file name without its ending, and what draws it.
type Picture = (&'static str, fn() -> Result<String>);

/// The pictures that are drawn, in the order of the page.
const PICTURES: [Picture; 4] =
    [("family", family::draw), ("windows", windows::draw), ("windows_pan", windows_pan::draw), ("hold", hold::draw)];

/// Draws them.
///
/// # Errors
/// When a fit is refused or a file cannot be written.
pub(crate) fn maths() -> Result<()> {
    let folder = process::root().join(IMAGES);
    for (name, draw) in PICTURES {
        let path = folder.join(name).with_extension("svg");
        let svg = draw().with_context(|| format!("cannot draw {name}"))?;
        std::fs::write(&path, svg).with_context(|| format!("cannot write {}", path.display()))?;
    }
    println!("{} pictures in {}", PICTURES.len(), folder.display());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_committed_pictures_are_what_the_code_draws() {
        let kept = |name: &str| std::fs::read_to_string(process::root().join(IMAGES).join(name).with_extension("svg"));
        let is_stale = |(name, draw): &Picture| kept(name).unwrap() != draw().unwrap();
        let stale: Vec<&str> = PICTURES.into_iter().filter(is_stale).map(|(name, _)| name).collect();
        assert!(stale.is_empty(), "{IMAGES} has old pictures: run `cargo xtask maths` and look at {stale:?}");
    }
}
