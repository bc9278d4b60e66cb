//! The rays of an animated scene, for the current pose and for an earlier one, and rays that a thread builds.
//!
//! Building rays takes at least a tenth of a second per million triangles, too long for a picture to wait. A
//! thread therefore builds them while the rays of an earlier pose are still in use. The two sets take turns:
//!
//! ```text
//!   request ──► making ──take──► present ──pose changes──► earlier ──newer ones come──► spare
//!                 ▲                                                                       │
//!                 └──────────────────── moved to the pose that is asked for ◄─────────────┘
//! ```

use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use glam::DVec3;
use shadowfit_scene::{Pose, Scene};

use crate::{SceneRays, in_background};

/// The rays of a scene's poses, which are counted from 0.
#[derive(Debug, Default)]
pub(crate) struct PosedRays {
    pose: u64,
    present: OnceLock<Arc<SceneRays>>,
    others: Mutex<Others>,
}

/// All rays except the current pose's.
#[derive(Debug, Default)]
struct Others {
    earlier: Option<Earlier>,
    /// Replaced earlier rays, reused to build the next ones.
    spare: Option<Arc<SceneRays>>,
    making: Option<Making>,
    /// Pose whose rays a thread failed to build. It is not requested again.
    failed: Option<u64>,
}

#[derive(Debug)]
struct Earlier {
    pose: u64,
    rays: Arc<SceneRays>,
}

/// Rays that a thread is building.
#[derive(Debug)]
struct Making {
    pose: u64,
    result: Receiver<SceneRays>,
}

impl Making {
    /// Waits for the rays. In a browser nothing else runs meanwhile, so they exist now or never will.
    fn wait(self) -> Option<SceneRays> {
        if cfg!(target_family = "wasm") { self.result.try_recv().ok() } else { self.result.recv().ok() }
    }
}

/// A scene in a pose, and the world position that its rays are relative to, in metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Posed<'a> {
    pub(crate) scene: &'a Arc<Scene>,
    pub(crate) pose: &'a Pose,
    pub(crate) origin: DVec3,
}

impl PosedRays {
    /// Advances to another pose of the scene. The current rays become the earlier ones.
    pub(crate) fn change_pose(&mut self) {
        let pose = self.pose;
        self.pose += 1;
        if let Some(rays) = self.present.take() {
            self.others_mut().replace_earlier(Earlier { pose, rays });
        }
    }

    /// Returns the rays for the current pose. Builds them or waits for them if missing.
    pub(crate) fn get_or_make(&self, posed: Posed<'_>) -> &Arc<SceneRays> {
        self.present.get_or_init(|| {
            let mut others = self.others();
            let making = others.making.take_if(|making| making.pose == self.pose);
            let made = making.and_then(Making::wait).unwrap_or_else(|| {
                let spare = others.spare.take();
                let from = spare.or_else(|| others.earlier.take().map(|earlier| earlier.rays));
                make(posed.scene, posed.pose, posed.origin, from)
            });
            Arc::new(made)
        })
    }

    /// Returns the rays for the current pose, if they exist.
    pub(crate) fn ready(&self) -> Option<Arc<SceneRays>> {
        self.present.get().cloned()
    }

    /// Returns only the rays for the current pose, for another thread.
    pub(crate) fn snapshot(&self) -> Self {
        Self { present: self.ready().map_or_else(OnceLock::new, OnceLock::from), ..Self::default() }
    }

    /// Returns the latest rays, and whether they are for the current pose.
    pub(crate) fn latest(&self) -> Option<(Arc<SceneRays>, bool)> {
        let earlier = || self.others().earlier.as_ref().map(|earlier| (Arc::clone(&earlier.rays), false));
        self.ready().map(|rays| (rays, true)).or_else(earlier)
    }

    /// Starts a thread that builds the rays for the current pose, unless they exist or a thread is already
    /// building.
    pub(crate) fn request(&mut self, posed: Posed<'_>) {
        let pose = self.pose;
        let is_there = self.present.get().is_some();
        let others = self.others_mut();
        if is_there || others.making.is_some() || others.failed == Some(pose) {
            return;
        }
        let spare = others.spare.take_if(|spare| Arc::strong_count(spare) == 1);
        let from = spare.or_else(|| others.earlier.as_ref().map(|earlier| Arc::clone(&earlier.rays)));
        let (sender, result) = channel();
        let (scene, its_pose, origin) = (Arc::clone(posed.scene), posed.pose.clone(), posed.origin);
        let work = move || {
            // There is no receiver once the scene is dropped.
            let _ = sender.send(make(&scene, &its_pose, origin, from));
        };
        match in_background("rays", work) {
            Ok(()) => others.making = Some(Making { pose, result }),
            Err(_) => others.failed = Some(pose),
        }
    }

