//! Several maps for one view, kept stable from frame to frame.
//!
//! A [`MapFitter`] remembers what it fitted last, as plain data: the splits between the maps and,
//! with [`Stabilise::Hysteresis`], the maps themselves. Everything else follows from the input.

use glam::{DVec2, DVec3, Vec3};

use crate::base::{FitError, checks};
use crate::bias::Bias;
use crate::content::Content;
use crate::demand::histogram::DepthBounds;
use crate::fits::{FitInput, FitRule, LightFit, Placement, Volume, Workspace, check_least_texel};
use crate::light::grid::GridAnchor;
use crate::light::{Light, grid};
use crate::map::{FittedMap, FittedMaps, set_empty_ranges_apart};
use crate::slices::hold::HeldMap;
use crate::slices::motion::Motion;
use crate::slices::{Chooser, Splits, hold};
use crate::technique::Technique;
use crate::technique::settings::{
    BiasSettings, CasterPolicy, FilterKind, FitKind, FitSettings, MAX_BLEND, MAX_DEPTH_STEPS, MAX_MAPS, Stabilise,
};
use crate::view::{Range, ViewFrustum};
use crate::windows::HeldWindows;
use crate::{fits, windows};

/// Fits several maps frame by frame.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MapFitter {
    splits: Option<HeldSplits>,
    maps: [Option<HeldMap>; MAX_MAPS],
    depths: [Option<HeldDepth>; MAX_MAPS],
    windows: Option<HeldWindows>,
    last_view: Option<ViewFrustum>,
    /// The light's unit direction of travel that the maps were made for: input that differs from it by
    /// rounding alone changes nothing.
    direction: Option<DVec3>,
    /// The technique that the state was computed with; any change resets it.
    technique: Option<Technique>,
}

/// Splits of an earlier frame.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct HeldSplits {
    splits: Splits,
    /// View depths over which they were distributed, in metres.
    spread: (f64, f64),
    /// View depth at which shadows ended when they were chosen, in metres.
    far: f32,
    /// Frames since they were last compared with the best splits.
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

/// Frames between two comparisons of held splits with the best ones, which take most of the time of
/// a fit. Whether they reach as far as they must is checked in each frame.
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
    /// As [`fit_scene`](crate::fits::fit_scene), for the settings of each map;
    /// [`FitError::OutOfRange`] for a number of maps outside 1..=8, an overlap or λ outside 0..=1,
    /// a blend outside 0..=[`MAX_BLEND`], and hold settings, softness, fade or depth steps that are out of range;
    /// [`FitError::ClampedCasters`] for a filter that depth clamp leaves without the distances that it needs;
    /// [`FitError::NearNotBelowFar`] for manual splits that do not ascend. Manual splits before or beyond what is shadowed are not an error: a map
    /// without a range [is empty](LightFit::is_empty). An error leaves the fitter as it was.
    pub fn fit(
        &mut self,
        input: &FitInput,
        technique: &Technique,
        workspace: &mut Workspace,
    ) -> Result<FittedMaps, FitError> {
        let mut maps = FittedMaps::default();
        self.fit_into(input, technique, workspace, &mut maps)?;
        Ok(maps)
    }

    /// [`Self::fit`] into existing maps, such as the last frame's, which saves copies.
    ///
    /// # Errors
    ///
    /// As [`Self::fit`]. After an error the maps must not be used.
    pub fn fit_into(
        &mut self,
        input: &FitInput,
        technique: &Technique,
        workspace: &mut Workspace,
        maps: &mut FittedMaps,
    ) -> Result<(), FitError> {
        // 1. The rule of the maps' fit, and the light.
        let (rule, light) = check(input, technique)?;
        let is_continued = self.technique.as_ref() == Some(technique);
        let before = if is_continued { Some(&*self) } else { None };
        let is_held = technique.stabilise != Stabilise::Off || technique.has_windows();
        let held_light = before.filter(|_| is_held).and_then(|before| before.direction);
        let light = light.held(held_light);
        // 2. What is seen, and where one map ends and the next begins.
        let (content, points) = Content::new(input, workspace)?;
        let range = whole_range(input, technique.fit.max_distance);
        if technique.has_windows() {
            let before = before.and_then(|before| before.windows.as_ref());
            let frame = windows::Frame { input, technique, content: &content, light, range };
            let (volumes, held) = frame.fit(&rule, before, points)?;
            let maps = maps.take(technique.count as usize);
            for (i, (map, volume)) in maps.iter_mut().zip(volumes.iter().flatten()).enumerate() {
                map.fit = LightFit::from_volume(content.origin, volume, rule.resolution, rule.convention)?;
                map.bias = Bias::from_texels(&technique.bias, technique.format, &map.fit);
                map.anchor = volume.grid.as_ref().and_then(GridAnchor::of);
                // Only the last one holds all that is seen between any depths.
                let covered_near = if i + 1 < technique.count as usize { range.far } else { range.near };
                (map.near, map.far, map.covered_near) = (range.near, range.far, covered_near);
            }
            *self = Self {
                windows: Some(held),
                last_view: Some(input.views[0]),
                direction: Some(light.direction()),
                technique: Some(*technique),
                ..Self::default()
            };
            return Ok(());
        }
        let chooser = Chooser { content: &content, light, rule: &rule, technique, input, range };
        let splits = choose_splits(before.and_then(|before| before.splits), &chooser)?;
        // 3. The maps: new ones, or those of the frame before while they serve.
        let maps = maps.take(technique.count as usize);
        let depths = before.map_or([None; MAX_MAPS], |before| before.depths);
        let mut frame =
            Frame { content: &content, technique, rule: &rule, light, range, splits: splits.splits, depths, points };
        let mut held = None;
        if technique.stabilise == Stabilise::Hysteresis {
            held = Some(frame.hold(input, before, maps)?);
        } else {
            frame.fit(maps)?;
        }
        set_empty_ranges_apart(maps);
        // 4. What the next frame begins with.
        (self.splits, self.depths) = (Some(splits), frame.depths);
        (self.last_view, self.direction) = (Some(input.views[0]), Some(light.direction()));
        if !is_continued {
            (self.technique, self.maps) = (Some(*technique), [None; MAX_MAPS]);
        }
        if let Some(held) = held {
            self.maps = held;
        }
        Ok(())
    }
}

