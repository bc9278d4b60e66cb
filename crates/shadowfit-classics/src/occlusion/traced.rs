//! Ambient occlusion by rays for the pictures of a sample: waited for, or traced on a thread while the camera rests.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use shadowfit::PerspectiveCamera;
use shadowfit_scene::Pose;
use shadowfit_study::{PreparedScene, SceneRays, in_background};
use shadowfit_truth::{AmbientSettings, AmbientTruth, PixelCamera, Truth};

/// What occlusion was traced for.
#[derive(Clone, Debug, PartialEq)]
struct Key {
    camera: PerspectiveCamera,
    size: [u32; 2],
    pose: Pose,
}

/// The occlusion that was traced last, and the trace that is running.
#[derive(Debug, Default)]
pub(crate) struct Traced {
    done: Option<(Key, Vec<f32>)>,
    under_way: Option<(Key, Receiver<Vec<f32>>)>,
}

impl Traced {
    /// The occlusion of a picture, rows from the top, 0 where there is sky. Unless it `waits` it is traced on a thread, and
    /// `None` until it is there.
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
            // A thread that is gone leaves nothing, and the next frame begins another one.
            Some((_, Err(TryRecvError::Disconnected), _)) | None => None,
        };
        if self.done.as_ref().is_none_or(|(of, _)| *of != key) {
            let camera = PixelCamera::new(scene.camera_for_rays(camera), size);
            if waits {
                self.done = Some((key.clone(), trace(scene.rays(), &camera)));
            } else if let Some(rays) = ready(scene).filter(|_| self.under_way.is_none()) {
                let (sender, result) = channel();
                let work = move || {
                    // Nobody waits any more where the sample is another one.
                    let _ = sender.send(trace(&rays, &camera));
                };
                // Where no thread can be made, the picture stays as it is in screen space.
                let started = in_background("occlusion", work);
                self.under_way = started.is_ok().then(|| (key.clone(), result));
            }
        }
        self.done.as_ref().filter(|(of, _)| *of == key).map(|(_, occlusion)| occlusion.as_slice())
    }
}

/// The rays of a scene's pose, if they are there; they are asked for where they are not.
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

/// The ray-traced occlusion of what rays see through a camera.
pub(crate) fn truth(rays: &SceneRays, camera: &PixelCamera) -> AmbientTruth {
    let seen = Truth::seen_by_rays(&rays.tracer, camera);
    AmbientTruth::trace(&rays.tracer, camera, &AmbientSettings::default(), &seen)
}
