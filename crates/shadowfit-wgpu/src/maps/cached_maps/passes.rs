//! Passes of a frame, for the engine to draw.

use shadowfit::cache::{FramePlan, PassKind, PassPlan, RegionVolumes};

use super::CachedMaps;
use crate::CullingRegion;
use crate::maps::static_layers::Opening;

/// A pass into a map. A map that is kept unchanged has no pass.
#[derive(Clone, Copy, Debug)]
pub struct ShadowPass<'a> {
    pub(super) maps: &'a CachedMaps,
    pub(super) pass: &'a PassPlan,
    /// Number of the plan's first region in the numbering of both sets of maps.
    first_region: usize,
}

/// A region of a pass: casters that are drawn with one viewport and one scissor rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawRegion<'a> {
    /// Number of the region, counted over all passes of the frame.
    pub number: usize,
    /// Index of the map.
    pub map: usize,
    /// Left, top, width and height of the viewport, in texels. It may begin outside the texture, because maps
    /// wrap around in their layers.
    pub viewport: [f32; 4],
    /// Left, top, width and height of the scissor rectangle, in texels.
    pub scissor: [u32; 4],
    /// Numbers of the casters to draw from the list ([`SunFrame::casters`](crate::SunFrame::casters)),
    /// nearest to the light first, so that hidden casters cost least.
    pub casters: &'a [u32],
    /// Numbers of the static casters to draw from the hierarchy
    /// ([`SunFrame::static_boxes`](crate::SunFrame::static_boxes)), also nearest first.
    pub static_boxes: &'a [u32],
}

impl<'a> ShadowPass<'a> {
    /// Returns the index of the map. During a [light step](crate::SunShadows::set_light_steps) two maps have
    /// the same index.
    pub fn map(&self) -> usize {
        self.pass.map
    }

    /// Returns the kind of casters that the pass draws.
    pub fn content(&self) -> PassKind {
        self.pass.content
    }

    /// Returns whether the whole layer is cleared, because no part of it can be kept.
    pub fn is_cleared(&self) -> bool {
        self.pass.clears
    }

    /// Returns the regions of the pass.
    pub fn regions(&self) -> impl ExactSizeIterator<Item = DrawRegion<'a>> + use<'a> {
        let (plan, pass) = (self.maps.cache.plan(), self.pass);
        let first = self.first_region;
        pass.regions.clone().map(move |region| DrawRegion { number: first + region, ..draw_region(plan, pass, region) })
    }
}

impl<'a> ShadowPass<'a> {
    /// Returns the pass's regions for shaders that cull casters.
    pub(crate) fn culling_regions(&self) -> impl Iterator<Item = CullingRegion> + use<'a> {
        let (cache, pass) = (&self.maps.cache, self.pass);
        let parts = cache.plan().regions_of(pass).iter().map(|region| region.part.window);
        self.regions().zip(parts).map(move |(region, part)| {
            let RegionVolumes { casters, moving } = cache.region_volumes(pass.map, pass.content, part);
            let all = CullingRegion::new([casters].into_iter().chain(moving), cache.plan().origin);
            CullingRegion {
                viewport: region.viewport,
                scissor: region.scissor,
                map: region.map as u32,
                fixed: (pass.content != PassKind::Moving).into(),
                moving: (pass.content != PassKind::Static).into(),
                fixed_planes: casters.count,
                ..all
            }
        })
    }
}

impl ShadowPass<'_> {
    /// Records the pass. `draw` is called for each region that has casters.
    pub(crate) fn render(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        group: u32,
        draw: &mut impl FnMut(&mut wgpu::RenderPass<'_>, &DrawRegion<'_>),
    ) {
        let mut opened = self.begin(encoder, group, None);
        for region in self.regions().filter(|region| !region.casters.is_empty() || !region.static_boxes.is_empty()) {
            region.set(&mut opened);
            draw(&mut opened, &region);
        }
    }

    /// Opens the pass: clears or restores the layer, and binds the map's matrix at `group`.
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

fn draw_region<'a>(plan: &'a FramePlan, pass: &PassPlan, number: usize) -> DrawRegion<'a> {
    let region = &plan.regions[number];
    let (first, stored) = (region.part.viewport(), region.part.stored);
    DrawRegion {
        number,
        map: pass.map,
        viewport: [first.x as f32, first.y as f32, pass.size.x as f32, pass.size.y as f32],
        scissor: [stored.min.x, stored.min.y, stored.size.x, stored.size.y],
        casters: plan.casters_of(region),
        static_boxes: plan.static_boxes_of(region),
    }
}

impl DrawRegion<'_> {
    /// Sets the viewport and the scissor rectangle.
    pub fn set(&self, pass: &mut wgpu::RenderPass<'_>) {
        let [x, y, width, height] = self.viewport;
        pass.set_viewport(x, y, width, height, 0.0, 1.0);
        let [x, y, width, height] = self.scissor;
        pass.set_scissor_rect(x, y, width, height);
    }
}

impl CachedMaps {
    /// Gives the frame no passes.
    pub(crate) fn skip(&mut self) {
        self.cache.skip();
    }

    /// Returns the number of passes of this frame.
    pub(crate) fn pass_count(&self) -> usize {
        self.cache.plan().passes.len()
    }

    /// Returns the number of regions of all passes.
    pub(crate) fn piece_count(&self) -> usize {
        self.cache.plan().regions.len()
    }

    /// Returns one of the passes in draw order. `first_region` is the number of this set's first region.
    pub(crate) fn pass(&self, index: usize, first_region: usize) -> ShadowPass<'_> {
        ShadowPass { maps: self, pass: &self.cache.plan().passes[index], first_region }
    }
}
