//! Ray-traced ambient occlusion for the pictures of a sample: either blocking, or on a thread while the
//! camera rests.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use shadowfit::PerspectiveCamera;
use shadowfit_scene::Pose;
use shadowfit_study::{PreparedScene, SceneRays, in_background};
use shadowfit_truth::{AmbientSettings, AmbientTruth, PixelCamera, Truth};

/// Input of a trace.
#[derive(Clone, Debug, PartialEq)]
struct Key {
    camera: PerspectiveCamera,
    size: [u32; 2],
    pose: Pose,
}

/// The latest traced occlusion, and the running trace.
#[derive(Debug, Default)]
pub(crate) struct Traced {
    done: Option<(Key, Vec<f32>)>,
    under_way: Option<(Key, Receiver<Vec<f32>>)>,
}

impl Traced {
    /// Returns the occlusion of a picture, rows from the top, 0 in the sky. If `waits` is false, a thread
    /// traces it, and the result is `None` until it has finished.
    pub(crate) fn occlusion(
        &mut self,
        scene: &mut PreparedScene,
        camera: &PerspectiveCamera,
        size: [u32; 2],
        waits: bool,
    ) -> Option<&[f32]> {
        let key = Key { camera: *camera, size, pose: scene.pose().clone() };
        self.under_way = match self.under_way.take().map(|(of, result)| (of, result.try_recv(), result)) {
            Some((of, Ok(occlusion), _)) => {
                self.done = Some((of, occlusion));
                None
            }
            Some((of, Err(TryRecvError::Empty), result)) => Some((of, result)),
            // If the thread has ended without a result, the next frame starts another.
            Some((_, Err(TryRecvError::Disconnected), _)) | None => None,
        };
        if self.done.as_ref().is_none_or(|(of, _)| *of != key) {
            let camera = PixelCamera::new(scene.camera_for_rays(camera), size);
            if waits {
                self.done = Some((key.clone(), trace(scene.rays(), &camera)));
            } else if let Some(rays) = ready(scene).filter(|_| self.under_way.is_none()) {
                let (sender, result) = channel();
                let work = move || {
                    // If the sample has changed, there is no receiver.
                    let _ = sender.send(trace(&rays, &camera));
                };
                // If the thread cannot be started, the picture keeps screen-space occlusion.
                let started = in_background("occlusion", work);
                self.under_way = started.is_ok().then(|| (key.clone(), result));
            }
        }
        self.done.as_ref().filter(|(of, _)| *of == key).map(|(_, occlusion)| occlusion.as_slice())
    }
}

/// Returns the rays of a scene's pose if they are ready. Otherwise requests them.
fn ready(scene: &mut PreparedScene) -> Option<Arc<SceneRays>> {
    scene.take_rays();
    scene.request_rays();
    scene.ready_rays()
}

/// Traces the occlusion of a picture.
fn trace(rays: &SceneRays, camera: &PixelCamera) -> Vec<f32> {
    let truth = truth(rays, camera);
    truth.occlusion.into_iter().map(|occlusion| occlusion.unwrap_or(0.0)).collect()
}

/// Returns the ray-traced occlusion of the surfaces that a camera sees.
pub(crate) fn truth(rays: &SceneRays, camera: &PixelCamera) -> AmbientTruth {
    let seen = Truth::seen_by_rays(&rays.tracer, camera);
    AmbientTruth::trace(&rays.tracer, camera, &AmbientSettings::default(), &seen)
}
