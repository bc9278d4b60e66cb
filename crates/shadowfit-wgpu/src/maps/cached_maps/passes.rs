//! The passes of a frame, for the engine to draw.

use shadowfit::cache::{FramePlan, PassContent, PassPlan, PieceVolumes};

use super::CachedMaps;
use crate::CullingPiece;
use crate::maps::static_layers::Opening;

/// A pass into a map. A map that is kept unchanged has none.
#[derive(Clone, Copy, Debug)]
pub struct ShadowPass<'a> {
    pub(super) maps: &'a CachedMaps,
    pub(super) pass: &'a PassPlan,
    /// Number of its plan's first piece, among those of all sets of maps.
    first_piece: usize,
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
    /// Number of the map. While the sun [steps](crate::SunShadows::set_light_steps) two maps have the same number.
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
        let (plan, pass) = (self.maps.cache.plan(), self.pass);
        let first = self.first_piece;
        pass.pieces.clone().map(move |piece| ShadowPiece { number: first + piece, ..shadow_piece(plan, pass, piece) })
    }
}

impl<'a> ShadowPass<'a> {
    /// The pass's pieces for shaders that find their casters.
    pub(crate) fn culling_pieces(&self) -> impl Iterator<Item = CullingPiece> + use<'a> {
        let (cache, pass) = (&self.maps.cache, self.pass);
        let parts = cache.plan().pieces_of(pass).iter().map(|piece| piece.part.window);
        self.pieces().zip(parts).map(move |(piece, part)| {
            let PieceVolumes { casters, moving } = cache.piece_volumes(pass.map, pass.content, part);
            let all = CullingPiece::new([casters].into_iter().chain(moving), cache.plan().origin);
            CullingPiece {
                viewport: piece.viewport,
                scissor: piece.scissor,
                map: piece.map as u32,
                fixed: (pass.content != PassContent::Moving).into(),
                moving: (pass.content != PassContent::Static).into(),
                fixed_planes: casters.count,
                ..all
            }
        })
    }
}

impl ShadowPass<'_> {
    /// Records the pass. `draw` is called for each part that has casters.
    pub(crate) fn render(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        group: u32,
        draw: &mut impl FnMut(&mut wgpu::RenderPass<'_>, &ShadowPiece<'_>),
    ) {
        let mut opened = self.begin(encoder, group, None);
        for piece in self.pieces().filter(|piece| !piece.casters.is_empty() || !piece.standing.is_empty()) {
            piece.set(&mut opened);
            draw(&mut opened, &piece);
        }
    }

    /// Opens the pass: cleared or mended, with the map's matrix bound at `group`.
    pub(crate) fn begin<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        group: u32,
        timestamps: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'encoder> {
        let CachedMaps { map, cache, layers, .. } = self.maps;
        layers.begin(encoder, Opening { map, plan: cache.plan(), group }, self.pass, timestamps)
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
        casters: plan.casters_of(piece),
        standing: plan.standing_of(piece),
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
        self.cache.skip();
    }

    /// Number of passes of this frame.
    pub(crate) fn pass_count(&self) -> usize {
        self.cache.plan().passes.len()
    }

    /// Number of the passes' pieces.
    pub(crate) fn piece_count(&self) -> usize {
        self.cache.plan().pieces.len()
    }

    /// One of the passes, in the order in which they must be drawn. `first_piece`: number of the first piece of all.
    pub(crate) fn pass(&self, index: usize, first_piece: usize) -> ShadowPass<'_> {
        ShadowPass { maps: self, pass: &self.cache.plan().passes[index], first_piece }
    }
}
