//! Visible demand: the surfaces in a depth buffer of an earlier frame, counted here or by the demand shader.

use shadowfit::ViewFrustum;
use shadowfit::demand::{DepthPicture, VisibleDemandSpace};
use shadowfit::glam::{Mat4, Vec3, Vec4};
use shadowfit::uniform::DemandUniform;

use crate::error::Failure;
use crate::pointer::{DepthRead, GivenCounts};
use crate::state::{Memory, State};
use crate::types::{ShadowfitDepths, ShadowfitView};
use crate::view;

/// A depth buffer of the caller, without its depths.
pub(crate) struct DepthBuffer {
    view: ViewFrustum,
    depth: shadowfit::DepthConvention,
    clip_from_eye: Mat4,
    light_direction: Vec3,
    size: [u32; 2],
    step: u32,
    is_bottom_up: bool,
}

impl DepthBuffer {
    pub(crate) fn new(depths: &ShadowfitDepths, drawn: &ShadowfitView) -> Result<Self, Failure> {
        Ok(Self {
            view: view::frustum(drawn),
            depth: view::depth(drawn.depth)?,
            clip_from_eye: Mat4::from_cols_array(&drawn.clip_from_eye),
            light_direction: Vec3::from_array(depths.light_direction),
            size: [depths.width, depths.height],
            step: depths.step,
            is_bottom_up: depths.row_stride < 0,
        })
    }

    fn space(&self, state: &State) -> Result<VisibleDemandSpace, Failure> {
        let fit = &state.technique.fit;
        Ok(VisibleDemandSpace::new(&self.view, self.light_direction, fit.up, fit.max_distance)?)
    }

    fn picture(&self, clip_from_world: Mat4) -> DepthPicture<'_> {
        DepthPicture { size: self.size, clip_from_world, depth: self.depth, view: &self.view }
    }

    /// Counts the surfaces. An error leaves no counts.
    pub(crate) fn count(&self, memory: Memory<'_>, read: DepthRead) -> Result<(), Failure> {
        let Memory { state, counts, .. } = memory;
        state.seen = None;
        let space = self.space(state)?;
        counts.fill(0);
        space.count_picture(counts, &self.picture(self.clip_from_eye), self.step, |x, y| read.at(x, y))?;
        state.seen = Some(space);
        Ok(())
    }

    /// Returns the block of the demand shader. Textures whose rows begin at the bottom are pictures that are turned
    /// over.
    pub(crate) fn uniform(&self, state: &State) -> Result<DemandUniform, Failure> {
        let turn = Mat4::from_diagonal(Vec4::new(1.0, -1.0, 1.0, 1.0));
        let clip_from_eye = if self.is_bottom_up { turn * self.clip_from_eye } else { self.clip_from_eye };
        let space = self.space(state)?;
        Ok(DemandUniform::new(&self.picture(clip_from_eye), &space, self.step.max(1), [0, 0])?)
    }

    /// Sets the counts of the demand shader.
    pub(crate) fn set_counts(&self, memory: Memory<'_>, given: &GivenCounts) -> Result<(), Failure> {
        let Memory { state, counts, .. } = memory;
        state.seen = None;
        let space = self.space(state)?;
        given.copy(counts);
        state.seen = Some(space);
        Ok(())
    }
}
