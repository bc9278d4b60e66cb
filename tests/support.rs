//! Shared parts of these tests: the device, the viewer as a program, the collection of scenes.

use std::path::{Path, PathBuf};
use std::process::Command;

use shadowfit::PerspectiveCamera;
use shadowfit::glam::Vec3;
use shadowfit_scene::{Lens, Scene};
use shadowfit_study::View;
use shadowfit_testing::package_folder;
/// The tests' device, which successive tests share, and the name of its adapter for programs.
pub(crate) use shadowfit_testing::{adapter_name, renderer_gpu as test_gpu};

/// Returns the view from a scene's own camera under its own sun, in pictures of this size.
pub(crate) fn start_view(scene: &Scene, size: [u32; 2]) -> View {
    let camera = scene.cameras.first().expect("a camera");
    let Lens::Perspective { fov_y, near, far } = camera.lens else { panic!("a perspective camera") };
    let [_, up, back, eye] = scene.pose(None, 0.0).world_from_node[camera.node].to_cols_array_2d();
    let axis = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z);
    let camera = PerspectiveCamera {
        eye: axis(eye).as_dvec3(),
        forward: -axis(back).normalize(),
        up: axis(up).normalize(),
        fov_y,
        aspect: size[0] as f32 / size[1] as f32,
        near,
        far: far.expect("a far plane"),
    };
    View { camera: camera.into(), direction: scene.sun.expect("a sun").direction, is_first: true }
}

/// Returns the folder of the workspace.
pub(crate) fn workspace() -> PathBuf {
    package_folder(env!("CARGO_MANIFEST_DIR"))
}

/// Returns the collection of scenes next to the workspace. Prints a note and returns `None` if it is missing.
pub(crate) fn assets() -> Option<PathBuf> {
    let folder = workspace().join("../shared/assets");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("SKIPPED: {} does not exist", folder.display());
    None
}

/// Returns every file below a folder, sorted.
pub(crate) fn files_below(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files = Vec::new();
    for entry in entries {
        let path = entry.unwrap_or_else(|error| panic!("{}: {error}", folder.display())).path();
        if path.is_dir() { files.extend(files_below(&path)) } else { files.push(path) }
    }
    files.sort();
    files
}

/// Returns the folder of this build's profile, such as `target/debug`. This test runs from its `deps`.
fn profile_folder() -> PathBuf {
    let test = std::env::current_exe().expect("the test knows its own path");
    test.ancestors().nth(2).expect("the test lies in target/<profile>/deps").to_owned()
}

/// Returns cargo's target folder.
pub(crate) fn target_folder() -> PathBuf {
    profile_folder().parent().expect("the profile's folder lies in the target folder").to_owned()
}

/// Returns the viewer's program next to this test.
pub(crate) fn viewer_program() -> PathBuf {
    example_program("viewer")
}

/// Returns an example's program next to this test. `cargo test` builds examples, but a filtered run may not
/// have.
pub(crate) fn example_program(name: &str) -> PathBuf {
    let program = profile_folder().join("examples").join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
    if !program.is_file() {
        let mut build = Command::new(env!("CARGO"));
        // The viewer is an example of another package.
        build.args(["build", "--workspace", "--example", name]).current_dir(workspace());
        build.env("CARGO_TARGET_DIR", target_folder());
        if profile_folder().ends_with("release") {
            build.arg("--release");
        }
        let status = build.status().expect("cargo starts");
        assert!(status.success(), "the example {name} does not build");
    }
    program
}