/// The fewest slices of the view that are enough: the least count, up to that of the technique, for
/// which the 95% quantile of pixels per texel with the best splits is at most `waste` times that with
/// the technique's count. Of [windows](crate::settings::FitKind::Windows), which are no slices, it says
/// nothing.
///
/// What is visible is taken from the histogram where the technique's splits use one, else estimated from the
/// boxes; other split schemes count as [`SplitScheme::FromBoxes`](crate::settings::SplitScheme::FromBoxes)
/// here. Costs about as much as choosing the splits of one frame: ask when a level begins, or now and then,
/// and set [`Technique::count`] by it.
///
/// ```
/// # use shadowfit::glam::{DVec2, DVec3, Vec3};
/// # use shadowfit::*;
/// use shadowfit::map_fitter::fewest_maps;
/// # let camera = PerspectiveCamera {
/// #     eye: DVec3::new(0.0, 1.7, 5.0),
/// #     forward: Vec3::NEG_Z,
/// #     up: Vec3::Y,
/// #     fov_y: 0.8,
/// #     aspect: 16.0 / 9.0,
/// #     near: 0.1,
/// #     far: 200.0,
/// # };
/// # let views = [camera.frustum()?];
/// # let input = FitInput::new(&views, Vec3::new(0.3, -0.8, 0.2));
/// # let mut storage = [DVec2::ZERO; Workspace::required(0, 1)];
/// # let mut workspace = Workspace::new(&mut storage);
/// let technique = Technique::preset("calm-4").unwrap().with_count(8);
/// let count = fewest_maps(&input, &technique, 1.5, &mut workspace)?;
/// assert!(count < 8); // the last ones would make texels less than 1.5 times as fine
/// let maps = MapFitter::new().fit(&input, &technique.with_count(count), &mut workspace)?;
/// assert_eq!(maps.len(), count as usize);
/// # Ok::<(), FitError>(())
/// ```
///
/// # Errors
///
/// As [`MapFitter::fit`], and [`FitError::OutOfRange`] for a waste outside 1..=100.
pub fn fewest_maps(
    input: &FitInput,
    technique: &Technique,
    waste: f32,
    workspace: &mut Workspace,
) -> Result<u32, FitError> {
    let waste = checks::within("the waste of fewer maps", f64::from(waste), 1.0, 100.0)?;
    let (rule, light) = check(input, technique)?;
    let (content, _) = Content::new(input, workspace)?;
    let range = whole_range(input, technique.fit.max_distance);
    Ok(Chooser { content: &content, light, rule: &rule, technique, input, range }.fewest(waste))
}

