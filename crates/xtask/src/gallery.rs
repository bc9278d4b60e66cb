//! `cargo xtask gallery`: renders the pictures that the README and the docs show, on the software driver, so that they
//! change with the code and not with the machine.

use std::fs;
use std::path::Path;
use std::process::Stdio;

use anyhow::{Context, Result};

use crate::process;
use crate::run;
use crate::setup::{self, Purpose};

/// Where the docs keep their pictures, relative to the workspace's folder.
const IMAGES: &str = "docs/images";

/// Size of a picture of the docs in pixels: half of full HD each way, wide enough to see single shadow texels.
const SIZE: &str = "960x540";

/// The view that errors are shown in, relative to the workspace's folder.
const ERROR_VIEW: &str = "docs/report.toml";

/// Techniques whose errors are shown, by their places in the report and their names.
const TECHNIQUES: [(usize, &str); 2] = [(0, "xna-1"), (1, "windows-4")];

/// Renders the docs' pictures.
///
/// # Errors
/// When the viewer or the report cannot be built, or ends with an error.
pub(crate) fn gallery() -> Result<()> {
    let machine = setup::prepare(Purpose::Pictures)?;
    let images = process::root().join(IMAGES);
    process::run(run::viewer(&machine).arg("--headless").arg(&images).args(["--size", SIZE, "--software"]))?;
    errors(&images)?;
    run::say_where(&images);
    Ok(())
}

/// The errors and the texels of techniques in one view, as the report marks them.
fn errors(images: &Path) -> Result<()> {
    let out = process::root().join("target/gallery-report");
    let mut report = process::cargo("run");
    report.args(["--release", "--quiet", "--example", "report", "--", "courtyard", "--software", "--size", SIZE]);
    report.arg("--path").arg(process::root().join(ERROR_VIEW)).arg("-o").arg(&out);
    for (_, technique) in TECHNIQUES {
        report.args(["--technique", technique]);
    }
    process::run(report.stdout(Stdio::null()))?;
    for (place, technique) in TECHNIQUES {
        for (kind, name) in [("overlay", "errors"), ("heat", "heat")] {
            let from = out.join(format!("pictures/{place}-{technique}-path-0-{kind}.png"));
            let to = images.join(format!("{name}-{technique}.png"));
            fs::copy(&from, &to).with_context(|| format!("{}: cannot be copied", from.display()))?;
        }
    }
    Ok(())
}
