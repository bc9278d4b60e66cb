//! Several maps for one view, kept still from frame to frame.
//!
//! A [`CascadeFitter`] remembers what it fitted last, as plain data: the cuts between the maps and,
//! with [`Stabilise::Hysteresis`], the maps themselves. Everything else follows from the input.

mod hold;

use core::ops::Deref;

use glam::DVec2;

use crate::fits::{self, Content, Light, Range, Volume};
use crate::motion::Motion;
use crate::settings::{CascadeSettings, FitKind, FitSettings, MAX_CASCADES, Stabilise};
use crate::splits::{Chooser, Cuts};
use crate::{FitError, FitInput, LightFit, ViewFrustum, Workspace, checks, grid};
use hold::HeldMap;

/// One of several maps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CascadeMap {
    /// The map's matrices and box.
    pub fit: LightFit,
    /// View depth from which points choose this map, in metres.
    pub near: f32,
    /// View depth up to which points choose this map, in metres. The last map has no end.
    pub far: f32,
    /// View depth from which this map covers what is seen, in metres: before `near` where the
    /// maps overlap.
    pub covered_near: f32,
}

/// The maps of one frame, nearest first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cascades {
    maps: [CascadeMap; MAX_CASCADES],
    count: usize,
}

impl Deref for Cascades {
    type Target = [CascadeMap];

    fn deref(&self) -> &[CascadeMap] {
        &self.maps[..self.count]
    }
}

/// Fits several maps frame by frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct CascadeFitter {
    cuts: Option<HeldCuts>,
    maps: [Option<HeldMap>; MAX_CASCADES],
    last_view: Option<ViewFrustum>,
    /// What the state was made with; any change begins anew.
    settings: Option<CascadeSettings>,
}

/// Cuts of an earlier frame.
#[derive(Clone, Copy, Debug)]
struct HeldCuts {
    cuts: Cuts,
    /// Depths over which they were spread, in metres.
    spread: (f64, f64),
    /// Frames since they were last compared with what would be best.
    age: u32,
}

/// Frames between two comparisons of held cuts with what would be best, which costs most of a
/// frame's fit. Whether they reach as far as they must is looked at in each.
const COMPARE_EVERY: u32 = 8;

impl CascadeFitter {
    /// A fitter that remembers nothing.
    pub fn new() -> Self {
        Self::default()
    }

    /// Forgets all earlier frames: after a camera cut, or when a new level begins.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// Fits the maps of a frame.
    ///
    /// # Errors
    ///
    /// As [`fit_scene`](crate::fit_scene), for the settings of each map;
    /// [`FitError::OutOfRange`] for a number of maps outside 1..=8, an overlap or λ outside 0..=1
    /// and hold settings that make no sense; [`FitError::NearNotBelowFar`] for manual cuts that
    /// do not ascend. An error leaves the fitter as it was.
    pub fn fit(
        &mut self,
        input: &FitInput,
        settings: &CascadeSettings,
        workspace: &mut Workspace,
    ) -> Result<Cascades, FitError> {
        let (light, distance) = check(input, settings)?;
        let mut next = if self.settings.as_ref() == Some(settings) { *self } else { Self::default() };
        next.settings = Some(*settings);
        let cascades = next.fit_checked(input, settings, workspace, light, distance)?;
        next.last_view = Some(input.views[0]);
        *self = next;
        Ok(cascades)
    }

    fn fit_checked(
        &mut self,
        input: &FitInput,
        settings: &CascadeSettings,
        workspace: &mut Workspace,
        light: Light,
        distance: f32,
    ) -> Result<Cascades, FitError> {
        let mut cascades = Cascades { count: settings.count as usize, ..Cascades::default() };
        let (content, points) = Content::new(input, workspace)?;
        let range = whole_range(input, distance);
        let chooser =
            Chooser { content: &content, light, fit: settings.fit, settings, histogram: input.histogram, range };
        let cuts = self.choose_cuts(&chooser)?;
        let motion = self.last_view.and_then(|before| Motion::between(&before, &input.views[0]));
        let frame = hold::Frame { input, content: &content, light, motion, hold: settings.hold };
        for (i, map) in cascades.maps[..cascades.count].iter_mut().enumerate() {
            let fit_settings = map_settings(settings, i);
            let slice = slice_range(&cuts, i, settings, range);
            let volume = match settings.stabilise {
                Stabilise::Hysteresis if fit_settings.kind != FitKind::XnaSample => {
                    let held = frame.place(self.maps[i], &fit_settings, slice, points)?;
                    self.maps[i] = Some(held);
                    hold::volume(&held, input.views[0].origin)
                }
                stabilise => fit_anew(&content, &light, &fit_settings, stabilise, slice, points)?,
            };
            let far = if i + 1 == settings.count as usize { f32::MAX } else { cuts[i + 1] };
            *map = CascadeMap {
                fit: LightFit::from_volume(input.views[0].origin, &volume, &fit_settings)?,
                near: cuts[i],
                far,
                covered_near: slice.near,
            };
        }
        Ok(cascades)
    }

