//! The maps of one frame.

use core::ops::Deref;

use glam::{DVec3, UVec2};

use crate::bias::{Bias, rounding};
use crate::light::grid::GridAnchor;
use crate::projection::LightProjection;
use crate::selection::{DepthRange, MapOrder, MapRead, by_coverage, by_view_depth};
use crate::technique::Technique;
use crate::technique::settings::{MAX_MAPS, MapSelection};

/// One of several maps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FittedMap {
    /// The map's matrices and box.
    pub projection: LightProjection,
    /// The technique's biases for this map's texels and depth range.
    pub bias: Bias,
    /// View depth from which points choose this map, in metres, where maps are [read by view
    /// depth](crate::settings::MapSelection::ViewDepth). By coverage it says for which part of the view the
    /// map was made: of [windows](crate::Windows) for all of it.
    pub near: f32,
    /// View depth up to which points choose this map by view depth, in metres: they take the first map that
    /// ends beyond them. Of slices the last one has no end. Where splits coincide there is no range: such maps end
    /// at `f32::MIN` before all others, and begin at `f32::MAX` after them.
    pub far: f32,
    /// View depth from which this map covers what is seen, in metres: before `near` where the
    /// maps overlap. The end of its range for a [window](crate::Windows) that is not the
    /// last one, since it need not hold all of any depth.
    pub covered_near: f32,
    /// Where the map lies on the world's grid, if it does: what [`Scroll`](crate::scroll::Scroll) and
    /// [tiles](crate::scroll::tiles) are made from.
    pub anchor: Option<GridAnchor>,
    /// Where the map's first texel is stored in its texture, in texels: texel t at (t + wrap) mod size, so that a map
    /// that moves keeps what it still covers where it is ([`Scroll::wrap`](crate::scroll::Scroll::wrap)). Fits leave it
    /// zero.
    pub wrap: UVec2,
}

impl FittedMap {
    /// A single map for all view depths.
    pub fn new(fit: LightProjection, bias: Bias) -> Self {
        Self { projection: fit, bias, near: f32::MIN, far: f32::MAX, covered_near: f32::MIN, ..Self::default() }
    }

    /// This map as one of several that are read by view depth and end one after the other, in metres, without a blend
    /// from the map in front of it.
    #[must_use]
    pub const fn ending_at(mut self, far: f32) -> Self {
        (self.far, self.covered_near) = (far, f32::MAX);
        self
    }

    /// Returns this map for shaders that take positions relative to another world position, in metres. f32 rounds
    /// positions more that are farther away, and biases grow by that much unless they are 0.
    #[must_use]
    pub fn relative_to(&self, origin: DVec3) -> Self {
        let projection = self.projection.relative_to(origin);
        let more = (rounding(&projection) - rounding(&self.projection)).max(0.0) as f32;
        Self { projection, bias: self.bias.widened(more, &projection), ..*self }
    }

    /// Where points read the map by view depth.
    pub fn depth_range(&self) -> DepthRange {
        // A map without a range behind all others is read where those in front leave points out.
        let far = if self.near == f32::MAX { f32::MAX } else { self.far };
        DepthRange { blend_near: f64::from(self.covered_near), far: f64::from(far) }
    }
}

/// The maps of one frame, nearest first, windows finest first. There are none in a frame without shadows, whose views
/// begin beyond the shadow distance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FittedMaps {
    maps: [FittedMap; MAX_MAPS],
    count: usize,
    /// What the maps were placed by.
    pub placed_by: PlacedBy,
}

/// What told a fit where surfaces are seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum PlacedBy {
    /// The boxes of the receivers, or the views alone where there are none: nothing else was told, nothing else is
    /// used by the technique, or what was told belongs to another light or has another size.
    #[default]
    Boxes,
    /// What an earlier frame showed: a [demand grid](crate::FitInput::demand), or a
    /// [histogram](crate::FitInput::histogram).
    LastFrame,
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
    /// view's forward direction, both in metres: beyond the shadow distance nothing is read, nearer it counts only by view depth. A point that is
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
    /// # let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
    /// # let scratch = &mut Scratch::new(&mut storage);
    /// let (views, technique) = ([camera.frustum()?], Technique::default());
    /// let maps = FitState::new().fit(&FitInput::new(&views, Vec3::new(0.3, -0.8, 0.2)), &technique, scratch)?;
    /// let read = maps.read(&technique, DVec3::new(0.0, 1.0, -20.0), 25.0).expect("it is in view");
    /// println!("map {}, blended into {:?}", read.map, read.blend);
    /// # assert!(maps[read.main()].projection.covers(DVec3::new(0.0, 1.0, -20.0)));
    /// # Ok::<(), FitError>(())
    /// ```
    pub fn read(&self, technique: &Technique, point: DVec3, view_depth: f64) -> Option<MapRead> {
        // Shadows end there, however far maps reach.
        if view_depth > f64::from(technique.fit.max_distance) {
            return None;
        }
        match technique.maps.selection() {
            selection @ MapSelection::Coverage { blend } => {
                let order = MapOrder::new(selection, self.iter().map(|map| &map.projection));
                let (reach, blend) = (f64::from(technique.reach()), f64::from(blend));
                by_coverage(order.iter(), reach, blend, |map| self[map].projection.free_texels(point))
            }
            MapSelection::ViewDepth { .. } => {
                by_view_depth(self.iter().map(FittedMap::depth_range), view_depth, |map| {
                    self[map].projection.covers(point)
                })
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
