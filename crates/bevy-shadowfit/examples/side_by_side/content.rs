//! The scene that is shown, at rest, and where its camera and its sun begin.

use std::path::Path;

use shadowfit::glam::{Vec3, Vec4};
use shadowfit_scene::builtin::default_scene;
use shadowfit_scene::{BlendedCasters, Casting, Instance, Lens, Pose, Primitive, Scene, SceneError, load_gltf};

/// Vertical field of view where the scene has no camera, in radians.
const FOV_Y: f32 = 0.785;
/// Direction in which the light of a scene without a sun travels.
const SUN: Vec3 = Vec3::new(-0.41, -0.68, -0.6);
/// Least extent of a scene, in metres, so that one without triangles has a camera as well.
const MIN_EXTENT: f32 = 1.0;

/// A scene and where everything in it is. World space is right-handed, y up, in metres.
pub(crate) struct Content {
    pub(crate) scene: Scene,
    pub(crate) pose: Pose,
    /// Corners of a box around everything.
    bounds: [Vec3; 2],
}

/// Where a camera begins.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StartView {
    pub(crate) eye: Vec3,
    /// Direction of view, of any length.
    pub(crate) forward: Vec3,
    /// Vertical field of view, in radians.
    pub(crate) fov_y: f32,
}

impl Content {
    /// Loads a glTF file, or makes the built-in courtyard.
    ///
    /// # Errors
    ///
    /// When the file cannot be read as a scene.
    pub(crate) fn load(file: Option<&Path>) -> Result<Self, SceneError> {
        let scene = match file {
            Some(file) => {
                let scene = load_gltf(file)?;
                scene.warnings(file).for_each(|warning| eprintln!("{warning}"));
                scene
            }
            None => default_scene(),
        };
        let scene = Scene { blended_casters: BlendedCasters::Never, ..scene };
        let pose = scene.pose(None, 0.0);
        let bounds = scene.bounds(&pose).map_or([Vec3::ZERO; 2], |bounds| [bounds.min, bounds.max]);
        Ok(Self { scene, pose, bounds })
    }

    /// The diagonal of the box around everything, in metres.
    pub(crate) fn extent(&self) -> f32 {
        (self.bounds[1] - self.bounds[0]).length().max(MIN_EXTENT)
    }

    /// The first camera of the scene, or a look at its middle from above a corner, where nothing is in the way.
    pub(crate) fn start_view(&self) -> StartView {
        if let Some(camera) = self.scene.cameras.first() {
            let world_from_camera = self.pose.world_from_node[camera.node];
            let fov_y = match camera.lens {
                Lens::Perspective { fov_y, .. } => fov_y,
                Lens::Orthographic { .. } => FOV_Y,
            };
            let forward = -world_from_camera.z_axis.truncate();
            return StartView { eye: world_from_camera.w_axis.truncate(), forward, fov_y };
        }
        let [min, max] = self.bounds;
        let (middle, size) = ((min + max) * 0.5, max - min);
        let eye = Vec3::new(middle.x + 0.3 * size.x, max.y + 0.06 * self.extent(), middle.z + 0.4 * size.z);
        StartView { eye, forward: middle - eye, fov_y: FOV_Y }
    }

    /// Direction in which the sunlight travels; not vertical.
    pub(crate) fn sunlight(&self) -> Vec3 {
        self.scene.sun.map_or(SUN, |sun| sun.direction)
    }

    /// The vertices of an instance before its pose.
    pub(crate) fn primitive(&self, instance: &Instance) -> &Primitive {
        &self.scene.meshes[instance.mesh].primitives[instance.primitive]
    }

    /// Whether an instance casts shadows.
    pub(crate) fn casts(&self, instance: &Instance) -> bool {
        self.scene.casting(self.primitive(instance)) != Casting::Nothing
    }

    /// Colour of a vertex, linear; white where the scene has none.
    pub(crate) fn color(primitive: &Primitive, vertex: usize) -> Vec4 {
        primitive.colors.get(vertex).copied().unwrap_or(Vec4::ONE)
    }
}
