//! Draws and judges the frames of scenes with each technique of a contestant.

use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};
use glam::DVec3;
use shadowfit_truth::{Crawl, Judged, MapsBefore, PixelCamera, Tracer, Truth, TruthPoint, crawl, judge};

use super::results::{FrameResult, Results};
use super::sums::Sums;
use super::surfaces::{MAX_DIFFERENT, Surfaces, factors};
use super::{Contestant, Drawn, LightMaps, LitSurface, Redraw, Shadows};
use crate::geometry::Corners;
use crate::peers::Frame;

/// Relative change of brightness that rounding may cause: renderers draw in half floats.
const ROUNDING: f32 = 2e-3;

/// How frames are judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JudgeSettings {
    /// Width and height of the pictures, in pixels.
    pub size: [u32; 2],
    /// Interval of judged frames. The last frame of each interval is judged, so that its previous frame is on
    /// the same path.
    pub every: u32,
    /// Whether crawl is measured. If so, each frame is drawn once more.
    pub crawl: bool,
}

impl Default for JudgeSettings {
    fn default() -> Self {
        Self { size: [320, 180], every: 1, crawl: true }
    }
}

/// Time that parts of the work took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JudgeTimes {
    /// Time for drawing by the contestant.
    pub drawing: Duration,
    /// Time for tracing the truth.
    pub tracing: Duration,
    /// Time for judging pictures.
    pub judging: Duration,
    /// Number of frames whose truth was traced.
    pub frames: u32,
    /// Sum over these frames of the share of pixels that were left out because the picture and rays show
    /// different surfaces.
    pub different: f64,
}

/// A judged picture.
#[derive(Clone, Copy, Debug)]
pub struct JudgedPicture<'a> {
    /// Name of the scene.
    pub scene: &'a str,
    /// Camera and light.
    pub frame: &'a Frame,
    /// Place of the technique among [`Contestant::techniques`].
    pub technique: usize,
    /// Truth at each pixel.
    pub truth: &'a Truth,
    /// Brightness without shadows, if the contestant draws brightness.
    pub unshadowed: Option<&'a [f32]>,
    /// Share of the light that reaches each pixel with the contestant's shadows, 0..=1.
    pub factors: &'a [f32],
    /// Class of each pixel.
    pub judged: &'a Judged,
    /// Maps of the frame.
    pub maps: &'a LightMaps,
}

/// Judges the techniques of a contestant scene by scene.
#[derive(Clone, Debug)]
pub struct Judging {
    settings: JudgeSettings,
    results: Results,
    times: JudgeTimes,
}

impl Judging {
    /// Begins without a scene.
    pub fn new(contestant: &impl Contestant, settings: JudgeSettings) -> Self {
        let results = Results { techniques: contestant.techniques(), frames: Vec::new() };
        Self { settings, results, times: JudgeTimes::default() }
    }

    /// Returns the results of all scenes that were judged.
    pub fn results(&self) -> &Results {
        &self.results
    }

    /// Returns the time that the parts of the work took.
    pub fn times(&self) -> JudgeTimes {
        self.times
    }

    /// Judges the frames of a scene, whose triangles are in `objects`. Frames under one light must be
    /// consecutive and in order. `look` is called with each judged picture.
    ///
    /// # Errors
    ///
    /// If the contestant fails, if its pictures and rays show different surfaces, or if `look` fails.
    pub fn judge_scene<C: Contestant>(
        &mut self,
        contestant: &mut C,
        scene: &str,
        objects: &[Vec<Corners>],
        frames: &[&Frame],
        mut look: impl FnMut(&JudgedPicture<'_>) -> Result<()>,
    ) -> Result<()> {
        let tracer = Tracer::new(objects.iter().flatten().copied());
        contestant.set_scene(objects)?;
        let judged: &mut dyn FnMut(&JudgedPicture<'_>) -> Result<()> = &mut look;
        let mut stage =
            Stage { contestant, scene, tracer: &tracer, extent: extent(objects), judging: self, look: judged };
        frames.chunk_by(|a, b| a.elevation_deg == b.elevation_deg).try_for_each(|path| stage.judge_path(path))
    }
}

/// A contestant and its current scene.
struct Stage<'a, C> {
    contestant: &'a mut C,
    scene: &'a str,
    tracer: &'a Tracer,
    /// Size of the scene, in metres.
    extent: f64,
    judging: &'a mut Judging,
    look: &'a mut dyn FnMut(&JudgedPicture<'_>) -> Result<()>,
}

/// A frame, drawn with one technique.
struct Shown<'a, Maps> {
    frame: &'a Frame,
    drawn: Drawn<Maps>,
}

