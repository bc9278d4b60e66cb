//! What is drawn into each piece of a frame, for shaders that find its casters.

use shadowfit::CasterVolume;
use shadowfit::scroll::TexelRect;

use super::{CachedMaps, ShadowPass};
use crate::cache::PassContent;
use crate::maps::shadow_map::caster_policy;
use crate::{Culling, CullingPiece, ShadowPiece};

impl<'a> ShadowPass<'a> {
    /// The pass's pieces for shaders.
    pub(crate) fn culling_pieces(&self) -> impl Iterator<Item = CullingPiece> + use<'a> {
        let (maps, pass, content) = (self.maps, self.pass, self.content());
        let parts = maps.plan.pieces[pass.pieces.clone()].iter().map(|piece| piece.part.window);
        self.pieces()
            .zip(parts)
            .map(move |(piece, part)| of_piece(&piece, content, &maps.culling_piece(pass.map, content, part)))
    }
}

impl CachedMaps {
    /// The planes of the casters that are drawn into a part of a map. Maps that are kept hold what stands still over them;
    /// other maps, and what moves, are drawn as far as they can shadow something in view.
    fn culling_piece(&self, map: usize, content: PassContent, part: TexelRect) -> CullingPiece {
        let (Some(in_view), Some(fitted)) = (self.volumes.get(map), self.maps.get(map)) else {
            return CullingPiece::new([], self.origin);
        };
        if self.culling == Culling::Off {
            return CullingPiece::new([], self.origin);
        }
        if !self.is_cached(map) {
            return CullingPiece::new([*in_view], self.origin);
        }
        let over = CasterVolume::of_part(&fitted.projection, caster_policy(self.map.descriptor().depth_clamp), part);
        let moving = (content != PassContent::Static).then_some(*in_view);
        let piece = CullingPiece::new([over].into_iter().chain(moving), self.origin);
        CullingPiece { fixed_planes: over.count, ..piece }
    }
}

/// The record of a piece, with the planes of `planes`.
fn of_piece(piece: &ShadowPiece<'_>, content: PassContent, planes: &CullingPiece) -> CullingPiece {
    CullingPiece {
        viewport: piece.viewport,
        scissor: piece.scissor,
        map: piece.map as u32,
        fixed: (content != PassContent::Moving).into(),
        moving: (content != PassContent::Static).into(),
        ..*planes
    }
}
