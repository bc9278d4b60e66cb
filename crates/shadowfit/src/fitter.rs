//! The fitter that needs no allocator. Its state is plain data, and the caller passes in the working memory.
//! [`FitState::fit_into`] is the pipeline from the input to the maps of a frame.

use glam::{DVec2, DVec3};

use crate::base::{FitError, checks};
use crate::bias::Bias;
use crate::cascades::{self, HeldCascades};
use crate::content::Content;
use crate::demand::histogram::DepthBounds;
use crate::fits::{self, FitRule, Frame, MapUse, PlacedMap, PlacedMaps, check_least_texel};
use crate::input::{FitInput, Scratch};
use crate::light::Light;
use crate::light::grid::GridPosition;
use crate::map::{FittedMap, FittedMaps, PlacementSource};
use crate::projection::LightProjection;
use crate::technique::settings::{BiasSettings, CasterPolicy, FitSettings};
use crate::technique::{Maps, Technique, Windows};
use crate::view::{Range, ViewFrustum};
use crate::windows::{self, HeldWindows};

/// Fitter that computes a technique's maps frame by frame, in memory that the caller owns.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FitState {
    last: Option<LastFrame>,
}

/// State of the last frame.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct LastFrame {
    /// Technique of the last frame. Another technique starts without state.
    technique: Technique,
    /// Unit direction of travel of the light that the maps were made for. Input that differs from it only by
    /// rounding changes nothing.
    direction: DVec3,
    view: ViewFrustum,
    held: Held,
}

/// State that a placement starts from in the next frame.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
enum Held {
    Cascades(HeldCascades),
    Windows(HeldWindows),
}

impl FitState {
    /// Creates a fitter without history.
    pub fn new() -> Self {
        Self::default()
    }

    /// Forgets all earlier frames. Call it after a camera cut or when a new level begins.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// Fits the maps of a frame. Returns no maps if every view begins beyond the [shadow
    /// distance](crate::settings::MapSettings::max_distance) or [is empty](ViewFrustum::is_empty). The frame
    /// then has no shadows, and the next frame with shadows continues from the state of earlier frames.
    ///
    /// # Errors
    ///
    /// As [`fit_scene`](crate::fit_scene) for the settings of each map. Also:
    ///
    /// - [`FitError::OutOfRange`] for a number of windows outside 1..=8 or of cascades outside 2..=8, for an
    ///   overlap or λ outside 0..=1, for a blend outside
    ///   0..=[`MapSelection::MAX_BLEND`](crate::settings::MapSelection::MAX_BLEND), and for settings of
    ///   stabilisation, softness, fade, depth steps or rays that are out of range
    /// - [`FitError::ClampedCasters`] for a filter that needs the distances of casters, if depth clamp loses
    ///   them
    /// - [`FitError::NotFinite`] for biases that are not finite, before or after they are scaled to a map's
    ///   texels
    /// - [`FitError::NearNotBelowFar`] for manual splits that do not ascend
    ///
    /// Manual splits outside the shadowed range are valid: a map without a range [is
    /// empty](LightProjection::is_empty). An error leaves the fitter unchanged.
    pub fn fit(
        &mut self,
        input: &FitInput,
        technique: &Technique,
        scratch: &mut Scratch,
    ) -> Result<FittedMaps, FitError> {
        let mut maps = FittedMaps::default();
        self.fit_into(input, technique, scratch, &mut maps)?;
        Ok(maps)
    }