    /// This frame's cuts: held ones while they serve.
    fn choose_cuts(&mut self, chooser: &Chooser) -> Result<Cuts, FitError> {
        let is_held = chooser.settings.stabilise != Stabilise::Off;
        let spread = chooser.spread();
        if let Some(mut held) = self.cuts.filter(|_| is_held)
            && chooser.reaches(&held.cuts, spread)
        {
            let is_young = held.age + 1 < COMPARE_EVERY;
            if is_young || chooser.serves(&held.cuts, held.spread, spread) {
                held.age = if is_young { held.age + 1 } else { 0 };
                self.cuts = Some(held);
                return Ok(held.cuts);
            }
        }
        let cuts = chooser.choose(spread)?;
        self.cuts = Some(HeldCuts { cuts, spread, age: 0 });
        Ok(cuts)
    }
}

/// One map of this frame alone.
fn fit_anew(
    content: &Content,
    light: &Light,
    settings: &FitSettings,
    stabilise: Stabilise,
    slice: Range,
    points: &mut [DVec2],
) -> Result<Volume, FitError> {
    let is_snapped = stabilise == Stabilise::Snap && !matches!(settings.kind, FitKind::Sphere | FitKind::XnaSample);
    if !is_snapped {
        return fits::fit_slice(content, light, settings, slice, points);
    }
    // Margins and the kernel's texels are added once, by the grid.
    let mut volume = fits::fit_slice(content, light, &FitSettings { kernel_margin: 0.0, ..*settings }, slice, points)?;
    grid::snap(&mut volume, content.origin, settings);
    volume.light_at_near_plane();
    Ok(volume)
}

/// The settings of one of the maps.
fn map_settings(settings: &CascadeSettings, map: usize) -> FitSettings {
    let fit = settings.fit;
    settings.overrides[map].map_or(fit, |own| FitSettings { kind: own.kind, resolution: own.resolution, ..fit })
}

/// Everything that is shadowed.
fn whole_range(input: &FitInput, distance: f32) -> Range {
    let near = input.views.iter().map(|view| view.near).fold(f32::MAX, f32::min);
    let far = input.views.iter().map(|view| view.far).fold(f32::MIN, f32::max);
    Range { near, far: far.min(distance) }
}

/// The view depths that a map covers.
fn slice_range(cuts: &Cuts, map: usize, settings: &CascadeSettings, whole: Range) -> Range {
    let near = if map == 0 { whole.near } else { cuts[map] - settings.overlap * (cuts[map] - cuts[map - 1]) };
    Range { near, far: cuts[map + 1] }
}

/// Checks what is new beside a single fit's settings.
fn check(input: &FitInput, settings: &CascadeSettings) -> Result<(Light, f32), FitError> {
    let most = MAX_CASCADES as f64;
    checks::within("the number of cascades", f64::from(settings.count), 1.0, most)?;
    checks::within("the cascades' overlap", f64::from(settings.overlap), 0.0, 1.0)?;
    let hold = settings.hold;
    checks::within("the hold's margin", f64::from(hold.margin), 0.0, 10.0)?;
    checks::within("the hold's growth", f64::from(hold.growth), 1.0, 100.0)?;
    checks::within("the hold's waste", f64::from(hold.waste), 1.0, 100.0)?;
    let mut checked = fits::prepare(input, &settings.fit)?;
    for map in 0..settings.count as usize {
        checked = fits::prepare(input, &map_settings(settings, map))?;
    }
    Ok(checked)
}
