//! Loads scenes on a thread, while the window keeps drawing.

mod progress;

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use web_time::Instant;

use anyhow::{Context, Error, Result, anyhow};
use shadowfit_render::Gpu;
use shadowfit_scene::{LoadStep, SceneSize};
use shadowfit_study::{PreparedScene, in_background_async, next_turn};

use crate::platform::busy;
use crate::scene_source::SceneSource;
use progress::{Progress, READY};

/// A scene that is loading.
pub(crate) struct Loading {
    pub(crate) source: SceneSource,
    /// The line of a script that requested it.
    pub(crate) line: Option<String>,
    progress: Arc<Mutex<Progress>>,
    result: Receiver<Result<PreparedScene>>,
    _end: End,
}

/// Cancels the work when it is dropped.
struct End(Arc<AtomicBool>);

impl Drop for End {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
        busy(None);
    }
}

impl Loading {
    /// Starts to load. `layout` is the layout of the scene's materials.
    pub(crate) fn start(source: SceneSource, line: Option<String>, gpu: &Gpu, layout: &wgpu::BindGroupLayout) -> Self {
        let (sender, result) = channel();
        let progress = Arc::new(Mutex::new(Progress::new(Instant::now())));
        let is_given_up = Arc::new(AtomicBool::new(false));
        let work = {
            let (source, gpu, layout, progress) = (source.clone(), gpu.clone(), layout.clone(), Arc::clone(&progress));
            let is_given_up = Arc::clone(&is_given_up);
            move || async move {
                if let Some(prepared) = load(&source, &gpu, &layout, &progress, &is_given_up).await {
                    // The receiver is gone after another scene was requested.
                    let _ = sender.send(prepared);
                }
            }
        };
        // Without a thread the channel is closed, which is reported as the end of the thread.
        let _ = in_background_async("loading", work);
        Self { source, line, progress, result, _end: End(is_given_up) }
    }

    /// Returns the finished share, 0..=1.
    pub(crate) fn share(&self) -> f32 {
        self.progress.lock().unwrap_or_else(PoisonError::into_inner).share(Instant::now())
    }

    /// Returns the scene, once it is loaded.
    pub(crate) fn take(&self) -> Option<Result<PreparedScene>> {
        match self.result.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(anyhow!(
                "{} could not be loaded: the loader ended before it was done; this is a bug of the viewer",
                self.source.text()
            ))),
        }
    }
}

/// Loads a scene; `None` if it was cancelled. A browser draws frames between the steps.
async fn load(
    source: &SceneSource,
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    progress: &Mutex<Progress>,
    is_given_up: &AtomicBool,
) -> Option<Result<PreparedScene>> {
    let begin = |phase, size: Option<&SceneSize>| {
        let mut progress = progress.lock().unwrap_or_else(PoisonError::into_inner);
        progress.begin(phase, size, Instant::now());
        busy(Some(progress.ahead(Instant::now())));
    };
    next_turn().await;
    let tell = |step: LoadStep, size: &SceneSize| begin(step as usize, Some(size));
    let scene = match source.load(&tell).await {
        Ok(scene) => scene,
        Err(error) => return Some(Err(error)),
    };
    begin(READY, None);
    next_turn().await;
    if is_given_up.load(Ordering::Relaxed) {
        return None;
    }
    // After a lost device, the viewer loads the scene again for the next one.
    let prepared = gpu.unless_lost(|| PreparedScene::new(gpu, layout, scene))?;
    Some(prepared.map_err(Error::from).with_context(|| source.text()))
}
