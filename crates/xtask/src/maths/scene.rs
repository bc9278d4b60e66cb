//! What the pictures show: cameras, lights, boxes, and how they look from the light or from elsewhere.

use anyhow::Result;
use shadowfit::fits::fit_scene;
use shadowfit::glam::{DVec2, DVec3, UVec2, Vec3, Vec4};
use shadowfit::settings::{CasterPolicy, FitKind, FitSettings, SplitScheme, Stabilise};
use shadowfit::{Aabb, Boxes, FitInput, LightFit, PerspectiveCamera, Technique, ViewFrustum, Workspace};

use super::canvas::{Canvas, Frame, GREY, Paint, fill, stroke};

/// A camera at a man's height that looks along a heading (degrees from -z toward +x) and down or up by a pitch.
pub(super) fn camera(heading: f64, pitch: f64, fov_y: f32, far: f32) -> PerspectiveCamera {
    let (sin, cos) = libm::sincos(heading.to_radians());
    let (rise, level) = libm::sincos(pitch.to_radians());
    let forward = DVec3::new(sin * level, rise, -cos * level).as_vec3();
    PerspectiveCamera {
        eye: DVec3::new(0.0, 1.7, 0.0),
        forward,
        up: Vec3::Y,
        fov_y,
        aspect: 16.0 / 9.0,
        near: 0.5,
        far,
    }
}

/// A square of ground and some houses on it, in world coordinates.
pub(super) const VILLAGE: [Aabb; 6] = [
    Aabb::new(Vec3::new(-40.0, -0.3, -60.0), Vec3::new(60.0, 0.0, 20.0)),
    Aabb::new(Vec3::new(6.0, 0.0, -12.0), Vec3::new(9.0, 2.5, -9.0)),
    Aabb::new(Vec3::new(15.0, 0.0, -14.0), Vec3::new(19.0, 4.0, -10.0)),
    Aabb::new(Vec3::new(9.0, 0.0, -23.0), Vec3::new(13.0, 4.0, -18.0)),
    Aabb::new(Vec3::new(21.0, 0.0, -23.0), Vec3::new(26.0, 5.0, -18.0)),
    Aabb::new(Vec3::new(19.0, 0.0, -32.0), Vec3::new(23.0, 4.0, -28.0)),
];

/// The frustum's box with nothing beside it, near plane by extension: what the pictures show the parts of a fit on.
pub(super) fn plain_fit() -> FitSettings {
    FitSettings::default()
        .with_kind(FitKind::FrustumAabb)
        .with_max_distance(40.0)
        .with_casters(CasterPolicy::Extend)
        .with_border(0.0)
}

/// Four maps of such fits around what is seen, on the grid of texels.
pub(super) fn plain_maps() -> Technique {
    Technique::default()
        .with_fit(plain_fit().with_kind(FitKind::Focused))
        .with_splits(SplitScheme::FromBoxes)
        .with_stabilise(Stabilise::Snap)
}

/// Boxes in world coordinates as fits take them.
pub(super) fn boxes(boxes: &[Aabb]) -> Boxes<'_> {
    Boxes { origin: DVec3::ZERO, boxes }
}

/// Fits one map, with as much storage as it takes.
pub(super) fn fit_one(input: &FitInput, settings: &FitSettings) -> Result<LightFit> {
    let count = input
        .receivers
        .map_or(0, |receivers| receivers.boxes.len())
        .max(input.casters.map_or(0, |casters| casters.boxes.len()));
    let mut storage = vec![DVec2::ZERO; Workspace::required(count, input.views.len())];
    Ok(fit_scene(input, settings, &mut Workspace::new(&mut storage))?)
}

/// A parallel view of the world: the axes that point right and up on the page, from an origin.
#[derive(Clone, Copy)]
pub(super) struct Look {
    pub(super) origin: DVec3,
    pub(super) right: DVec3,
    pub(super) up: DVec3,
}

impl Look {
    /// What the light sees: the map's right and up.
    pub(super) fn from_light(fit: &LightFit) -> Self {
        let [right, up, _] = axes(fit);
        Self { origin: fit.origin, right, up }
    }

    /// The map's right on the page, and the direction toward the light up.
    pub(super) fn from_side(fit: &LightFit) -> Self {
        let [right, _, up] = axes(fit);
        Self { origin: fit.origin, right, up }
    }

    /// A point in world coordinates.
    pub(super) fn at(&self, p: DVec3) -> DVec2 {
        self.relative(p - self.origin)
    }

    /// A point relative to the origin.
    pub(super) fn relative(&self, p: DVec3) -> DVec2 {
        DVec2::new(self.right.dot(p), self.up.dot(p))
    }

    pub(super) fn frustum(&self, view: &ViewFrustum) -> [DVec2; 8] {
        view.corners.map(|corner| self.at(corner.as_dvec3() + view.origin))
    }

    /// Corners of the map's box: near face, then far face.
    pub(super) fn map(&self, fit: &LightFit) -> [DVec2; 8] {
        fit.corners().map(|corner| self.at(corner.as_dvec3() + fit.origin))
    }

