//! Several maps for one view, kept still from frame to frame.
//!
//! A [`MapFitter`] remembers what it fitted last, as plain data: the cuts between the maps and,
//! with [`Stabilise::Hysteresis`], the maps themselves. Everything else follows from the input.

mod hold;

use core::ops::Deref;

use glam::{DVec2, Vec3};

use crate::fits::{self, Content, Light, Placing, Range, Volume};
use crate::motion::Motion;
use crate::settings::{BiasSettings, FitKind, FitSettings, MAX_MAPS, MapOverride, Stabilise};
use crate::splits::{Chooser, Cuts};
use crate::{
    Bias, DepthBounds, FitError, FitInput, GridAnchor, LightFit, Technique, ViewFrustum, Workspace, checks, grid,
};
use hold::HeldMap;

/// One of several maps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FittedMap {
    /// The map's matrices and box.
    pub fit: LightFit,
    /// The technique's biases for this map's texels and depth range.
    pub bias: Bias,
    /// View depth from which points choose this map, in metres.
    pub near: f32,
    /// View depth up to which points choose this map, in metres: they take the first map that ends
    /// beyond them. The last one has no end. Where cuts coincide there is no range: such maps end at
    /// `f32::MIN` before all others, and begin at `f32::MAX` after them.
    pub far: f32,
    /// View depth from which this map covers what is seen, in metres: before `near` where the
    /// maps overlap.
    pub covered_near: f32,
    /// Where the map lies on the world's grid, if it does: what [`Scroll`](crate::Scroll) and
    /// [tiles](crate::scroll::tiles) are made from.
    pub anchor: Option<GridAnchor>,
}

/// The maps of one frame, nearest first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FittedMaps {
    maps: [FittedMap; MAX_MAPS],
    count: usize,
}

impl Deref for FittedMaps {
    type Target = [FittedMap];

    fn deref(&self) -> &[FittedMap] {
        // A number that was read from a file may be any.
        &self.maps[..self.count.min(MAX_MAPS)]
    }
}

/// Fits several maps frame by frame.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MapFitter {
    cuts: Option<HeldCuts>,
    maps: [Option<HeldMap>; MAX_MAPS],
    depths: [Option<HeldDepth>; MAX_MAPS],
    last_view: Option<ViewFrustum>,
    /// What the state was made with; any change begins anew.
    settings: Option<Technique>,
}

/// Cuts of an earlier frame.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct HeldCuts {
    cuts: Cuts,
    /// Depths over which they were spread, in metres.
    spread: (f64, f64),
    /// Frames since they were last compared with what would be best.
    age: u32,
}

/// Depth range of an earlier frame's map that is not held itself.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct HeldDepth {
    /// Direction toward the light.
    to_light: Vec3,
    /// Far and near plane along it from the world's origin, in metres.
    z: (f64, f64),
}

/// Frames between two comparisons of held cuts with what would be best, which costs most of a
/// frame's fit. Whether they reach as far as they must is looked at in each.
const COMPARE_EVERY: u32 = 8;

impl MapFitter {
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
    /// do not ascend. Manual cuts before or beyond what is shadowed are no error: a map without a
    /// range [is empty](LightFit::is_empty). An error leaves the fitter as it was.
    pub fn fit(
        &mut self,
        input: &FitInput,
        settings: &Technique,
        workspace: &mut Workspace,
    ) -> Result<FittedMaps, FitError> {
        let mut cascades = FittedMaps::default();
        self.fit_into(input, settings, workspace, &mut cascades)?;
        Ok(cascades)
    }

