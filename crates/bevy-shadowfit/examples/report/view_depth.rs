//! View depths of another frame: the same image, but its points select cascades by the depths of the other
//! frame.
//!
//! The view depth of a point decides which cascades it reads, and how they are blended. To draw a point in
//! this frame's view as it looked in the previous frame, it must have the view depth of the previous frame.
//! The renderer therefore gets the view of the previous frame, and a projection from there to the clip space
//! of this frame:
//!
//! ```text
//! clip of this frame <- view of this frame <- world <- view of the frame before
//! ```
//!
//! The main world keeps its camera, so that neither culling nor fits are affected. Bevy's shader also uses
//! the eye of the previous frame for lighting.

use bevy::math::DMat4;
use bevy::prelude::*;
use bevy::render::camera::ExtractedCamera;
use bevy::render::view::ExtractedView;
use bevy::render::{Render, RenderApp, RenderSystems};

/// World from view of the frame whose view depths the renderer uses, if it is not the current frame.
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
