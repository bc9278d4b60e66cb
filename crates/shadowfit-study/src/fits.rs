//! Fits of a scene's views by the public fitter, with rays that find the visible points.

use glam::{DVec3, Vec3};
use shadowfit::demand;
use shadowfit::demand::needed_texel;
use shadowfit::demand::{VisibleDemand, VisibleDemandSpace};
use shadowfit::{Camera, FitError, FitInput, FittedMaps, ShadowFitter, Technique, ViewFrustum};
use shadowfit_params::Inputs;
use shadowfit_truth::Tracer;

use crate::{PosedScene, View};

/// Rays across the picture.
const COLUMNS: u32 = 64;
/// Rays down the picture.
const ROWS: u32 = 36;

/// Rays that may be used to find the visible points of a view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RayUse {
    /// Rays for the current pose. Builds them if missing.
    #[default]
    Wait,
    /// Rays for the current pose, or for an earlier pose if these are missing. Builds rays only if there are
    /// none. Earlier rays cost sharpness, never coverage.
    Late,
    /// Only existing rays, for any pose. Never builds any. Without rays, fits use the scene's boxes.
    IfReady,
}

impl PosedScene {
    /// Returns the input of fits in this scene, for views and a light that travels in `direction` (world
    /// axes).
    pub fn input<'a>(&'a self, inputs: Inputs, views: &'a [ViewFrustum], direction: Vec3) -> FitInput<'a> {
        self.boxes(inputs.boxes).input(views, direction)
    }

    /// Fits the next view of a path, then passes the visible points of that view to the fitter. At the start
    /// of a path, the fitter forgets earlier views.
    ///
    /// # Errors
    ///
    /// If the camera or the technique is invalid.
    pub fn fit_next(&self, fitter: &mut ShadowFitter, inputs: Inputs, view: &View) -> Result<FittedMaps, FitError> {
        if view.is_first {
            fitter.reset();
        }
        let maps = self.fit(fitter, inputs, view)?;
        self.see(fitter, inputs, view, RayUse::Wait)?;
        Ok(maps)
    }

    /// Fits a single view, like a running program after it has drawn that view once: nothing is held from
    /// other views, and the fitter knows the visible points of this view.
    ///
    /// # Errors
    ///
    /// As for [`Self::fit_next`].
    pub fn fit_alone(&self, fitter: &mut ShadowFitter, inputs: Inputs, view: &View) -> Result<FittedMaps, FitError> {
        fitter.reset();
        self.see(fitter, inputs, view, RayUse::Wait)?;
        self.fit(fitter, inputs, view)
    }

    fn fit(&self, fitter: &mut ShadowFitter, inputs: Inputs, view: &View) -> Result<FittedMaps, FitError> {
        fitter.fit(&self.input(inputs, &[view.camera.frustum()?], view.direction)).copied()
    }

    /// Passes the visible points of a view, found by rays, to a fitter. Does nothing if the inputs or the
    /// technique do not use them, there are no rays, or the view begins beyond the shadow distance.
    ///
    /// # Errors
    ///
    /// If the camera is invalid.
    pub fn see(&self, fitter: &mut ShadowFitter, inputs: Inputs, view: &View, rays: RayUse) -> Result<(), FitError> {
        let is_shadowed = view.camera.frustum()?.begins_before(fitter.technique().fit.max_distance);
        if !inputs.tell(fitter.technique()) || !is_shadowed {
            return Ok(());
        }
        let latest = if rays == RayUse::Wait { None } else { self.latest_rays() };
        let rays = match latest {
            Some((rays, _)) => rays,
            None if rays == RayUse::IfReady => return Ok(()),
            None => self.shared_rays(),
        };
        let camera = self.camera_for_rays(view.camera);
        let seen = see_by_rays(&rays.tracer, camera, view.direction, fitter.technique())?;
        fitter.set_visible_demand(seen.moved(self.origin()));
        Ok(())
    }
}

