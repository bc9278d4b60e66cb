//! Creates small glTF files for the tests.

use std::fmt::Write;
use std::path::PathBuf;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use shadowfit_scene::{Scene, SceneError, load_gltf};

/// Component types of glTF.
pub(crate) const U8: u32 = 5121;
pub(crate) const U16: u32 = 5123;
pub(crate) const U32: u32 = 5125;
pub(crate) const F32: u32 = 5126;

/// The three corners of the triangle that most tests use, facing +z with area 1/2.
pub(crate) const TRIANGLE: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];

/// A glTF file under construction: buffer data with accessors, and further JSON members.
#[derive(Default)]
pub(crate) struct Build {
    bytes: Vec<u8>,
    views: String,
    accessors: String,
    count: usize,
    members: String,
}

impl Build {
    /// Adds an accessor over `data` and returns its index.
    pub(crate) fn accessor(&mut self, component: u32, kind: &str, count: usize, data: &[u8]) -> usize {
        self.accessor_with(component, kind, count, data, "")
    }

    /// Adds an accessor like `accessor`, with further members in its JSON.
    pub(crate) fn accessor_with(&mut self, component: u32, kind: &str, count: usize, data: &[u8], more: &str) -> usize {
        let view = self.view(data);
        self.push_accessor(&format!(
            r#"{{"bufferView":{view},"componentType":{component},"type":"{kind}","count":{count}{more}}}"#
        ))
    }

    /// Adds an accessor given as JSON.
    pub(crate) fn push_accessor(&mut self, json: &str) -> usize {
        let comma = if self.count == 0 { "" } else { "," };
        write!(self.accessors, "{comma}{json}").unwrap();
        self.count += 1;
        self.count - 1
    }

    /// Adds a float accessor. Its count is the number of values divided by `components`.
    pub(crate) fn floats(&mut self, kind: &str, components: usize, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        self.accessor(F32, kind, values.len() / components, &bytes)
    }

    /// Adds a buffer view and returns its index.
    pub(crate) fn view(&mut self, data: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let (offset, length) = (self.bytes.len(), data.len());
        let comma = if self.views.is_empty() { "" } else { "," };
        write!(self.views, r#"{comma}{{"buffer":0,"byteOffset":{offset},"byteLength":{length}}}"#).unwrap();
        self.bytes.extend_from_slice(data);
        self.views.matches("\"buffer\"").count() - 1
    }

    /// Adds members to the root object, such as `"nodes":[{}]`.
    pub(crate) fn members(&mut self, json: &str) -> &mut Self {
        write!(self.members, ",{json}").unwrap();
        self
    }

    /// Adds one node with one mesh of one primitive.
    pub(crate) fn one_primitive(&mut self, primitive: &str) -> &mut Self {
        self.members(&format!(r#""nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{primitive}]}}]"#))
    }

    /// Returns the file's text.
    pub(crate) fn json(&self) -> String {
        let data = BASE64_STANDARD.encode(&self.bytes);
        let length = self.bytes.len();
        let (views, accessors, members) = (&self.views, &self.accessors, &self.members);
        format!(
            r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{length},"uri":"data:;base64,{data}"}}],
            "bufferViews":[{views}],"accessors":[{accessors}]{members}}}"#
        )
    }

    /// Writes the file as `<name>.gltf` and loads it.
    pub(crate) fn load(&self, name: &str) -> Result<Scene, SceneError> {
        load_text(name, &self.json())
    }
}

/// Writes a file into the folder `name` of the running test and returns its path. Tests that run in parallel
/// have threads with their names. Tests that share a thread run one after the other.
pub(crate) fn write(name: &str, file: &str, content: &[u8]) -> PathBuf {
    let test = std::thread::current().name().unwrap_or("test").replace("::", "-");
    let folder = std::env::temp_dir().join(format!("shadowfit-scene-{}", std::process::id())).join(test).join(name);
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(file);
    std::fs::write(&path, content).unwrap();
    path
}

/// Loads a file with this text.
pub(crate) fn load_text(name: &str, text: &str) -> Result<Scene, SceneError> {
    load_gltf(&write(name, &format!("{name}.gltf"), text.as_bytes()))
}

/// Returns the error message of a refused file.
pub(crate) fn refusal(result: Result<Scene, SceneError>) -> String {
    match result {
        Ok(scene) => panic!("{} was accepted", scene.name),
        Err(error) => error.to_string(),
    }
}