    /// [`Self::fit`] into maps that are at hand, such as the last frame's, which saves copies.
    ///
    /// # Errors
    ///
    /// As [`Self::fit`]. After an error the maps are of no use.
    pub fn fit_into(
        &mut self,
        input: &FitInput,
        technique: &Technique,
        workspace: &mut Workspace,
        cascades: &mut FittedMaps,
    ) -> Result<(), FitError> {
        let (light, distance) = check(input, technique)?;
        let settings = &technique.with_fit(technique.fit.with_border(technique.border()));
        let is_continued = self.settings.as_ref() == Some(settings);
        let before = if is_continued { Some(&*self) } else { None };
        let (content, points) = Content::new(input, workspace)?;
        let range = whole_range(input, distance);
        let chooser = Chooser { content: &content, light, settings, input, range };
        let cuts = choose_cuts(before.and_then(|before| before.cuts), &chooser)?;
        cascades.count = settings.count as usize;
        let mut held = None;
        let depths = before.map_or([None; MAX_MAPS], |before| before.depths);
        let mut places = Places { content: &content, settings, light, range, depths, points };
        if settings.stabilise == Stabilise::Hysteresis {
            held = Some(places.hold(input, before, &cuts.cuts, cascades)?);
        } else {
            places.fit(&cuts.cuts, cascades)?;
        }
        part_voids(&mut cascades.maps[..cascades.count]);
        (self.cuts, self.depths) = (Some(cuts), places.depths);
        self.last_view = Some(input.views[0]);
        if !is_continued {
            (self.settings, self.maps) = (Some(*settings), [None; MAX_MAPS]);
        }
        if let Some(held) = held {
            self.maps = held;
        }
        Ok(())
    }
}

/// The fewest maps that do: the least count, up to that of the settings, with which the best cuts leave
/// a 95% quantile of pixels per texel at most `waste` times that of the settings' count.
///
/// What is visible is told by the histogram where the settings' splits use one, else by the boxes;
/// other splits are taken for [`SplitScheme::FromBoxes`](crate::SplitScheme::FromBoxes) here. Costs
/// about as much as choosing the cuts of one frame: ask when a level begins, or now and then, and
/// set [`Technique::count`] by it.
///
/// # Errors
///
/// As [`MapFitter::fit`], and [`FitError::OutOfRange`] for a waste outside 1..=100.
pub fn fewest_maps(
    input: &FitInput,
    settings: &Technique,
    waste: f32,
    workspace: &mut Workspace,
) -> Result<u32, FitError> {
    let waste = checks::within("the waste of fewer maps", f64::from(waste), 1.0, 100.0)?;
    let (light, distance) = check(input, settings)?;
    let (content, _) = Content::new(input, workspace)?;
    let chooser = Chooser { content: &content, light, settings, input, range: whole_range(input, distance) };
    Ok(chooser.fewest(waste))
}

/// This frame's cuts: held ones while they serve.
fn choose_cuts(held: Option<HeldCuts>, chooser: &Chooser) -> Result<HeldCuts, FitError> {
    let is_held = chooser.settings.stabilise != Stabilise::Off;
    let spread = chooser.spread();
    if let Some(held) = held.filter(|_| is_held)
        && chooser.reaches(&held.cuts, spread)
    {
        let age = held.age.saturating_add(1);
        let is_young = age < COMPARE_EVERY;
        if is_young || chooser.serves(&held.cuts, held.spread, spread) {
            return Ok(HeldCuts { age: if is_young { age } else { 0 }, ..held });
        }
    }
    Ok(HeldCuts { cuts: chooser.choose(spread)?, spread: chooser.bounded(spread), age: 0 })
}

/// What all maps of a frame are fitted with.
struct Places<'a, 'b> {
    content: &'a Content<'b>,
    settings: &'a Technique,
    light: Light,
    range: Range,
    /// Depth ranges of the last frame, then of this one.
    depths: [Option<HeldDepth>; MAX_MAPS],
    points: &'a mut [DVec2],
}

impl Places<'_, '_> {
    /// All maps of this frame alone.
    fn fit(&mut self, cuts: &Cuts, cascades: &mut FittedMaps) -> Result<(), FitError> {
        // Each step of one map waits for the step before it; those of several maps side by side do not.
        let mut volumes = [None; MAX_MAPS];
        for (i, volume) in volumes.iter_mut().enumerate().take(cascades.count) {
            self.fit_anew(cuts, i, volume)?;
        }
        for (i, volume) in volumes.iter_mut().flatten().enumerate() {
            self.steady(i, volume);
            let own = own_settings(self.settings, i);
            self.write(&mut cascades.maps[i], volume, own.as_ref().unwrap_or(&self.settings.fit), cuts, i)?;
        }
        Ok(())
    }

