//! Selection of the map that a point reads.
//!
//! By **coverage** a point reads the finest map that covers it and the filter's footprint around it, at any
//! view depth. Toward that map's border it is blended into the next coarser one. By **view depth** it reads
//! the map of its range of view depths, as in most engines. The WGSL of `shadowfit-wgpu` uses the same rule,
//! and reports judge pictures by it.
//!
//! ```text
//!   ┌──────────────────────────┐ coarser map
//!   │   ┌───────────────┐      │
//!   │   │ ┌───────────┐ │reach │   inside by reach + blend: the finer map alone
//!   │   │ │  ┌─────┐  │ │      │   inside by reach:         both, the finer one's weight falls to 0
//!   │   │ │  │     │  │ │      │   beyond that:             the coarser map
//!   │   │ │  └─────┘  │ │      │
//!   │   │ └─blend─────┘ │      │
//!   │   └───────────────┘      │
//!   └──────────────────────────┘
//! ```

use crate::projection::LightProjection;
use crate::technique::Technique;
use crate::technique::settings::{FilterKind, MAX_MAPS, MapSelection, Softness};

/// Settings for reading several maps: the selection of a map, and the filter of the look-up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapReading {
    /// Rule that selects the map that a point reads.
    pub selection: MapSelection,
    /// Filter of the look-up.
    pub filter: FilterKind,
    /// Width of soft filters.
    pub softness: Softness,
}

impl Technique {
    /// Returns the selection and the filter of this technique.
    pub const fn reading(&self) -> MapReading {
        let Self { filter, softness, .. } = *self;
        MapReading { selection: self.maps.selection(), filter, softness }
    }
}

/// The maps that a point reads, by their indices.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MapRead {
    /// Index of the first map that the selection finds.
    pub map: usize,
    /// Map that it is blended into, if any.
    pub blend: Option<MapBlend>,
}

/// A second map that a point reads.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MapBlend {
    /// Index of the map.
    pub map: usize,
    /// Share of this map in the shadow factor, 0..=1. The first map has the rest.
    pub weight: f64,
}

impl MapRead {
    /// Returns the map with the greater weight, or the first map if both weigh the same.
    pub fn main(&self) -> usize {
        match self.blend {
            Some(blend) if blend.weight > 0.5 => blend.map,
            _ => self.map,
        }
    }
}

/// Indices of maps in the order in which a point tries them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MapOrder {
    indices: [u8; MAX_MAPS],
    count: u8,
}

impl MapOrder {
    /// Creates the order of maps. By coverage, the maps with the smallest texel areas come first, and maps of
    /// equal area are ordered by index. By view depth, all maps are ordered by index. Maps past [`MAX_MAPS`]
    /// are left out. By coverage, maps that [are empty](LightProjection::is_empty) are left out too, since
    /// their passes may be skipped.
    ///
    /// ```
    /// use shadowfit::selection::MapOrder;
    /// use shadowfit::glam::Vec2;
    /// use shadowfit::settings::MapSelection;
    /// use shadowfit::LightProjection;
    ///
    /// let map = |side: f32| LightProjection { texel_size: Vec2::splat(side), ..LightProjection::default() };
    /// let maps = [map(0.4), map(0.1), map(0.1), LightProjection { is_empty: true, ..map(0.2) }];
    /// assert!(MapOrder::new(MapSelection::default(), &maps).iter().eq([1, 2, 0]));
    /// assert!(MapOrder::new(MapSelection::ViewDepth { overlap: 0.0 }, &maps).iter().eq([0, 1, 2, 3]));
    /// ```
    pub fn new<'a>(selection: MapSelection, maps: impl IntoIterator<Item = &'a LightProjection>) -> Self {
        let area = |fit: &LightProjection| f64::from(fit.texel_size.x) * f64::from(fit.texel_size.y);
        let maps = maps.into_iter();
        match selection {
            MapSelection::Coverage { .. } => Self::by_area(maps.map(|fit| (!fit.is_empty).then(|| area(fit)))),
            MapSelection::ViewDepth { .. } => Self::by_area(maps.map(|_| Some(1.0))),
        }
    }

    /// Creates the order of maps by the areas of their texels, in any unit. Maps without an area are left
    /// out.
    pub fn by_area(areas: impl IntoIterator<Item = Option<f64>>) -> Self {
        let mut order = Self::default();
        let mut sorted = [0.0; MAX_MAPS];
        for (index, area) in (0..MAX_MAPS as u8).zip(areas) {
            let Some(area) = area else { continue };
            let mut place = usize::from(order.count);
            while place > 0 && area < sorted[place - 1] {
                (sorted[place], order.indices[place]) = (sorted[place - 1], order.indices[place - 1]);
                place -= 1;
            }
            (sorted[place], order.indices[place]) = (area, index);
            order.count += 1;
        }
        order
    }

    /// Returns the indices, in the order in which a point tries the maps.
    pub fn iter(&self) -> impl Iterator<Item = usize> + '_ {
        self.indices[..usize::from(self.count)].iter().map(|index| usize::from(*index))
    }
}

