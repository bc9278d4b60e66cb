//! `cargo xtask web`: the viewer as a web page. Its module is built twice, for WebGPU and for browsers with
//! only WebGL2, and the page loads one of them. Tests build one module for both. Any static host can serve
//! the folder: all paths are relative, and the page needs no special headers.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use image::imageops::FilterType;

use crate::machine::WEB_TARGET;
use crate::process::{self, has_target, target_folder};

mod browser;
mod serve;

pub(crate) use browser::{browser, test};

/// The modules: a folder, and the viewer's feature for the build.
const MODULES: [(&str, &str); 2] = [("webgpu", "webgpu"), ("webgl2", "webgl")];
/// JavaScript of the second module if the first one has both features: it hides WebGPU and loads the first
/// module.
const WITHOUT_WEBGPU: &str = "\
    Object.defineProperty(navigator, 'gpu', { value: undefined });\n\
    export * from '../webgpu/shadowfit_viewer.js';\n\
    export { default } from '../webgpu/shadowfit_viewer.js';\n";
/// File name of a module in its folder.
const MODULE: &str = "shadowfit_viewer_bg.wasm";
/// The picture that is shown while the module loads, and its width in pixels.
const COVER: (&str, u32) = ("docs/images/scene-courtyard.png", 960);

/// Builds the page into `folder`, or serves it.
///
/// # Errors
/// If the page cannot be built, written or served.
pub(crate) fn web(folder: Option<&Path>, port: u16) -> Result<()> {
    let is_served = folder.is_none();
    let folder = folder.map_or_else(|| process::root().join("out/web"), Path::to_owned);
    build(&folder, Modules::Small)?;
    if !is_served {
        return Ok(());
    }
    serve::serve(&folder, port, |address| {
        println!("serving on {address} until Ctrl+C");
        // Without a browser the printed address is enough.
        let _ = open::that_detached(address);
    })
}

/// Build modes of the modules.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Modules {
    /// Small modules for users.
    Small,
    /// One module for tests, built in as little time as possible.
    Quick,
}

/// Builds the page into `folder`.
fn build(folder: &Path, modules: Modules) -> Result<()> {
    if !has_target(WEB_TARGET) {
        bail!("the page needs Rust's target {WEB_TARGET}: install it with `rustup target add {WEB_TARGET}`");
    }
    fs::create_dir_all(folder).with_context(|| format!("cannot create {}", folder.display()))?;
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
    // The page shows the loading progress. It needs the sizes, since compressed responses do not contain
    // them.
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
    // Cargo's folder for the profile `dev` is named `debug`.
    let profile = if options.contains(&"web") { "web" } else { "debug" };
    if profile == "debug" && process::succeeds(process::cargo("clippy").arg("--version")) {
        // Code that is only for browsers is not linted elsewhere.
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