    /// What one map holds in this frame alone, written where it stands, since it is large.
    fn fit_anew(&mut self, cuts: &Cuts, map: usize, volume: &mut Option<Volume>) -> Result<(), FitError> {
        let placing = if self.settings.stabilise == Stabilise::Snap { Placing::OnGrid } else { Placing::Tight };
        let own = own_settings(self.settings, map);
        let settings = own.as_ref().unwrap_or(&self.settings.fit);
        let own_light = self.own_light(settings);
        let light = own_light.as_ref().unwrap_or(&self.light);
        let slice = self.slice(cuts, map);
        *volume = Some(fits::fit_slice(self.content, light, settings, slice, placing, self.points)?);
        Ok(())
    }

    /// Keeps a map's depth range from the last frame while it serves.
    #[inline(always)]
    fn steady(&mut self, map: usize, volume: &mut Volume) {
        let to_light = volume.axes.z;
        let held = self.depths[map].filter(|held| held.to_light == to_light).map(|held| held.z);
        grid::steady(volume, self.content.origin, held, f64::from(self.settings.hold.waste));
        self.depths[map] = volume.grid.map(|grid| HeldDepth { to_light, z: grid.z });
    }

    /// All maps, held ones while they serve.
    fn hold(
        &mut self,
        input: &FitInput,
        before: Option<&MapFitter>,
        cuts: &Cuts,
        cascades: &mut FittedMaps,
    ) -> Result<[Option<HeldMap>; MAX_MAPS], FitError> {
        let last_view = before.and_then(|before| before.last_view);
        let motion = last_view.and_then(|last| Motion::between(&last, &input.views[0]));
        let frame = hold::Frame { input, content: self.content, light: self.light, motion, hold: self.settings.hold };
        let mut maps = [None; MAX_MAPS];
        for (i, map) in maps.iter_mut().enumerate().take(cascades.count) {
            let slice = self.slice(cuts, i);
            let own = own_settings(self.settings, i);
            let settings = own.as_ref().unwrap_or(&self.settings.fit);
            let volume = if settings.kind == FitKind::XnaSample {
                let light = self.own_light(settings).unwrap_or(self.light);
                fits::fit_slice(self.content, &light, settings, slice, Placing::Tight, self.points)?
            } else {
                let held = frame.place(before.and_then(|before| before.maps[i]), settings, slice, self.points)?;
                *map = Some(held);
                hold::volume(&held, self.content.origin)
            };
            self.write(&mut cascades.maps[i], &volume, settings, cuts, i)?;
        }
        Ok(maps)
    }

    /// The light for a map of another kind than most.
    #[inline]
    fn own_light(&self, settings: &FitSettings) -> Option<Light> {
        (settings.kind != self.settings.fit.kind).then(|| self.light.of_kind(settings.kind))
    }

    /// The view depths that a map covers; those of all maps where it has none.
    fn slice(&self, cuts: &Cuts, map: usize) -> Range {
        let slice = slice_range(cuts, map, self.settings, self.range);
        if is_void(self.content.views, slice) { self.range } else { widened(slice) }
    }

    /// Writes a map where it stands, since it is large.
    fn write(
        &self,
        map: &mut FittedMap,
        volume: &Volume,
        settings: &FitSettings,
        cuts: &Cuts,
        i: usize,
    ) -> Result<(), FitError> {
        let slice = slice_range(cuts, i, self.settings, self.range);
        let is_void = is_void(self.content.views, slice);
        map.fit = LightFit::from_volume(self.content.origin, volume, settings)?;
        map.bias = Bias::from_texels(&self.settings.bias, &map.fit);
        map.fit.is_empty |= is_void;
        map.anchor = volume.grid.as_ref().and_then(GridAnchor::of);
        (map.near, map.far) = (cuts[i], cuts[i + 1]);
        map.covered_near = if is_void { cuts[i] } else { slice.near };
        Ok(())
    }
}

