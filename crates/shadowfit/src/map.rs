//! The maps of one frame.

use core::ops::Deref;

use glam::DVec3;

use crate::base::FitError;
use crate::bias::Bias;
use crate::culling::{CasterVolume, Sweep};
use crate::fits::{FitRule, LightFit};
use crate::light::grid::GridAnchor;
use crate::selection::{DepthRange, MapOrder, MapRead, by_coverage, by_view_depth};
use crate::technique::Technique;
use crate::technique::settings::{MAX_MAPS, MapChoice};
use crate::view::ViewFrustum;

/// One of several maps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FittedMap {
    /// The map's matrices and box.
    pub fit: LightFit,
    /// The technique's biases for this map's texels and depth range.
    pub bias: Bias,
    /// View depth from which points choose this map, in metres, where maps are [read by view
    /// depth](crate::settings::MapChoice::ViewDepth). By coverage it says for which part of the view the
    /// map was made: of [windows](crate::settings::FitKind::Windows) for all of it.
    pub near: f32,
    /// View depth up to which points choose this map by view depth, in metres: they take the first map that
    /// ends beyond them. Of slices the last one has no end. Where splits coincide there is no range: such maps end
    /// at `f32::MIN` before all others, and begin at `f32::MAX` after them.
    pub far: f32,
    /// View depth from which this map covers what is seen, in metres: before `near` where the
    /// maps overlap. The end of its range for a [window](crate::settings::FitKind::Windows) that is not the
    /// last one, since it need not hold all of any depth.
    pub covered_near: f32,
    /// Where the map lies on the world's grid, if it does: what [`Scroll`](crate::scroll::Scroll) and
    /// [tiles](crate::scroll::tiles) are made from.
    pub anchor: Option<GridAnchor>,
}

impl FittedMap {
    /// Every caster that can cast a shadow through this map on what views see of it, relative to the
    /// fit's origin: the [swept volume](CasterVolume::swept) of the map's depths, for the technique's
    /// filter, as wide as it is in this map, and this map's bias. A map that no point reads has the empty volume.
    ///
    /// It is for maps that are drawn anew in each frame. A map that is kept, or
    /// [scrolled](crate::scroll::Scroll), shows casters to later frames too: cull those by
    /// [`CasterVolume::of_map`].
    ///
    /// By coverage a map serves whatever it holds of the views, at any depth, so each is swept over the whole
    /// of the views; one that [is empty](LightFit::is_empty) is not read and needs no caster. By view depth a
    /// point that its own map does not hold may be read from a later one. Fits hold their slices,
    /// filter included, so that a map's casters are those of its own depths; where the technique's do
    /// not ([`FitKind::XnaSample`](crate::settings::FitKind::XnaSample), or a border below the filter's reach), each map is swept from the
    /// views' near end.
    ///
    /// ```
    /// # use shadowfit::glam::{DVec2, DVec3, Vec3};
    /// # use shadowfit::culling::cull;
    /// # use shadowfit::settings::MAX_MAPS;
    /// # use shadowfit::*;
    /// # let camera = PerspectiveCamera {
    /// #     eye: DVec3::new(0.0, 1.7, 5.0),
    /// #     forward: Vec3::NEG_Z,
    /// #     up: Vec3::Y,
    /// #     fov_y: 0.8,
    /// #     aspect: 16.0 / 9.0,
    /// #     near: 0.1,
    /// #     far: 200.0,
    /// # };
    /// # let mut storage = [DVec2::ZERO; Workspace::required(0, 1)];
    /// # let workspace = &mut Workspace::new(&mut storage);
    /// let (views, technique) = ([camera.frustum()?], Technique::default());
    /// let input = FitInput::new(&views, Vec3::new(0.3, -0.8, 0.2));
    /// let maps = MapFitter::new().fit(&input, &technique, workspace)?;
    /// let mut volumes = [CasterVolume::nowhere(views[0].origin); MAX_MAPS];
    /// for (volume, map) in volumes.iter_mut().zip(maps.iter()) {
    ///     *volume = map.caster_volume(&views, &technique)?;
    /// }
    ///
    /// let boxes = [Aabb::new(Vec3::new(-2.0, 0.0, -12.0), Vec3::new(2.0, 6.0, -8.0))];
    /// let mut masks = [0; 1]; // bit i: draw into map i
    /// cull(&volumes[..maps.len()], DVec3::ZERO, &boxes, &mut masks);
    /// # assert_ne!(masks[0], 0);
    /// # Ok::<(), FitError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`CasterVolume::swept`].
    pub fn caster_volume(&self, views: &[ViewFrustum], technique: &Technique) -> Result<CasterVolume, FitError> {
        let (is_read, near, far) = match technique.map_choice() {
            MapChoice::Coverage => (!self.fit.is_empty, f32::MIN, f32::MAX),
            MapChoice::ViewDepth if holds_slices(technique) => {
                (self.covered_near < self.far, self.covered_near, self.far)
            }
            MapChoice::ViewDepth => (self.covered_near < self.far, f32::MIN, self.far),
        };
        if !is_read {
            return Ok(CasterVolume::nowhere(self.fit.origin));
        }
        let reach = technique.reach_in(&self.fit);
        let sweep = Sweep { near, far, reach, normal_offset: self.bias.normal_offset, ..Sweep::new(views) };
        CasterVolume::swept(&self.fit, &sweep)
    }
}

