//! A process with files, threads and dialogs, with or without a window.

mod state_file;

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};

use anyhow::Result;
use shadowfit_scene::{LoadStep, Scene, SceneSize, load_gltf_with_progress};
pub(crate) use shadowfit_study::write_whole as save_file;
pub(crate) use tempfile::{TempDir as TemporaryFolder, tempdir as temporary_folder};

use super::BusyBar;
pub(crate) use state_file::StateFile;

/// Returns the content of a file.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>> {
    Ok(std::fs::read(path)?)
}

/// Loads a scene of a file, and calls `progress` at each step.
pub(crate) async fn load_gltf(
    path: &Path,
    scene: Option<usize>,
    progress: &dyn Fn(LoadStep, &SceneSize),
) -> Result<Scene> {
    Ok(load_gltf_with_progress(path, scene, progress)?)
}

/// Opens the system's dialog on a thread, which sends the file that the user chooses. Returns `None` if no thread could
/// be started.
pub(crate) fn choose_file() -> Option<Receiver<Option<PathBuf>>> {
    let (sender, receiver) = channel();
    let work = move || {
        let dialog = rfd::FileDialog::new().set_title("Open").add_filter("Scenes", &["glb", "gltf"]);
        let dialog = dialog.add_filter("Techniques and screenshots", &["toml", "png"]);
        // The receiver is gone once the viewer has ended.
        let _ = sender.send(dialog.pick_file());
    };
    std::thread::Builder::new().name("file dialog".to_owned()).spawn(work).ok().map(|_| receiver)
}

/// Does nothing, since the window keeps drawing while a thread works.
pub(crate) fn busy(_: Option<BusyBar>) {}

/// Returns the memory of the process, in bytes, or `None` on systems other than Linux.
pub(crate) fn memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}
