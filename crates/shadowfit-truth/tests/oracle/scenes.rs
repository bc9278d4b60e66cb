//! Scenes whose shadows can be drawn by hand, with cameras and maps for them.

use glam::dcamera::rh::proj::directx::{orthographic, perspective};
use glam::dcamera::rh::view::{look_at_mat4, look_to_mat4};
use glam::{DMat4, DVec2, DVec3, Vec3};
use shadowfit_truth::{MeasuredMap, PixelCamera};

pub(crate) type Triangles = Vec<[Vec3; 3]>;

/// Returns two triangles with these corners in turn.
pub(crate) fn quad([a, b, c, d]: [Vec3; 4]) -> Triangles {
    vec![[a, b, c], [a, c, d]]
}

/// Returns a horizontal rectangle between two corners (x, z).
pub(crate) fn level(height: f32, from: [f32; 2], to: [f32; 2]) -> Triangles {
    let at = |x, z| Vec3::new(x, height, z);
    quad([at(from[0], from[1]), at(from[0], to[1]), at(to[0], to[1]), at(to[0], from[1])])
}

/// Returns the six sides of a box.
pub(crate) fn cuboid(min: Vec3, max: Vec3) -> Triangles {
    let at = |x: f32, y: f32, z: f32| min + (max - min) * Vec3::new(x, y, z);
    let side = |u: Vec3, v: Vec3, base: Vec3| {
        quad([base, base + u, base + u + v, base + v].map(|corner| at(corner.x, corner.y, corner.z)))
    };
    [
        side(Vec3::X, Vec3::Y, Vec3::ZERO),
        side(Vec3::X, Vec3::Y, Vec3::Z),
        side(Vec3::Y, Vec3::Z, Vec3::ZERO),
        side(Vec3::Y, Vec3::Z, Vec3::X),
        side(Vec3::Z, Vec3::X, Vec3::ZERO),
        side(Vec3::Z, Vec3::X, Vec3::Y),
    ]
    .concat()
}

/// Returns a sphere of `rings` rings of twice as many quads, with all corners on it.
pub(crate) fn sphere(centre: Vec3, radius: f32, rings: u32) -> Triangles {
    let step = core::f32::consts::PI / rings as f32;
    let at = |ring: u32, slice: u32| {
        let ((sin, cos), (east, north)) = ((ring as f32 * step).sin_cos(), (slice as f32 * step).sin_cos());
        centre + Vec3::new(sin * north, cos, sin * east) * radius
    };
    (0..rings)
        .flat_map(|ring| (0..2 * rings).map(move |slice| (ring, slice)))
        .flat_map(|(ring, slice)| {
            quad([at(ring, slice), at(ring + 1, slice), at(ring + 1, slice + 1), at(ring, slice + 1)])
        })
        .collect()
}

/// Returns a camera at `eye` that looks at `target`, 60 degrees high.
pub(crate) fn looking_at(eye: DVec3, target: DVec3, size: [u32; 2]) -> PixelCamera {
    let forward = (target - eye).normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let tangent = (0.5f64 * 60f64.to_radians()).tan();
    let aspect = f64::from(size[0]) / f64::from(size[1]);
    PixelCamera {
        eye,
        right,
        up: right.cross(forward),
        forward,
        half_size: DVec2::new(tangent * aspect, tangent),
        is_orthographic: false,
        size,
        near: 0.1,
        far: 100.0,
    }
}

/// Returns a camera `height` metres over the origin that looks straight down, with z downward in the picture
/// and pixels of `pixel` metres on the ground.
pub(crate) fn looking_down(height: f64, pixel: f64, size: [u32; 2]) -> PixelCamera {
    PixelCamera {
        eye: DVec3::Y * height,
        right: DVec3::X,
        up: DVec3::NEG_Z,
        forward: DVec3::NEG_Y,
        half_size: DVec2::new(size[0].into(), size[1].into()) * (0.5 * pixel / height),
        is_orthographic: false,
        size,
        near: 0.1,
        far: 100.0,
    }
}

/// A square map whose matrix tests can change before it is measured.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlainMap {
    pub(crate) clip_from_world: DMat4,
    pub(crate) texels: u32,
    pub(crate) split_far: f64,
}

impl PlainMap {
    pub(crate) fn measured(&self, to_light: DVec3) -> MeasuredMap {
        MeasuredMap::new(&self.clip_from_world, DVec2::splat(self.texels.into()), self.split_far, to_light)
    }
}

/// Returns a square orthographic map around `centre`: `width` metres wide, from `before` metres before it to
/// the same distance behind it.
pub(crate) fn map_around(centre: DVec3, to_light: DVec3, width: f64, before: f64, texels: u32) -> PlainMap {
    let up = if to_light.y.abs() > 0.9 { DVec3::NEG_Z } else { DVec3::Y };
    let light_from_world: DMat4 = look_to_mat4(centre + to_light * before, -to_light, up);
    let half = width * 0.5;
    let clip_from_world = orthographic(-half, half, -half, half, 0.0, 2.0 * before) * light_from_world;
    PlainMap { clip_from_world, texels, split_far: 1e9 }
}

/// Returns the map of [`map_around`], prepared for measuring.
pub(crate) fn shadow_map(centre: DVec3, to_light: DVec3, width: f64, before: f64, texels: u32) -> MeasuredMap {
    map_around(centre, to_light, width, before, texels).measured(to_light)
}

/// Returns the matrix clip from world of a lamp that looks at the origin, with -z approximately upward, 90
/// degrees wide, between two distances in metres.
pub(crate) fn lamp_image(position: DVec3, [near, far]: [f64; 2]) -> DMat4 {
    perspective(90f64.to_radians(), 1.0, near, far) * look_at_mat4(position, DVec3::ZERO, DVec3::NEG_Z)
}

/// Returns a square map with the image of [`lamp_image`], for every view depth.
pub(crate) fn lamp_map(position: DVec3, planes: [f64; 2], texels: u32) -> MeasuredMap {
    let image = lamp_image(position, planes);
    MeasuredMap::of_spot(&image, DVec2::splat(texels.into()), f64::INFINITY, position)
}