    pub(super) fn aabb(&self, aabb: &Aabb) -> [DVec2; 8] {
        corners(aabb).map(|corner| self.at(corner))
    }
}

/// The map's axes in the world: right, up, toward the light.
pub(super) fn axes(fit: &LightFit) -> [DVec3; 3] {
    let rows = fit.light_from_world.transpose();
    [rows.x_axis, rows.y_axis, rows.z_axis].map(|row: Vec4| row.truncate().as_dvec3())
}

/// A box's corners: the four with the least z around, then the others.
pub(super) fn corners(aabb: &Aabb) -> [DVec3; 8] {
    let (a, b) = (aabb.min.as_dvec3(), aabb.max.as_dvec3());
    [
        (a.x, a.y, a.z),
        (b.x, a.y, a.z),
        (b.x, b.y, a.z),
        (a.x, b.y, a.z),
        (a.x, a.y, b.z),
        (b.x, a.y, b.z),
        (b.x, b.y, b.z),
        (a.x, b.y, b.z),
    ]
    .map(|(x, y, z)| DVec3::new(x, y, z))
}

/// Pairs of corners that an edge joins, for frusta, maps and boxes alike.
pub(super) const EDGES: [(usize, usize); 12] =
    [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)];

/// Draws a body of eight corners: its outline painted, and its edges thin.
pub(super) fn draw_body(canvas: &mut Canvas, frame: &Frame, corners: &[DVec2; 8], paint: Paint, edges: Paint) {
    canvas.polygon(hull(corners).into_iter().map(|p| frame.at(p)), paint);
    for (i, j) in EDGES {
        canvas.line(frame.at(corners[i]), frame.at(corners[j]), edges);
    }
}

/// Draws a view frustum as all pictures do.
pub(super) fn draw_frustum(canvas: &mut Canvas, frame: &Frame, corners: &[DVec2; 8]) {
    draw_body(canvas, frame, corners, fill("#f4e3b2", 0.75), stroke("#b08d2a", 0.8));
}

/// Draws a box of the scene as all pictures do.
pub(super) fn draw_box(canvas: &mut Canvas, frame: &Frame, corners: &[DVec2; 8]) {
    draw_body(canvas, frame, corners, fill(GREY, 0.25), stroke(GREY, 0.7));
}

/// Convex hull, anticlockwise in plot coordinates.
pub(super) fn hull(points: &[DVec2]) -> Vec<DVec2> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let mut out: Vec<DVec2> = Vec::new();
    let mut chain = |points: &mut dyn Iterator<Item = DVec2>| {
        let start = out.len();
        for p in points {
            while out.len() >= start + 2
                && (out[out.len() - 1] - out[out.len() - 2]).perp_dot(p - out[out.len() - 2]) <= 0.0
            {
                out.pop();
            }
            out.push(p);
        }
        out.pop();
    };
    chain(&mut sorted.iter().copied());
    chain(&mut sorted.iter().rev().copied());
    out
}

/// A visible point.
pub(super) struct Visible {
    /// Position relative to the eye.
    pub(super) point: Vec3,
    /// Of the surface, on the side of the eye.
    pub(super) normal: Vec3,
    /// View depth, in metres.
    pub(super) depth: f64,
    /// How far the point moves on its surface from one pixel to the next.
    pub(super) right: Vec3,
    pub(super) down: Vec3,
}

/// What a camera sees of boxes in a picture of `size` pixels, by rays through places in it, from 0 to 1 across and down.
pub(super) fn visible(
    camera: &PerspectiveCamera,
    boxes: &[Aabb],
    places: impl Iterator<Item = DVec2>,
    size: UVec2,
) -> Result<Vec<Visible>> {
    let frustum = camera.frustum()?;
    let corner = |i: usize| frustum.corners[i + 4].as_dvec3() / f64::from(camera.far);
    let (across, downward) = (corner(1) - corner(0), corner(3) - corner(0));
    let mut out = Vec::new();
    for place in places {
        let ray = corner(0) + across * place.x + downward * place.y;
        let Some((depth, normal)) = boxes.iter().filter_map(|aabb| hit(camera.eye, ray, aabb)).reduce(nearer) else {
            continue;
        };
        if depth >= f64::from(camera.far) {
            continue;
        }
        let step = |edge: DVec3, pixels: u32| {
            let moved = ray + edge / f64::from(pixels);
            let other = moved * (normal.dot(ray) * depth / normal.dot(moved));
            (other - ray * depth).as_vec3()
        };
        let (right, down) = (step(across, size.x), step(downward, size.y));
        out.push(Visible { point: (ray * depth).as_vec3(), normal: normal.as_vec3(), depth, right, down });
    }
    Ok(out)
}

fn nearer(a: (f64, DVec3), b: (f64, DVec3)) -> (f64, DVec3) {
    if b.0 < a.0 { b } else { a }
}

/// Share of a ray at which it meets a box, and the face's normal.
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
