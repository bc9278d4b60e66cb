//! Makes small glTF files for the tests.

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

/// A glTF file in the making: buffer data with accessors, and JSON members beside them.
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

    /// As `accessor`, with more members in the accessor's JSON.
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

    /// Adds a float accessor; the count follows from `components`.
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

    /// One node with one mesh of one primitive.
    pub(crate) fn one_primitive(&mut self, primitive: &str) -> &mut Self {
        self.members(&format!(r#""nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{primitive}]}}]"#))
    }

    /// The file's text.
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

/// Writes a file into the folder `name` of the running test and returns its path. Tests run side by side, each on a
/// thread that has its name; where they share one thread they run one after the other.
pub(crate) fn write(name: &str, file: &str, content: &[u8]) -> PathBuf {
    let test = std::thread::current().name().unwrap_or("test").replace("::", "-");
    let folder = std::env::temp_dir().join(format!("shadowfit-scene-{}", std::process::id())).join(test).join(name);
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(file);
    std::fs::write(&path, content).unwrap();
    path
}

/// Loads a file of this text.
pub(crate) fn load_text(name: &str, text: &str) -> Result<Scene, SceneError> {
    load_gltf(&write(name, &format!("{name}.gltf"), text.as_bytes()))
}

/// The message with which a file is refused.
pub(crate) fn refusal(result: Result<Scene, SceneError>) -> String {
    match result {
        Ok(scene) => panic!("{} was accepted", scene.name),
        Err(error) => error.to_string(),
    }
}
