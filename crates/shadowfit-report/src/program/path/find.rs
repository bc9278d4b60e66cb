//! A path for a scene that comes without one: an orbit around it and a flight through it.
//!
//! The path depends only on the geometry, so that a helmet and a landscape both get a useful one. Rays ensure
//! that no camera is inside geometry, and that geometry fills most of the picture of a camera in the scene.

use anyhow::{Result, ensure};
use glam::Vec3;
use rayon::prelude::*;
use shadowfit::{Aabb, Camera, PerspectiveCamera};
use shadowfit_truth::Tracer;

use super::probe::{Probe, is_a_point};
use super::route::{Places, Route};
use super::{CameraPath, PathFrame};

/// Number of frames of the orbit, and of the flight.
const FRAMES: usize = 16;
/// Vertical field of view, in degrees. It is also the default of path files.
const FOV: f32 = 60.0;
/// Elevation of the orbit's eye, in degrees: high enough to see the ground between objects.
const ORBIT_ELEVATION: f32 = 22.0;
/// Share of half of the picture that the scene may fill in the orbit.
const ORBIT_FILL: f32 = 0.95;
/// Minimum distance of cameras from triangles, as a share of the scene's radius.
const CLEARANCE: f32 = 0.005;
/// Distance of the near plane's corners, as a share of the clearance.
const NEAR_SHARE: f32 = 0.9;
/// Factor for the far plane beyond the farthest corner of the scene.
const FAR_MARGIN: f32 = 1.02;
/// Height of a person's eyes, in metres.
const EYE_HEIGHT: f32 = 1.7;
/// Bounds of the eye height, as shares of the scene's radius: for scenes that are not of human scale.
const HEIGHT_SHARES: [f32; 2] = [0.01, 0.4];
/// Factors of the eye height, in the order of trying: unchanged, lower for models that are small compared
/// with it, and higher for rough ground.
const RAISES: [f32; 5] = [1.0, 0.4, 2.0, 4.0, 8.0];
/// Shares of the route, in the order of trying, for routes that are not usable as a whole.
const SHARES: [f32; 7] = [1.0, 0.85, 0.7, 0.55, 0.4, 0.28, 0.16];
/// View angles below the horizon for the flight, in degrees, in the order of trying.
const PITCHES: [f32; 4] = [6.0, 14.0, 22.0, 32.0];
/// Least share of a view's rays that hit the scene.
const FILLED: f32 = 0.6;
/// Least median distance of a view's hits, in clearances. A smaller one means a wall right before the camera.
const ROOM: f32 = 10.0;
/// Least length of a flight, as a share of the scene's radius.
const LEAST_LENGTH: f32 = 0.1;
/// Number of frames that a camera looks ahead, so that it turns before its route does.
const AHEAD: usize = 3;
/// Number of smoothing passes over the corners of a route.
const SMOOTHINGS: usize = 6;
/// Shifts of a position that is too close to a triangle, in clearances, in the order of trying.
const SHIFTS: [f32; 4] = [1.0, 2.0, 4.0, 8.0];

/// A path, and notes on how it was found.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Found {
    pub(crate) path: CameraPath,
    /// Notes in whole sentences. May be empty.
    pub(crate) notes: Vec<String>,
}

/// Finds an orbit and a flight for the scene of `tracer`, whose triangles are within `bounds` (world space, y
/// up, metres), for pictures of `aspect`. The same scene gives the same path. If no flight is found, the path
/// is the orbit alone, with a note.
///
/// # Errors
///
/// If the scene is empty, or its bounds have no size.
pub(crate) fn find(tracer: &Tracer, bounds: Aabb, aspect: f32) -> Result<Found> {
    let Aabb { min: low, max: high } = bounds;
    ensure!(!tracer.is_empty(), "the scene has no triangles; give another scene");
    let radius = bounds.size().length() * 0.5;
    let sane = radius.is_finite() && radius > 0.0 && low.cmple(high).all();
    ensure!(sane, "the scene reaches from {low} to {high}, which is not a usable size; give a camera path for it");
    ensure!(aspect.is_finite() && aspect > 0.0, "an aspect ratio of {aspect} is not possible");
    let probe = Probe::new(tracer, radius * CLEARANCE);
    let lens = lens(radius, aspect);
    let mut frames = frames("orbit", orbit(&probe, bounds, lens));
    let mut notes = Vec::new();
    match flight(&probe, bounds, lens) {
        Some(cameras) => frames.extend(self::frames("fly-through", cameras)),
        None => notes.push(
            "No flight through the scene was found whose views are filled by geometry, so the path is the orbit alone; \
             write a camera path to look at the scene from inside."
                .to_owned(),
        ),
    }
    let farthest = |camera: &Camera| {
        bounds.corners().map(|corner| corner.distance(camera.eye.as_vec3())).into_iter().fold(0.0, f32::max)
    };
    let far = frames.iter().map(|frame| farthest(&frame.camera)).fold(0.0, f32::max) * FAR_MARGIN;
    for frame in &mut frames {
        frame.camera.far = far;
        frame.camera.frustum()?;
    }
    Ok(Found { path: CameraPath { frames, light: None }, notes })
}