/// This frame's splits: held ones while they serve.
fn choose_splits(held: Option<HeldSplits>, chooser: &Chooser) -> Result<HeldSplits, FitError> {
    let is_held = chooser.technique.stabilise != Stabilise::Off;
    let spread = chooser.spread();
    if let Some(held) = held.filter(|_| is_held)
        && let Some(splits) = chooser.kept(&held.splits, held.far, spread)
    {
        let age = held.age.saturating_add(1);
        let is_young = age < COMPARE_EVERY;
        if is_young || chooser.serves(&splits, held.spread, spread) {
            return Ok(HeldSplits { splits, age: if is_young { age } else { 0 }, ..held });
        }
    }
    Ok(HeldSplits { splits: chooser.choose(spread)?, spread: chooser.bounded(spread), far: chooser.range.far, age: 0 })
}

/// What all maps of a frame are fitted with.
struct Frame<'a, 'b> {
    content: &'a Content<'b>,
    technique: &'a Technique,
    rule: &'a FitRule,
    light: Light,
    /// Everything that is shadowed.
    range: Range,
    splits: Splits,
    /// Depth ranges of the last frame, then of this one.
    depths: [Option<HeldDepth>; MAX_MAPS],
    points: &'a mut [DVec2],
}

impl Frame<'_, '_> {
    /// All maps of this frame alone.
    fn fit(&mut self, maps: &mut [FittedMap]) -> Result<(), FitError> {
        // Each step of one map depends on the step before it; interleaving several maps hides that
        // latency.
        let mut volumes = [None; MAX_MAPS];
        for (i, volume) in volumes.iter_mut().enumerate().take(maps.len()) {
            self.fit_anew(i, volume)?;
        }
        for (i, volume) in volumes.iter_mut().flatten().enumerate() {
            self.stabilise_depth(i, volume);
            self.write(&mut maps[i], volume, i)?;
        }
        Ok(())
    }

    /// What one map covers in this frame alone, written in place, since it is large.
    fn fit_anew(&mut self, map: usize, volume: &mut Option<Volume>) -> Result<(), FitError> {
        let is_snapped = self.technique.stabilise == Stabilise::Snap;
        let placement = if is_snapped { Placement::OnGrid } else { Placement::Tight };
        let slice = self.slice(map);
        *volume = Some(fits::fit_map(self.content, &self.light, self.rule, slice, placement, self.points)?);
        Ok(())
    }

    /// Keeps a map's depth range from the last frame while it serves.
    #[inline(always)]
    fn stabilise_depth(&mut self, map: usize, volume: &mut Volume) {
        let to_light = volume.axes.z;
        let held = self.depths[map].filter(|held| held.to_light == to_light).map(|held| held.z);
        grid::stabilise_depth(volume, self.content.origin, held, f64::from(self.technique.hold.waste));
        self.depths[map] = volume.grid.map(|grid| HeldDepth { to_light, z: grid.z });
    }

    /// All maps, held ones while they serve.
    fn hold(
        &mut self,
        input: &FitInput,
        before: Option<&MapFitter>,
        maps: &mut [FittedMap],
    ) -> Result<[Option<HeldMap>; MAX_MAPS], FitError> {
        let last_view = before.and_then(|before| before.last_view);
        let motion = last_view.and_then(|last| Motion::between(&last, &input.views[0]));
        let holder =
            hold::Holder { input, content: self.content, light: self.light, motion, hold: self.technique.hold };
        let mut held = [None; MAX_MAPS];
        for (i, map) in maps.iter_mut().enumerate() {
            let (rule, slice) = (self.rule, self.slice(i));
            let volume = if rule.can_be_held() {
                let last = before.and_then(|before| before.maps[i]);
                let now = holder.hold(last, rule, slice, self.points)?;
                held[i] = Some(now);
                hold::volume(&now, self.content.origin)
            } else {
                fits::fit_map(self.content, &self.light, rule, slice, Placement::Tight, self.points)?
            };
            self.write(map, &volume, i)?;
        }
        Ok(held)
    }

    /// The view depths that a map covers; those of all maps where it has none.
    fn slice(&self, map: usize) -> Range {
        let slice = self.slice_range(map);
        if is_empty(self.content.views, slice) { self.range } else { widened(slice) }
    }

    /// The view depths that a map covers.
    fn slice_range(&self, map: usize) -> Range {
        let (splits, overlap) = (&self.splits, self.technique.overlap);
        let near = if map == 0 { self.range.near } else { splits[map] - overlap * (splits[map] - splits[map - 1]) };
        Range { near, far: splits[map + 1] }
    }

