//! `cargo xtask web`: the viewer as a page. Its module is built twice: for WebGPU, and for browsers that have WebGL2 alone;
//! the page loads one of them. Tests build one module for both. Any host serves the folder: all paths are relative, and
//! the page needs no header.

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
/// The JavaScript of the second module where the first one has both features: it takes WebGPU where the browser has it.
const WITHOUT_WEBGPU: &str = "\
    Object.defineProperty(navigator, 'gpu', { value: undefined });\n\
    export * from '../webgpu/shadowfit_viewer.js';\n\
    export { default } from '../webgpu/shadowfit_viewer.js';\n";
/// The file of a module in its folder.
const MODULE: &str = "shadowfit_viewer_bg.wasm";
/// The picture that is shown while the module is loaded, and its width in pixels.
const COVER: (&str, u32) = ("docs/images/scene-courtyard.png", 960);

/// Builds the page into `folder`, or serves it.
///
/// # Errors
/// When it cannot be built, written or served.
pub(crate) fn web(folder: Option<&Path>, port: u16) -> Result<()> {
    let is_served = folder.is_none();
    let folder = folder.map_or_else(|| process::root().join("out/web"), Path::to_owned);
    build(&folder, Modules::Small)?;
    if !is_served {
        return Ok(());
    }
    serve::serve(&folder, port, |address| {
        println!("serving on {address} until Ctrl+C");
        // Without a browser the address is all there is.
        let _ = open::that_detached(address);
    })
}

/// How the modules of a page are built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Modules {
    /// Small ones, for people to load.
    Small,
    /// The module of tests, in as little time as possible.
    Quick,
}

/// Builds the page into `folder`.
fn build(folder: &Path, modules: Modules) -> Result<()> {
    if !has_target(WEB_TARGET) {
        bail!("the page needs Rust's target {WEB_TARGET}: `rustup target add {WEB_TARGET}` brings it");
    }
    fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    match modules {
        Modules::Small => {
            for (name, feature) in MODULES {
                module(&folder.join(name), feature, &["--profile", "web"])?;
            }
        }
        Modules::Quick => quick_module(folder)?,
    }
    let mut sizes = String::new();
    for (name, _) in MODULES {
        let bytes = fs::metadata(folder.join(name).join(MODULE))?.len();
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

/// Builds a module with its JavaScript.
fn module(folder: &Path, features: &str, options: &[&str]) -> Result<()> {
    let mut compiler = process::cargo("rustc");
    compiler.args(["--package", "shadowfit-viewer", "--lib", "--crate-type", "cdylib"]).args(options);
    compiler.args(["--target", WEB_TARGET, "--no-default-features", "--features", features]);
    // Cargo names the folder of its profile `dev` otherwise.
    let profile = if options.contains(&"web") { "web" } else { "debug" };
    if profile == "debug" && process::succeeds(process::cargo("clippy").arg("--version")) {
        // Code for browsers alone is linted nowhere else.
        process::with_lints(&mut compiler);
    }
    process::run(&mut compiler)?;
    let built = target_folder().join(WEB_TARGET).join(profile).join("shadowfit_viewer.wasm");
    let mut bindgen = process::cargo("run");
    bindgen.args(["--quiet", "--package", "xtask", "--features", "bindgen", "--bin", "bindgen", "--"]);
    process::run(bindgen.arg(&built).arg(folder))
}

/// Builds one module for both APIs, with little optimisation, because the stack of WebAssembly has 1 MiB.
fn quick_module(folder: &Path) -> Result<()> {
    let [(first, _), (second, _)] = MODULES.map(|(name, feature)| (folder.join(name), feature));
    let features = MODULES.map(|(_, feature)| feature).join(",");
    let settings = ["debug=false", "opt-level=1", "package.wgpu-core.opt-level=1", "package.wgpu-hal.opt-level=1"];
    let settings = settings.map(|setting| format!("profile.dev.{setting}"));
    let options: Vec<&str> = settings.iter().flat_map(|setting| ["--config", setting]).collect();
    module(&first, &features, &options)?;
    fs::create_dir_all(&second)?;
    fs::copy(first.join(MODULE), second.join(MODULE))?;
    fs::write(second.join("shadowfit_viewer.js"), WITHOUT_WEBGPU)?;
    Ok(())
}

/// Writes the picture that is shown first.
fn cover(file: &Path) -> Result<()> {
    let (picture, width) = COVER;
    let picture = image::open(process::root().join(picture))?.into_rgb8();
    let height = picture.height() * width / picture.width();
    image::imageops::resize(&picture, width, height, FilterType::Triangle).save(file)?;
    Ok(())
}
