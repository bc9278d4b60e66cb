//! The fuzz targets: a function for each, which panics when a guarantee is violated.
//!
//! The targets in this folder use only public items, and the tests of the workspace also run them over the
//! files of `corpus`. A target that needs private items is in a module `fuzzed` of its crate, with its own
//! test.

#[path = "../../../crates/shadowfit-report/src/program/path"]
mod path {
    //! Enough of the report's camera paths to read their files.

    #[expect(dead_code, reason = "reports read files, and this reads their content")]
    pub(crate) mod file;

    use shadowfit::Camera;
    use shadowfit_params::tool::LightSettings;

    #[derive(Clone, Debug, PartialEq)]
    pub(crate) struct CameraPath {
        pub(crate) frames: Vec<PathFrame>,
        pub(crate) light: Option<LightSettings>,
    }

    #[derive(Clone, Debug, PartialEq)]
    pub(crate) struct PathFrame {
        pub(crate) camera: Camera,
        pub(crate) group: String,
    }
}

mod bytes;
mod cache_plan;
mod finite;
mod fit_input;
mod gltf_import;
mod saved_json;
mod settings_toml;
mod technique_toml;

pub use cache_plan::cache_plan;
pub use fit_input::fit_input;
pub use gltf_import::gltf_import;
pub use saved_json::saved_json;
pub use shadowfit_report::fuzzed::fit_file;
pub use shadowfit_viewer::fuzzed::script;
pub use technique_toml::technique_toml;

/// Fuzzes settings, and all files that the viewer saves.
pub fn settings_toml(data: &[u8]) {
    settings_toml::settings_toml(data);
    shadowfit_viewer::fuzzed::saved_toml(data);
}

/// Fuzzes camera paths.
pub fn camera_path(data: &[u8]) {
    path::file::camera_path(data);
}
