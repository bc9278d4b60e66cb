//! Explains why a pixel is lit or dark, and right or wrong: the texel that it reads, the compared depths, and
//! the reason in words.
//!
//! The class is the judge's. A few more rays find the reasons. `map_reason` explains the choice of the map,
//! `look_up` computes the look-up, and `reason` does the rest.

mod look_up;
mod map_reason;
mod reason;
mod words;

use std::sync::Arc;

use glam::{DVec2, DVec3, Vec3};
use shadowfit::selection::MapRead;
use shadowfit::{FittedMap, Technique};
use shadowfit_scene::Scene;
use shadowfit_truth::{Class, Occluder, PictureMaps, PixelFinding, PixelTruth, TruthPoint};
use shadowfit_wgpu::ShadowMapDescriptor;

use self::look_up::{LookUp, Tap};
use crate::maps::{measured, picture_maps};
use crate::{Judging, SceneRays, View};

/// A pixel to explain, and everything that its shadow depends on. It owns or shares its data, so that a
/// thread can use it.
#[derive(Clone, Debug)]
pub struct WhyInput {
    /// The scene. Its nodes name the objects.
    pub scene: Arc<Scene>,
    /// The scene's rays for the visible pose.
    pub rays: Arc<SceneRays>,
    /// Camera and light of the picture.
    pub view: View,
    /// Size of the picture in pixels, and settings for judging it.
    pub judging: Judging,
    /// The pixel, from the left and from the top of the picture, in pixels. Fractions are dropped.
    pub pixel: [f32; 2],
    /// The technique that fitted the maps.
    pub technique: Technique,
    /// The maps that the picture was drawn with.
    pub maps: Vec<FittedMap>,
    /// The shadow map that they were drawn into.
    pub descriptor: ShadowMapDescriptor,
    /// Share of the light at the pixel as it was drawn, 0..=1, for example from a probe. `None` uses one
    /// comparison with the texel of the point.
    pub factor: Option<f32>,
    /// Depths that the map stores around the look-up, if they were read back. Otherwise rays find them.
    pub stored: Option<StoredTexels>,
}

/// Texels of a map that were read back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoredTexels {
    /// The middle texel, from the left and from the top of the map: [`Why::texel`] rounded down. If a map [is
    /// stored shifted](FittedMap::texel_offset), it lies elsewhere in the layer.
    pub texel: [u32; 2],
    /// Depths of the middle texel and the eight texels around it, rows from the top, as stored: 0..=1, plain
    /// or reversed. NaN beyond the map.
    pub depths: [[f32; 3]; 3],
}

impl StoredTexels {
    /// Returns the depth of a texel, if it was read back.
    fn depth(&self, texel: DVec2) -> Option<f32> {
        let [x, y] = [0, 1].map(|axis| texel[axis] - f64::from(self.texel[axis]) + 1.0);
        let is_here = (0.0..3.0).contains(&x) && (0.0..3.0).contains(&y);
        is_here.then(|| self.depths[y as usize][x as usize]).filter(|depth| !depth.is_nan())
    }
}

/// Explanation why a pixel is lit or dark, and right or wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct Why {
    /// The visible point; world space, metres.
    pub position: DVec3,
    /// Unit geometric normal on the side of the eye, world axes.
    pub normal: Vec3,
    /// Distance from the eye, in metres.
    pub distance: f32,
    /// Index of the map that is read, or of the one with the greater weight if two are blended. `None` if no
    /// map holds the point.
    pub map: Option<usize>,
    /// Position of the look-up in that map, with the bias's offset, in texels from the left and from the top.
    /// `None` without a map, and on a surface that faces away from the light.
    pub texel: Option<[f32; 2]>,
    /// Compared depth, with the bias, as the map stores depths: 0..=1, plain or reversed.
    pub compared: Option<f32>,
    /// Compared depth in metres from the map's near plane along the light; negative before it.
    pub compared_metres: Option<f32>,
    /// Depth that the map stores at that texel, read back or found by rays. If the texel is empty, the depth
    /// of a cleared map.
    pub stored: Option<f32>,
    /// Stored depth in metres from the map's near plane along the light. `None` if the texel is empty.
    pub stored_metres: Option<f32>,
    /// Screen pixels per shadow texel along the worse axis. `None` without a map, and if the surface is
    /// edge-on to the light.
    pub pixels_per_texel: Option<f32>,
    /// Class of the pixel. It equals the class in a judged picture, unless the edge zone is wider than the
    /// limit of [`PixelTruth::judge`].
    pub class: Class,
    /// Whether the light reaches the pixel in truth.
    pub is_lit: bool,
    /// Share of the light that was judged, 0..=1: [`WhyInput::factor`], or the result of one comparison.
    /// `None` on a surface that is not judged, if no factor was given.
    pub factor: Option<f32>,
    /// The map that is read, and the reason: "map 2 of 4: the finest that holds this point; map 1 ends 3.1 m
    /// to the left of it".
    pub map_reason: String,
    /// Why it is lit or dark, and right or wrong: "wrongly lit: its occluder, "roof", is 3.2 m before the near plane
    /// of map 2".
    pub reason: String,
}

