//! The search for views: casts coarse pictures of rays from candidate cameras, to find views that show an
//! artefact. Positions are relative to the origin of the scene's rays, in metres.

use glam::{DVec3, Vec3};
use shadowfit::{Aabb, PerspectiveCamera, ShadowFitter, Technique};
use shadowfit_params::Inputs;
use shadowfit_study::{PosedScene, View};
use shadowfit_truth::Tracer;

use crate::stage::fitted::Fitted;

/// Columns and rows of a candidate's coarse picture.
pub(crate) const GRID: [u32; 2] = [32, 18];
/// Number of light rays along each side of the square that is searched for shadows.
const LIGHT_GRID: i32 = 24;
/// Least distance from caster to shadow, in radii of the searched bounds.
const LEAST_REACH: f32 = 0.02;
/// Offset of shadow rays along the normal, as a share of the scene's size.
const RAY_OFFSET: f32 = 1e-4;

/// The surface at one coarse pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// Visible point.
    pub(crate) position: Vec3,
    /// Unit geometric normal toward the eye.
    pub(crate) normal: Vec3,
    /// Distance from the eye, in metres.
    pub(crate) distance: f32,
}

/// A point in shadow and its caster.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shadow {
    /// The point in shadow.
    pub(crate) receiver: Vec3,
    /// Distance of the caster toward the light, in metres.
    pub(crate) reach: f32,
}

/// A scene under one light.
pub(crate) struct ViewSearch<'a> {
    scene: &'a PosedScene,
    inputs: Inputs,
    tracer: &'a Tracer,
    /// Direction of travel of the light.
    pub(crate) direction: Vec3,
    to_light: Vec3,
    offset: f32,
}

impl<'a> ViewSearch<'a> {
    pub(crate) fn new(scene: &'a PosedScene, inputs: Inputs, direction: Vec3) -> Self {
        let bounds = scene.bounds();
        let offset = (bounds.max - bounds.min).length() * RAY_OFFSET;
        Self { scene, inputs, tracer: &scene.rays().tracer, direction, to_light: -direction, offset }
    }

    /// Fits the maps of a candidate, as the viewer does after moving the camera to a new view; `None` if
    /// fitting fails.
    pub(crate) fn fit(&self, technique: &Technique, camera: &PerspectiveCamera) -> Option<Fitted> {
        let camera = PerspectiveCamera { eye: self.world(camera.eye), ..*camera };
        let view = View { camera: camera.into(), direction: self.direction, is_first: true };
        let maps = self.scene.fit_alone(&mut ShadowFitter::new(technique), self.inputs, &view).ok()?;
        Some(Fitted::new(camera, technique, &maps))
    }

    /// Returns the world position of a point of the search.
    pub(crate) fn world(&self, point: DVec3) -> DVec3 {
        self.scene.origin() + point
    }

    /// Returns the coarse picture of a camera, rows from the top.
    pub(crate) fn look(&self, camera: &PerspectiveCamera) -> Vec<Option<Seen>> {
        let right = camera.forward.cross(Vec3::Y).normalize_or(Vec3::X);
        let up = right.cross(camera.forward);
        let half_height = (camera.fov_y * 0.5).tan();
        let eye = camera.eye.as_vec3();
        (0..GRID[0] * GRID[1])
            .map(|index| {
                let x = ((index % GRID[0]) as f32 + 0.5) / GRID[0] as f32 * 2.0 - 1.0;
                let y = 1.0 - ((index / GRID[0]) as f32 + 0.5) / GRID[1] as f32 * 2.0;
                let ray = camera.forward + right * (x * half_height * camera.aspect) + up * (y * half_height);
                let ray = ray.normalize();
                let hit = self.tracer.first_hit(eye, ray)?;
                let normal = self.tracer.normal(hit.triangle);
                Some(Seen {
                    position: eye + ray * hit.distance,
                    normal: if normal.dot(ray) > 0.0 { -normal } else { normal },
                    distance: hit.distance,
                })
            })
            .collect()
    }