/// Counts the visible points that face the light, by rays against the triangles. Camera and triangles are
/// relative to the same position. `direction` is the light's direction of travel in world axes.
///
/// # Errors
///
/// As for [`VisibleDemandSpace::new`].
pub fn see_by_rays(
    tracer: &Tracer,
    camera: impl Into<Camera>,
    direction: Vec3,
    technique: &Technique,
) -> Result<VisibleDemand, FitError> {
    let camera: Camera = camera.into();
    let settings = &technique.fit;
    let space = VisibleDemandSpace::new(&camera.frustum()?, direction, settings.up, settings.max_distance)?;
    let mut seen = VisibleDemand::new(space);
    let world_from_view = camera.view_from_world().inverse();
    let [right, up, back] =
        [world_from_view.x_axis, world_from_view.y_axis, world_from_view.z_axis].map(|axis| axis.truncate().as_dvec3());
    let (half, is_orthographic) = (camera.half_size(), camera.lens.is_orthographic());
    let pixel = 2.0 * half.y / f64::from(demand::PIXELS);
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            let x = (2.0 * (f64::from(column) + 0.5) / f64::from(COLUMNS) - 1.0) * half.x;
            let y = (1.0 - 2.0 * (f64::from(row) + 0.5) / f64::from(ROWS)) * half.y;
            let aside: DVec3 = right * x + up * y;
            // Lines of sight start at the eye, or are parallel.
            let (from, ray) = if is_orthographic { (aside, -back) } else { (DVec3::ZERO, aside - back) };
            let Some(hit) = tracer.first_hit((camera.eye + from).as_vec3(), ray.as_vec3()) else { continue };
            let normal = tracer.normal(hit.triangle).as_dvec3();
            let normal = if normal.dot(ray) > 0.0 { -normal } else { normal };
            let depth = f64::from(hit.distance);
            // Returns how far the point moves on its surface when the line of sight moves by one metre; for a
            // perspective, at a depth of one metre.
            let slide = |across: DVec3| across - ray * (across.dot(normal) / ray.dot(normal));
            let [right, down] = [slide(right), slide(-up)];
            if normal.dot(direction.as_dvec3()) < 0.0 {
                let texel = needed_texel(right.as_vec3(), down.as_vec3(), direction);
                seen.count_depth(hit.distance, -texel.log2());
            }
            let spread = if is_orthographic { 1.0 } else { depth };
            let [right, down] = [right, down].map(|step| (step * (pixel * spread)).as_vec3());
            if let Some(cell) = space.demand.index((from + ray * depth).as_vec3(), normal.as_vec3(), right, down) {
                seen.count_cell(cell);
            }
        }
    }
    Ok(seen)
}

#[cfg(test)]
mod tests {
    use shadowfit::PerspectiveCamera;
    use shadowfit_render::Renderer;
    use shadowfit_scene::builtin::default_scene;
    use shadowfit_testing::renderer_gpu;
    use shadowfit_wgpu::ShadowMapDescriptor;

    use crate::PreparedScene;

    use crate::NamedTechnique;

    use super::*;

    fn scene() -> PreparedScene {
        let gpu = renderer_gpu();
        let renderer = Renderer::new(&gpu, &ShadowMapDescriptor::default(), 1).expect("a renderer");
        PreparedScene::new(&gpu, renderer.material_layout(), default_scene()).expect("the default scene")
    }

    fn view(z: f64, is_first: bool) -> View {
        let camera = PerspectiveCamera {
            eye: DVec3::new(3.0, 2.0, z),
            forward: Vec3::new(-0.3, -0.2, -0.9),
            up: Vec3::Y,
            fov_y: 0.8,
            aspect: 1.6,
            near: 0.1,
            far: 150.0,
        };
        View { camera: camera.into(), direction: Vec3::new(0.4, -0.7, 0.3).normalize(), is_first }
    }

