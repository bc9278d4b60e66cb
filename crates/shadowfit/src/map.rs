//! The maps of one frame.

use core::ops::Deref;

use glam::{DVec3, UVec2};

use crate::bias::{Bias, rounding};
use crate::light::grid::GridPosition;
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
    /// The view depths that the map was made for; of a [window](crate::Windows) those of the whole view. Points read it
    /// there if maps are [read by view depth](crate::settings::MapSelection::ViewDepth). The last cascade has no end.
    /// Where splits coincide a map has no depths of its own: in front of all others it has `None`, and no point reads
    /// it by view depth. Behind all others it begins where shadows end, and points read it that the maps in front do
    /// not hold.
    pub depths: Option<DepthRange>,
    /// Where the map lies on the world's grid, if it does: what [`Scroll`](crate::scroll::Scroll) and
    /// [tiles](crate::scroll::tiles) are made from.
    pub grid_position: Option<GridPosition>,
    /// Where the map's first texel is stored in its texture, in texels: texel t at `(t + texel_offset) % size`, so that
    /// a map that moves keeps what it still covers where it is
    /// ([`Scroll::texel_offset`](crate::scroll::Scroll::texel_offset)). Fits leave it zero.
    pub texel_offset: UVec2,
}

impl FittedMap {
    /// A single map for all view depths.
    pub fn new(fit: LightProjection, bias: Bias) -> Self {
        Self { projection: fit, bias, depths: Some(DepthRange::ALL), ..Self::default() }
    }

    /// This map as one of several that are read by view depth.
    #[must_use]
    pub const fn with_depths(mut self, depths: DepthRange) -> Self {
        self.depths = Some(depths);
        self
    }

    /// Returns the view depth at which the map ends, in metres, for shaders that compare in f32: `f32::MAX` for no end, and
    /// `f32::MIN` for a map that no point reads by view depth.
    pub fn shader_end(&self) -> f32 {
        self.depths.map_or(f32::MIN, |range| range.far.map_or(f32::MAX, |far| far as f32))
    }

    /// Returns the view depth from which points are blended from the map in front into this one, in metres, for shaders
    /// that compare in f32: `f32::MAX` for no blend.
    pub fn shader_blend_start(&self) -> f32 {
        self.depths.and_then(|range| range.covered_from).map_or(f32::MAX, |start| start as f32)
    }

    /// Returns this map for shaders that take positions relative to another world position, in metres. f32 rounds
    /// positions more that are farther away, and biases grow by that much unless they are 0.
    #[must_use]
    pub fn relative_to(&self, origin: DVec3) -> Self {
        let projection = self.projection.relative_to(origin);
        let more = (rounding(&projection) - rounding(&self.projection)).max(0.0) as f32;
        Self { projection, bias: self.bias.widened(more, &projection), ..*self }
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
    pub placement: PlacementSource,
}

/// What told a fit where surfaces are seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum PlacementSource {
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
        // A count that was read from a file may have any value.
        &self.maps[..self.count.min(MAX_MAPS)]
    }
}
