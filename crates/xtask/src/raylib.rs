//! `cargo xtask capi --raylib`: the example in C with raylib. The crate `raylib-sys` has raylib's sources. The
//! example runs on a virtual display with the software driver, and rays judge its shadows.

use std::fs;
use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use anyhow::{Context, Result, ensure};

use crate::capi;
use crate::process::{self, target_folder};
use crate::setup::{self, Purpose};

/// Version of the crate with raylib's sources. It is raylib 6.0.
const VERSION: &str = "6.0.0";
/// Sources of raylib that the example needs: all files except sound.
const SOURCES: [&str; 6] = ["rcore", "rglfw", "rmodels", "rshapes", "rtext", "rtextures"];
/// Flags for raylib: a window on X11, OpenGL 3.3.
const RAYLIB_FLAGS: [&str; 6] =
    ["-O1", "-w", "-D_GNU_SOURCE", "-DPLATFORM_DESKTOP_GLFW", "-DGRAPHICS_API_OPENGL_33", "-D_GLFW_X11"];
const LIBRARIES: [&str; 4] = ["-lX11", "-lm", "-ldl", "-lpthread"];

/// Folder of the programs that judge the example.
const TESTS: &str = "crates/shadowfit-capi/tests/c";

/// Frames of a judged walk. In the last third, the camera stands still.
const FRAMES: &str = "48";
/// Frames before the picture. It shows the last place of the walk.
const FRAMES_OF_PICTURE: &str = "6";
/// Greatest share of wrong pixels, in percent. The software driver's pictures have 0.13.
const LIMIT: &str = "0.3";
/// Compares the example's shadows with rays, and also the shadows of raylib's own example.
///
/// # Errors
/// If the example cannot be built, too many pixels are wrong, or a still camera causes draws of static casters.
pub(crate) fn test() -> Result<()> {
    let Some(build) = Build::prepare()? else { return Ok(()) };
    let windows = build.program(&windows(), "windows")?;
    let one_map = build.program(&process::root().join(TESTS).join("one_map.c"), "one_map")?;
    let judge = build.judge()?;
    let screen = Screen::start()?;
    let factors = build.folder.join("factors.bin");

    let log = process::printed_by(screen.show(&windows, FRAMES, "--judge").arg(&factors))?;
    println!("four windows:");
    process::run(Command::new(&judge).arg(&factors).arg(LIMIT))?;
    let last = log.lines().last().unwrap_or_default();
    ensure!(last.contains(" 0 draws of static casters"), "a still camera causes draws of static casters: {last}");

    process::printed_by(screen.show(&one_map, FRAMES, "--judge").arg(&factors))?;
    println!("one map of 1024 x 1024, as in raylib's example:");
    process::run(Command::new(&judge).arg(&factors))
}

/// Renders the example's picture. Returns its file, or `None` if this machine cannot build the example.
///
/// # Errors
/// If the example cannot be built or run.
pub(crate) fn picture() -> Result<Option<PathBuf>> {
    let Some(build) = Build::prepare()? else { return Ok(None) };
    let (program, file) = (build.program(&windows(), "windows")?, build.folder.join("windows.png"));
    process::printed_by(Screen::start()?.show(&program, FRAMES_OF_PICTURE, "--picture").arg(&file))?;
    Ok(Some(file))
}

/// Returns the file with the example's shadows.
fn windows() -> PathBuf {
    process::root().join("examples/c/shadows.c")
}

/// Downloads raylib's sources into cargo's registry. Returns their folder.
fn fetch(folder: &Path) -> Result<PathBuf> {
    let manifest = folder.join("Cargo.toml");
    let text = format!(
        "[package]\nname = \"raylib-sources\"\nedition = \"2024\"\n\n[workspace]\n\n\
         [dependencies]\nraylib-sys = {{ version = \"={VERSION}\", default-features = false }}\n"
    );
    fs::write(&manifest, text)?;
    fs::write(folder.join("src/lib.rs"), "")?;
    let mut metadata = process::cargo("metadata");
    metadata.args(["--format-version", "1", "--manifest-path"]).arg(&manifest);
    let packages: serde_json::Value = serde_json::from_str(&process::printed_by(&mut metadata)?)?;
    let mut packages = packages["packages"].as_array().into_iter().flatten();
    let package = packages.find(|package| package["name"] == "raylib-sys").context("raylib-sys is missing")?;
    let path = Path::new(package["manifest_path"].as_str().unwrap_or_default());
    Ok(path.with_file_name("raylib").join("src"))
}

