//! The maps of one frame.

use core::ops::Deref;

use glam::{DVec3, UVec2};

use crate::bias::{Bias, rounding};
use crate::light::grid::GridPosition;
use crate::projection::LightProjection;
use crate::selection::{DepthRange, MapOrder, MapRead, by_coverage, by_view_depth};
use crate::technique::Technique;
use crate::technique::settings::{MAX_MAPS, MapSelection};

/// A fitted map: its matrices, its biases and its place among the maps of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FittedMap {
    /// The map's matrices and box.
    pub projection: LightProjection,
    /// The technique's biases for this map's texels and depth range.
    pub bias: Bias,
    /// View depths that the map is for. If maps are selected [by view
    /// depth](crate::settings::MapSelection::ViewDepth), points at these depths read it. A
    /// [window](crate::Windows) has the depths of the whole view. The last cascade has no end.
    ///
    /// Splits that coincide give maps with an empty range. Such a map has `None` if it lies in front of all
    /// maps with a range, and no point reads it by view depth. If it lies behind all of them, its range
    /// begins where shadows end, and it is read only by points that the maps in front do not cover.
    pub depths: Option<DepthRange>,
    /// Position of the map on the world's grid, if it lies on it. [`Scroll`](crate::scroll::Scroll) and
    /// [tiles](crate::scroll::tiles) are computed from it.
    pub grid_position: Option<GridPosition>,
    /// Offset from the map's texels to the texture's, in texels. Texel t of the map is stored at
    /// `(t + texel_offset) % size`, so a map that moves keeps its valid texels where they are
    /// ([`Scroll::texel_offset`](crate::scroll::Scroll::texel_offset)). Fits set it to zero.
    pub texel_offset: UVec2,
}

impl FittedMap {
    /// Creates a single map for all view depths.
    pub fn new(fit: LightProjection, bias: Bias) -> Self {
        Self { projection: fit, bias, depths: Some(DepthRange::ALL), ..Self::default() }
    }

    /// Returns this map with a range of view depths, as one of several maps that are read by view depth.
    #[must_use]
    pub const fn with_depths(mut self, depths: DepthRange) -> Self {
        self.depths = Some(depths);
        self
    }

    /// Returns the view depth at which the map ends, in metres, for shaders that compare in f32. It is
    /// `f32::MAX` for no end, and `f32::MIN` for a map that no point reads by view depth.
    pub fn shader_end(&self) -> f32 {
        self.depths.map_or(f32::MIN, |range| range.far.map_or(f32::MAX, |far| far as f32))
    }

    /// Returns the view depth from which points are blended from the map in front into this one, in metres,
    /// for shaders that compare in f32. It is `f32::MAX` for no blend.
    pub fn shader_blend_start(&self) -> f32 {
        self.depths.and_then(|range| range.covered_from).map_or(f32::MAX, |start| start as f32)
    }

    /// Returns this map for shaders that take positions relative to another world position, in metres.
    /// Positions farther from that origin are rounded more in f32, so biases other than 0 grow by the
    /// additional rounding.
    #[must_use]
    pub fn relative_to(&self, origin: DVec3) -> Self {
        let projection = self.projection.relative_to(origin);
        let more = (rounding(&projection) - rounding(&self.projection)).max(0.0) as f32;
        Self { projection, bias: self.bias.widened(more, &projection), ..*self }
    }
}

/// The maps of one frame: cascades from near to far, windows from fine to coarse. It is empty if the frame
/// has no shadows, for example if the views begin beyond the shadow distance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FittedMaps {
    maps: [FittedMap; MAX_MAPS],
    count: usize,
    /// Source of the visible surfaces that these maps were placed by.
    pub placement: PlacementSource,
}

/// Source of the visible surfaces that maps are placed by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum PlacementSource {
    /// The receivers' boxes, or the views if there are no boxes. They are used if the technique does not use
    /// visible demand, or if the input has none that belongs to this light and has the right size.
    #[default]
    Boxes,
    /// The visible demand of an earlier frame: a [demand grid](crate::FitInput::demand), or a
    /// [histogram](crate::FitInput::histogram).
    LastFrame,
}

impl FittedMaps {
    /// Sets the number of maps, and returns the maps for writing.
    pub(crate) fn take(&mut self, count: usize) -> &mut [FittedMap] {
        self.count = count;
        &mut self.maps[..count]
    }
}

impl FittedMaps {
    /// Returns the maps that a point reads, by the same rule as the shaders of `shadowfit-wgpu`. Returns
    /// `None` if no map covers the point, which is then lit. `point` is a world position, and `view_depth` is
    /// its distance from the eye along the view's forward direction, both in metres. Points beyond the shadow
    /// distance read no map. At shorter distances, `view_depth` is used only if maps are selected by view
    /// depth. No map covers a point that is not finite.
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
        // Shadows end there, even if maps reach farther.
        if view_depth > f64::from(technique.fit.max_distance) {
            return None;
        }
        match technique.maps.selection() {
            selection @ MapSelection::Coverage { blend } => {
                let order = MapOrder::new(selection, self.iter().map(|map| &map.projection));
                let (reach, blend) = (f64::from(technique.filter_radius()), f64::from(blend));
                by_coverage(order.iter(), reach, blend, |map| self[map].projection.texels_to_edge(point))
            }
            MapSelection::ViewDepth { .. } => {
                by_view_depth(self.iter().map(|map| map.depths), view_depth, |map| self[map].projection.covers(point))
            }
        }
    }
}

impl Deref for FittedMaps {
    type Target = [FittedMap];

    fn deref(&self) -> &[FittedMap] {
        // A count from a file may have any value.
        &self.maps[..self.count.min(MAX_MAPS)]
    }
}