fn frames(group: &str, cameras: Vec<PerspectiveCamera>) -> Vec<PathFrame> {
    cameras.into_iter().map(|camera| PathFrame { camera: camera.into(), group: group.to_owned() }).collect()
}

/// Returns a camera at the origin whose near plane's corners stay within the clearance. Its far plane is set
/// last.
fn lens(radius: f32, aspect: f32) -> PerspectiveCamera {
    let fov_y = FOV.to_radians();
    let corner = Vec3::new(aspect * (fov_y * 0.5).tan(), (fov_y * 0.5).tan(), 1.0).length();
    let near = radius * CLEARANCE * NEAR_SHARE / corner;
    let far = radius;
    PerspectiveCamera { eye: glam::DVec3::ZERO, forward: Vec3::NEG_Z, up: Vec3::Y, fov_y, aspect, near, far }
}

/// Returns cameras on a circle around the scene, at the least distance from which each one sees the whole
/// scene. They look at the point on the vertical through the centre that minimises this distance.
fn orbit(probe: &Probe, bounds: Aabb, lens: PerspectiveCamera) -> Vec<PerspectiveCamera> {
    let middle = (bounds.min + bounds.max) * 0.5;
    let (sin, cos) = ORBIT_ELEVATION.to_radians().sin_cos();
    let outward: Vec<Vec3> = (0..FRAMES)
        .map(|frame| (frame as f32 / FRAMES as f32 * std::f32::consts::TAU).sin_cos())
        .map(|(azimuth_sin, azimuth_cos)| Vec3::new(cos * azimuth_sin, sin, cos * azimuth_cos))
        .collect();
    let needs = outward.par_iter().map(|&outward| Needs::of(probe.tracer, middle, outward, &lens));
    let needs = needs.reduce(Needs::default, Needs::max);
    // Raising the target by r brings the eye r sin nearer, and moves the scene down by r cos in the picture.
    // It helps until top and bottom need the same distance, or no more than the sides.
    let steepness = cos / (lens.fov_y * 0.5).tan() / ORBIT_FILL;
    let level = (0.5 * (needs.top + needs.bottom)).max(needs.sides);
    let raise = ((needs.top - level).max(0.0) - (needs.bottom - level).max(0.0)) / steepness;
    let [top, bottom] = [needs.top - raise * steepness, needs.bottom + raise * steepness];
    let distance = top.max(bottom).max(needs.sides).max(needs.depth + 2.0 * probe.clearance) - raise * sin;
    let camera = |&outward: &Vec3| {
        let eye = (middle + Vec3::Y * raise + outward * distance).as_dvec3();
        PerspectiveCamera { eye, forward: -outward, ..lens }
    };
    outward.iter().map(camera).collect()
}

/// Least distances, in metres, from a point to a camera that looks at it, so that the whole scene is below
/// the top of the picture, above its bottom, between its sides, and in front of the camera.
#[derive(Clone, Copy, Debug)]
struct Needs {
    top: f32,
    bottom: f32,
    sides: f32,
    depth: f32,
}

impl Default for Needs {
    fn default() -> Self {
        Self { top: f32::MIN, bottom: f32::MIN, sides: f32::MIN, depth: f32::MIN }
    }
}

impl Needs {
    fn of(tracer: &Tracer, point: Vec3, outward: Vec3, lens: &PerspectiveCamera) -> Self {
        let right = Vec3::Y.cross(outward).normalize();
        let up = outward.cross(right);
        let tangent = (lens.fov_y * 0.5).tan() * ORBIT_FILL;
        let triangles = (0..tracer.len() as u32).map(|triangle| tracer.corners(triangle));
        triangles.filter(|corners| !is_a_point(corners)).flatten().fold(Self::default(), |needs, corner| {
            let corner = corner - point;
            let (depth, rise) = (corner.dot(outward), corner.dot(up) / tangent);
            let sides = depth + corner.dot(right).abs() / (tangent * lens.aspect);
            needs.max(Self { top: depth + rise, bottom: depth - rise, sides, depth })
        })
    }