impl FittedMap {
    /// Where points read the map by view depth.
    pub fn depth_range(&self) -> DepthRange {
        // A map without a range behind all others is read where those in front leave points out.
        let far = if self.near == f32::MAX { f32::MAX } else { self.far };
        DepthRange { blend_near: f64::from(self.covered_near), far: f64::from(far) }
    }
}

/// Whether each map of a technique covers all of its slice with what the filter reads around it.
fn holds_slices(technique: &Technique) -> bool {
    let needed = f64::from(technique.reach() + technique.bias.normal_offset);
    let rule = FitRule::new(&technique.fit, technique.border(), true);
    rule.is_ok_and(|rule| rule.leaves_border(needed))
}

/// The maps of one frame, nearest first, windows finest first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FittedMaps {
    maps: [FittedMap; MAX_MAPS],
    count: usize,
}

impl FittedMaps {
    /// The maps of a number of ranges, to be written.
    pub(crate) fn take(&mut self, count: usize) -> &mut [FittedMap] {
        self.count = count;
        &mut self.maps[..count]
    }
}

impl FittedMaps {
    /// Which maps a point reads, as the shaders of `shadowfit-wgpu` do; `None` where it is lit because
    /// no map holds it. `point` is a world position, `view_depth` its distance from the eye along the
    /// view's forward direction, both in metres; the latter counts only by view depth. A point that is
    /// not finite is held by no map.
    ///
    /// ```
    /// # use shadowfit::glam::{DVec2, DVec3, Vec3};
    /// # use shadowfit::*;
    /// # let camera = PerspectiveCamera {
    /// #     eye: DVec3::new(0.0, 1.7, 5.0),
    /// #     forward: Vec3::NEG_Z,
    /// #     up: Vec3::Y,
    /// #     fov_y: 0.8,
    /// #     aspect: 16.0 / 9.0,
    /// #     near: 0.1,
    /// #     far: 200.0,
    /// # };
    /// # let mut storage = [DVec2::ZERO; Workspace::required(0, 1)];
    /// # let workspace = &mut Workspace::new(&mut storage);
    /// let (views, technique) = ([camera.frustum()?], Technique::default());
    /// let maps = MapFitter::new().fit(&FitInput::new(&views, Vec3::new(0.3, -0.8, 0.2)), &technique, workspace)?;
    /// let read = maps.read(&technique, DVec3::new(0.0, 1.0, -20.0), 25.0).expect("it is in view");
    /// println!("map {}, blended into {:?}", read.map, read.blend);
    /// # assert!(maps[read.main()].fit.covers(DVec3::new(0.0, 1.0, -20.0)));
    /// # Ok::<(), FitError>(())
    /// ```
    pub fn read(&self, technique: &Technique, point: DVec3, view_depth: f64) -> Option<MapRead> {
        match technique.map_choice() {
            MapChoice::Coverage => {
                let order = MapOrder::new(MapChoice::Coverage, self.iter().map(|map| &map.fit));
                let (reach, blend) = (f64::from(technique.reach()), f64::from(technique.blend));
                by_coverage(order.iter(), reach, blend, |map| self[map].fit.free_texels(point))
            }
            MapChoice::ViewDepth => {
                by_view_depth(self.iter().map(FittedMap::depth_range), view_depth, |map| self[map].fit.covers(point))
            }
        }
    }
}

impl Deref for FittedMaps {
    type Target = [FittedMap];

    fn deref(&self) -> &[FittedMap] {
        // A count that was read from a file may have any value.
        &self.maps[..self.count.min(MAX_MAPS)]
    }
}
