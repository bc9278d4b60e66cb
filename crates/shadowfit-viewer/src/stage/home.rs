//! The settings and the view that a scene is opened with.

use glam::{DVec3, Mat4, Vec3};
use shadowfit::Aabb;
use shadowfit_params::tool::{LightSettings, Settings};
use shadowfit_render::FlyCamera;
use shadowfit_scene::Lens;
use shadowfit_study::PreparedScene;

/// Settings and view for a scene: its own camera and sun where it has them.
pub(super) fn home(prepared: &PreparedScene) -> (Settings, FlyCamera) {
    let (scene, bounds) = (prepared.scene(), prepared.bounds());
    let mut settings = Settings::default();
    if let Some(light) = scene.sun.and_then(|sun| LightSettings::from_direction(sun.direction)) {
        settings.light = LightSettings { azimuth: light.azimuth, elevation: light.elevation, ..settings.light };
    }
    let radius = ((bounds.max - bounds.min).length() * 0.5).max(1e-3);
    if scene.subject.is_none() {
        // A scene of unknown units: all lengths follow from its size. Shadows reach as far as the camera sees, since
        // maps are placed by content and not by distance.
        settings.technique.fit.caster_extension = radius * 2.0;
        settings.camera.near = radius * 0.005;
        settings.camera.far = radius * 20.0;
        settings.camera.speed = radius * 0.4;
    }
    let camera = own_camera(prepared, &mut settings).unwrap_or_else(|| overview(&bounds, radius, &settings));
    (settings, camera)
}

/// The scene's first perspective camera.
fn own_camera(prepared: &PreparedScene, settings: &mut Settings) -> Option<FlyCamera> {
    prepared.scene().cameras.iter().find_map(|camera| {
        let Lens::Perspective { fov_y, near, far } = camera.lens else { return None };
        let world: &Mat4 = prepared.pose().world_from_node.get(camera.node)?;
        let eye = world.w_axis.truncate();
        let forward = -world.z_axis.truncate();
        if !eye.is_finite() || !forward.is_finite() || forward == Vec3::ZERO {
            return None;
        }
        settings.camera.fov_y = fov_y.clamp(0.1, 2.5);
        if near > 0.0 && near < settings.camera.far {
            settings.camera.near = near;
        }
        if let Some(far) = far.filter(|far| *far > settings.camera.near * 2.0) {
            settings.camera.far = far;
        }
        let mut fly = FlyCamera { position: eye.as_dvec3(), yaw: 0.0, pitch: 0.0 };
        fly.look_along(forward);
        Some(fly)
    })
}

/// A view of everything, from a little above and on the lit side.
fn overview(bounds: &Aabb, radius: f32, settings: &Settings) -> FlyCamera {
    let center = (bounds.min + bounds.max) * 0.5;
    let to_light = -settings.light.direction();
    let level = Vec3::new(to_light.x, 0.0, to_light.z).normalize_or(Vec3::Z);
    let side = level.cross(Vec3::Y);
    let away = (level * 0.75 + side * 0.65 + Vec3::Y * 0.5).normalize();
    let distance = radius / (settings.camera.fov_y * 0.5).sin() * 0.75;
    let eye: DVec3 = (center + away * distance).as_dvec3();
    FlyCamera::look_at(eye, center.as_dvec3())
}
