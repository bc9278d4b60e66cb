//! The content of the pictures: cameras, boxes, their maps, and views along the light.

use anyhow::Result;
use shadowfit::glam::{DVec2, DVec3, UVec2, Vec3, Vec4};
use shadowfit::settings::{CasterPolicy, FitKind, FitSettings, Stabilise};
use shadowfit::{
    Aabb, FitInput, FitState, FittedMaps, LightProjection, PerspectiveCamera, Scratch, SingleMap, Technique,
    ViewFrustum,
};

use super::canvas::{Canvas, Frame, GREY, Paint, stroke};

/// Size of the camera's picture for computations in pixels.
pub(super) const PICTURE: UVec2 = UVec2::new(1920, 1080);

/// Greatest number of boxes that a picture passes to a fit.
const MOST_BOXES: usize = 16;

/// Returns a camera at eye height with a heading (degrees from -z toward +x) and a pitch (degrees, up is
/// positive).
pub(super) fn camera(heading: f64, pitch: f64, fov_y: f32, far: f32) -> PerspectiveCamera {
    let (sin, cos) = libm::sincos(heading.to_radians());
    let (rise, level) = libm::sincos(pitch.to_radians());
    let forward = DVec3::new(sin * level, rise, -cos * level).as_vec3();
    let eye = DVec3::new(0.0, 1.7, 0.0);
    PerspectiveCamera { eye, forward, up: Vec3::Y, fov_y, aspect: 16.0 / 9.0, near: 0.5, far }
}

/// Returns a fit without a border, whose near plane comes from the caster extension. The pictures show single
/// parts of it.
pub(super) fn plain_fit(kind: FitKind) -> FitSettings {
    FitSettings::default().with_kind(kind).with_max_distance(40.0).with_casters(CasterPolicy::Extend).with_border(0.0)
}

/// Returns a technique with one map of such a fit, fitted afresh in each frame.
pub(super) fn one_map(fit: FitSettings) -> Technique {
    let map = SingleMap { shape: fit.shape, stabilise: Stabilise::Off };
    Technique::default().with_maps(map).with_fit(fit.map)
}

/// Fits consecutive frames. It owns the fitter's state and storage.
pub(super) struct Fitter {
    fitter: FitState,
    storage: Vec<DVec2>,
}

impl Fitter {
    pub(super) fn new() -> Self {
        Self { fitter: FitState::new(), storage: vec![DVec2::ZERO; Scratch::required(MOST_BOXES, 1)] }
    }

    pub(super) fn fit(&mut self, input: &FitInput, technique: &Technique) -> Result<FittedMaps> {
        Ok(self.fitter.fit(input, technique, &mut Scratch::new(&mut self.storage))?)
    }
}

/// A parallel projection of the world: origin, and the axes that point right and up on the page.
#[derive(Clone, Copy)]
pub(super) struct Look {
    pub(super) origin: DVec3,
    pub(super) right: DVec3,
    pub(super) up: DVec3,
}

impl Look {
    /// Returns the view from the light, with the map's right and up axes.
    pub(super) fn from_light(fit: &LightProjection) -> Self {
        let rows = fit.light_from_world.transpose();
        let [right, up] = [rows.x_axis, rows.y_axis].map(|row: Vec4| row.truncate().as_dvec3());
        Self { origin: fit.origin, right, up }
    }

    /// Returns the page position of a point that is relative to the origin.
    pub(super) fn relative(&self, p: DVec3) -> DVec2 {
        DVec2::new(self.right.dot(p), self.up.dot(p))
    }

    /// Returns the page positions of points with their own origin.
    fn points<const N: usize>(&self, points: [Vec3; N], origin: DVec3) -> [DVec2; N] {
        points.map(|point| self.relative(point.as_dvec3() + origin - self.origin))
    }

    pub(super) fn frustum(&self, view: &ViewFrustum) -> [DVec2; 8] {
        self.points(view.corners, view.origin)
    }

