//! View depths of another frame: the same picture, but its points choose among cascades as they did there.
//!
//! Which cascades a point reads, and how they are blended, follows from its depth in the view. What a point looked like
//! in the frame before can only be drawn in the view of this frame if it has the depth that it had in that one. So the
//! renderer gets the view of the frame before, and a projection from there to where this frame's camera sees the point:
//!
//! ```text
//! clip of this frame <- view of this frame <- world <- view of the frame before
//! ```
//!
//! The main world keeps its camera, so that neither culling nor fits see anything of it. The eye that Bevy's shader
//! lights for is that of the frame before, too.

use bevy::math::DMat4;
use bevy::prelude::*;
use bevy::render::camera::ExtractedCamera;
use bevy::render::view::ExtractedView;
use bevy::render::{Render, RenderApp, RenderSystems};

/// World from view of the frame whose view depths the renderer takes, if they are not its own.
#[derive(Resource, Default)]
pub(crate) struct ViewDepthsOf(pub(crate) Option<DMat4>);

/// Adds the system to the renderer.
pub(crate) fn plugin(app: &mut App) {
    let Some(renderer) = app.get_sub_app_mut(RenderApp) else { return };
    let when = replace.after(RenderSystems::ExtractCommands).before(RenderSystems::PrepareAssets);
    renderer.init_resource::<ViewDepthsOf>().add_systems(Render, when);
}

fn replace(other: Res<ViewDepthsOf>, mut views: Query<&mut ExtractedView, With<ExtractedCamera>>) {
    let Some(world_from_other) = other.0 else { return };
    for mut view in &mut views {
        let view_from_world = view.world_from_view.to_matrix().as_dmat4().inverse();
        let clip_from_world = view.clip_from_view.as_dmat4() * view_from_world;
        view.clip_from_world = Some(clip_from_world.as_mat4());
        view.clip_from_view = (clip_from_world * world_from_other).as_mat4();
        view.world_from_view = GlobalTransform::from(world_from_other.as_mat4());
    }
}
