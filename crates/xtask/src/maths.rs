//! `cargo xtask maths`: draws the pictures of docs/MATHS.md with the core crate's own fits.
//!
//! Every shape is what a fit gave, seen from the light or from the side, so a picture cannot differ from what the code
//! does. The core gives the same bits on every machine, and so do these drawings: a test compares the committed files
//! with what is drawn now.

mod axes;
mod bias;
mod calipers;
mod canvas;
mod clusters;
mod culling;

mod diagnostics;
mod family;
mod focused;
mod hold;
mod near_plane;
mod scene;
mod sphere;
mod splits;
mod visible_splits;
mod windows;
mod windows_pan;
mod xna;

use anyhow::{Context, Result};

use crate::process;

/// Where the pictures are kept, relative to the workspace's folder.
const IMAGES: &str = "docs/images/maths";

/// A picture's file name without its ending, and what draws it.
type Picture = (&'static str, fn() -> Result<String>);

/// All pictures, in the order of the page.
const PICTURES: [Picture; 16] = [
    ("family", family::draw),
    ("axes", axes::draw),
    ("xna", xna::draw),
    ("calipers", calipers::draw),
    ("sphere", sphere::draw),
    ("focused", focused::draw),
    ("clusters", clusters::draw),
    ("near_plane", near_plane::draw),
    ("splits", splits::draw),
    ("visible_splits", visible_splits::draw),
    ("windows", windows::draw),
    ("windows_pan", windows_pan::draw),
    ("hold", hold::draw),
    ("culling", culling::draw),
    ("bias", bias::draw),
    ("diagnostics", diagnostics::draw),
];

/// Draws all pictures.
///
/// # Errors
/// When a fit is refused or a file cannot be written.
pub(crate) fn maths() -> Result<()> {
    let folder = process::root().join(IMAGES);
    std::fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
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
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn the_committed_pictures_are_what_the_code_draws() {
        let folder = process::root().join(IMAGES);
        let is_stale = |(name, draw): &Picture| {
            let drawn = draw().unwrap();
            std::fs::read_to_string(folder.join(name).with_extension("svg"))
                .is_ok_and(|kept| kept == drawn)
                .then_some(())
        };
        let stale: Vec<&str> = PICTURES.iter().filter(|p| is_stale(p).is_none()).map(|(name, _)| *name).collect();
        assert!(stale.is_empty(), "{IMAGES} has old pictures: run `cargo xtask maths` and look at {stale:?}");
    }

    #[test]
    fn the_page_shows_every_picture_and_no_other() {
        let page = std::fs::read_to_string(process::root().join("docs/MATHS.md")).unwrap();
        let shown: BTreeSet<&str> = page
            .split("(images/maths/")
            .skip(1)
            .filter_map(|rest| rest.split_once(".svg)").map(|(name, _)| name))
            .collect();
        let drawn: BTreeSet<&str> = PICTURES.iter().map(|(name, _)| *name).collect();
        assert_eq!(shown, drawn);
        let files = std::fs::read_dir(process::root().join(IMAGES)).unwrap();
        assert_eq!(files.count(), drawn.len(), "{IMAGES} holds files that nothing draws");
    }
}
