//! Loads scenes on a thread, while the window goes on.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use anyhow::{Context, Error, Result, anyhow};
use shadowfit_render::Gpu;
use shadowfit_study::PreparedScene;

use crate::source::SceneSource;

/// Share of the work that reading the file takes; the rest prepares the scene.
const READING: f32 = 0.7;
/// Steps of the bar.
const STEPS: f32 = 1000.0;

/// A scene that is being loaded.
pub(crate) struct Loading {
    pub(crate) source: SceneSource,
    /// The line of a script that asked for it.
    pub(crate) line: Option<String>,
    /// Progress, in steps.
    done: Arc<AtomicU32>,
    result: Receiver<Result<PreparedScene>>,
}

impl Loading {
    /// Begins to load. `layout` is that of the scene's materials.
    pub(crate) fn start(source: SceneSource, line: Option<String>, gpu: &Gpu, layout: &wgpu::BindGroupLayout) -> Self {
        let (sender, result) = channel();
        let done = Arc::new(AtomicU32::new(0));
        let work = {
            let (source, gpu, layout, done) = (source.clone(), gpu.clone(), layout.clone(), done.clone());
            move || {
                let prepared = load(&source, &gpu, &layout, &done);
                // The receiver is gone where another scene was asked for.
                let _ = sender.send(prepared);
            }
        };
        // Where no thread can be made, the channel is closed, which is reported as the end of the thread.
        let _ = std::thread::Builder::new().name("loading".to_owned()).spawn(work);
        Self { source, line, done, result }
    }

    /// Share that is done, 0..=1.
    pub(crate) fn share(&self) -> f32 {
        self.done.load(Ordering::Relaxed) as f32 / STEPS
    }

    /// The scene, once it is loaded.
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

fn load(source: &SceneSource, gpu: &Gpu, layout: &wgpu::BindGroupLayout, done: &AtomicU32) -> Result<PreparedScene> {
    let tell = |share: f32| done.store((share * STEPS) as u32, Ordering::Relaxed);
    let scene = source.load(&|share| tell(share * READING))?;
    tell(READING);
    let prepared = PreparedScene::new(gpu, layout, scene).map_err(Error::from).with_context(|| source.text())?;
    tell(1.0);
    Ok(prepared)
}
