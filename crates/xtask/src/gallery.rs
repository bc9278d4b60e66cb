//! `cargo xtask gallery`: renders the pictures that the README and the docs show, on the software driver, so that they
//! change with the code and not with the machine.

use anyhow::Result;

use crate::process;
use crate::run;
use crate::setup::{self, Purpose};

/// Where the docs keep their pictures, relative to the workspace's folder.
const IMAGES: &str = "docs/images";

/// Size of a picture of the docs in pixels: half of full HD each way, wide enough to see single shadow texels.
const SIZE: &str = "960x540";

/// Renders the docs' pictures.
///
/// # Errors
/// When the viewer cannot be built, or ends with an error.
pub(crate) fn gallery() -> Result<()> {
    let machine = setup::prepare(Purpose::Pictures)?;
    let images = process::root().join(IMAGES);
    process::run(run::viewer(&machine).arg("--headless").arg(&images).args(["--size", SIZE, "--software"]))?;
    run::say_where(&images);
    Ok(())
}
