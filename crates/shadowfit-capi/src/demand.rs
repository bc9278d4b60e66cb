//! Visible demand: the surfaces in a depth buffer of an earlier frame.

use shadowfit::demand::{DepthPicture, VisibleDemandSpace};
use shadowfit::glam::{Mat4, Vec3};

use crate::error::Failure;
use crate::pointer::DepthRead;
use crate::state::Memory;
use crate::types::{ShadowfitDepths, ShadowfitView};
use crate::view;

/// Counts the surfaces of a depth buffer. An error leaves no counts.
pub(crate) fn count(
    memory: Memory<'_>,
    depths: &ShadowfitDepths,
    read: DepthRead,
    drawn: &ShadowfitView,
) -> Result<(), Failure> {
    let Memory { state, counts, .. } = memory;
    state.seen = None;
    let fit = &state.technique.fit;
    let (frustum, direction) = (view::frustum(drawn), Vec3::from_array(depths.light_direction));
    let space = VisibleDemandSpace::new(&frustum, direction, fit.up, fit.max_distance)?;
    let picture = DepthPicture {
        size: [depths.width, depths.height],
        clip_from_world: Mat4::from_cols_array(&drawn.clip_from_eye),
        depth: view::depth(drawn.depth)?,
        view: &frustum,
    };
    counts.fill(0);
    space.count_picture(counts, &picture, depths.step, |x, y| read.at(x, y))?;
    state.seen = Some(space);
    Ok(())
}
