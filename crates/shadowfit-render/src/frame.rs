//! What a frame shows, and what was drawn for it: plain data.

use glam::{DVec3, Vec3};
use shadowfit::PerspectiveCamera;
use shadowfit_wgpu::{Culling, MAX_MAPS, MapFit};

use crate::Line;
use crate::uniform::Atmosphere;

/// What a frame shows.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Eye and lens that the picture is seen through.
    pub camera: &'a PerspectiveCamera,
    /// Unit direction of travel of the light.
    pub direction: Vec3,
    /// The shadow maps with their biases, in order of their `far`; empty where there is nothing to fit.
    pub maps: &'a [MapFit],
    /// Eye and unit forward direction (world space, metres) whose view depths choose among maps that are
    /// read by view depth; the
    /// camera's own where `None`.
    pub choice: Option<(DVec3, Vec3)>,
    /// Which casters are drawn into the maps.
    pub culling: Culling,
    /// Whether shadows are drawn.
    pub shadows: bool,
    /// Colours of sun and sky.
    pub atmosphere: &'a Atmosphere,
    /// What is overlaid on the shaded surfaces.
    pub overlay: Overlay,
    /// Lines drawn over the scene.
    pub lines: &'a [Line],
    /// Shadow map shown in a corner.
    pub inset: Option<Inset>,
}

impl<'a> Frame<'a> {
    /// A plain picture with shadows, for a light that travels along `direction` (unit, world axes).
    pub fn new(camera: &'a PerspectiveCamera, direction: Vec3, maps: &'a [MapFit], atmosphere: &'a Atmosphere) -> Self {
        Self {
            camera,
            direction,
            maps,
            choice: None,
            culling: Culling::default(),
            shadows: true,
            atmosphere,
            overlay: Overlay::default(),
            lines: &[],
            inset: None,
        }
    }
}

/// What is overlaid on the shaded surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Overlay {
    /// Nothing.
    #[default]
    None,
    /// Surfaces are tinted by the map that they read, in the colours [`MAP_TINTS`](shadowfit::figures::MAP_TINTS). What no map
    /// covers keeps its own colour.
    MapTint,
}

/// Where and how the shadow map is shown in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inset {
    /// Left, top, width and height, in pixels.
    pub rectangle: [f32; 4],
    /// Stored depths shown as black and white.
    pub depth_range: [f32; 2],
    /// Index of the map that is shown.
    pub map: u32,
}

/// What a frame drew.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Draw calls of all shadow passes.
    pub shadow_draws: u32,
    /// Triangles of all shadow passes.
    pub shadow_triangles: u64,
    /// Draw calls of the shaded pass.
    pub scene_draws: u32,
    /// Triangles of the shaded pass.
    pub scene_triangles: u64,
    /// What was drawn into each map; zeros past the number of maps.
    pub maps: [MapStatistics; MAX_MAPS],
}

/// What was drawn into one map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MapStatistics {
    /// Instances that were not culled.
    pub casters: u32,
    /// Draw calls for them.
    pub draws: u32,
    /// Their triangles.
    pub triangles: u64,
}
