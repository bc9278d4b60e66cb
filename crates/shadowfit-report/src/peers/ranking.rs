//! Measures many fits on the frames of a scene, in parallel over the frames.

use std::path::Path;

use rayon::prelude::*;

use super::error::PeersError;
use super::fit_file::{FitFile, FitMap};
use super::measure::{FrameMaps, PreviousMaps, measure};
use super::scenarios::{Frame, Scenarios};
use super::table::{FitTable, GroupTally};
use super::tally::Tally;
use super::visible::VisiblePoints;
use shadowfit_truth::{MeasuredMap, PictureTally, Tracer};

/// Fits that are measured on the same frames. Each frame is traced once for all fits.
#[derive(Clone, Debug)]
pub struct Ranking {
    scenarios: Scenarios,
    fits: Vec<Fit>,
}

/// A fit and its sums so far.
#[derive(Clone, Debug)]
struct Fit {
    peer: String,
    nanoseconds: Option<f64>,
    depth_clamp: bool,
    /// Maps of each frame, in the order of the scenarios.
    maps: Vec<Vec<MeasuredMap>>,
    groups: Vec<GroupTally>,
}

impl Ranking {
    /// Creates a ranking without fits.
    pub fn new(scenarios: Scenarios) -> Self {
        Self { scenarios, fits: Vec::new() }
    }

    /// Returns the scenes and frames.
    pub fn scenarios(&self) -> &Scenarios {
        &self.scenarios
    }

    /// Adds a fit. `file` is named in errors.
    ///
    /// # Errors
    ///
    /// If the fit lacks a frame of the scenarios, has a frame twice, or has an unknown frame.
    pub fn add(&mut self, fit: &FitFile, file: &Path) -> Result<(), PeersError> {
        let in_order = fit.maps_in_order(&self.scenarios, file)?;
        let prepare = |(frame, maps): (&Frame, &[FitMap])| -> Vec<MeasuredMap> {
            maps.iter().map(|map| map.measured(frame.to_light())).collect()
        };
        self.fits.push(Fit {
            peer: fit.peer.clone(),
            nanoseconds: fit.ns_per_fit,
            depth_clamp: fit.depth_clamp,
            maps: self.scenarios.frames.iter().zip(in_order).map(prepare).collect(),
            groups: Vec::new(),
        });
        Ok(())
    }

    /// Measures all frames of a scene on all cores. `tracer` holds the scene's triangles, and `stride` is the
    /// argument of [`VisiblePoints::trace`]. `frame_done` is called once per frame.
    pub fn measure_scene(&mut self, scene: usize, tracer: &Tracer, stride: u32, frame_done: &(impl Fn() + Sync)) {
        let frames: Vec<usize> =
            (0..self.scenarios.frames.len()).filter(|index| self.scenarios.frames[*index].scene == scene).collect();
        let tallies: Vec<Vec<Tally>> = frames
            .par_iter()
            .map(|frame| {
                let tallies = self.measure_frame(*frame, tracer, stride);
                frame_done();
                tallies
            })
            .collect();
        // Merge in frame order, so that sums do not depend on the timing of the cores.
        for (frame, tallies) in frames.iter().zip(tallies) {
            let frame = &self.scenarios.frames[*frame];
            let (scene, group) = (&self.scenarios.scenes[frame.scene].name, self.scenarios.group(frame));
            for (fit, tally) in self.fits.iter_mut().zip(&tallies) {
                fit.group(scene, &group).tally.merge(tally);
            }
        }
    }

    /// Adds the sums of a judged picture. `fit` is the index of the fit in the order of [`Self::add`], and
    /// `frame` is the index of the frame in the scenarios. Sums are equal to the last bit only if pictures
    /// are added in the same order.
    ///
    /// # Panics
    ///
    /// If `fit` or `frame` is out of range.
    pub fn add_picture(&mut self, fit: usize, frame: usize, pictures: &PictureTally) {
        let frame = &self.scenarios.frames[frame];
        let (scene, group) = (&self.scenarios.scenes[frame.scene].name, self.scenarios.group(frame));
        self.fits[fit].group(scene, &group).pictures.merge(pictures);
    }

    /// Returns the tables of the fits, in the order in which they were added, over all scenes measured so
    /// far.
    pub fn tables(&self) -> Vec<FitTable> {
        let table = |fit: &Fit| FitTable::new(&fit.peer, fit.nanoseconds, &fit.groups);
        self.fits.iter().map(table).collect()
    }

    fn measure_frame(&self, frame: usize, tracer: &Tracer, stride: u32) -> Vec<Tally> {
        let visible = VisiblePoints::trace(tracer, &self.scenarios.frames[frame], stride);
        let previous = self.scenarios.previous(frame);
        let of = |fit: &Fit| {
            let maps = FrameMaps {
                maps: &fit.maps[frame],
                previous: previous
                    .map(|index| PreviousMaps { frame: &self.scenarios.frames[index], maps: &fit.maps[index] }),
                depth_clamp: fit.depth_clamp,
            };
            measure(&visible, &maps)
        };
        self.fits.iter().map(of).collect()
    }
}

impl Fit {
    /// Returns the sums of a group. Adds the group if it is new.
    fn group(&mut self, scene: &str, group: &str) -> &mut GroupTally {
        let index = self.groups.iter().position(|known| known.group == group).unwrap_or_else(|| {
            self.groups.push(GroupTally {
                scene: scene.to_owned(),
                group: group.to_owned(),
                tally: Tally::default(),
                pictures: PictureTally::default(),
            });
            self.groups.len() - 1
        });
        &mut self.groups[index]
    }
}