impl<C: Contestant> Stage<'_, C> {
    /// Judges a path of consecutive frames with all techniques.
    fn judge_path(&mut self, path: &[&Frame]) -> Result<()> {
        let surfaces = self.see(path)?;
        let judged = path.iter().zip(&surfaces).filter(|(_, surfaces)| surfaces.is_some());
        let mut results: Vec<FrameResult> = judged.map(|(frame, _)| FrameResult::new(self.scene, frame)).collect();
        for technique in 0..self.judging.results.techniques.len() {
            let sums = self.judge_technique(path, &surfaces, technique)?;
            results.iter_mut().zip(sums).for_each(|(result, sums)| result.sums.push(sums));
        }
        self.judging.results.frames.extend(results);
        Ok(())
    }

    /// Traces the truth of the judged frames. Returns `None` for the others.
    fn see(&mut self, path: &[&Frame]) -> Result<Vec<Option<Surfaces>>> {
        self.contestant.begin_path(0, path[0])?;
        let JudgeSettings { every, crawl, .. } = self.judging.settings;
        let see = |(index, frame): (usize, &&Frame)| {
            let before = index.checked_sub(1).map(|before| path[before]).filter(|_| crawl);
            (frame.frame + 1).is_multiple_of(every).then(|| self.see_frame(frame, before)).transpose()
        };
        path.iter().enumerate().map(see).collect()
    }

    fn see_frame(&mut self, frame: &Frame, before: Option<&Frame>) -> Result<Surfaces> {
        let unshadowed = self.redraw(&Redraw { frame, maps: None, view_depths_of: None })?;
        let start = Instant::now();
        let contestant = &*self.contestant;
        let brightness = |surface: &LitSurface| contestant.brightness(surface);
        let size = self.judging.settings.size;
        let mut surfaces = Surfaces::new(self.tracer, frame, size, unshadowed, &brightness)?;
        self.judging.times.tracing += start.elapsed();
        if surfaces.unshadowed.is_some() && before.is_some() {
            let unshadowed = self.redraw(&Redraw { frame, maps: None, view_depths_of: before })?;
            let unshadowed = unshadowed.with_context(|| format!("{}: not drawn again", frame.id))?;
            surfaces = surfaces.with_before(unshadowed).with_context(|| frame.id.clone())?;
        }
        self.judging.times.frames += 1;
        self.judging.times.different += surfaces.different;
        Ok(surfaces)
    }

    /// Judges a path with one technique. Returns the sums of each judged frame.
    fn judge_technique(
        &mut self,
        path: &[&Frame],
        surfaces: &[Option<Surfaces>],
        technique: usize,
    ) -> Result<Vec<Sums>> {
        self.contestant.begin_path(technique, path[0])?;
        let first = surfaces.iter().position(Option::is_some);
        let mut before: Option<Shown<'_, C::Maps>> = None;
        let mut sums = Vec::new();
        for (index, frame) in path.iter().enumerate() {
            // The maps of the frame before a judged one are also needed.
            if surfaces[index].is_none() && surfaces.get(index + 1).is_none_or(Option::is_none) {
                before = None;
                continue;
            }
            let start = Instant::now();
            let shown = Shown { frame, drawn: self.contestant.draw(frame)? };
            self.judging.times.drawing += start.elapsed();
            if Some(index) == first {
                self.check_again(&shown)?;
            }
            if let Some(surfaces) = &surfaces[index] {
                let before = before.as_ref().filter(|_| self.judging.settings.crawl);
                sums.push(self.judge_frame(&shown, surfaces, before, technique)?);
            }
            before = Some(shown);
        }
        Ok(sums)
    }

    /// Draws a frame again with its own maps and then also with its own view depths. Both pictures must equal
    /// the first one: otherwise the crawl would contain other differences.
    fn check_again(&mut self, shown: &Shown<'_, C::Maps>) -> Result<()> {
        let (Shadows::Brightness(picture) | Shadows::Factors(picture)) = &shown.drawn.shadows else { return Ok(()) };
        let (frame, maps) = (shown.frame, Some(&shown.drawn.maps));
        // The second projection goes through world space and rounds differently, so that pixels at
        // silhouettes may differ.
        for (view_depths_of, allowed, cause) in [(None, 0.0, "maps"), (Some(frame), MAX_DIFFERENT, "view depths")] {
            let Some(again) = self.redraw(&Redraw { frame, maps, view_depths_of })? else { return Ok(()) };
            let differs = |(first, second): &(&f32, &f32)| (**first - **second).abs() > ROUNDING * first.max(**second);
            let different = picture.iter().zip(&again).filter(differs).count();
            let id = &frame.id;
            ensure!(
                different as f64 <= allowed * picture.len() as f64,
                "{id}: drawn again with its own {cause}, {different} pixels differ"
            );
        }
        Ok(())
    }

    fn judge_frame(
        &mut self,
        shown: &Shown<'_, C::Maps>,
        surfaces: &Surfaces,
        before: Option<&Shown<'_, C::Maps>>,
        technique: usize,
    ) -> Result<Sums> {
        let (frame, truth) = (shown.frame, &surfaces.truth);
        let factors = self.factors(&shown.drawn.shadows, surfaces, |point| point.view_depth)?;
        let start = Instant::now();
        let maps = self.contestant.light_maps(&shown.drawn.maps, frame.to_light());
        let judged = judge(self.tracer, truth, &maps.picture_maps(), &factors, |_| true);
        self.judging.times.judging += start.elapsed();
        let unshadowed = surfaces.unshadowed.as_deref();
        let (scene, judged, factors, maps) = (self.scene, &judged, &factors, &maps);
        (self.look)(&JudgedPicture { scene, frame, technique, truth, unshadowed, factors, judged, maps })?;
        let is_missed = |point: &&TruthPoint| point.is_judged && !maps.holds(point.position, point.view_depth);
        let missed = truth.points.iter().flatten().filter(is_missed).count();
        let mut sums = Sums { tally: judged.tally.clone(), missed: missed as u64 };
        sums.tally.add_flip(surfaces.flip(factors));
        if let Some(before) = before {
            let crawl = self.crawl(shown, surfaces, &Found { judged, factors }, before)?;
            if let Some(crawl) = &crawl {
                sums.tally.add_crawl(crawl);
            }
        }
        Ok(sums)
    }

    /// Compares a judged picture with a picture of the same view that uses the previous frame's maps. Returns
    /// `None` if the contestant cannot draw it.
    fn crawl(
        &mut self,
        shown: &Shown<'_, C::Maps>,
        surfaces: &Surfaces,
        found: &Found<'_>,
        before: &Shown<'_, C::Maps>,
    ) -> Result<Option<Crawl>> {
        let PixelCamera { eye, forward, .. } = PixelCamera::new(before.frame.camera(), self.judging.settings.size);
        let depth = |point: &TruthPoint| (point.position - eye).dot(forward);
        let factors_before = if let Shadows::Lookup(_) = &before.drawn.shadows {
            Some(self.factors(&before.drawn.shadows, surfaces, depth)?)
        } else {
            let (frame, maps) = (shown.frame, Some(&before.drawn.maps));
            let picture = self.redraw(&Redraw { frame, maps, view_depths_of: Some(before.frame) })?;
            let is_brightness = matches!(before.drawn.shadows, Shadows::Brightness(_));
            let unshadowed = surfaces.unshadowed_before.as_deref().filter(|_| is_brightness);
            picture
                .map(|picture| unshadowed.map_or_else(|| picture.clone(), |unshadowed| factors(&picture, unshadowed)))
        };
        let Some(factors_before) = factors_before else { return Ok(None) };
        let start = Instant::now();
        let maps = self.contestant.light_maps(&before.drawn.maps, before.frame.to_light());
        // Points outside all maps of the previous frame do not crawl.
        let mut judged = found.judged.clone();
        for (counted, point) in judged.counted.iter_mut().zip(&surfaces.truth.points) {
            *counted &= point.as_ref().is_some_and(|point| maps.holds(point.position, depth(point)));
        }
        let maps_before = MapsBefore { maps: maps.picture_maps(), eye, forward, factors: &factors_before };
        let crawl = crawl(&surfaces.truth, &judged, found.factors, &maps_before);
        self.judging.times.judging += start.elapsed();
        Ok(Some(crawl))
    }

    /// Returns the share of the light that reaches each pixel of a frame. `view_depth` selects the map of a look-up.
    fn factors(
        &self,
        shadows: &Shadows,
        surfaces: &Surfaces,
        view_depth: impl Fn(&TruthPoint) -> f64,
    ) -> Result<Vec<f32>> {
        match shadows {
            Shadows::Brightness(picture) => {
                let unshadowed = surfaces.unshadowed.as_ref();
                let unshadowed = unshadowed.context("a picture of brightness needs one without shadows: `redraw`")?;
                Ok(factors(picture, unshadowed))
            }
            Shadows::Factors(factors) => Ok(factors.clone()),
            Shadows::Lookup(lookup) => Ok(lookup.factors_at(self.tracer, &surfaces.truth, self.extent, view_depth)),
        }
    }

    fn redraw(&mut self, redraw: &Redraw<'_, C::Maps>) -> Result<Option<Vec<f32>>> {
        let start = Instant::now();
        let picture = self.contestant.redraw(redraw);
        self.judging.times.drawing += start.elapsed();
        picture
    }
}

/// A picture and its classes.
struct Found<'a> {
    judged: &'a Judged,
    factors: &'a [f32],
}

/// Returns the size of a scene, in metres.
fn extent(objects: &[Vec<Corners>]) -> f64 {
    let corners = objects.iter().flatten().flatten().map(|corner| corner.as_dvec3());
    let start = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    let [low, high] = corners.fold(start, |[low, high], corner| [low.min(corner), high.max(corner)]);
    if low.cmple(high).all() { (high - low).length() } else { 0.0 }
}