    fn max(self, other: Self) -> Self {
        Self {
            top: self.top.max(other.top),
            bottom: self.bottom.max(other.bottom),
            sides: self.sides.max(other.sides),
            depth: self.depth.max(other.depth),
        }
    }
}

/// Returns cameras through the scene: the route is lowered, raised and shortened until all views are usable.
fn flight(probe: &Probe, bounds: Aabb, lens: PerspectiveCamera) -> Option<Vec<PerspectiveCamera>> {
    let radius = probe.clearance / CLEARANCE;
    let height = EYE_HEIGHT.clamp(HEIGHT_SHARES[0] * radius, HEIGHT_SHARES[1] * radius);
    let middle = (bounds.min + bounds.max) * 0.5;
    RAISES.iter().find_map(|raise| {
        let route = Places::new(probe, bounds, height * raise).route(middle)?;
        SHARES.iter().find_map(|&share| {
            let long_enough = route.length() * share >= LEAST_LENGTH * radius;
            long_enough.then(|| fly(probe, &route, share, lens)).flatten()
        })
    })
}

/// Returns cameras along a part of a route, in one direction or the other.
fn fly(probe: &Probe, route: &Route, share: f32, lens: PerspectiveCamera) -> Option<Vec<PerspectiveCamera>> {
    let mut eyes = smooth(probe, route.samples(FRAMES, share));
    for eye in &mut eyes {
        *eye = free(probe, *eye)?;
    }
    [false, true].into_iter().find_map(|back| {
        if back {
            eyes.reverse();
        }
        PITCHES.iter().find_map(|pitch| serving(probe, &eyes, pitch.to_radians(), lens))
    })
}

/// Returns the position, or one nearby, that is outside solids and away from every triangle.
fn free(probe: &Probe, eye: Vec3) -> Option<Vec3> {
    let aside = [Vec3::Y, Vec3::X, Vec3::NEG_X, Vec3::Z, Vec3::NEG_Z];
    let shifts = SHIFTS.iter().flat_map(|shift| aside.map(|aside| aside * shift * probe.clearance));
    let mut places = std::iter::once(eye).chain(shifts.map(|shift| eye + shift));
    places.find(|&place| probe.is_open(place) && probe.is_clear(place))
}

/// Smooths the corners of a route, where it stays open and keeps its height above the ground.
fn smooth(probe: &Probe, mut eyes: Vec<Vec3>) -> Vec<Vec3> {
    for _ in 0..SMOOTHINGS {
        for index in 1..eyes.len() - 1 {
            let (before, eye, after) = (eyes[index - 1], eyes[index], eyes[index + 1]);
            let smoothed = eye.lerp((before + after) * 0.5, 0.5);
            let is_high = || probe.height(smoothed) >= 0.7 * probe.height(eye).min(f32::MAX);
            let is_way = || probe.is_way(before, smoothed) && probe.is_way(smoothed, after);
            if is_high() && is_way() && probe.is_open(smoothed) {
                eyes[index] = smoothed;
            }
        }
    }
    eyes
}

/// Returns cameras that look ahead and down by an angle in radians, if geometry fills the picture of each.
fn serving(probe: &Probe, eyes: &[Vec3], pitch: f32, lens: PerspectiveCamera) -> Option<Vec<PerspectiveCamera>> {
    let last = eyes.len() - 1;
    let camera = |index: usize| {
        let from = eyes[index.min(last - AHEAD)];
        let ahead = (eyes[(index + AHEAD).min(last)] - from).with_y(0.0).try_normalize()?;
        let forward = ahead * pitch.cos() - Vec3::Y * pitch.sin();
        let camera = PerspectiveCamera { eye: eyes[index].as_dvec3(), forward, ..lens };
        let seen = probe.look(camera);
        (seen.share >= FILLED && seen.distance >= ROOM * probe.clearance).then_some(camera)
    };
    (0..eyes.len()).map(camera).collect()
}

#[cfg(test)]
mod tests {
    use super::super::scenes::{Corners, bounds, cuboid, hills, object_on_floor, room};
    use super::*;

    const ASPECT: f32 = 16.0 / 9.0;

    fn scaled(triangles: &[Corners], scale: f32) -> Vec<Corners> {
        triangles.iter().map(|corners| corners.map(|corner| corner * scale)).collect()
    }

    fn found(triangles: &[Corners]) -> Found {
        find(&Tracer::new(triangles.iter().copied()), bounds(triangles), ASPECT).expect("a path")
    }

