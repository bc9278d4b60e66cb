//! What the last pictures showed, counted in Bevy's depth prepass and read back late, without waiting: bounds follow
//! it where a light has a single view.

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

/// A light, and a camera whose picture is counted for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct CountedView {
    pub(crate) light: Entity,
    pub(crate) camera: Entity,
}

/// Pictures that are to be counted in this frame; their rectangles are those of the cameras.
#[derive(Resource, ExtractResource, Clone, Default)]
#[extract_app(RenderApp)]
pub(crate) struct Wanted(pub(crate) Vec<(CountedView, DemandView)>);

/// What was counted last, shared by both worlds.
#[derive(Resource, Clone, Default)]
pub(crate) struct Sightings(Arc<Mutex<HashMap<CountedView, VisibleDemand>>>);

impl Sightings {
    /// The newest counts, given once.
    pub(crate) fn take(&self, key: CountedView) -> Option<VisibleDemand> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).remove(&key)
    }

    fn put(&self, key: CountedView, seen: VisibleDemand) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(key, seen);
    }
}

/// The passes that count, in the render world: one for each light and camera.
#[derive(Resource, Default)]
struct Passes {
    passes: HashMap<CountedView, DemandPass>,
    /// Whether the device cannot count.
    is_refused: bool,
}

/// Adds what counts, where the app renders.
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

/// Counts a view's depth prepass for each light that asks for it.
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
            warn_once!("what a depth prepass shows cannot be counted: {error}; cascades go by boxes");
        }
    }
    passes.passes.retain(|key, _| wanted.0.iter().any(|(wanted, _)| wanted == key));
}

impl Passes {
    /// The pass of a light and a camera; `None` where the device has none.
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
                    info!("cascades go by boxes: {error}");
                }
            }
        }
        self.passes.get_mut(&key)
    }
}

/// Hands what has come back over to the fits.
fn take(mut passes: ResMut<Passes>, sightings: Res<Sightings>) {
    for (key, pass) in &mut passes.passes {
        // A lost device is Bevy's to deal with.
        if let Ok(Some(seen)) = pass.take() {
            sightings.put(*key, seen);
        }
    }
}
