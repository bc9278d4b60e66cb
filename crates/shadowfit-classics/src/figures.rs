//! Judges samples against rays, with the source's shadows and with modern maps, on the same view.

use anyhow::{Context, Result, bail};
use glam::{DMat4, DVec2, DVec3};
use shadowfit::{PerspectiveCamera, ShadowFitter, Technique};
use shadowfit_params::Inputs;
use shadowfit_render::passes::material_layout;
use shadowfit_render::{Gpu, Renderer};
use shadowfit_study::{Evaluator, Judging, PreparedScene, SharedTruth, View};
use shadowfit_truth::{
    Judged, MapReading, MeasuredMap, PictureFigures, PictureMaps, PixelCamera, Truth, TruthLight, TruthSettings, judge,
};
use shadowfit_wgpu::ShadowMapDescriptor;

use crate::drawer::SampleDrawer;
use crate::mapped::{LightImage, LightPlace, SampleFrame, SampleLight};
use crate::options::SampleValues;
use crate::sample::{Sample, SampleDrawing};

/// Distance of the shadow rays' origins above a surface, in units of the sample.
const RAY_OFFSET: f64 = 0.005;

/// The figures of a sample on a view.
#[derive(Clone, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "there is one at a time")]
pub enum SampleFigures {
    /// Figures of the sample's shadows and of modern maps.
    Shadows {
        /// With the source's shadows. `None` if no pixel was judged.
        source: Option<PictureFigures>,
        /// With modern maps.
        modern: Option<PictureFigures>,
    },
    /// Mean absolute error of each method's ambient occlusion against rays, 0..=1, by the method's name.
    Occlusion(Vec<(&'static str, f64)>),
}

/// Methods of ambient occlusion to compare: names and options.
const METHODS: [(&str, &[(&str, &str)]); 4] = [
    ("front faces", &[("method", "front")]),
    ("front and back faces", &[("method", "back")]),
    ("front faces, level of detail", &[("method", "front"), ("detail", "on")]),
    ("depth alone", &[("method", "depth")]),
];

impl SampleFigures {
    /// Judges a sample, posed at a time of its animation, in seconds. Pictures have the height of the
    /// source's window.
    ///
    /// # Errors
    ///
    /// If the camera cannot be fitted.
    pub fn measure(
        gpu: Gpu,
        sample: &Sample,
        values: &SampleValues,
        camera: &PerspectiveCamera,
        seconds: f32,
    ) -> Result<Self> {
        pollster::block_on(Self::measure_async(gpu, sample, values, camera, seconds))
    }

    /// Judges a sample like [`Self::measure`], but lets a browser do other work while the GPU draws.
    ///
    /// # Errors
    ///
    /// As [`Self::measure`].
    pub async fn measure_async(
        gpu: Gpu,
        sample: &Sample,
        values: &SampleValues,
        camera: &PerspectiveCamera,
        seconds: f32,
    ) -> Result<Self> {
        let mut scene = PreparedScene::new(&gpu, &material_layout(&gpu.device), sample.scene())?;
        if sample.controls.model_turn != 0.0 {
            scene.set_time(&gpu, 0, seconds);
        }
        let height = sample.size[1];
        let size = [((height as f32 * camera.aspect).round() as u32).max(1), height];
        let mut bench = Bench { gpu, drawer: None, sample, camera, size };
        if let SampleDrawing::Occlusion { .. } = sample.drawing(values, camera)? {
            return Ok(Self::Occlusion(bench.occlusion_errors(&mut scene, values).await?));
        }
        let mut figures = [None, None];
        for (figures, shadows) in figures.iter_mut().zip(["source", "ours"]) {
            let mut values = values.clone();
            values.set_from_str("shadows", shadows)?;
            *figures = bench.judge(&mut scene, &values).await?.tally.figures();
        }
        let [source, modern] = figures;
        Ok(Self::Shadows { source, modern })
    }

    /// Returns the figures of the sample's shadows and of modern maps, if pixels were judged for both.
    pub fn shadows(&self) -> Option<[PictureFigures; 2]> {
        match self {
            Self::Shadows { source, modern } => Some([(*source)?, (*modern)?]),
            Self::Occlusion(_) => None,
        }
    }

    /// Returns names and figures, for people.
    pub fn lines(&self) -> Vec<(String, String)> {
        let (source, modern) = match self {
            Self::Shadows { source, modern } => (source, modern),
            Self::Occlusion(errors) => {
                let line = |(name, error): &(&str, f64)| (format!("Mean error, {name}"), format!("{error:.3}"));
                return errors.iter().map(line).collect();
            }
        };
        let both = [("as its source", source), ("modern maps", modern)];
        let mut lines: Vec<_> = both
            .iter()
            .map(|(name, figures)| {
                let wrong = figures.map_or_else(|| "no pixels to judge".to_owned(), |figures| percent(figures.wrong));
                (format!("Wrong pixels, {name}"), wrong)
            })
            .collect();
        for (name, figures) in both {
            let Some(figures) = figures else { continue };
            let classes = [
                ("false shadow", figures.false_shadow),
                ("false light", figures.false_light),
                ("holes", figures.hole),
                ("edges", figures.edge),
            ];
            let classes: Vec<String> =
                classes.iter().map(|(name, share)| format!("{name} {}", percent(*share))).collect();
            lines.push((name.to_owned(), classes.join(", ")));
        }
        lines
    }
}

fn percent(share: f64) -> String {
    format!("{share:.2}%")
}

/// State for judging the pictures of a sample.
struct Bench<'a> {
    gpu: Gpu,
    drawer: Option<SampleDrawer>,
    sample: &'a Sample,
    camera: &'a PerspectiveCamera,
    size: [u32; 2],
}

impl Bench<'_> {
    async fn judge(&mut self, scene: &mut PreparedScene, values: &SampleValues) -> Result<Judged> {
        match self.sample.drawing(values, self.camera)? {
            SampleDrawing::Technique { technique, .. } => Box::pin(self.judge_technique(scene, &technique)).await,
            SampleDrawing::Mapped(frame) => self.judge_mapped(scene, &frame).await,
            SampleDrawing::Occlusion { .. } => bail!("{} has no shadows to judge", self.sample.id),
        }
    }