    fn cameras<'a>(found: &'a Found, group: &'a str) -> Vec<&'a Camera> {
        found.path.frames.iter().filter(|frame| frame.group == group).map(|frame| &frame.camera).collect()
    }

    /// Asserts the guarantees of a found path with both of its parts.
    fn assert_serves(name: &str, triangles: &[Corners]) -> Found {
        let found = found(triangles);
        let bounds = bounds(triangles);
        let tracer = Tracer::new(triangles.iter().copied());
        let probe = Probe::new(&tracer, bounds.size().length() * 0.5 * CLEARANCE);
        assert_eq!(found.path.frames.len(), 2 * FRAMES, "{name}: {:?}", found.notes);
        for frame in &found.path.frames {
            let (camera, eye) = (&frame.camera, frame.camera.eye.as_vec3());
            assert!(probe.is_clear(eye), "{name}: {} at {eye}", frame.group);
            camera.frustum().expect("a frustum");
            for corner in bounds.corners() {
                assert!((corner - eye).dot(camera.forward) < camera.far, "{name}: {corner}");
            }
        }
        for camera in cameras(&found, "fly-through") {
            assert!(probe.is_open(camera.eye.as_vec3()) && probe.look(camera).share >= FILLED, "{name}: {camera:?}");
        }
        found
    }

    #[test]
    fn rooms_hills_and_floors_of_any_unit_get_an_orbit_and_a_flight() {
        for (name, triangles) in [("room", room()), ("hills", hills()), ("object", object_on_floor())] {
            for scale in [0.04, 1.0, 30.0] {
                assert_serves(&format!("{name} x {scale}"), &scaled(&triangles, scale));
            }
        }
    }

    #[test]
    fn the_flight_through_a_room_stays_in_it_and_moves() {
        let found = assert_serves("room", &room());
        let eyes: Vec<Vec3> = cameras(&found, "fly-through").iter().map(|camera| camera.eye.as_vec3()).collect();
        assert!(eyes.iter().all(|eye| eye.abs().cmplt(Vec3::new(4.0, 3.0, 3.0)).all() && eye.y > 0.5), "{eyes:?}");
        assert!(eyes[0].distance(eyes[FRAMES - 1]) > 2.0, "{eyes:?}");
    }

    #[test]
    fn the_orbit_sees_the_whole_scene_and_fills_the_picture_with_it() {
        let pole = cuboid(Vec3::ZERO, Vec3::new(0.1, 9.0, 0.1));
        for triangles in [object_on_floor(), room(), hills(), pole] {
            let found = found(&triangles);
            let mut fullest = 0f32;
            for camera in cameras(&found, "orbit") {
                let clip = camera.clip_from_world(shadowfit::DepthConvention::ZeroToOne);
                for corner in triangles.iter().flatten().copied() {
                    let point = clip * (corner - camera.eye.as_vec3()).extend(1.0);
                    let across = (point.x.abs() / point.w).max(point.y.abs() / point.w);
                    assert!(point.w > 0.0 && across < 1.0, "{corner}: {point}");
                    fullest = fullest.max(across);
                }
            }
            assert!((fullest - ORBIT_FILL).abs() < 1e-3, "{fullest}");
        }
    }

    #[test]
    fn the_same_scene_gives_the_same_path() {
        assert_eq!(found(&room()), found(&room()));
    }

    #[test]
    fn a_scene_that_cannot_be_flown_through_gets_the_orbit_and_a_note() {
        let wall = [[Vec3::ZERO, Vec3::X, Vec3::Y]];
        let found = found(&wall);
        assert!(found.path.frames.iter().all(|frame| frame.group == "orbit"));
        assert!(found.notes[0].contains("the orbit alone"), "{:?}", found.notes);
    }

    #[test]
    fn scenes_without_anything_or_any_size_are_refused() {
        let refused = |tracer: &Tracer, bounds| find(tracer, bounds, ASPECT).expect_err("refused").to_string();
        assert!(refused(&Tracer::new([]), Aabb::new(Vec3::ZERO, Vec3::ONE)).contains("no triangles"));
        let point = Tracer::new([[Vec3::ONE; 3]]);
        for bad in [[Vec3::ONE; 2], [Vec3::NAN; 2], [Vec3::INFINITY, Vec3::NEG_INFINITY], [Vec3::ONE, Vec3::ZERO]] {
            assert!(refused(&point, Aabb::new(bad[0], bad[1])).contains("not a usable size"), "{bad:?}");
        }
    }
}
