//! `cargo xtask web`: the viewer as a page. Its module is built twice: for WebGPU, and for browsers that have WebGL2 alone;
//! the page loads one of them. Any host serves the folder: all paths are relative, and no header is asked for.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use image::imageops::FilterType;

use crate::machine::WEB_TARGET;
use crate::process::{self, has_target, target_folder};

mod browser;
mod serve;

pub(crate) use browser::test;

/// The modules: a folder, and the feature of the viewer that it is built with.
const MODULES: [(&str, &str); 2] = [("webgpu", "webgpu"), ("webgl2", "webgl")];
/// The picture that is shown while the module is loaded, and its width in pixels.
const COVER: (&str, u32) = ("docs/images/scene-courtyard.png", 960);

/// Builds the page into `folder`, or serves it.
///
/// # Errors
/// When it cannot be built, written or served.
pub(crate) fn web(folder: Option<&Path>, port: u16) -> Result<()> {
    let is_served = folder.is_none();
    let folder = folder.map_or_else(|| process::root().join("out/web"), Path::to_owned);
    build(&folder, "web")?;
    if !is_served {
        return Ok(());
    }
    serve::serve(&folder, port, |address| {
        println!("serving on {address} until Ctrl+C");
        // Without a browser the address is all there is.
        let _ = open::that_detached(address);
    })
}

/// Builds the page with a profile.
fn build(folder: &Path, profile: &str) -> Result<()> {
    if !has_target(WEB_TARGET) {
        bail!("the page needs Rust's target {WEB_TARGET}: `rustup target add {WEB_TARGET}` brings it");
    }
    fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let mut sizes = String::new();
    for (name, feature) in MODULES {
        let bytes = module(&folder.join(name), feature, profile)?;
        // Writing to a String cannot fail.
        let _ = write!(sizes, "{name}: {bytes}, ");
    }
    // The page shows how much of its module has arrived, which compressed answers do not tell.
    fs::write(folder.join("sizes.js"), format!("export const sizes = {{ {sizes}}};\n"))?;
    for entry in fs::read_dir(process::root().join("crates/shadowfit-viewer/web"))? {
        let file = entry?.path();
        fs::copy(&file, folder.join(file.file_name().unwrap_or_default()))?;
    }
    cover(&folder.join("cover.jpg"))?;
    println!("the page is in {}", folder.display());
    Ok(())
}

/// Builds a module with its JavaScript, and returns its bytes.
fn module(folder: &Path, feature: &str, profile: &str) -> Result<u64> {
    let mut compiler = process::cargo("rustc");
    compiler.args(["--package", "shadowfit-viewer", "--lib", "--crate-type", "cdylib", "--profile", profile]);
    compiler.args(["--target", WEB_TARGET, "--no-default-features", "--features", feature]);
    process::run(&mut compiler)?;
    // Cargo names the folder of its profile `dev` otherwise.
    let profile = if profile == "dev" { "debug" } else { profile };
    let built = target_folder().join(WEB_TARGET).join(profile).join("shadowfit_viewer.wasm");
    let mut bindgen = process::cargo("run");
    bindgen.args(["--quiet", "--package", "xtask", "--features", "bindgen", "--bin", "bindgen", "--"]);
    process::run(bindgen.arg(&built).arg(folder))?;
    Ok(fs::metadata(folder.join("shadowfit_viewer_bg.wasm"))?.len())
}

/// Writes the picture that is shown first.
fn cover(file: &Path) -> Result<()> {
    let (picture, width) = COVER;
    let picture = image::open(process::root().join(picture))?.into_rgb8();
    let height = picture.height() * width / picture.width();
    image::imageops::resize(&picture, width, height, FilterType::Triangle).save(file)?;
    Ok(())
}