/// All data about a pixel. Positions are relative to the origin of the rays, in metres.
pub(crate) struct At<'a> {
    input: &'a WhyInput,
    truth: PixelTruth<'a>,
    maps: &'a PictureMaps<'a>,
    /// The pixel's index in rows from the top.
    pixel: usize,
    point: TruthPoint,
    read: Option<MapRead>,
    look_up: Option<(LookUp<'a>, Tap)>,
    factor: Option<f32>,
    finding: PixelFinding,
}

/// Explains why a pixel is lit or dark, and right or wrong. `None` for the sky and beyond the picture.
///
/// It casts a few dozen rays, plus one per texel that the filter reads. At a wrong pixel it casts up to a
/// hundred thousand more to find the shadow's true edge. It takes between microseconds and some tens of
/// milliseconds.
///
/// ```no_run
/// # use shadowfit::{FittedMap, Technique};
/// # use shadowfit_study::{Judging, PreparedScene, View, WhyInput, why};
/// # use shadowfit_wgpu::ShadowMapDescriptor;
/// # fn click(scene: &PreparedScene, view: View, technique: Technique, maps: Vec<FittedMap>, pixel: [f32; 2]) {
/// let Some(rays) = scene.ready_rays() else { return };
/// let found = why(&WhyInput {
///     scene: scene.shared_scene(),
///     rays,
///     view,
///     judging: Judging { size: [1280, 720], ..Judging::default() },
///     pixel,
///     technique,
///     maps,
///     descriptor: ShadowMapDescriptor::from(&technique),
///     factor: None,
///     stored: None,
/// });
/// match found {
///     Some(why) => println!("{}\n{}", why.reason, why.map_reason),
///     None => println!("the sky"),
/// }
/// # }
/// ```
pub fn why(input: &WhyInput) -> Option<Why> {
    let WhyInput { rays, view, judging, maps, descriptor, .. } = input;
    let camera = judging.pixel_camera(rays.origin, view);
    let pixel = pixel_index(input.pixel, judging.size)?;
    let settings = judging.truth_settings(view);
    let truth = PixelTruth { tracer: &rays.tracer, camera: &camera, settings: &settings };
    let point = truth.point(pixel)?;
    let measured = measured(maps, descriptor, view.direction, rays.origin);
    let picture = picture_maps(&measured, maps, descriptor);
    let read = picture.read(point.view_depth, point.position);
    let look_up = read.filter(|_| point.facing > 0.0).and_then(|read| {
        let map = read.main();
        let look_up = LookUp::new(&maps[map], &measured[map], descriptor, &point)?;
        let centre = look_up.centre(&rays.tracer, input.stored.as_ref());
        Some((look_up, centre))
    });
    let predicted = || point.is_judged.then(|| look_up.as_ref().map_or(1.0, |(_, centre)| lit(centre)));
    let factor = input.factor.or_else(predicted);
    let finding = truth.judge(&picture, factor.unwrap_or(1.0), pixel, &point);
    Some(At { input, truth, maps: &picture, pixel, point, read, look_up, factor, finding }.why())
}

/// Returns the share of the light from one comparison.
fn lit(tap: &Tap) -> f32 {
    if tap.is_dark() { 0.0 } else { 1.0 }
}

/// Returns a pixel's index in rows from the top, if it is in the picture.
fn pixel_index(pixel: [f32; 2], [width, height]: [u32; 2]) -> Option<usize> {
    let is_inside = (0.0..width as f32).contains(&pixel[0]) && (0.0..height as f32).contains(&pixel[1]);
    is_inside.then(|| pixel[1] as usize * width as usize + pixel[0] as usize)
}

impl At<'_> {
    /// Returns the occluders between the point and the sun, seen from the point itself instead of the start
    /// of its ray.
    fn occluders(&self) -> Vec<Occluder> {
        let mut occluders = self.truth.occluders(self.pixel, &self.point);
        for occluder in &mut occluders {
            let direction = (occluder.position - self.point.position).normalize_or_zero();
            let normal = self.truth.tracer.normal(occluder.triangle).as_dvec3();
            let corner = self.truth.tracer.corners(occluder.triangle)[0].as_dvec3();
            let distance = normal.dot(corner - self.point.position) / normal.dot(direction);
            // A plane along the ray has no intersection.
            if distance.is_finite() {
                (occluder.position, occluder.distance) = (self.point.position + direction * distance, distance);
            }
        }
        occluders
    }

    fn why(&self) -> Why {
        let Self { point, look_up, finding, .. } = self;
        let looked_up = look_up.as_ref();
        Why {
            position: self.input.rays.origin + point.position,
            normal: point.normal.as_vec3(),
            distance: (point.position - self.truth.camera.eye).length() as f32,
            map: self.read.map(|read| read.main()),
            texel: looked_up.map(|(look_up, _)| look_up.texel.as_vec2().to_array()),
            compared: looked_up.map(|(look_up, _)| look_up.depth(Some(look_up.compared))),
            compared_metres: looked_up.map(|(look_up, _)| look_up.compared as f32),
            stored: looked_up.map(|(look_up, centre)| look_up.depth(centre.stored)),
            stored_metres: looked_up.and_then(|(_, centre)| Some(centre.stored? as f32)),
            pixels_per_texel: Some(finding.pixels_per_texel).filter(|pixels| pixels.is_finite()),
            class: finding.class,
            is_lit: point.verdict() == Some(true),
            factor: self.factor,
            map_reason: map_reason::map_reason(self),
            reason: reason::reason(self),
        }
    }
}

#[cfg(test)]
mod tests;
