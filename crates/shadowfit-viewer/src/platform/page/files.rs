//! Files that the user chose or dropped, the only files of a page. They stay in memory until others are
//! chosen.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result};
use js_sys::{Array, Promise, Uint8Array};
use shadowfit_scene::{DecodedImage, LoadStep, Scene, SceneSize, gltf_images, load_gltf_from_memory};
use wasm_bindgen::JsCast;
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen_futures::JsFuture;

#[wasm_bindgen]
extern "C" {
    /// Has the browser decode an image, to width, height and pixels. `web/worker.js` defines it.
    #[wasm_bindgen(js_name = decodeImage)]
    fn decode_image(bytes: &Uint8Array) -> Promise;
}

std::thread_local! {
    static FILES: RefCell<BTreeMap<String, Vec<u8>>> = const { RefCell::new(BTreeMap::new()) };
}

/// Removes all files.
pub(crate) fn clear() {
    FILES.with_borrow_mut(BTreeMap::clear);
}

/// Stores a file under its name.
pub(crate) fn keep(name: String, bytes: Vec<u8>) {
    FILES.with_borrow_mut(|files| files.insert(name, bytes));
}

/// Returns the content of a file.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>> {
    let name = path.to_string_lossy();
    let found = FILES.with_borrow(|files| files.get(&*name).cloned());
    found.with_context(|| format!("{name} is no longer available; choose it again"))
}

/// The images of a file's scene, by their encoded bytes, each decoded or with the browser's error.
type Images = BTreeMap<Vec<u8>, Result<DecodedImage, String>>;

/// Has the browser decode the images of a file.
async fn decode(path: &Path) -> Images {
    let encoded = FILES.with_borrow(|files| gltf_images(&path.to_string_lossy(), files));
    let mut images = Images::new();
    for bytes in encoded {
        let decoded = JsFuture::from(decode_image(&Uint8Array::from(&bytes[..]))).await;
        let found = decoded.ok().and_then(|found| found.dyn_into::<Array>().ok());
        let image = found.and_then(|found| {
            let side = |index| Some(found.get(index).as_f64()? as u32);
            let rgba = found.get(2).dyn_into::<Uint8Array>().ok()?.to_vec();
            Some(DecodedImage { width: side(0)?, height: side(1)?, rgba })
        });
        images.insert(bytes, image.ok_or_else(|| "the browser cannot decode it".to_owned()));
    }
    images
}

/// Loads a scene of a file with the files that were chosen together with it, and calls `progress` at each
/// step. The browser decodes the images first.
pub(crate) async fn load_gltf(
    path: &Path,
    scene: Option<usize>,
    progress: &dyn Fn(LoadStep, &SceneSize),
) -> Result<Scene> {
    let images = decode(path).await;
    let decoded = |bytes: &[u8]| images.get(bytes).cloned().unwrap_or_else(|| Err("it was not decoded".to_owned()));
    let name = path.to_string_lossy();
    FILES.with_borrow(|files| Ok(load_gltf_from_memory(&name, files, &decoded, scene, progress)?))
}
