//! The courtyard as plain opaque triangles, with its camera and its maps.

use shadowfit::glam::Vec3;
use shadowfit::{Aabb, Boxes, FitError, FitInput, FittedMaps, PerspectiveCamera, ShadowFitter, Technique};
use shadowfit_scene::builtin::{default_camera, default_scene};

/// Triangles, camera and sun; world space, metres.
pub(crate) struct Courtyard {
    /// Triangles of each object.
    pub(crate) objects: Vec<Vec<[Vec3; 3]>>,
    pub(crate) camera: PerspectiveCamera,
    /// Direction of travel of the sunlight.
    pub(crate) sun: Vec3,
}

impl Courtyard {
    /// Returns the courtyard at rest, for pictures of a size in pixels.
    pub(crate) fn new(size: [u32; 2]) -> Self {
        let scene = default_scene();
        let mut objects = vec![Vec::new(); scene.instances().len()];
        for triangle in scene.pose(None, 0.0).triangles(&scene) {
            objects[triangle.instance as usize].push(triangle.vertices);
        }
        objects.retain(|triangles| !triangles.is_empty());
        let (eye, target) = default_camera();
        let camera = PerspectiveCamera {
            eye: eye.as_dvec3(),
            forward: (target - eye).normalize(),
            up: Vec3::Y,
            fov_y: 0.9,
            aspect: size[0] as f32 / size[1] as f32,
            near: 0.1,
            far: 100.0,
        };
        Self { objects, camera, sun: scene.sun.map_or(Vec3::NEG_Y, |sun| sun.direction) }
    }

    /// Returns the maps of the first frame, fitted to the boxes of the objects.
    pub(crate) fn fit(&self, technique: &Technique) -> Result<FittedMaps, FitError> {
        let around = |triangles: &Vec<[Vec3; 3]>| {
            let corners = triangles.iter().flatten().copied();
            let start = [Vec3::INFINITY, Vec3::NEG_INFINITY];
            let [min, max] = corners.fold(start, |[min, max], corner| [min.min(corner), max.max(corner)]);
            Aabb::new(min, max)
        };
        let boxes: Vec<Aabb> = self.objects.iter().map(around).collect();
        let boxes = Some(Boxes::world(&boxes));
        let views = [self.camera.frustum()?];
        let input = FitInput { receivers: boxes, casters: boxes, ..FitInput::new(&views, self.sun) };
        ShadowFitter::new(technique).fit(&input).cloned()
    }
}
