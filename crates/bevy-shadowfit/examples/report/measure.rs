//! Draws and judges the frames of a path, for each of the fits that are compared.

use std::error::Error;
use std::time::{Duration, Instant};

use shadowfit::glam::DVec3;
use shadowfit::selection::MapOrder;
use shadowfit::settings::MapSelection;
use shadowfit_truth::peers::Frame;
use shadowfit_truth::{
    Crawl, Judged, MapReading, MapsBefore, MeasuredMap, PictureMaps, PictureTally, PixelCamera, Tracer, TruthPoint,
    crawl, judge,
};

use crate::contestant::Entrant;
use crate::light_maps::LightMaps;
use crate::seen::{MAX_DIFFERENT, Seen};
use crate::stage::{Stage, StageSettings};

/// Share of a brightness by which rounding may change it: the renderer draws in half floats.
const ROUNDING: f32 = 2e-3;

/// Sums over judged pictures.
#[derive(Clone, Default)]
pub(crate) struct Sums {
    pub(crate) tally: PictureTally,
    /// Judged pixels whose point lies outside of the cascade that Bevy's shader reads for it: it finds light there,
    /// even if a later cascade holds the point. The tally's uncovered pixels are those that no later one holds either.
    missed: u64,
}

impl Sums {
    pub(crate) fn merge(&mut self, other: &Self) {
        self.tally.merge(&other.tally);
        self.missed += other.missed;
    }

    /// Titles and values of all columns.
    pub(crate) fn columns(&self) -> Vec<(&'static str, f64)> {
        let missed = if self.tally.is_empty() { f64::NAN } else { 100.0 * self.tally.share(self.missed) };
        let mut columns = self.tally.columns();
        columns.retain(|(title, _)| !["area error %", "area error several %", "traced %"].contains(title));
        columns.push(("missed %", missed));
        columns
    }

    /// The value of a column; not a number where there is none.
    pub(crate) fn value(&self, title: &str) -> f64 {
        self.columns().iter().find(|(known, _)| *known == title).map_or(f64::NAN, |(_, value)| *value)
    }
}

/// How frames are measured.
pub(crate) struct Measure<'a> {
    pub(crate) stage: &'a mut Stage,
    pub(crate) tracer: &'a Tracer,
    pub(crate) settings: &'a StageSettings,
    /// Reach of the filter, in texels.
    pub(crate) reach: f32,
    /// Updates of the app for each frame.
    pub(crate) settle: u32,
    /// Every so many frames are judged.
    pub(crate) every: usize,
    pub(crate) crawl: bool,
    pub(crate) times: Times,
}

/// Where the time goes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Times {
    pub(crate) drawing: Duration,
    pub(crate) tracing: Duration,
    pub(crate) judging: Duration,
    /// Pictures without shadows, one for each judged frame.
    pub(crate) frames: u32,
    /// Sum over the frames of the shares of pixels that are left out.
    pub(crate) different: f64,
}

/// A judged picture.
pub(crate) struct Picture<'a> {
    pub(crate) seen: &'a Seen,
    /// The picture with shadows. Red channels, rows from the top.
    pub(crate) shadowed: &'a [f32],
    pub(crate) judged: &'a Judged,
    pub(crate) maps: &'a LightMaps,
}

