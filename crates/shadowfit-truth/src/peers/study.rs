//! Many fits measured on the frames of a scene, in parallel over the frames.

use std::path::Path;

use rayon::prelude::*;

use super::error::PeersError;
use super::measure::{FrameMaps, measure};
use super::shadow_map::ShadowMap;
use super::table::{FitTable, GroupTally};
use super::tally::Tally;
use super::visible::VisiblePoints;
use super::{FitFile, Scenarios};
use crate::{PictureTally, Tracer};

/// Fits that are measured side by side, so that each frame is traced once.
#[derive(Clone, Debug)]
pub struct Study {
    scenarios: Scenarios,
    fits: Vec<Fit>,
}

/// A fit, and what was measured of it so far.
#[derive(Clone, Debug)]
struct Fit {
    peer: String,
    nanoseconds: Option<f64>,
    pancake: bool,
    /// Maps of each frame, in the order of the scenarios.
    maps: Vec<Vec<ShadowMap>>,
    groups: Vec<GroupTally>,
}

impl Study {
    /// A study without fits.
    pub fn new(scenarios: Scenarios) -> Self {
        Self { scenarios, fits: Vec::new() }
    }

    /// The scenes and frames.
    pub fn scenarios(&self) -> &Scenarios {
        &self.scenarios
    }

    /// Adds a fit; `file` is named in errors.
    ///
    /// # Errors
    ///
    /// When the fit does not have every frame of the scenarios once, and no other.
    pub fn add(&mut self, fit: &FitFile, file: &Path) -> Result<(), PeersError> {
        let in_order = fit.maps_in_order(&self.scenarios, file)?;
        let prepare = |(frame, maps): (&super::Frame, &[super::FitMap])| {
            maps.iter().map(|map| ShadowMap::new(map, frame.to_light())).collect()
        };
        self.fits.push(Fit {
            peer: fit.peer.clone(),
            nanoseconds: fit.ns_per_fit,
            pancake: fit.pancake,
            maps: self.scenarios.frames.iter().zip(in_order).map(prepare).collect(),
            groups: Vec::new(),
        });
        Ok(())
    }

    /// Measures all frames of a scene, on every core. `stride` takes every so many rays across and
    /// down, 1 for all; `frame_done` is called as often as the scene has frames.
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
        // Merged in order, so that sums do not depend on which core was first.
        for (frame, tallies) in frames.iter().zip(tallies) {
            let frame = &self.scenarios.frames[*frame];
            let (scene, group) = (&self.scenarios.scenes[frame.scene].name, self.scenarios.group(frame));
            for (fit, tally) in self.fits.iter_mut().zip(&tallies) {
                fit.group(scene, &group).tally.merge(tally);
            }
        }
    }

    /// Adds the sums of a judged picture: of a fit, by the order in which fits were added, at a frame. Pictures are
    /// summed in the order in which they are added.
    pub fn add_picture(&mut self, fit: usize, frame: usize, pictures: &PictureTally) {
        let frame = &self.scenarios.frames[frame];
        let (scene, group) = (&self.scenarios.scenes[frame.scene].name, self.scenarios.group(frame));
        self.fits[fit].group(scene, &group).pictures.merge(pictures);
    }

    /// The tables of the fits, in the order in which they were added, over all scenes measured so far.
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
                previous: previous.map(|previous| fit.maps[previous].as_slice()),
                pancake: fit.pancake,
            };
            measure(&visible, &maps)
        };
        self.fits.iter().map(of).collect()
    }
}

impl Fit {
    /// The sums of a group, made when it is new.
    fn group(&mut self, scene: &str, group: &str) -> &mut GroupTally {
        let place = self.groups.iter().position(|known| known.group == group).unwrap_or_else(|| {
            self.groups.push(GroupTally {
                scene: scene.to_owned(),
                group: group.to_owned(),
                tally: Tally::default(),
                pictures: PictureTally::default(),
            });
            self.groups.len() - 1
        });
        &mut self.groups[place]
    }
}
