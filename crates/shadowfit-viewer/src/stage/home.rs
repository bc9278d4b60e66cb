//! The initial settings and view of a scene, and the cameras and suns of its file.

use glam::{DVec3, Vec3};
use shadowfit::{Aabb, Camera, Lens};
use shadowfit_params::set_from_str;
use shadowfit_params::tool::{CameraSettings, Settings};
use shadowfit_render::FlyCamera;
use shadowfit_study::{PosedScene, near_of};

use super::Stage;

/// Returns the initial settings and view of a scene, with its own camera and sun if it has them.
pub(super) fn home(prepared: &PosedScene) -> (Settings, FlyCamera) {
    let (scene, bounds) = (prepared.scene(), prepared.bounds());
    let mut settings = Settings::default();
    if let Some(sun) = scene.sun {
        settings.light.point_along(sun.direction);
        settings.light.file = scene.strongest_sun().map(number);
    }
    let radius = radius(&bounds);
    if scene.subject.is_none() {
        // A scene of unknown units: all lengths follow from its size. Shadows reach the far plane, since maps
        // are placed by content and not by distance.
        settings.technique.fit.caster_extension = radius * 2.0;
        settings.camera.near = near_of(&bounds);
        settings.camera.far = radius * 20.0;
        settings.camera.speed = radius * 0.4;
    }
    let own = (1..).zip(&scene.cameras).find_map(|(number, _)| Some((number, seen_by(prepared, Some(number))?)));
    let Some((number, camera)) = own else {
        let camera = overview(&bounds, radius, &settings);
        return (settings, camera);
    };
    take_lens(&mut settings.camera, &camera);
    // Built-in scenes have a start view and no file.
    settings.camera.file = scene.subject.is_none().then_some(number);
    (settings, placed(&camera))
}

/// Returns half of the diagonal of a scene's bounds, in metres; a millimetre for a scene without a size.
fn radius(bounds: &Aabb) -> f32 {
    let radius = (bounds.max - bounds.min).length() * 0.5;
    if radius > 0.0 { radius } else { 1e-3 }
}

/// Returns the number of a file's sun with an index.
fn number(index: usize) -> u32 {
    u32::try_from(index + 1).unwrap_or(u32::MAX)
}

/// Returns the element of a list with a number that counts from 1.
fn numbered<T>(list: &[T], number: Option<u32>) -> Option<&T> {
    list.get((number? as usize).checked_sub(1)?)
}

/// Copies the lens of a camera of the file into the settings.
fn take_lens(settings: &mut CameraSettings, camera: &Camera) {
    let (fov_y, height) = match camera.lens {
        Lens::Perspective { fov_y } => (fov_y, None),
        Lens::Orthographic { half_height } => (settings.fov_y, Some(half_height * 2.0)),
    };
    *settings = CameraSettings { fov_y, height, near: camera.near, far: camera.far, ..*settings };
}

/// Returns the camera of the file with a number, in the current pose. `None` without such a camera, or if its
/// node has a scale of zero.
fn seen_by(scene: &PosedScene, number: Option<u32>) -> Option<Camera> {
    // The aspect comes from the window, not from the settings.
    scene.file_camera((number? as usize).checked_sub(1)?, 1.0)
}

/// Returns the position and direction of a camera of the file.
fn placed(camera: &Camera) -> FlyCamera {
    FlyCamera::placed(camera.eye, camera.forward, camera.up)
}

impl Stage {
    /// Moves sun and camera to the file's sun and camera that the settings name, in the current pose. A
    /// number that the file lacks counts as none. The lens is copied once, when a camera is chosen.
    pub(crate) fn follow_file(&mut self) {
        let (scene, pose) = (self.scene.scene(), self.scene.pose());
        let light = &mut self.settings.light;
        match numbered(&scene.suns, light.file) {
            Some(sun) => sun.direction(pose).into_iter().for_each(|direction| light.point_along(direction)),
            None => light.file = None,
        }
        let file = self.settings.camera.file;
        let Some(camera) = seen_by(&self.scene, file) else {
            (self.settings.camera.file, self.followed) = (None, None);
            return;
        };
        if self.followed != file {
            self.set_camera(placed(&camera));
            take_lens(&mut self.settings.camera, &camera);
            (self.settings.camera.file, self.followed) = (file, file);
        }
        self.camera = placed(&camera);
    }

    /// Restores settings that already have the lens of their camera of the file.
    pub(crate) fn restore_settings(&mut self, settings: &Settings) {
        if settings.camera.file != self.settings.camera.file {
            self.set_camera(self.camera);
        }
        (self.settings, self.followed) = (*settings, settings.camera.file);
    }

    /// Applies the file's camera among the parameters, if there is one, and gives the settings its lens. Set
    /// the other parameters afterwards, since they may change the lens. An invalid value changes nothing.
    pub(crate) fn choose_camera<'a>(
        &self,
        parameters: impl IntoIterator<Item = (&'a str, &'a str)>,
        settings: &mut Settings,
    ) {
        let Some((id, value)) = parameters.into_iter().filter(|(id, _)| *id == "camera.file").last() else { return };
        if set_from_str(settings, id, value).is_ok()
            && let Some(camera) = seen_by(&self.scene, settings.camera.file)
        {
            take_lens(&mut settings.camera, &camera);
        }
    }

    /// Returns the distance above the surface at which shadow rays start, in metres.
    pub(crate) fn ray_offset(&self) -> f64 {
        self.settings.view.ray_offset.map_or(self.scene.ray_offset(), f64::from)
    }
}

/// Returns a view of the whole scene, from above on the lit side.
fn overview(bounds: &Aabb, radius: f32, settings: &Settings) -> FlyCamera {
    let center = (bounds.min + bounds.max) * 0.5;
    let to_light = -settings.light.direction();
    let level = Vec3::new(to_light.x, 0.0, to_light.z).normalize_or(Vec3::Z);
    let side = level.cross(Vec3::Y);
    let away = (level * 0.75 + side * 0.65 + Vec3::Y * 0.5).normalize();
    let distance = radius / (settings.camera.fov_y * 0.5).sin() * 0.75;
    let eye: DVec3 = center.as_dvec3() + (away * distance).as_dvec3();
    FlyCamera::look_at(eye, center.as_dvec3())
}