impl Measure<'_> {
    /// What is true of the frames that are judged, in their order; `None` for the others.
    ///
    /// # Errors
    ///
    /// When pictures are not those of the frames.
    pub(crate) fn see(&mut self, path: &[&Frame]) -> Result<Vec<Option<Seen>>, Box<dyn Error>> {
        self.stage.set_light(path[0], Entrant::BEVY);
        let mut seen = Vec::with_capacity(path.len());
        for (index, frame) in path.iter().enumerate() {
            let before = index.checked_sub(1).map(|before| path[before]).filter(|_| self.crawl);
            seen.push(self.is_judged(frame).then(|| self.see_frame(frame, before)).transpose()?);
        }
        Ok(seen)
    }

    fn see_frame(&mut self, frame: &Frame, before: Option<&Frame>) -> Result<Seen, Box<dyn Error>> {
        self.stage.set_camera(frame);
        let start = Instant::now();
        let unshadowed = self.stage.draw_unshadowed()?;
        self.times.drawing += start.elapsed();
        let start = Instant::now();
        let mut seen = Seen::new(self.tracer, frame, self.settings.size, unshadowed)?;
        self.times.tracing += start.elapsed();
        if let Some(before) = before {
            let start = Instant::now();
            self.stage.set_view_depths(Some(before));
            let unshadowed = self.stage.draw_unshadowed();
            self.stage.set_view_depths(None);
            seen = seen.with_before(unshadowed?).map_err(|error| format!("{}: {error}", frame.id))?;
            self.times.drawing += start.elapsed();
        }
        self.times.frames += 1;
        self.times.different += seen.different;
        Ok(seen)
    }

    /// Draws and judges a path, whose frames follow one another, with one of the fits. `look` is shown each judged
    /// picture.
    pub(crate) fn run(
        &mut self,
        path: &[&Frame],
        seen: &[Option<Seen>],
        entrant: Entrant,
        mut look: impl FnMut(&Picture) -> Result<(), Box<dyn Error>>,
    ) -> Result<Sums, Box<dyn Error>> {
        self.stage.set_light(path[0], entrant);
        let first = seen.iter().position(Option::is_some).unwrap_or(0);
        let mut sums = Sums::default();
        let mut before: Option<(&Frame, LightMaps)> = None;
        for (index, frame) in path.iter().enumerate() {
            // The fit of the frame before a judged one is needed, too.
            if seen[index].is_none() && seen.get(index + 1).is_none_or(Option::is_none) {
                before = None;
                continue;
            }
            let start = Instant::now();
            self.stage.set_camera(frame);
            self.stage.settle(self.settle.saturating_sub(1));
            let shadowed = self.stage.draw()?;
            let maps = self.stage.maps()?;
            self.times.drawing += start.elapsed();
            if index == first {
                self.check_again(frame, &shadowed, &maps)?;
            }
            if let Some(seen) = &seen[index] {
                let before = before.as_ref().filter(|_| self.crawl);
                sums.merge(&self.judge_frame(frame, seen, (&shadowed, &maps), before, &mut look)?);
            }
            before = Some((frame, maps));
        }
        Ok(sums)
    }

    /// Draws a frame again with its own maps in place of those of the next update, and once more with its own view
    /// depths: both have to give the same picture, or crawl would be measured with something else.
    fn check_again(&mut self, frame: &Frame, shadowed: &[f32], maps: &LightMaps) -> Result<(), Box<dyn Error>> {
        let again = self.stage.draw_with(maps)?;
        self.stage.set_view_depths(Some(frame));
        let by_depths = self.stage.draw_with(maps);
        self.stage.set_view_depths(None);
        // A projection by way of the world is rounded otherwise, so that pixels at silhouettes may differ.
        for (again, allowed, what) in [(again, 0.0, "maps"), (by_depths?, MAX_DIFFERENT, "view depths")] {
            let differs = |(first, second): &(&f32, &f32)| (**first - **second).abs() > ROUNDING * first.max(**second);
            let different = shadowed.iter().zip(&again).filter(differs).count();
            if different as f64 > allowed * shadowed.len() as f64 {
                return Err(format!("{}: drawn again with its own {what}, {different} pixels differ", frame.id).into());
            }
        }
        Ok(())
    }

    fn judge_frame(
        &mut self,
        frame: &Frame,
        seen: &Seen,
        (shadowed, maps): (&[f32], &LightMaps),
        before: Option<&(&Frame, LightMaps)>,
        look: &mut impl FnMut(&Picture) -> Result<(), Box<dyn Error>>,
    ) -> Result<Sums, Box<dyn Error>> {
        let start = Instant::now();
        let measured = maps.measured(self.settings.map_size, frame.to_light());
        let factors = seen.factors(shadowed);
        let judged = judge(self.tracer, &seen.truth, &self.picture_maps(&measured), &factors, |_| true);
        self.times.judging += start.elapsed();
        look(&Picture { seen, shadowed, judged: &judged, maps })?;
        let missed = seen.truth.points.iter().flatten().filter(|point| is_missed(point, &measured)).count();
        let mut sums = Sums { tally: judged.tally.clone(), missed: missed as u64 };
        if let Some((frame, maps)) = before {
            sums.tally.add_crawl(&self.crawl(seen, &judged, &factors, frame, maps)?);
        }
        Ok(sums)
    }

    /// Compares a judged picture with that of the maps of the frame before, in the same view.
    fn crawl(
        &mut self,
        seen: &Seen,
        judged: &Judged,
        factors: &[f32],
        before: &Frame,
        maps: &LightMaps,
    ) -> Result<Crawl, Box<dyn Error>> {
        let start = Instant::now();
        self.stage.set_view_depths(Some(before));
        let shadowed = self.stage.draw_with(maps);
        self.stage.set_view_depths(None);
        self.times.drawing += start.elapsed();
        let start = Instant::now();
        let factors_before = seen.factors_before(&shadowed?).ok_or("the frame before was not drawn without shadows")?;
        let measured = maps.measured(self.settings.map_size, before.to_light());
        let PixelCamera { eye, forward, .. } = PixelCamera::new(before.camera(), self.settings.size);
        let before = MapsBefore { maps: self.picture_maps(&measured), eye, forward, factors: &factors_before };
        // Where the cascade of a point's depth does not hold it, Bevy's shader finds light, and no later one.
        let mut judged = judged.clone();
        for (counted, point) in judged.counted.iter_mut().zip(&seen.truth.points) {
            let depth = |point: &TruthPoint| (point.position - eye).dot(forward);
            *counted &= point.as_ref().is_some_and(|point| is_read(point.position, depth(point), &measured));
        }
        let crawl = crawl(&seen.truth, &judged, factors, &before);
        self.times.judging += start.elapsed();
        Ok(crawl)
    }

    /// Whether a frame is judged: the last of so many, so that the frame before is of the same path.
    fn is_judged(&self, frame: &Frame) -> bool {
        (frame.frame as usize + 1).is_multiple_of(self.every)
    }

    fn picture_maps<'a>(&self, maps: &'a [MeasuredMap]) -> PictureMaps<'a> {
        // Windows all end where shadows do, and come finest first.
        let reading = if has_windows(maps) {
            let order = MapOrder::by_area(maps.iter().map(|_| Some(1.0)));
            MapReading::Coverage { order, blend: MapSelection::DEFAULT_BLEND }
        } else {
            MapReading::ViewDepth
        };
        PictureMaps { maps, reading, reach: self.reach, depth_clamp: true }
    }
}

fn has_windows(maps: &[MeasuredMap]) -> bool {
    maps.len() > 1 && maps.iter().all(|map| map.split_far == maps[0].split_far)
}

fn is_missed(point: &TruthPoint, maps: &[MeasuredMap]) -> bool {
    point.is_judged && !is_read(point.position, point.view_depth, maps)
}

/// Whether the map that Bevy's shader reads for a point holds it.
fn is_read(position: DVec3, view_depth: f64, maps: &[MeasuredMap]) -> bool {
    let is_inside = |map: &MeasuredMap| map.is_inside(&map.project(position));
    if has_windows(maps) {
        maps.iter().any(is_inside)
    } else {
        maps.iter().find(|map| view_depth < map.split_far).is_some_and(is_inside)
    }
}