    /// Writes a map in place, since it is large.
    fn write(&self, map: &mut FittedMap, volume: &Volume, i: usize) -> Result<(), FitError> {
        let (rule, slice) = (self.rule, self.slice_range(i));
        let is_empty = is_empty(self.content.views, slice);
        map.fit = LightFit::from_volume(self.content.origin, volume, rule.resolution, rule.convention)?;
        map.bias = Bias::from_texels(&self.technique.bias, self.technique.format, &map.fit);
        map.fit.is_empty |= is_empty;
        map.anchor = volume.grid.as_ref().and_then(GridAnchor::of);
        (map.near, map.far) = (self.splits[i], self.splits[i + 1]);
        map.covered_near = if is_empty { self.splits[i] } else { slice.near };
        Ok(())
    }
}

/// Whether no view has a part between two view depths, so that a map would have nothing to hold.
fn is_empty(views: &[ViewFrustum], slice: Range) -> bool {
    views.iter().all(|view| slice.near.max(view.near) >= slice.far.min(view.far))
}

/// Everything that is shadowed.
fn whole_range(input: &FitInput, distance: f32) -> Range {
    let near = input.views.iter().map(|view| view.near).fold(f32::MAX, f32::min);
    let far = input.views.iter().map(|view| view.far).fold(f32::MIN, f32::max);
    Range { near, far: far.min(distance) }
}

/// The view depths that a map is fitted to, widened: by a shader's rounded view depth a point may
/// read the map next to its own.
fn widened(slice: Range) -> Range {
    let rounding = slice.far.abs() * DEPTH_ROUNDING;
    Range { near: slice.near - rounding, far: slice.far + rounding }
}

/// Rounding of a view depth, as a share of it: nine times 2⁻²⁴ of a point's distance, which in the
/// corner of a wide view is up to seven times its depth.
const DEPTH_ROUNDING: f32 = 64.0 / 16_777_216.0;

/// Checks an input and a technique; gives the rule of its maps, and the light.
fn check(input: &FitInput, technique: &Technique) -> Result<(FitRule, Light), FitError> {
    check_numbers(technique)?;
    if let Some(DepthBounds { near, far }) = input.depth_bounds {
        for bound in [near, far] {
            checks::finite("a depth bound", f64::from(bound))?;
        }
        if near > far {
            return Err(FitError::NearNotBelowFar { near, far });
        }
    }
    let settings = FitSettings { least_texel: technique.least_texel(), ..technique.fit };
    let (mut rule, light) = fits::prepare(input, &settings, technique.border())?;
    rule.serves_all = technique.shares_maps() && rule.can_be_held();
    Ok((rule, light))
}

/// Checks the numbers of a technique that are not those of its fit, and what does not go together.
fn check_numbers(technique: &Technique) -> Result<(), FitError> {
    let most = MAX_MAPS as f64;
    checks::within("the number of maps", f64::from(technique.count), 1.0, most)?;
    checks::within("the maps' overlap", f64::from(technique.overlap), 0.0, 1.0)?;
    checks::within("the maps' blend", f64::from(technique.blend), 0.0, f64::from(MAX_BLEND))?;
    let hold = technique.hold;
    checks::within("the hold's margin", f64::from(hold.margin), 0.0, 10.0)?;
    checks::within("the hold's growth", f64::from(hold.growth), 1.0, 100.0)?;
    checks::within("the hold's waste", f64::from(hold.waste), 1.0, 100.0)?;
    technique.softness.checked()?;
    // The least texel of the maps is the greater of two, which would hide a bad one.
    check_least_texel(&technique.fit)?;
    checks::within("the shadows' fade", f64::from(technique.fade), 0.0, 1.0)?;
    let BiasSettings { constant, slope, normal_offset, receiver_plane, depth_steps } = technique.bias;
    for bias in [constant, slope, normal_offset, receiver_plane] {
        checks::finite("a bias", f64::from(bias))?;
    }
    checks::within("the bias in depth steps", f64::from(depth_steps), 0.0, f64::from(MAX_DEPTH_STEPS))?;
    // The XNA sample's fit has no caster policy.
    let clamps = technique.fit.casters == CasterPolicy::DepthClamp && technique.fit.kind != FitKind::XnaSample;
    if technique.filter == FilterKind::Pcss && clamps {
        return Err(FitError::ClampedCasters { filter: technique.filter });
    }
    Ok(())
}