/// Whether no view has a part between two view depths, so that a map would have nothing to hold.
fn is_void(views: &[ViewFrustum], slice: Range) -> bool {
    views.iter().all(|view| slice.near.max(view.near) >= slice.far.min(view.far))
}

/// Keeps maps without a range from being chosen, by rounded depths too: those before all others end
/// nowhere, those after them begin nowhere, and the last one with a range has no end.
fn part_voids(maps: &mut [FittedMap]) {
    for map in maps.iter_mut().take_while(|map| map.near >= map.far) {
        map.far = f32::MIN;
    }
    for map in maps.iter_mut().rev() {
        if map.near < map.far {
            map.far = f32::MAX;
            break;
        }
        (map.near, map.covered_near) = (f32::MAX, f32::MAX);
    }
}

/// The settings of a map that differs from the others.
fn own_settings(settings: &Technique, map: usize) -> Option<FitSettings> {
    let own = settings.overrides[map];
    let fit = settings.fit;
    (own != MapOverride::default()).then(|| FitSettings {
        kind: own.kind.unwrap_or(fit.kind),
        resolution: own.resolution.unwrap_or(fit.resolution),
        ..fit
    })
}

/// Everything that is shadowed.
fn whole_range(input: &FitInput, distance: f32) -> Range {
    let near = input.views.iter().map(|view| view.near).fold(f32::MAX, f32::min);
    let far = input.views.iter().map(|view| view.far).fold(f32::MIN, f32::max);
    Range { near, far: far.min(distance) }
}

/// The view depths that a map covers.
fn slice_range(cuts: &Cuts, map: usize, settings: &Technique, whole: Range) -> Range {
    let near = if map == 0 { whole.near } else { cuts[map] - settings.overlap * (cuts[map] - cuts[map - 1]) };
    Range { near, far: cuts[map + 1] }
}

/// The view depths that a map is fitted to: a shader's rounded view depth may put a point into the
/// map beside the one that it belongs to.
fn widened(slice: Range) -> Range {
    let rounding = slice.far.abs() * DEPTH_ROUNDING;
    Range { near: slice.near - rounding, far: slice.far + rounding }
}

/// Rounding of a view depth, as a share of it: nine times 2⁻²⁴ of a point's distance, which in the
/// corner of a wide view is up to seven times its depth.
const DEPTH_ROUNDING: f32 = 64.0 / 16_777_216.0;

/// Checks what is new beside a single fit's settings.
fn check(input: &FitInput, settings: &Technique) -> Result<(Light, f32), FitError> {
    let most = MAX_MAPS as f64;
    checks::within("the number of cascades", f64::from(settings.count), 1.0, most)?;
    checks::within("the cascades' overlap", f64::from(settings.overlap), 0.0, 1.0)?;
    let hold = settings.hold;
    checks::within("the hold's margin", f64::from(hold.margin), 0.0, 10.0)?;
    checks::within("the hold's growth", f64::from(hold.growth), 1.0, 100.0)?;
    checks::within("the hold's waste", f64::from(hold.waste), 1.0, 100.0)?;
    if let Some(DepthBounds { near, far }) = input.depth_bounds {
        for bound in [near, far] {
            checks::finite("a depth bound", f64::from(bound))?;
        }
        if near > far {
            return Err(FitError::NearNotBelowFar { near, far });
        }
    }
    let BiasSettings { constant, slope, normal_offset, receiver_plane } = settings.bias;
    for bias in [constant, slope, normal_offset, receiver_plane] {
        checks::finite("a bias", f64::from(bias))?;
    }
    let prepared = fits::prepare(input, &settings.fit.with_border(settings.border()))?;
    for own in (0..settings.count as usize).filter_map(|map| own_settings(settings, map)) {
        fits::check(&own)?;
    }
    Ok(prepared)
}