    pub(super) fn aabb(&self, aabb: &Aabb) -> [DVec2; 8] {
        self.points(aabb.corners(), DVec3::ZERO)
    }

    /// Returns the map's rectangle. This view must look along the light.
    pub(super) fn map(&self, fit: &LightProjection) -> [DVec2; 4] {
        let [a, b, c, d, ..] = fit.corners();
        self.points([a, b, c, d], fit.origin)
    }
}

/// Corner indices of each face of a frustum or a box.
const FACES: [[usize; 4]; 6] = [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

/// Draws a convex body by its faces. Two faces cover each point of it.
fn draw_body(canvas: &mut Canvas, frame: &Frame, corners: &[DVec2; 8], paint: Paint) {
    for face in FACES {
        canvas.polygon(face.map(|corner| frame.at(corners[corner])), paint);
    }
}

/// Draws a view frustum in the style of all pictures.
pub(super) fn draw_frustum(canvas: &mut Canvas, frame: &Frame, corners: &[DVec2; 8]) {
    draw_body(canvas, frame, corners, stroke("#b08d2a", 0.8).filled("#f4e3b2", 0.5));
}

/// Draws a box of the scene in the style of all pictures.
pub(super) fn draw_box(canvas: &mut Canvas, frame: &Frame, corners: &[DVec2; 8]) {
    draw_body(canvas, frame, corners, stroke(GREY, 0.7).filled(GREY, 0.13));
}

/// A visible point.
pub(super) struct Visible {
    /// Position relative to the eye.
    pub(super) point: Vec3,
    /// Normal of the surface, on the side of the eye.
    pub(super) normal: Vec3,
    /// View depth, in metres.
    pub(super) depth: f64,
    /// Movement of the point on its surface from one pixel of [`PICTURE`] to the next.
    pub(super) right: Vec3,
    pub(super) down: Vec3,
}

/// Returns the visible points of boxes, by rays through positions in the picture (0 to 1, across and down).
pub(super) fn visible(
    camera: &PerspectiveCamera,
    boxes: &[Aabb],
    places: impl Iterator<Item = DVec2>,
) -> Result<Vec<Visible>> {
    let frustum = camera.frustum()?;
    let corner = |i: usize| frustum.corners[i + 4].as_dvec3() / f64::from(camera.far);
    let (across, downward) = (corner(1) - corner(0), corner(3) - corner(0));
    let see = |place: DVec2| {
        let ray = corner(0) + across * place.x + downward * place.y;
        let met = boxes.iter().filter_map(|aabb| hit(camera.eye, ray, aabb));
        let (depth, normal) = met.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|met| met.0 < f64::from(camera.far))?;
        let step = |edge: DVec3, pixels: u32| {
            let moved = ray + edge / f64::from(pixels);
            let other = moved * (normal.dot(ray) * depth / normal.dot(moved));
            (other - ray * depth).as_vec3()
        };
        let (right, down) = (step(across, PICTURE.x), step(downward, PICTURE.y));
        Some(Visible { point: (ray * depth).as_vec3(), normal: normal.as_vec3(), depth, right, down })
    };
    Ok(places.filter_map(see).collect())
}

/// Returns the share of a ray at which it hits a box, and the normal of the face.
fn hit(eye: DVec3, ray: DVec3, aabb: &Aabb) -> Option<(f64, DVec3)> {
    let (mut enter, mut leave, mut face) = (0.0_f64, f64::MAX, DVec3::ZERO);
    for axis in 0..3 {
        let to = |plane: f32| (f64::from(plane) - eye[axis]) / ray[axis];
        let (a, b) = (to(aabb.min[axis]), to(aabb.max[axis]));
        if a.min(b) > enter {
            enter = a.min(b);
            face = DVec3::ZERO;
            face[axis] = if ray[axis] > 0.0 { -1.0 } else { 1.0 };
        }
        leave = leave.min(a.max(b));
    }
    (enter < leave && face != DVec3::ZERO).then_some((enter, face))
}
