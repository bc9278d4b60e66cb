//! The fitter of one sun and one camera: the numbers that the caller writes and reads, and the calls between.

use alloc::vec::Vec;

use shadowfit::culling::cull;
use shadowfit::demand::{DepthRows, VisibleDemandSpace};
use shadowfit::glam::{DVec3, Vec3};
use shadowfit::settings::MAX_MAPS;
use shadowfit::{Aabb, Boxes, CasterVolume, FitError, FitInput, ShadowFitter, ViewFrustum, VisibleDemand};

use crate::error::ErrorNumbers;
use crate::input::{Frame, INPUT};
use crate::output::{self, MAP};
use crate::settings::{SETTINGS, Settings};

/// Flag of boxes that cast shadows.
const CASTS: u8 = 1;
/// Flag of boxes that receive shadows.
const RECEIVES: u8 = 2;

/// Selection of casters for the maps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Drawn {
    /// All casters with a visible shadow in this frame.
    ThisFrame,
    /// All casters with a shadow in the map, for maps that are kept.
    Kept,
}

/// A fitter and the memory that it shares with the caller.
#[derive(Debug)]
pub(crate) struct Fitter {
    pub(crate) settings_numbers: [f64; SETTINGS],
    pub(crate) input: [f64; INPUT],
    pub(crate) maps: [[f64; MAP]; MAX_MAPS],
    /// Boxes relative to [`Self::origin`].
    pub(crate) boxes: Vec<Aabb>,
    pub(crate) flags: Vec<u8>,
    pub(crate) origin: DVec3,
    /// A byte for each box: bit i is set if it is drawn into map i.
    pub(crate) masks: Vec<u8>,
    pub(crate) depths: Vec<f32>,
    pub(crate) error: ErrorNumbers,
    settings: Option<Settings>,
    sun: ShadowFitter,
    receivers: Vec<Aabb>,
    casters: Vec<Aabb>,
    volumes: [CasterVolume; MAX_MAPS],
}

impl Fitter {
    pub(crate) fn new() -> Self {
        Self {
            settings_numbers: [0.0; SETTINGS],
            input: [0.0; INPUT],
            maps: [[0.0; MAP]; MAX_MAPS],
            boxes: Vec::new(),
            flags: Vec::new(),
            origin: DVec3::ZERO,
            masks: Vec::new(),
            depths: Vec::new(),
            error: ErrorNumbers::default(),
            settings: None,
            sun: ShadowFitter::default(),
            receivers: Vec::new(),
            casters: Vec::new(),
            volumes: [CasterVolume::nowhere(DVec3::ZERO); MAX_MAPS],
        }
    }

    /// Reads the settings from the memory.
    pub(crate) fn configure(&mut self) {
        let settings = Settings::read(&self.settings_numbers);
        self.sun.set_technique(&settings.technique);
        self.settings = Some(settings);
    }

    /// Makes room for boxes and their flags.
    pub(crate) fn set_count(&mut self, count: usize) {
        self.boxes.resize(count, Aabb::new(Vec3::ZERO, Vec3::ZERO));
        self.flags.resize(count, CASTS | RECEIVES);
    }

    /// Forgets all earlier frames.
    pub(crate) fn reset(&mut self) {
        self.sun.reset();
    }

    /// Forgets the counted surfaces.
    pub(crate) fn forget_depths(&mut self) {
        self.sun.forget_visible_demand();
    }

    /// Fits the maps of the frame in the memory. Returns their number.
    pub(crate) fn fit(&mut self) -> Result<usize, FitError> {
        let settings = self.settings.as_ref().ok_or(FitError::NoView)?;
        let frame = Frame::read(&self.input);
        let (frusta, views) = frame.frusta(settings.technique.fit.max_distance)?;
        let views = &frusta[..views];
        collect(&mut self.receivers, &self.boxes, &self.flags, RECEIVES);
        collect(&mut self.casters, &self.boxes, &self.flags, CASTS);
        let listed = |boxes| Some(Boxes { origin: self.origin, boxes });
        let (receivers, casters) = (listed(&self.receivers), listed(&self.casters));
        let input = FitInput { receivers, casters, ..FitInput::new(views, frame.direction) };
        let maps = self.sun.fit(&input)?;
        for (i, map) in maps.iter().enumerate() {
            // Shaders of web pages take world positions.
            let bias = settings.bias(&map.projection.relative_to(DVec3::ZERO))?;
            output::write(&mut self.maps[i], map, &bias, maps.get(i + 1));
        }
        self.volumes = maps.caster_volumes(views, &settings.technique)?;
        Ok(maps.len())
    }

    /// Finds the casters of each map of the last fit.
    pub(crate) fn cull(&mut self, drawn: Drawn) {
        let maps = self.sun.fitted();
        let mut volumes = self.volumes;
        if drawn == Drawn::Kept {
            let casters = self.sun.technique().fit.casters;
            for (volume, map) in volumes.iter_mut().zip(maps.iter()) {
                *volume = CasterVolume::of_map(&map.projection, casters);
            }
        }
        self.masks.clear();
        self.masks.resize(self.boxes.len(), 0);
        cull(&volumes[..maps.len()], self.origin, &self.boxes, &mut self.masks);
    }

    /// Counts the surfaces in a depth buffer of `width` columns, drawn with the first view of the memory.
    pub(crate) fn count_depths(&mut self, width: u32) -> Result<(), FitError> {
        let fit = &self.sun.technique().fit;
        let frame = Frame::read(&self.input);
        let (frusta, _) = frame.frusta(fit.max_distance)?;
        let view: &ViewFrustum = &frusta[0];
        let (clip_from_world, depth) = frame.clip_from_eye()?;
        let space = VisibleDemandSpace::new(view, frame.direction, fit.up, fit.max_distance)?;
        let mut demand = VisibleDemand::new(space);
        let clip_from_world = clip_from_world.as_mat4();
        demand.count_rows(&DepthRows { depths: &self.depths, width, clip_from_world, depth, view }, 1)?;
        self.sun.set_visible_demand(demand);
        Ok(())
    }
}

/// Collects the boxes with a flag.
fn collect(list: &mut Vec<Aabb>, boxes: &[Aabb], flags: &[u8], flag: u8) {
    list.clear();
    list.extend(boxes.iter().zip(flags).filter(|(_, flags)| *flags & flag != 0).map(|(aabb, _)| *aabb));
}
