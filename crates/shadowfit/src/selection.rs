//! Which of several maps a point reads.
//!
//! By **coverage** a point reads the finest map that holds it with all that the filter reads around
//! it, whatever its view depth, and is blended into the next coarser one toward that map's border.
//! By **view depth** it reads the map of its range of view depths, as most engines have it. The same
//! rule stands in the WGSL of `shadowfit-wgpu` and is what pictures are judged by.
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

/// How points read several maps: which of them, and how far around a point the filter looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapReading {
    /// Which of the maps a point reads.
    pub selection: MapSelection,
    /// Filter of the look-up.
    pub filter: FilterKind,
    /// Width of the filters that are soft.
    pub softness: Softness,
}

impl Technique {
    /// How points read the maps.
    pub const fn reading(&self) -> MapReading {
        let Self { filter, softness, .. } = *self;
        MapReading { selection: self.maps.selection(), filter, softness }
    }
}

/// The maps that a point reads, by their indices.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MapRead {
    /// The map that is found first.
    pub map: usize,
    /// The map that it is blended into, if it is.
    pub blend: Option<MapBlend>,
}

/// A second map that a point reads.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MapBlend {
    /// Its index.
    pub map: usize,
    /// Its share of the shadow factor, 0..=1; the first map has the rest.
    pub weight: f64,
}

impl MapRead {
    /// The map that weighs more; the first one where both weigh the same.
    pub fn main(&self) -> usize {
        match self.blend {
            Some(blend) if blend.weight > 0.5 => blend.map,
            _ => self.map,
        }
    }
}

/// The indices of maps in the order in which a point tries them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MapOrder {
    indices: [u8; MAX_MAPS],
    count: u8,
}

impl MapOrder {
    /// The order of maps: by coverage that of their texels' areas, the finest first, and of their
    /// indices where areas are equal; by view depth that of their indices. Maps past [`MAX_MAPS`]
    /// are left out, and by coverage also those that [are empty](LightProjection::is_empty), whose passes
    /// may be skipped.
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

    /// The order of maps by the areas of their texels, in any unit; those without one are left out.
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

    /// The indices, the first one to be tried first.
    pub fn iter(&self) -> impl Iterator<Item = usize> + '_ {
        self.indices[..usize::from(self.count)].iter().map(|index| usize::from(*index))
    }
}

/// The maps that a point reads by coverage; `None` where no map holds it.
///
/// `order` has the maps' indices, the finest first, each once; `reach` and `blend` are texels. `free`
/// says how many texels of a map lie between the point and the nearest side, or `None` where the map
/// does not hold the point ([`LightProjection::texels_to_edge`]).
///
/// The first map that has `reach` texels free is read, and blended with the next one that has, by
/// weights that are linear in the first one's free texels: from 0 at `reach` to 1 at
/// `reach + blend`. Where none has as many, the first one that holds the point is read alone, with
/// the filter clamped to the map.
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

/// View depths of a map: distances from the eye along the view's forward direction, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DepthRange {
    /// Where it begins.
    pub near: f64,
    /// Where it ends: points read the first map that ends beyond them. `None` for a map without an end, such as the last
    /// cascade, which is read as far as shadows reach.
    pub far: Option<f64>,
    /// From where on the map holds everything that is visible, up to its end. It lies before `near` where maps overlap,
    /// and points are blended from the map in front into this one from there on. `None` for a map that need not hold
    /// all of any depth, such as a [window](crate::Windows) that is not the last one; no point is blended into it by
    /// view depth.
    pub covered_from: Option<f64>,
}

impl DepthRange {
    /// All view depths, also those behind the eye, which orthographic views have.
    pub const ALL: Self = Self { near: f32::MIN as f64, far: None, covered_from: Some(f32::MIN as f64) };

    /// The range of a map that other code fitted: it need not hold all of it.
    pub const fn new(near: f64, far: Option<f64>) -> Self {
        Self { near, far, covered_from: None }
    }

    /// Whether the map ends beyond a view depth.
    pub fn ends_beyond(&self, view_depth: f64) -> bool {
        view_depth < self.far.unwrap_or(f64::MAX)
    }
}

/// The maps that a point reads by view depth; `None` where no map from there on holds it.
///
/// `ranges` are those of the maps, in order of their ends; none reads a map without one. `holds` says whether a map
/// holds the point ([`LightProjection::covers`]). The first map that ends beyond the point's view depth is read, or the
/// next later one that holds the point; it is blended into the map behind it, if that holds the
/// point, by weights that are linear in the view depth, from where that one's range begins to overlap
/// to its own end.
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
