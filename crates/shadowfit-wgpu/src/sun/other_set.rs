//! Second set of maps for a sun with cross-fading light steps. It is drawn for the next direction, then read
//! while the first set fades out.

use shadowfit::{FittedMap, ShadowFitter};

use super::steps::{Stage, Step};
use super::{SunShadows, SunShadowsError};
use crate::maps::cached_maps::CachedMaps;
use crate::{ShadowPass, SunFrame};

/// A set of maps with the fitter that places it.
#[derive(Debug)]
pub(super) struct OtherSet {
    pub(super) fitter: ShadowFitter,
    pub(super) maps: CachedMaps,
}

impl OtherSet {
    /// Creates the second set if the maps cross-fade.
    pub(super) fn of(maps: &CachedMaps) -> Option<Self> {
        let cross_fades = maps.map().descriptor().cross_fades;
        cross_fades.then(|| Self { fitter: ShadowFitter::default(), maps: maps.second() })
    }
}

impl SunShadows {
    /// Returns the light directions of a frame, and swaps the two sets of maps if the step requires it.
    pub(super) fn step(&mut self, frame: &SunFrame<'_>) -> Result<Step, SunShadowsError> {
        let [width, height] = self.map().descriptor().resolution;
        let count = self.maps().len();
        let kept = if (0..count).all(|map| self.is_cached(map)) { count } else { 0 };
        let Some(steps) = &mut self.steps else {
            return Ok(Step { now: frame.direction, other: None, begins: false, swaps: false });
        };
        let step = steps.next(frame.direction, width.max(height), kept)?;
        if let Some(other) = &mut self.other {
            if step.begins {
                // The new set starts from the present maps, so that windows keep their sizes and roughly
                // their places.
                other.fitter.clone_from(&self.fitter);
                other.maps.invalidate_all();
            }
            if step.swaps {
                core::mem::swap(&mut other.fitter, &mut self.fitter);
                core::mem::swap(&mut other.maps, &mut self.maps);
            }
            (self.maps.is_present, other.maps.is_present) = (true, false);
        }
        Ok(step)
    }

    /// Fits and prepares the other set of maps, after the present one.
    pub(super) fn update_other(
        &mut self,
        queue: &wgpu::Queue,
        frame: &SunFrame<'_>,
        step: &Step,
    ) -> Result<(), SunShadowsError> {
        let (Some(direction), Some(steps), Some(other)) = (step.other, &self.steps, &mut self.other) else {
            return Ok(());
        };
        let frame = SunFrame { direction, ..*frame };
        let fitted = *other.fitter.fit(&frame.input())?;
        match steps.stage() {
            Stage::Drawing { drawn, .. } => {
                // One more map than in the previous frame; the others are kept.
                let drawn: &[FittedMap] = &fitted[..drawn.min(fitted.len())];
                other.maps.update(queue, &frame.cache_frame(drawn), &frame.map_view())?;
            }
            Stage::Fading { share, .. } => {
                other.maps.update(queue, &frame.cache_frame(&fitted), &frame.map_view())?;
                self.maps.fade_from(queue, &other.maps, &frame.map_view(), share);
            }
            Stage::Held => {}
        }
        Ok(())
    }

    /// Returns the other set and the present set's share while the look-up mixes both.
    pub(super) fn faded(&self) -> Option<(&OtherSet, f32)> {
        let stage = self.steps.as_ref()?.stage();
        let Stage::Fading { share, .. } = stage else { return None };
        self.other.as_ref().map(|other| (other, share))
    }

    /// Returns the passes of both sets.
    pub(super) fn all_passes(&self) -> impl ExactSizeIterator<Item = ShadowPass<'_>> {
        let (present, other) = (self.maps.pass_count(), self.other.as_ref().map(|other| &other.maps));
        let all = present + other.map_or(0, CachedMaps::pass_count);
        (0..all).map(move |index| match other {
            Some(other) if index >= present => other.pass(index - present, self.maps.piece_count()),
            _ => self.maps.pass(index, 0),
        })
    }
}
