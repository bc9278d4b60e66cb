//! The viewer: fly through a scene under one sun, and show and cure shadow artefacts.
//!
//! ```sh
//! cargo run --release -p shadowfit-viewer --example viewer                     # the built-in courtyard
//! cargo run --release -p shadowfit-viewer --example viewer -- path/to/scene.glb
//! cargo run --release -p shadowfit-viewer --example viewer -- --headless out   # the same views as PNG files
//! ```

use std::process::ExitCode;

fn main() -> ExitCode {
    shadowfit_viewer::main()
}