    /// Does the same as [`Self::fit`], but writes into existing maps, such as the last frame's, to save
    /// copies.
    ///
    /// # Errors
    ///
    /// As [`Self::fit`]. Do not use the maps after an error.
    pub fn fit_into(
        &mut self,
        input: &FitInput,
        technique: &Technique,
        scratch: &mut Scratch,
        maps: &mut FittedMaps,
    ) -> Result<(), FitError> {
        // 1. The light, and the fit rule of the technique's maps.
        let (rule, light) = check(input, technique)?;
        if !fits::is_shadowed(input.views, technique.fit.max_distance) {
            self.pass_over(input, maps);
            return Ok(());
        }
        let last = self.last.as_ref().filter(|last| last.technique == *technique);
        let light = light.held(last.filter(|_| technique.maps.are_kept()).map(|last| last.direction));
        // 2. The boxes, and their parts in view.
        let (content, points) = Content::new(input.scene(), scratch.storage)?;
        let range = whole_range(input, technique.fit.max_distance);
        let last_view = last.map(|last| &last.view);
        let frame = Frame { input, technique, rule: &rule, light, content: &content, range, last_view };
        // 3. Placement of each map: its volume, from the near plane to the far plane.
        let (placed, held) = place(&frame, last.map(|last| &last.held), points)?;
        // 4. Matrices, biases and anchors.
        for (map, placed) in maps.take(technique.maps.count() as usize).iter_mut().zip(placed.iter().flatten()) {
            write(map, placed, &frame)?;
        }
        maps.placement = placement(&held, input, technique);
        // 5. State for the next frame.
        let (direction, view) = (light.direction(), input.views[0]);
        self.last = Some(LastFrame { technique: *technique, direction, view, held });
        Ok(())
    }

    /// Empties the maps of a frame without shadows, and keeps the state of earlier frames for later ones.
    fn pass_over(&mut self, input: &FitInput, maps: &mut FittedMaps) {
        *maps = FittedMaps::default();
        if let Some(last) = &mut self.last {
            last.view = input.views[0];
        }
    }
}

/// Places the maps of a frame as windows or as cascades.
fn place(frame: &Frame, before: Option<&Held>, points: &mut [DVec2]) -> Result<(PlacedMaps, Held), FitError> {
    let windows = before.and_then(|held| if let Held::Windows(held) = held { Some(held) } else { None });
    let cascades = before.and_then(|held| if let Held::Cascades(held) = held { Some(held) } else { None });
    match &frame.technique.maps {
        Maps::Windows(settings) => {
            windows::place(frame, settings, windows, points).map(|(maps, held)| (maps, Held::Windows(held)))
        }
        Maps::Cascades(settings) => {
            cascades::place(frame, settings, cascades, points).map(|(maps, held)| (maps, Held::Cascades(held)))
        }
        Maps::Single(one) => {
            cascades::place(frame, &one.slice(), cascades, points).map(|(maps, held)| (maps, Held::Cascades(held)))
        }
    }
}

/// Returns the source that the maps of a frame were placed by.
fn placement(held: &Held, input: &FitInput, technique: &Technique) -> PlacementSource {
    let is_told = match held {
        Held::Windows(windows) => !windows.is_guess(),
        Held::Cascades(_) => {
            technique.maps.uses_visible_demand() && input.histogram.is_some_and(|counted| !counted.is_empty())
        }
    };
    if is_told { PlacementSource::LastFrame } else { PlacementSource::Boxes }
}

/// Writes a map in place, since it is large.
fn write(map: &mut FittedMap, placed: &PlacedMap, frame: &Frame) -> Result<(), FitError> {
    let PlacedMap { volume, depths } = placed;
    map.projection =
        LightProjection::from_volume(frame.content.origin, volume, frame.rule.resolution, frame.rule.convention)?;
    map.bias = Bias::from_texels(&frame.technique.bias, frame.technique.format, &map.projection).checked()?;
    map.grid_position = volume.grid.as_ref().and_then(GridPosition::of);
    map.depths = *depths;
    Ok(())
}