/// Returns the maps that a point reads by coverage, or `None` if no map covers it.
///
/// `order` has the maps' indices, finest first, each once. `reach` is the filter radius and `blend` the width
/// of the blend, both in texels. `free` returns the number of texels between the point and the nearest side
/// of a map, or `None` if the map does not cover the point ([`LightProjection::texels_to_edge`]).
///
/// The point reads the first map that has `reach` texels free. This map is blended into the next one that has
/// `reach` texels free. The weight of the first map is linear in its free texels: 0 at `reach` and 1 at
/// `reach + blend`. If no map has `reach` texels free, the point reads only the first map that covers it,
/// with the filter clamped to the map.
pub fn by_coverage(
    order: impl IntoIterator<Item = usize>,
    reach: f64,
    blend: f64,
    free: impl Fn(usize) -> Option<f64>,
) -> Option<MapRead> {
    let mut first: Option<(usize, f64)> = None;
    let mut clamped = None;
    for map in order {
        match (free(map), first) {
            (Some(free), Some((finer, weight))) if free >= reach => {
                return Some(MapRead { map: finer, blend: Some(MapBlend { map, weight: 1.0 - weight }) });
            }
            (Some(free), None) if free >= reach => {
                let beyond = free - reach;
                if beyond >= blend {
                    return Some(MapRead { map, blend: None });
                }
                first = Some((map, beyond / blend));
            }
            (Some(_), None) => clamped = clamped.or(Some(map)),
            _ => {}
        }
    }
    first.map(|(map, _)| map).or(clamped).map(|map| MapRead { map, blend: None })
}

/// Range of view depths of a map. A view depth is a distance from the eye along the view's forward direction,
/// in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DepthRange {
    /// View depth at which the range begins.
    pub near: f64,
    /// View depth at which the range ends. Points read the first map that ends beyond their view depth.
    /// `None` for a map without an end, such as the last cascade, which is read up to the shadow distance.
    pub far: Option<f64>,
    /// View depth from which the map holds everything visible, up to its end. If maps overlap it lies before
    /// `near`, and from there on points are blended from the map in front into this one. `None` for a map
    /// that holds only a part of the view at every depth, such as a [window](crate::Windows) other than the
    /// last one. No point is blended into it by view depth.
    pub covered_from: Option<f64>,
}

impl DepthRange {
    /// All view depths, including those behind the eye, which orthographic views have.
    pub const ALL: Self = Self { near: f32::MIN as f64, far: None, covered_from: Some(f32::MIN as f64) };

    /// Creates the range of a map that other code fitted. The map need not hold everything in the range.
    pub const fn new(near: f64, far: Option<f64>) -> Self {
        Self { near, far, covered_from: None }
    }

    /// Returns whether the map ends beyond a view depth.
    pub fn ends_beyond(&self, view_depth: f64) -> bool {
        view_depth < self.far.unwrap_or(f64::MAX)
    }
}

/// Returns the maps that a point reads by view depth, or `None` if neither the map of that depth nor a later
/// map covers the point.
///
/// `ranges` are the ranges of the maps, in order of their ends. A map without a range is never read. `holds`
/// returns whether a map covers the point ([`LightProjection::covers`]). The point reads the first map that
/// ends beyond its view depth and covers the point. This map is blended into the next one if that covers the
/// point too. The weight of the next map is linear in the view depth, from 0 at [`DepthRange::covered_from`]
/// of the next map to 1 at the end of the first map.
pub fn by_view_depth(
    ranges: impl IntoIterator<Item = Option<DepthRange>>,
    view_depth: f64,
    holds: impl Fn(usize) -> bool,
) -> Option<MapRead> {
    let mut maps = ranges.into_iter().enumerate();
    let (map, own) = maps.find_map(|(index, range)| {
        let range = range.filter(|range| range.ends_beyond(view_depth))?;
        holds(index).then_some((index, range))
    })?;
    let blend = maps.next().and_then(|(next, range)| {
        let (start, end) = range?.covered_from.zip(own.far)?;
        let is_between = view_depth > start && start < end;
        let weight = (view_depth - start) / (end - start);
        (is_between && holds(next)).then_some(MapBlend { map: next, weight })
    });
    Some(MapRead { map, blend })
}
