//! Redrawn rectangles of the maps, and the maps that hold each caster, for tools that show them.

use alloc::vec;
use alloc::vec::Vec;

use glam::UVec2;

use super::MapCache;
use super::casters::Casters;
use super::plan::{PassKind, PassPlan};
use super::settings::Culling;
use crate::culling::cull;
use crate::scroll::TexelRect;
use crate::{CasterVolume, FittedMap};

/// A rectangle of a map that a frame draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UpdatedRect {
    /// Index of the map.
    pub map: usize,
    /// The rectangle in the map's coordinates, whose first texel is top left. It may be stored elsewhere in
    /// the layer.
    pub rect: TexelRect,
    /// Content that is drawn there.
    pub content: UpdateKind,
}

/// Content that is drawn into a rectangle of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UpdateKind {
    /// All casters, static and moving, after a clear. No part of the map is kept.
    All,
    /// Static casters, after a clear: in a strip that entered the map, or where one of them changed.
    Static,
    /// Kept depths of static casters, restored where a moving caster was drawn over them.
    Mended,
    /// A moving caster.
    Moving,
}

impl MapCache {
    /// Returns the rectangles that this frame draws, in the order of the passes. They may overlap.
    pub fn updates(&self) -> Vec<UpdatedRect> {
        let mut updates = Vec::new();
        for pass in &self.plan.passes {
            let Some(read) = self.plan.maps.get(pass.map) else { continue };
            let update = |content| move |rect| UpdatedRect { map: pass.map, rect, content };
            let regions = self.plan.regions_of(pass).iter().map(|region| region.part.window);
            match pass.content {
                PassKind::All => updates.extend(regions.map(update(UpdateKind::All))),
                PassKind::Static => updates.extend(regions.map(update(UpdateKind::Static))),
                PassKind::Moving => {
                    updates.extend(self.mended(pass, read).map(update(UpdateKind::Mended)));
                    updates.extend(self.moving(pass.map, read).map(update(UpdateKind::Moving)));
                }
            }
        }
        updates.retain(|update| !update.rect.is_empty());
        updates
    }

    /// Returns the rectangles that are restored from the static casters' layer.
    fn mended(&self, pass: &PassPlan, read: &FittedMap) -> impl Iterator<Item = TexelRect> {
        let stored = self.plan.rects[pass.mended.clone()].iter();
        let rects = stored.map(|stored| looked_up(*stored, read.texel_offset, pass.size));
        let boxes = self.plan.boxes[pass.mended_boxes.clone()].iter();
        rects.chain(boxes.map(|aabb| TexelRect::of_box(&read.projection, aabb, self.plan.origin)))
    }

    /// Returns rectangles around the moving casters in a map.
    fn moving(&self, map: usize, read: &FittedMap) -> impl Iterator<Item = TexelRect> {
        let origin = read.projection.origin;
        let drawn = self.maps.get(map).and_then(|state| state.layers.drawn());
        drawn
            .into_iter()
            .flat_map(|drawn| &drawn.moving)
            .map(move |moved| TexelRect::of_box(&read.projection, &moved.relative_to(origin), origin))
    }

    /// Returns a mask for each listed caster, with bit i set if map i holds it. A kept map holds all static
    /// casters over it. Any other map holds the casters that can shadow something in view. Without maps all
    /// masks are 0.
    pub fn maps_by_caster(&self, casters: &Casters<'_>) -> Vec<u8> {
        let in_view = &self.plan.in_view;
        let over = |((index, map), in_view): ((usize, &FittedMap), &CasterVolume)| match self.settings.culling {
            Culling::Off => CasterVolume::everywhere(map.projection.origin),
            _ if self.is_kept(index) => CasterVolume::of_map(&map.projection, self.settings.caster_policy()),
            _ => *in_view,
        };
        let over: Vec<CasterVolume> = self.plan.maps.iter().enumerate().zip(in_view).map(over).collect();
        let boxes = casters.boxes;
        let [mut moving, mut fixed] = [(); 2].map(|()| vec![0; boxes.boxes.len()]);
        cull(in_view, boxes.origin, boxes.boxes, &mut moving);
        cull(&over, boxes.origin, boxes.boxes, &mut fixed);
        let mask = |(number, (moving, fixed))| if casters.moves(number) { moving } else { fixed };
        moving.into_iter().zip(fixed).enumerate().map(mask).collect()
    }
}

/// Returns the place in the map's coordinates of a stored rectangle, which must not cross the map's seam.
fn looked_up(stored: TexelRect, texel_offset: UVec2, size: UVec2) -> TexelRect {
    let is_whole = stored == TexelRect::all(size);
    if is_whole {
        stored
    } else {
        TexelRect { min: (stored.min + size - texel_offset) % size.max(UVec2::ONE), ..stored }
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use super::*;

    #[test]
    fn each_piece_of_a_rectangle_is_looked_up_where_the_rectangle_lies() {
        let (size, texel_offset) = (UVec2::new(16, 8), UVec2::new(13, 3));
        let rect = TexelRect { min: UVec2::new(1, 2), size: UVec2::new(9, 5) };
        let regions: Vec<_> = rect.stored(texel_offset, size).collect();
        assert_eq!(regions.len(), 4);
        for region in regions {
            assert_eq!(looked_up(region.stored, texel_offset, size), region.window);
        }
        assert_eq!(looked_up(TexelRect::all(size), texel_offset, size), TexelRect::all(size));
    }
}
