//! A town of any size, and a walk through its middle.

use anyhow::Result;
use glam::{DVec3, Vec3};
use shadowfit::{Aabb, Boxes, FitInput, PerspectiveCamera, StaticBoxes, Technique, ViewFrustum, VisibleDemand};
use shadowfit_study::see_by_rays;
use shadowfit_truth::Tracer;

use crate::cuboid::triangles;

/// Distance between the middles of neighbouring houses, width of a house, and least and greatest height, in
/// metres.
const STEP: f32 = 3.0;
const WIDTH: f32 = 2.0;
const HEIGHTS: [f32; 2] = [2.0, 8.0];
/// Thickness of the ground, in metres.
const GROUND: f32 = 0.1;

/// Far distance of shadows and view, in metres.
const FAR: f32 = 400.0;
/// Height of the eye, in metres. Movement and turn per frame, in metres and radians.
const EYE: f64 = 1.7;
const WAY: f64 = 0.1;
const TURN: f32 = 0.02;

/// A ground and the houses on it, in a square around the origin.
pub(crate) struct Town {
    /// Boxes in world space, in metres. The ground comes first.
    pub(crate) boxes: Vec<Aabb>,
}

impl Town {
    /// Builds a town of `count` boxes.
    pub(crate) fn new(count: usize) -> Self {
        // Even, so that the middle is a street and not a house.
        let side = ((count as f64).sqrt().ceil() as usize).next_multiple_of(2);
        let half = side as f32 * STEP * 0.5;
        let ground = Aabb::new(Vec3::new(-half, -GROUND, -half), Vec3::new(half, 0.0, half));
        let house = |index: usize| {
            let middle = Vec3::new(index.rem_euclid(side) as f32 + 0.5, 0.0, (index / side) as f32 + 0.5) * STEP;
            let corner = middle - Vec3::new(half + WIDTH * 0.5, 0.0, half + WIDTH * 0.5);
            let share = (index as f64 * 0.618_033_988_749_895).fract() as f32;
            let height = HEIGHTS[0] + (HEIGHTS[1] - HEIGHTS[0]) * share;
            Aabb::new(corner, corner + Vec3::new(WIDTH, height, WIDTH))
        };
        Self { boxes: [ground].into_iter().chain((1..count).map(house)).collect() }
    }

    /// Returns the direction of travel of the sun's light.
    pub(crate) fn direction() -> Vec3 {
        Vec3::new(0.4, -0.8, 0.3).normalize()
    }

    /// Returns the camera of a frame, which moves along a street and turns.
    pub(crate) fn camera(frame: usize) -> PerspectiveCamera {
        let turn = frame as f32 * TURN;
        PerspectiveCamera {
            eye: DVec3::new(0.0, EYE, -(frame as f64) * WAY),
            forward: Vec3::new(turn.sin(), -0.1, -turn.cos()),
            up: Vec3::Y,
            fov_y: 0.6,
            aspect: 16.0 / 9.0,
            near: 0.1,
            far: FAR,
        }
    }

    /// Returns the visible demand of each of the first frames, by rays.
    pub(crate) fn seen(&self, frames: usize, technique: &Technique) -> Result<Vec<VisibleDemand>> {
        let in_reach = self.boxes.iter().filter(|aabb| aabb.min.length().min(aabb.max.length()) < FAR * 1.5);
        let tracer = Tracer::new(self.boxes.iter().take(1).chain(in_reach.skip(1)).flat_map(triangles));
        let see = |frame| Ok(see_by_rays(&tracer, Self::camera(frame), Self::direction(), technique)?);
        (0..frames).map(see).collect()
    }
}

/// Form in which boxes are passed to a fit.
#[derive(Clone, Copy)]
pub(crate) enum World<'a> {
    /// As a list in each frame.
    List(Boxes<'a>),
    /// As a hierarchy, built once.
    Tree(&'a StaticBoxes),
}

impl<'a> World<'a> {
    /// Returns the input of a fit.
    pub(crate) fn input(self, views: &'a [ViewFrustum]) -> FitInput<'a> {
        let input = FitInput::new(views, Town::direction());
        match self {
            Self::List(boxes) => FitInput { receivers: Some(boxes), casters: Some(boxes), ..input },
            Self::Tree(tree) => FitInput { static_boxes: Some(tree), ..input },
        }
    }
}