/// Compiles raylib into object files in a folder.
fn compile_raylib(raylib: &Path, folder: &Path) -> Result<()> {
    let mut compiler = Command::new("cc");
    compiler.current_dir(folder).arg("-c").args(RAYLIB_FLAGS);
    compiler.arg("-I").arg(raylib).arg("-I").arg(raylib.join("external/glfw/include"));
    process::run(compiler.args(SOURCES.map(|source| raylib.join(source).with_extension("c"))))
}

/// The parts that every program is built from.
struct Build {
    /// Folder of raylib's headers.
    raylib: PathBuf,
    /// Folder of raylib's object files, and of the programs.
    folder: PathBuf,
    /// The C library of shadowfit.
    library: PathBuf,
}

impl Build {
    /// Builds raylib and the C library. Returns `None` after printing the reason if this machine cannot do it.
    fn prepare() -> Result<Option<Self>> {
        if !setup::prepare(Purpose::Raylib)?.can_test_raylib() {
            println!("SKIPPED: the example with raylib: Xvfb, OpenGL or headers of X11 are missing");
            return Ok(None);
        }
        let folder = target_folder().join("raylib");
        fs::create_dir_all(folder.join("src")).with_context(|| format!("cannot create {}", folder.display()))?;
        let raylib = match fetch(&folder) {
            Err(error) if !setup::gpu_is_required() => {
                println!("SKIPPED: the example with raylib: {error:#}");
                return Ok(None);
            }
            raylib => raylib?,
        };
        compile_raylib(&raylib, &folder)?;
        Ok(Some(Self { raylib, folder, library: capi::build()?.fixed }))
    }

    /// Builds the example with one kind of shadows. Returns the program.
    fn program(&self, shadows: &Path, name: &str) -> Result<PathBuf> {
        let root = process::root();
        let mut compiler = Command::new("cc");
        compiler.args(capi::FLAGS).arg("-isystem").arg(&self.raylib);
        compiler.arg("-I").arg(root.join("examples/c")).arg("-I").arg(root.join("crates/shadowfit-capi/include"));
        compiler.arg(root.join("examples/c/raylib_shadows.c")).arg(shadows);
        compiler.args(SOURCES.map(|source| self.folder.join(source).with_extension("o"))).arg(&self.library);
        let program = self.folder.join(name);
        process::run(compiler.args(LIBRARIES).arg("-o").arg(&program))?;
        Ok(program)
    }

    /// Builds the program that judges the shadow factors. Returns it.
    fn judge(&self) -> Result<PathBuf> {
        let (source, program) = (process::root().join(TESTS).join("judge.c"), self.folder.join("judge"));
        process::run(Command::new("cc").args(capi::FLAGS).arg("-O2").arg(source).args(["-lm", "-o"]).arg(&program))?;
        Ok(program)
    }
}

/// A virtual display. Its server ends with this value.
struct Screen {
    server: Child,
    name: String,
}

impl Screen {
    /// Starts a server on a free display.
    fn start() -> Result<Self> {
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "1280x720x24", "-nolisten", "tcp"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .context("cannot start Xvfb")?;
        let mut number = String::new();
        if let Some(output) = server.stdout.take() {
            BufReader::new(output).read_line(&mut number)?;
        }
        let screen = Self { server, name: format!(":{}", number.trim()) };
        ensure!(!number.trim().is_empty(), "Xvfb opened no display");
        Ok(screen)
    }

    /// Returns the command that runs a program on this display with the software driver. The last option still needs
    /// its file.
    fn show(&self, program: &Path, frames: &str, option: &str) -> Command {
        let mut command = Command::new(program);
        command.args(["--shaders"]).arg(process::root().join("crates/shadowfit-capi/shaders"));
        command.args(["--frames", frames, option]);
        command.env("DISPLAY", &self.name).env("LIBGL_ALWAYS_SOFTWARE", "1");
        command
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shadows_of_the_example_take_at_most_200_lines() {
        let text = fs::read_to_string(windows()).unwrap();
        let lines = text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with("//"));
        assert!(lines.count() <= 200);
    }
}
