//! The passes of a frame, for the engine to draw.

use super::CachedMaps;
use crate::cache::{FramePlan, PassContent, PassPlan};
use crate::layers::Opening;

/// A pass into a map. A map that is kept unchanged has none.
#[derive(Clone, Copy, Debug)]
pub struct ShadowPass<'a> {
    pub(super) maps: &'a CachedMaps,
    pub(super) pass: &'a PassPlan,
}

/// A part of a pass: the casters that are drawn with one viewport and within one scissor rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowPiece<'a> {
    /// Number of the piece among those of all passes of the frame.
    pub number: usize,
    /// Number of the map.
    pub map: usize,
    /// Left, top, width and height of the viewport, in texels. It may begin outside the texture: maps wrap around in
    /// their layers.
    pub viewport: [f32; 4],
    /// Left, top, width and height of the scissor rectangle, in texels.
    pub scissor: [u32; 4],
    /// The casters of the list to draw, by number, nearest to the light first, so that those behind others cost least.
    pub casters: &'a [u32],
    /// The standing casters to draw ([`SunFrame::standing`](crate::SunFrame::standing)), by their numbers in the tree,
    /// likewise.
    pub standing: &'a [u32],
}

impl<'a> ShadowPass<'a> {
    /// Number of the map.
    pub fn map(&self) -> usize {
        self.pass.map
    }

    /// What it draws.
    pub fn content(&self) -> PassContent {
        self.pass.content
    }

    /// Whether the whole layer is cleared, because no part of it can be kept.
    pub fn is_cleared(&self) -> bool {
        self.pass.clears
    }

    /// Its parts.
    pub fn pieces(&self) -> impl ExactSizeIterator<Item = ShadowPiece<'a>> + use<'a> {
        let (plan, pass) = (&self.maps.plan, self.pass);
        pass.pieces.clone().map(move |number| shadow_piece(plan, pass, number))
    }
}

fn shadow_piece<'a>(plan: &'a FramePlan, pass: &PassPlan, number: usize) -> ShadowPiece<'a> {
    let piece = &plan.pieces[number];
    let (first, stored) = (piece.part.viewport(), piece.part.stored);
    ShadowPiece {
        number,
        map: pass.map,
        viewport: [first.x as f32, first.y as f32, pass.size.x as f32, pass.size.y as f32],
        scissor: [stored.min.x, stored.min.y, stored.size.x, stored.size.y],
        casters: &plan.casters[piece.casters.clone()],
        standing: &plan.standing[piece.standing.clone()],
    }
}

impl ShadowPiece<'_> {
    /// Sets viewport and scissor rectangle.
    pub fn set(&self, pass: &mut wgpu::RenderPass<'_>) {
        let [x, y, width, height] = self.viewport;
        pass.set_viewport(x, y, width, height, 0.0, 1.0);
        let [x, y, width, height] = self.scissor;
        pass.set_scissor_rect(x, y, width, height);
    }
}

impl CachedMaps {
    /// Leaves the frame without passes.
    pub(crate) fn skip(&mut self) {
        self.plan.clear();
    }

    /// The passes of this frame, in the order in which they must be drawn.
    pub(crate) fn passes(&self) -> impl ExactSizeIterator<Item = ShadowPass<'_>> {
        self.plan.passes.iter().map(|pass| ShadowPass { maps: self, pass })
    }

    /// Records all passes of this frame. `draw` is called for each part that has casters: it sets the engine's
    /// pipeline and buffers, and draws the part's casters. The map's matrix is bound at `group`; viewport and scissor
    /// rectangle are set, and must stay.
    pub(crate) fn render(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        group: u32,
        mut draw: impl FnMut(&mut wgpu::RenderPass<'_>, &ShadowPiece<'_>),
    ) {
        for pass in self.passes() {
            let mut opened = self.begin_pass(encoder, &pass, group, None);
            for piece in pass.pieces().filter(|piece| !piece.casters.is_empty() || !piece.standing.is_empty()) {
                piece.set(&mut opened);
                draw(&mut opened, &piece);
            }
        }
    }

    /// Opens a pass, for engines that schedule passes themselves: cleared or mended, with the map's matrix bound at
    /// `group`. Each of its pieces is then [set](ShadowPiece::set) and drawn.
    pub(crate) fn begin_pass<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        pass: &ShadowPass<'_>,
        group: u32,
        timestamps: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'encoder> {
        let opening = Opening { map: &self.map, plan: &pass.maps.plan, group };
        self.layers.begin(encoder, opening, pass.pass, timestamps)
    }
}