/// Returns the smallest number of cascades that is enough: the smallest count, up to the technique's own,
/// whose 95% quantile of pixels per texel is at most `max_oversize` times the quantile with the technique's
/// own count. Splits are the best ones for each count. Other kinds of maps are treated as the nearest
/// [cascades](Maps::as_cascades).
///
/// Visible depths come from the histogram if the technique's splits use one, and are otherwise estimated from
/// the boxes. All other split schemes count as
/// [`SplitScheme::FromBoxes`](crate::settings::SplitScheme::FromBoxes) here. A call costs about as much as
/// choosing the splits of one frame. Call it when a level begins, or now and then, and pass the result to
/// [`Technique::with_count`].
///
/// ```
/// # use shadowfit::glam::{DVec2, DVec3, Vec3};
/// # use shadowfit::*;
/// use shadowfit::fewest_maps;
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
/// # let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
/// # let mut scratch = Scratch::new(&mut storage);
/// let technique = Technique::preset("calm-4").unwrap().with_count(8);
/// let count = fewest_maps(&input, &technique, 1.5, &mut scratch)?;
/// assert!(count < 8); // more maps would make texels less than 1.5 times as fine
/// let maps = FitState::new().fit(&input, &technique.with_count(count), &mut scratch)?;
/// assert_eq!(maps.len(), count as usize);
/// # Ok::<(), FitError>(())
/// ```
///
/// # Errors
///
/// As [`FitState::fit`], and [`FitError::OutOfRange`] for a `max_oversize` outside 1..=100.
pub fn fewest_maps(
    input: &FitInput,
    technique: &Technique,
    max_oversize: f32,
    scratch: &mut Scratch,
) -> Result<u32, FitError> {
    let max_oversize = checks::within("max_oversize of fewest_maps", f64::from(max_oversize), 1.0, 100.0)?;
    let (rule, light) = check(input, technique)?;
    if technique.maps.count() == 1 || !fits::is_shadowed(input.views, technique.fit.max_distance) {
        return Ok(1);
    }
    let (content, _) = Content::new(input.scene(), scratch.storage)?;
    let range = whole_range(input, technique.fit.max_distance);
    let frame = Frame { input, technique, rule: &rule, light, content: &content, range, last_view: None };
    Ok(cascades::fewest(&frame, &technique.maps.as_cascades(), max_oversize))
}

/// Returns the range of view depths that has shadows.
fn whole_range(input: &FitInput, distance: f32) -> Range {
    let views = || input.views.iter().filter(|view| view.begins_before(distance));
    let near = views().map(|view| view.near).fold(f32::MAX, f32::min);
    let far = views().map(|view| view.far).fold(f32::MIN, f32::max);
    Range { near, far: far.min(distance) }
}

/// Checks an input and a technique. Returns the fit rule of the maps, and the light.
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
    let shape = technique.maps.shape().unwrap_or(Windows::WHOLE);
    let settings = FitSettings { shape, map: technique.fit.with_least_texel(technique.least_texel()) };
    let map = MapUse { border: technique.border(), is_shared: technique.shares_maps() };
    fits::prepare(input, &settings, map)
}

/// Checks the numbers of a technique outside its fit settings, and combinations that do not work together.
fn check_numbers(technique: &Technique) -> Result<(), FitError> {
    technique.maps.check()?;
    technique.softness.checked()?;
    technique.edges.checked()?;
    // The least texel of the maps is the greater of two values, which would hide a bad one.
    check_least_texel(&technique.fit)?;
    checks::within("the shadows' fade", f64::from(technique.fade), 0.0, 1.0)?;
    let BiasSettings { constant, slope, normal_offset, receiver_plane, depth_steps } = technique.bias;
    for bias in [constant, slope, normal_offset, receiver_plane] {
        checks::finite("a bias", f64::from(bias))?;
    }
    checks::within("the bias in depth steps", f64::from(depth_steps), 0.0, f64::from(BiasSettings::MAX_DEPTH_STEPS))?;
    let clamps = technique.fit.casters == CasterPolicy::DepthClamp && !technique.maps.are_exact();
    if technique.edges.need_distances(technique.filter) && clamps {
        return Err(FitError::ClampedCasters);
    }
    Ok(())
}