    /// Returns the error of each method against rays.
    async fn occlusion_errors(
        &mut self,
        scene: &mut PreparedScene,
        values: &SampleValues,
    ) -> Result<Vec<(&'static str, f64)>> {
        let camera = PixelCamera::new(scene.camera_for_rays(self.camera), self.size);
        let truth = crate::occlusion::truth(scene.rays(), &camera);
        let mut errors = Vec::new();
        for (name, options) in METHODS {
            let mut values = values.clone();
            for (id, text) in options {
                values.set_from_str(id, text)?;
            }
            let SampleDrawing::Occlusion { frame, .. } = self.sample.drawing(&values, self.camera)? else { continue };
            let drawer = self.drawer.get_or_insert_with(|| SampleDrawer::new(&self.gpu, 1));
            let occlusion = drawer.occlusion(&self.gpu, scene, &frame, self.camera, self.size).await?;
            errors.push((name, truth.mean_absolute_error(&occlusion).context("the picture shows only sky")?));
        }
        Ok(errors)
    }

    async fn judge_technique(&self, scene: &mut PreparedScene, technique: &Technique) -> Result<Judged> {
        let renderer = Renderer::new(&self.gpu, &ShadowMapDescriptor::from(technique), 1)?;
        let judging = Judging { size: self.size, ray_offset: RAY_OFFSET, crawl: false, ..Judging::default() };
        let mut evaluator = Evaluator::new(renderer, judging);
        let view = View { camera: self.camera.into(), direction: self.sample.direction, is_first: true };
        let maps = scene.fit_alone(&mut ShadowFitter::new(technique), Inputs::default(), &view)?;
        evaluator.judge_async(&self.gpu, scene, &view, &maps, &mut SharedTruth::default()).await
    }

    async fn judge_mapped(&mut self, scene: &mut PreparedScene, frame: &SampleFrame) -> Result<Judged> {
        // The dark parts of a light image are not shadows.
        let light = SampleLight { image: LightImage::Square, ..frame.light };
        let frame = &SampleFrame { light, ..*frame };
        let drawer = self.drawer.get_or_insert_with(|| SampleDrawer::new(&self.gpu, 1));
        let probe =
            drawer.probe(&self.gpu, scene, self.sample, frame, self.size).await.context("the sample's shadows")?;
        let origin = scene.origin();
        let rays = scene.rays();
        let camera = PixelCamera::new(scene.camera_for_rays(self.camera), self.size);
        // The light's matrix takes positions relative to the eye.
        let clip_from_world =
            frame.light.clip_from_world.as_dmat4() * DMat4::from_translation(origin - self.camera.eye);
        let size = DVec2::from(frame.map.size.map(f64::from));
        let (light, map) = match frame.light.place {
            LightPlace::Toward(to_light) => {
                let to_light = to_light.as_dvec3().normalize();
                (TruthLight::sun(to_light), MeasuredMap::new(&clip_from_world, size, f64::INFINITY, to_light))
            }
            LightPlace::At(position) => {
                let position: DVec3 = position - origin;
                let light = TruthLight::Spot { position, image: Some(clip_from_world) };
                (light, MeasuredMap::of_spot(&clip_from_world, size, f64::INFINITY, position))
            }
        };
        let settings = TruthSettings {
            ray_offset: RAY_OFFSET,
            max_distance: f64::from(self.camera.far),
            ..TruthSettings::of_light(light)
        };
        let seen: Vec<Option<u32>> = probe.pixels.iter().map(|pixel| pixel.map(|pixel| pixel.triangle)).collect();
        let truth = Truth::trace(&rays.tracer, &camera, &settings, &seen);
        let factors: Vec<f32> = probe.pixels.iter().map(|pixel| pixel.map_or(1.0, |pixel| pixel.factor)).collect();
        let maps = PictureMaps {
            maps: &[map],
            reading: MapReading::ViewDepth,
            filter_radius: frame.test.reach,
            depth_clamp: false,
        };
        Ok(judge(&rays.tracer, &truth, &maps, &factors, |_| true))
    }
}
