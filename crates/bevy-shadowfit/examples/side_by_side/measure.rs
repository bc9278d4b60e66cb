//! The figures of a half: its maps against rays, for a picture of a few thousand pixels.

use shadowfit::PerspectiveCamera;
use shadowfit::glam::DVec2;
use shadowfit::selection::MapOrder;
use shadowfit_truth::{MapReading, MeasuredMap, PictureMaps, PixelCamera, Tracer, Truth, TruthSettings, judge};

use crate::lookup::{BLEND, LightMaps, Lookup, REACH};

/// Pixels of a measured picture.
const PIXELS: f32 = 160.0 * 90.0;

/// All that decides what a half shows, apart from the scene.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Shown {
    pub(crate) camera: PerspectiveCamera,
    /// Pixels down the half.
    pub(crate) height: u32,
    pub(crate) light: LightMaps,
}

/// What was measured; not a number where no surface faces the light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Figures {
    /// Pixels of the window that a texel covers along its worse axis, at most, in 95% of the pixels.
    pub(crate) pixels_per_texel: f64,
    /// Pixels that are lit wrongly, in per cent of those that face the light.
    pub(crate) wrong: f64,
}

impl Shown {
    /// Measures a half. `extent` is the size of the scene, in metres.
    pub(crate) fn measure(&self, tracer: &Tracer, extent: f64) -> Figures {
        let width = (PIXELS * self.camera.aspect).sqrt().round().max(1.0);
        let size = [width, (PIXELS / width).round().max(1.0)].map(|side| side as u32);
        let camera = PixelCamera::new(self.camera, size);
        let light = &self.light;
        let max_distance = light.maps.last().map_or(0.0, |map| map.bound);
        let settings = TruthSettings { max_distance, ..TruthSettings::new(light.to_light) };
        let truth = Truth::trace(tracer, &camera, &settings, &Truth::seen_by_rays(tracer, &camera));
        let mut lookup = Lookup::new(tracer, light, extent);
        let judged = truth.points.iter().map(|point| point.as_ref().filter(|point| point.is_judged));
        let factors: Vec<f32> = judged.map(|point| point.map_or(1.0, |point| lookup.factor(point) as f32)).collect();
        let maps = light.measured();
        let reading = if light.has_windows() {
            // They come finest first.
            let order = MapOrder::by_area(maps.iter().map(|_| Some(1.0)));
            MapReading::Coverage { order, blend: BLEND as f32 }
        } else {
            MapReading::ViewDepth
        };
        let maps = PictureMaps { maps: &maps, reading, reach: REACH as f32, depth_clamp: true };
        let figures = judge(tracer, &truth, &maps, &factors, |_| true).tally.figures();
        // A pixel of the measured picture is that many pixels of the window wide.
        let scale = f64::from(self.height) / f64::from(size[1]);
        let [_, texel, _] = figures.and_then(|figures| figures.pixels_per_texel).unwrap_or([f64::NAN; 3]);
        Figures { pixels_per_texel: texel * scale, wrong: figures.map_or(f64::NAN, |figures| figures.wrong) }
    }
}

impl LightMaps {
    /// The maps as the measures take them.
    fn measured(&self) -> Vec<MeasuredMap> {
        let size = DVec2::splat(f64::from(self.size));
        let mut blend_near = f64::INFINITY;
        let measured = self.maps.iter().map(|map| {
            let measured = MeasuredMap::new(&map.clip_from_world, size, map.bound, self.to_light);
            let measured = measured.with_blend_near(blend_near);
            blend_near = (1.0 - self.overlap) * map.bound;
            measured
        });
        measured.collect()
    }
}