    /// Returns a fitter of a technique by name, and the inputs of its fits.
    fn fitter(name: &str) -> (ShadowFitter, Inputs) {
        let named = NamedTechnique::preset(name).expect("a preset");
        (ShadowFitter::new(&named.technique), named.inputs)
    }

    #[test]
    fn gpu_windows_are_placed_by_the_frame_before_and_those_of_a_picture_alone_by_itself() {
        let scene = scene();
        let alone = |name: &str| {
            let (mut fitter, inputs) = fitter(name);
            scene.fit_alone(&mut fitter, inputs, &view(9.0, false)).expect("maps")
        };
        let along = |name: &str| -> Vec<FittedMaps> {
            let (mut fitter, inputs) = fitter(name);
            let frames = [view(9.0, true), view(8.9, false), view(8.8, false)];
            frames.iter().map(|view| scene.fit_next(&mut fitter, inputs, view).expect("maps")).collect()
        };
        let (seen, estimated) = (along("windows-4"), along("windows-boxes-4"));
        assert_ne!(alone("windows-4"), alone("windows-boxes-4"), "the picture's own demand counts");
        assert_eq!(seen[0], estimated[0], "the first frame knows the boxes alone");
        assert_eq!(seen[0], alone("windows-boxes-4"));
        assert_ne!(seen[1], estimated[1], "the next one knows what the first one showed");
    }

    #[test]
    fn gpu_without_waiting_the_boxes_place_windows_until_rays_are_there() {
        let mut scene = scene();
        let seen = |scene: &PreparedScene, name: &str, rays: RayUse| {
            let (mut fitter, inputs) = fitter(name);
            scene.see(&mut fitter, inputs, &view(9.0, false), rays).expect("a camera that makes sense");
            fitter.visible_demand().cloned()
        };
        for name in ["windows-4", "histogram-4"] {
            assert_eq!(seen(&scene, name, RayUse::IfReady), None, "{name}");
        }
        assert!(scene.latest_rays().is_none());
        scene.request_rays();
        while !scene.take_rays() {
            std::thread::yield_now();
        }
        let by_rays = seen(&scene, "windows-4", RayUse::IfReady);
        assert!(by_rays.is_some());
        assert_eq!(by_rays, seen(&scene, "windows-4", RayUse::Wait));
    }

    #[test]
    fn gpu_only_techniques_that_go_by_it_are_told_what_a_view_shows() {
        let scene = scene();
        let is_told = |name: &str| {
            let (mut fitter, inputs) = fitter(name);
            scene.see(&mut fitter, inputs, &view(9.0, true), RayUse::Wait).expect("a camera that makes sense");
            fitter.visible_demand().is_some()
        };
        assert_eq!(["clusters-4", "stable-4", "windows-boxes-4"].map(is_told), [false; 3]);
        assert_eq!(["histogram-4", "windows-4"].map(is_told), [true; 2]);
    }

    #[test]
    fn rays_count_places_and_depths_in_world_positions() {
        let corner = |x: f32, z: f32| Vec3::new(x, 0.0, z);
        let ground = [corner(-50.0, 50.0), corner(50.0, 50.0), corner(0.0, -50.0)];
        let camera = Camera { eye: DVec3::new(0.0, 2.0, 5.0), forward: Vec3::NEG_Z, ..view(0.0, true).camera };
        let seen = see_by_rays(&Tracer::new([ground]), camera, Vec3::NEG_Y, &Technique::default());
        let origin = DVec3::new(1e5, 0.0, -2e5);
        let seen = seen.expect("a camera that makes sense").moved(origin);
        assert_eq!(seen.demand().space.origin, origin + camera.eye);
        assert!(seen.demand().counts.iter().sum::<u32>() > 100);
        assert!(seen.histogram().bins.iter().sum::<u32>() > 100);
        let from_below = see_by_rays(&Tracer::new([ground]), camera, Vec3::Y, &Technique::default());
        let from_below = from_below.expect("a camera that makes sense");
        assert_eq!(from_below.histogram().bins.iter().sum::<u32>(), 0, "what faces away does not count");
    }
}
