//! What is drawn into each piece of a frame, for shaders that find its casters.

use shadowfit::CasterVolume;

use super::CachedMaps;
use super::passes::shadow_piece;
use crate::cache::{PassContent, PassPlan, PiecePlan};
use crate::{Culling, CullingPiece};

impl CachedMaps {
    /// The pieces of all passes, in the order of their numbers.
    pub(crate) fn culling_pieces(&self) -> impl Iterator<Item = CullingPiece> {
        let plan = &self.plan;
        let numbers = |pass: &'_ PassPlan| pass.pieces.clone();
        plan.passes.iter().flat_map(move |pass| numbers(pass).map(move |number| (pass, number))).map(
            |(pass, number)| {
                let volumes = self.volumes_of(pass, &plan.pieces[number]).into_iter().flatten();
                CullingPiece::new(volumes, self.origin).of_piece(&shadow_piece(plan, pass, number), pass.content)
            },
        )
    }

    /// Volumes each of which holds all casters of a piece: those over its rectangle, and those that can shadow something
    /// in view, where nothing else is drawn.
    fn volumes_of(&self, pass: &PassPlan, piece: &PiecePlan) -> [Option<CasterVolume>; 2] {
        if self.culling == Culling::Off {
            return [None; 2];
        }
        let in_view = self.volumes.get(pass.map).copied();
        let over = self.maps.get(pass.map).map(|map| {
            let casters = crate::map::caster_policy(self.map.descriptor().depth_clamp);
            CasterVolume::of_part(&map.projection, casters, piece.part.window)
        });
        match pass.content {
            PassContent::All => [None, in_view],
            PassContent::Static => [over, None],
            PassContent::Moving => [over, in_view],
        }
    }
}
