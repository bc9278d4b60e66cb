//! Visible demand from Bevy's depth prepass, read back late, without waiting. If a light has a single view,
//! it also places the bounds.

use std::sync::{Arc, Mutex, PoisonError};

use bevy::core_pipeline::prepass::ViewPrepassTextures;
use bevy::core_pipeline::schedule::{Core3d, Core3dSystems};
use bevy::platform::collections::HashMap;
use bevy::prelude::*;
use bevy::render::camera::ExtractedCamera;
use bevy::render::extract_resource::{ExtractResource, ExtractResourcePlugin};
use bevy::render::renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::view::ExtractedView;
use bevy::render::{Render, RenderApp, RenderSystems};
use shadowfit::VisibleDemand;
use shadowfit_wgpu::demand::{DemandPass, DemandView};

/// A light, and a camera whose visible points are counted for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct CountedView {
    pub(crate) light: Entity,
    pub(crate) camera: Entity,
}

/// Views to count in this frame. Their rectangles are the cameras' viewports.
#[derive(Resource, ExtractResource, Clone, Default)]
#[extract_app(RenderApp)]
pub(crate) struct Wanted(pub(crate) Vec<(CountedView, DemandView)>);

/// Latest visible demand, shared by the main world and the render world.
#[derive(Resource, Clone, Default)]
pub(crate) struct Sightings(Arc<Mutex<HashMap<CountedView, VisibleDemand>>>);

impl Sightings {
    /// Returns the newest visible demand, only once.
    pub(crate) fn take(&self, key: CountedView) -> Option<VisibleDemand> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).remove(&key)
    }

    fn put(&self, key: CountedView, seen: VisibleDemand) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(key, seen);
    }
}

/// Counting passes in the render world: one for each light and camera.
#[derive(Resource, Default)]
struct Passes {
    passes: HashMap<CountedView, DemandPass>,
    /// Whether the device cannot count.
    is_refused: bool,
}

/// Adds the counting systems if the app renders.
pub(crate) fn add(app: &mut App) {
    let sightings = Sightings::default();
    app.insert_resource(sightings.clone()).init_resource::<Wanted>();
    if app.get_sub_app(RenderApp).is_none() {
        return;
    }
    app.add_plugins(ExtractResourcePlugin::<Wanted>::default());
    let Some(render) = app.get_sub_app_mut(RenderApp) else { return };
    render
        .insert_resource(sightings)
        .init_resource::<Passes>()
        .add_systems(Core3d, count.after(Core3dSystems::Prepass).before(Core3dSystems::MainPass))
        .add_systems(Render, take.in_set(RenderSystems::Cleanup));
}

/// Counts a view's depth prepass for each light that requests it.
fn count(
    view: ViewQuery<(&ExtractedView, &ExtractedCamera, &ViewPrepassTextures)>,
    wanted: Option<Res<Wanted>>,
    mut passes: ResMut<Passes>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    mut context: RenderContext,
) {
    let (view, camera, textures) = view.into_inner();
    let camera_entity = view.retained_view_entity.main_entity.id();
    let (Some(wanted), Some(depth)) = (wanted, textures.depth_only_view()) else { return };
    for (key, demand) in wanted.0.iter().filter(|(key, _)| key.camera == camera_entity) {
        let (corner, size) = match &camera.viewport {
            Some(part) => (part.physical_position, part.physical_size),
            None => (UVec2::ZERO, UVec2::new(depth.texture().width(), depth.texture().height())),
        };
        let demand = DemandView { rectangle: [corner.x, corner.y, size.x, size.y], ..*demand };
        let Some(pass) = passes.of(*key, depth.texture().sample_count(), &device, &queue) else { return };
        if let Err(error) = pass.record(context.command_encoder(), depth, &demand, None) {
            warn_once!("a depth prepass cannot be counted: {error}; cascades are fitted to bounding boxes");
        }
    }
    passes.passes.retain(|key, _| wanted.0.iter().any(|(wanted, _)| wanted == key));
}

impl Passes {
    /// Returns the pass of a light and a camera, or `None` if the device cannot count.
    fn of(
        &mut self,
        key: CountedView,
        samples: u32,
        device: &RenderDevice,
        queue: &RenderQueue,
    ) -> Option<&mut DemandPass> {
        if self.is_refused {
            return None;
        }
        if self.passes.get(&key).is_none_or(|pass| pass.samples() != samples) {
            match DemandPass::new(device.wgpu_device(), queue, samples) {
                Ok(pass) => _ = self.passes.insert(key, pass),
                Err(error) => {
                    self.is_refused = true;
                    info!("cascades are fitted to bounding boxes: {error}");
                }
            }
        }
        self.passes.get_mut(&key)
    }
}

/// Passes arrived counts on to the fits.
fn take(mut passes: ResMut<Passes>, sightings: Res<Sightings>) {
    for (key, pass) in &mut passes.passes {
        // Bevy handles a lost device.
        if let Ok(Some(seen)) = pass.take() {
            sightings.put(*key, seen);
        }
    }
}
