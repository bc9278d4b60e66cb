//! Which rectangles of the maps a frame draws, and which maps hold a caster: for tools that show it.

use shadowfit::culling::cull;
use shadowfit::glam::UVec2;
use shadowfit::scroll::TexelRect;
use shadowfit::{CasterVolume, FittedMap};

use super::CachedMaps;
use crate::cache::{Casters, Culling, PassContent, PassPlan};
use crate::maps::shadow_map::stored_casters;
use crate::{MapView, ShadowMapError};

/// A rectangle of a map that is drawn in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MapUpdate {
    /// Number of the map.
    pub map: usize,
    /// The rectangle as it is looked up, wherever it is stored: the map's first texel is its left top one.
    pub rect: TexelRect,
    /// What is drawn there.
    pub content: UpdateContent,
}

/// What is drawn into a rectangle of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UpdateContent {
    /// All casters, static and moving, after a clear: no part of the map is kept.
    All,
    /// Static casters, after a clear: a strip that came into the map, or a place where one of them changed.
    Static,
    /// The depths of static casters that are kept, where something that moves was drawn over them before.
    Mended,
    /// A moving caster.
    Moving,
}

impl CachedMaps {
    /// The rectangles that are drawn in this frame, in the order of the passes. Some may overlap.
    pub(crate) fn updates(&self) -> Vec<MapUpdate> {
        let mut updates = Vec::new();
        for pass in &self.plan.passes {
            let Some(fitted) = self.maps.get(pass.map) else { continue };
            let update = |content| move |rect| MapUpdate { map: pass.map, rect, content };
            let pieces = self.plan.pieces[pass.pieces.clone()].iter().map(|piece| piece.part.window);
            match pass.content {
                PassContent::All => updates.extend(pieces.map(update(UpdateContent::All))),
                PassContent::Static => updates.extend(pieces.map(update(UpdateContent::Static))),
                PassContent::Moving => {
                    updates.extend(self.mended(pass, fitted).map(update(UpdateContent::Mended)));
                    updates.extend(self.moving(pass.map, fitted).map(update(UpdateContent::Moving)));
                }
            }
        }
        updates.retain(|update| !update.rect.is_empty());
        updates
    }

    /// Rectangles that are restored from the static casters' layer.
    fn mended(&self, pass: &PassPlan, fitted: &FittedMap) -> impl Iterator<Item = TexelRect> {
        let stored = self.plan.rects[pass.mended.clone()].iter();
        let rects = stored.map(|stored| looked_up(*stored, fitted.wrap, pass.size));
        let boxes = self.plan.boxes[pass.mended_boxes.clone()].iter();
        rects.chain(boxes.map(|aabb| TexelRect::of_box(&fitted.projection, aabb, self.origin)))
    }

    /// Rectangles around the moving casters that a map was drawn with.
    fn moving(&self, map: usize, fitted: &FittedMap) -> impl Iterator<Item = TexelRect> {
        let origin = fitted.projection.origin;
        let boxes = self.cache.moving(map).iter();
        boxes.map(move |moved| TexelRect::of_box(&fitted.projection, &moved.relative_to(origin), origin))
    }

    /// Whether the static casters of a map, by its number, are kept for later frames.
    pub(crate) fn is_cached(&self, map: usize) -> bool {
        self.cache.is_cached(map)
    }

    /// Which maps hold each caster, by its number: bit i of the mask stands for map i. A map that is kept holds all
    /// static casters over it; any other map those that can shadow something in view. Without maps all masks are 0.
    pub(crate) fn holders(&self, casters: &Casters<'_>) -> Vec<u8> {
        let clamps = self.map.descriptor().depth_clamp;
        let in_view = &self.volumes;
        let over = |(index, map): (usize, &FittedMap)| match self.culling {
            Culling::Off => CasterVolume::everywhere(map.projection.origin),
            _ if self.is_cached(index) => stored_casters(&map.projection, clamps),
            _ => in_view[index],
        };
        let over: Vec<CasterVolume> = self.maps.iter().enumerate().map(over).collect();
        let boxes = casters.boxes;
        let [mut moving, mut fixed] = [(); 2].map(|()| vec![0; boxes.boxes.len()]);
        cull(in_view, boxes.origin, boxes.boxes, &mut moving);
        cull(&over, boxes.origin, boxes.boxes, &mut fixed);
        let mask = |(number, (moving, fixed))| if casters.moves(number) { moving } else { fixed };
        moving.into_iter().zip(fixed).enumerate().map(mask).collect()
    }

    /// Writes the uniforms for another picture with the same maps, whose positions are relative to another origin or
    /// whose view depths are counted from another eye. The maps stay as they were drawn: their passes must not be drawn
    /// after this. A light that is off gives nothing from anywhere.
    ///
    /// # Errors
    ///
    /// [`ShadowMapError::Forward`] for a direction that is not of unit length; nothing is written then.
    pub(crate) fn look_from(&mut self, queue: &wgpu::Queue, view: &MapView) -> Result<(), ShadowMapError> {
        if self.is_off { Ok(()) } else { self.write_uniforms(queue, view) }
    }
}

/// Where a rectangle of a layer, which does not reach across the map's seam, is looked up.
fn looked_up(stored: TexelRect, wrap: UVec2, size: UVec2) -> TexelRect {
    let is_whole = stored == TexelRect::all(size);
    if is_whole { stored } else { TexelRect { min: (stored.min + size - wrap) % size.max(UVec2::ONE), ..stored } }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_piece_of_a_rectangle_is_looked_up_where_the_rectangle_lies() {
        let (size, wrap) = (UVec2::new(16, 8), UVec2::new(13, 3));
        let rect = TexelRect { min: UVec2::new(1, 2), size: UVec2::new(9, 5) };
        let pieces: Vec<_> = rect.stored(wrap, size).collect();
        assert_eq!(pieces.len(), 4);
        for piece in pieces {
            assert_eq!(looked_up(piece.stored, wrap, size), piece.window);
        }
        assert_eq!(looked_up(TexelRect::all(size), wrap, size), TexelRect::all(size));
    }
}