    /// Returns the cosine between the normal of a visible surface and the direction toward the light.
    pub(crate) fn facing(&self, seen: &Seen) -> f32 {
        seen.normal.dot(self.to_light)
    }

    /// Returns whether a visible point is in shadow.
    pub(crate) fn is_shadowed(&self, seen: &Seen) -> bool {
        self.tracer.is_occluded(seen.position + seen.normal * self.offset, self.to_light)
    }

    /// Returns the points of a coarse picture that face the light and are in shadow.
    pub(crate) fn shadowed<'p>(&self, pixels: &'p [Option<Seen>]) -> Vec<Option<&'p Seen>> {
        let is_shadowed = |seen: &&Seen| self.facing(seen) > 0.0 && self.is_shadowed(seen);
        pixels.iter().map(|seen| seen.as_ref().filter(is_shadowed)).collect()
    }

    /// Returns for each point in shadow whether it lies in a hole.
    pub(crate) fn holes(&self, shadowed: &[Option<&Seen>], fitted: &Fitted) -> Vec<Option<bool>> {
        shadowed.iter().map(|seen| seen.map(|seen| self.is_hole(seen, fitted))).collect()
    }

    /// Returns whether all casters of a visible point's shadow are outside the map that it reads.
    fn is_hole(&self, seen: &Seen, fitted: &Fitted) -> bool {
        let origin = seen.position + seen.normal * self.offset;
        let Some(map) = fitted.read_at(self.world(origin.as_dvec3())) else { return false };
        let fit = &fitted.maps[map].projection;
        let hits = self.tracer.all_hits(origin, self.to_light);
        let inside = |distance: f32| fit.covers(self.world((origin + self.to_light * distance).as_dvec3()));
        !hits.is_empty() && !hits.iter().any(|hit| inside(hit.distance))
    }

    /// Returns the shadows that casters inside `bounds` cast on surfaces that face the light, in search
    /// order.
    pub(crate) fn shadows(&self, bounds: &Aabb) -> Vec<Shadow> {
        let center = (bounds.min + bounds.max) * 0.5;
        let radius = (bounds.max - bounds.min).length() * 0.5;
        let [u, v] =
            [self.to_light.any_orthonormal_vector(), self.to_light.cross(self.to_light.any_orthonormal_vector())];
        let step = |index: i32| (index as f32 + 0.5) / LIGHT_GRID as f32 * 2.0 - 1.0;
        (0..LIGHT_GRID * LIGHT_GRID)
            .filter_map(|index| {
                let across = u * step(index % LIGHT_GRID) + v * step(index / LIGHT_GRID);
                self.shadow_along(center + across * radius, radius)
            })
            .collect()
    }

    /// Returns the shadow of the first caster within `radius` of `middle` on the farthest surface behind it
    /// that faces the light.
    fn shadow_along(&self, middle: Vec3, radius: f32) -> Option<Shadow> {
        let start = middle + self.to_light * radius;
        let mut hits = self.tracer.all_hits(start, -self.to_light);
        hits.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let caster = hits.first().filter(|hit| hit.distance < radius * 2.0)?;
        let faces = |triangle| self.tracer.normal(triangle).dot(self.to_light) > 0.3;
        let least = caster.distance + radius * LEAST_REACH;
        let receiver = hits[1..].iter().rfind(|hit| hit.distance > least && faces(hit.triangle))?;
        Some(Shadow { receiver: start - self.to_light * receiver.distance, reach: receiver.distance - caster.distance })
    }
}

/// Returns a camera at `eye` that looks at `target`, with the lens of another.
pub(crate) fn aimed(lens: &PerspectiveCamera, eye: Vec3, target: Vec3) -> PerspectiveCamera {
    let forward = (target - eye).normalize_or(Vec3::NEG_Z);
    PerspectiveCamera { eye: DVec3::from(eye), forward, ..*lens }
}