    /// Takes the rays that a thread has built, and returns whether there were any.
    pub(crate) fn take(&mut self) -> bool {
        let present = self.pose;
        let others = self.others_mut();
        let Some(making) = &others.making else { return false };
        let (pose, received) = (making.pose, making.result.try_recv());
        if matches!(received, Err(TryRecvError::Empty)) {
            return false;
        }
        others.making = None;
        let Ok(rays) = received.map(Arc::new) else {
            others.failed = Some(pose);
            return false;
        };
        if pose == present && self.present.get().is_none() {
            self.present = OnceLock::from(rays);
        } else {
            self.others_mut().replace_earlier(Earlier { pose, rays });
        }
        true
    }

    fn others(&self) -> MutexGuard<'_, Others> {
        self.others.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn others_mut(&mut self) -> &mut Others {
        self.others.get_mut().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Others {
    /// Keeps the rays of the later of two earlier poses. The others become spare.
    fn replace_earlier(&mut self, found: Earlier) {
        let is_older = self.earlier.as_ref().is_some_and(|known| known.pose > found.pose);
        self.spare = if is_older { Some(found.rays) } else { self.earlier.replace(found).map(|known| known.rays) };
    }
}

/// Builds the rays for a pose, from other rays of the same scene if there are any. These are moved in place
/// if they have no other readers, and copied otherwise. Both are several times faster than building a new
/// hierarchy.
fn make(scene: &Scene, pose: &Pose, origin: DVec3, from: Option<Arc<SceneRays>>) -> SceneRays {
    let Some(from) = from else { return SceneRays::from_origin(scene, pose, origin) };
    let mut rays = Arc::unwrap_or_clone(from);
    rays.set_pose(scene, pose);
    rays
}

#[cfg(test)]
mod tests {
    use std::thread;
    use std::time::Duration;

    use shadowfit_scene::builtin::default_scene;

    use super::*;

    /// A playing scene, and its rays.
    struct Player {
        scene: Arc<Scene>,
        pose: Pose,
        rays: PosedRays,
    }

    fn corners(rays: &SceneRays) -> Vec<[glam::Vec3; 3]> {
        (0..rays.tracer.len()).map(|index| rays.tracer.corners(index as u32)).collect()
    }

    impl Player {
        fn new() -> Self {
            let scene = Arc::new(default_scene());
            Self { pose: scene.pose(None, 0.0), scene, rays: PosedRays::default() }
        }

        fn play(&mut self, seconds: f32) {
            self.pose = self.scene.pose(Some(0), seconds);
            self.rays.change_pose();
        }

        fn request(&mut self) {
            self.rays.request(Posed { scene: &self.scene, pose: &self.pose, origin: DVec3::ZERO });
        }

        fn wait(&mut self) {
            while !self.rays.take() {
                thread::sleep(Duration::from_millis(1));
            }
        }

        fn is_of_present_pose(&self, rays: &SceneRays) -> bool {
            corners(rays) == corners(&SceneRays::from_origin(&self.scene, &self.pose, DVec3::ZERO))
        }
    }

    #[test]
    fn nothing_is_there_until_it_is_asked_for_and_taken() {
        let mut player = Player::new();
        assert!(player.rays.ready().is_none() && player.rays.latest().is_none() && !player.rays.take());
        player.request();
        assert!(player.rays.ready().is_none(), "asking takes nothing");
        player.wait();
        let rays = player.rays.ready().expect("they were taken");
        assert!(player.is_of_present_pose(&rays) && player.rays.latest().expect("the same").1);
        player.request();
        assert!(player.rays.others_mut().making.is_none(), "they are there already");
    }

    #[test]
    fn rays_of_a_scene_that_plays_lag_behind_and_catch_up_when_it_stops() {
        let mut player = Player::new();
        player.request();
        player.play(0.4);
        player.request();
        player.wait();
        let (late, is_present) = player.rays.latest().expect("those of the rest pose");
        assert!(!is_present && !player.is_of_present_pose(&late) && player.rays.ready().is_none());
        player.request();
        player.wait();
        let (rays, is_present) = player.rays.latest().expect("those of 0.4 s");
        assert!(is_present && player.is_of_present_pose(&rays));
        assert!(corners(&late) != corners(&rays), "whoever holds the late ones keeps them as they were");
    }

    #[test]
    fn two_sets_of_rays_are_enough_for_an_animation_however_long() {
        let mut player = Player::new();
        for frame in 0..5u8 {
            player.request();
            assert!(player.rays.others_mut().spare.is_none(), "frame {frame}: what is spare is moved, not copied");
            player.wait();
            player.play(0.1 * f32::from(frame + 1));
            let others = player.rays.others_mut();
            assert_eq!((others.earlier.is_some(), others.spare.is_some()), (true, frame > 0), "frame {frame}");
        }
    }

    #[test]
    fn who_can_wait_gets_what_a_thread_is_making() {
        let mut player = Player::new();
        player.request();
        let posed = Posed { scene: &player.scene, pose: &player.pose, origin: DVec3::ZERO };
        let rays = Arc::clone(player.rays.get_or_make(posed));
        assert!(player.is_of_present_pose(&rays) && !player.rays.take(), "it is taken once");
    }
}
