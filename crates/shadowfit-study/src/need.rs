//! How fine a texel the frame before asked for, found by rays against the triangles.

use glam::{DVec3, Vec3};
use shadowfit::need::{self, NeedGrid, NeedSpace};
use shadowfit::settings::FitSettings;
use shadowfit::{FitError, PerspectiveCamera};
use shadowfit_truth::Tracer;

/// Rays across the picture.
const COLUMNS: u32 = 64;
/// Rays down the picture.
const ROWS: u32 = 36;

/// What a camera sees that faces the light, and how fine a texel it asks for.
#[derive(Clone, Debug, PartialEq)]
pub struct SeenNeed {
    space: NeedSpace,
    counts: Vec<u32>,
}

impl SeenNeed {
    /// Counts by rays. `direction` is the light's direction of travel in world axes.
    ///
    /// # Errors
    ///
    /// As [`NeedSpace::new`].
    pub fn trace(
        tracer: &Tracer,
        camera: &PerspectiveCamera,
        direction: Vec3,
        settings: &FitSettings,
    ) -> Result<Self, FitError> {
        let space = NeedSpace::new(&camera.frustum()?, direction, settings.up, settings.max_distance)?;
        let world_from_view = camera.view_from_world().inverse();
        let [right, up, back] = [world_from_view.x_axis, world_from_view.y_axis, world_from_view.z_axis]
            .map(|axis| axis.truncate().as_dvec3());
        let tan_y = (f64::from(camera.fov_y) * 0.5).tan();
        let tan_x = tan_y * f64::from(camera.aspect);
        let pixel = 2.0 * tan_y / f64::from(need::PIXELS);
        let mut counts = vec![0; need::CELLS];
        for row in 0..ROWS {
            for column in 0..COLUMNS {
                let x = (2.0 * (f64::from(column) + 0.5) / f64::from(COLUMNS) - 1.0) * tan_x;
                let y = (1.0 - 2.0 * (f64::from(row) + 0.5) / f64::from(ROWS)) * tan_y;
                let ray: DVec3 = right * x + up * y - back;
                let Some(hit) = tracer.first_hit(camera.eye.as_vec3(), ray.as_vec3()) else { continue };
                let normal = tracer.normal(hit.triangle).as_dvec3();
                let normal = if normal.dot(ray) > 0.0 { -normal } else { normal };
                let depth = f64::from(hit.distance);
                let slide = |across: DVec3| {
                    ((across - ray * (across.dot(normal) / ray.dot(normal))) * (pixel * depth)).as_vec3()
                };
                let position = (ray * depth).as_vec3();
                if let Some(index) = space.index(position, normal.as_vec3(), slide(right), slide(-up)) {
                    counts[index] += 1;
                }
            }
        }
        Ok(Self { space, counts })
    }

    /// The same, counted from another world position: moved by this many metres along each axis.
    #[must_use]
    pub fn moved(mut self, by: DVec3) -> Self {
        self.space.origin += by;
        self
    }

    /// As fits take it.
    pub fn grid(&self) -> NeedGrid<'_> {
        NeedGrid { space: self.space, counts: &self.counts }
    }
}
