//! Files that were chosen or dropped: a page has no others. They stay in memory until others are chosen.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result};
use shadowfit_scene::{LoadStep, Scene, SceneSize, load_gltf_from_memory};

std::thread_local! {
    static FILES: RefCell<BTreeMap<String, Vec<u8>>> = const { RefCell::new(BTreeMap::new()) };
}

/// Forgets all files.
pub(super) fn clear() {
    FILES.with_borrow_mut(BTreeMap::clear);
}

/// Keeps a file under its name.
pub(super) fn keep(name: String, bytes: Vec<u8>) {
    FILES.with_borrow_mut(|files| files.insert(name, bytes));
}

/// The content of a file.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>> {
    let name = path.to_string_lossy();
    let found = FILES.with_borrow(|files| files.get(&*name).cloned());
    found.with_context(|| format!("{name} is not there any more; choose it again"))
}

/// Loads a scene of a file, with those that were chosen together with it.
pub(crate) fn load_gltf(path: &Path, scene: Option<usize>, progress: &dyn Fn(LoadStep, &SceneSize)) -> Result<Scene> {
    FILES.with_borrow(|files| Ok(load_gltf_from_memory(&path.to_string_lossy(), files, scene, progress)?))
}
