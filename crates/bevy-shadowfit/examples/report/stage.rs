//! A Bevy app without a window that draws one image per update, and reads it back before the next one.
//!
//! Bevy's pipelined renderer is disabled. An update draws the main world's state at its end. Only then is the
//! copy of the image submitted and waited for. So an image always belongs to the camera and the light that
//! were set before its update.

use anyhow::{Result, anyhow};
use bevy::app::PluginsState;
use bevy::asset::RenderAssetUsages;
use bevy::camera::{Hdr, ImageRenderTarget, RenderTarget};
use bevy::core_pipeline::prepass::DepthPrepass;
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::light::{CascadeShadowConfig, DirectionalLightShadowMap, ShadowFilteringMethod};
use bevy::log::{Level, LogPlugin};
use bevy::math::DMat4;
use bevy::mesh::PrimitiveTopology;
use bevy::prelude::*;
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::render_asset::RenderAssets;
use bevy::render::render_resource::{
    BufferDescriptor, BufferUsages, CommandEncoderDescriptor, MapMode, PollType, TexelCopyBufferInfo,
    TexelCopyBufferLayout, TextureFormat, TextureUsages,
};
use bevy::render::renderer::{RenderDevice, RenderQueue};
use bevy::render::texture::GpuImage;
use bevy::render::{RenderApp, RenderPlugin};
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use bevy_shadowfit::{Fit, FittedShadows};
use shadowfit_report::geometry::Corners;
use shadowfit_report::peers::Frame;

use crate::entrant::{Cascades, Entrant, Splits};
use crate::light_maps::{self, Frozen, Live, Sun};
use crate::sun_maps::SunMaps;
use crate::view_depth::{self, ViewDepthsOf};

/// Bytes per pixel of the image: four f32.
const PIXEL_BYTES: u32 = 16;
/// Updates after a scene has been set, until all its meshes are on the GPU.
const SCENE_UPDATES: u32 = 4;
/// Updates after a light has windows for the first time, until Bevy's shader reads them.
const SHADER_UPDATES: u32 = 20;

/// The app and its scene.
pub(crate) struct Stage {
    app: App,
    camera: Entity,
    picture: Handle<Image>,
    material: Handle<StandardMaterial>,
    settings: StageSettings,
    objects: Vec<Entity>,
    sun: Option<Entity>,
    /// Whether Bevy's shader has been extended for windows.
    reads_windows: bool,
    /// Number of updates so far. Each one drew the view.
    pub(crate) updates: u64,
}

/// Settings that are the same for all images.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StageSettings {
    /// Width and height of images, in pixels.
    pub(crate) size: [u32; 2],
    /// Width and height of each shadow map, in texels.
    pub(crate) map_size: u32,
    pub(crate) filter: ShadowFilteringMethod,
    pub(crate) splits: Splits,
    /// Depth bias of lights with Bevy's bias, in metres.
    pub(crate) depth_bias: f32,
    /// Normal bias of lights with Bevy's bias, in diagonals of a texel.
    pub(crate) normal_bias: f32,
}

impl Stage {
    /// Starts Bevy with an empty scene.
    pub(crate) fn new(settings: &StageSettings) -> Self {
        let mut app = new_app();
        app.insert_resource(GlobalAmbientLight::NONE)
            .insert_resource(DirectionalLightShadowMap { size: settings.map_size as usize })
            .insert_resource(ClearColor(Color::BLACK))
            .add_plugins((bevy_shadowfit::ShadowfitPlugin, light_maps::plugin, view_depth::plugin));
        while app.plugins_state() == PluginsState::Adding {
            bevy::tasks::tick_global_task_pools_on_main_thread();
        }
        app.finish();
        app.cleanup();
        let world = app.world_mut();
        let picture = add_picture(world, settings.size);
        let target = ImageRenderTarget { handle: picture.clone(), scale_factor: 1.0 };
        let plain = (Hdr, Msaa::Off, Tonemapping::None, DebandDither::Disabled, settings.filter);
        let camera = world.spawn((Camera3d::default(), RenderTarget::Image(target), plain)).id();
        let material = world.resource_mut::<Assets<StandardMaterial>>().add(white());
        Self {
            app,
            camera,
            picture,
            material,
            settings: *settings,
            objects: Vec::new(),
            sun: None,
            reads_windows: false,
            updates: 0,
        }
    }

    /// Replaces the scene.
    pub(crate) fn set_scene(&mut self, objects: &[Vec<Corners>]) {
        let world = self.app.world_mut();
        for object in self.objects.drain(..) {
            world.despawn(object);
        }
        for object in objects.iter().filter(|object| !object.is_empty()) {
            let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh(object));
            let parts = (Mesh3d(mesh), MeshMaterial3d(self.material.clone()), Transform::IDENTITY);
            self.objects.push(world.spawn(parts).id());
        }
        for _ in 0..SCENE_UPDATES {
            self.update();
        }
    }

    /// Updates until Bevy's shader can read windows. A temporary light with windows triggers the extension.
    fn wait_for_windows(&mut self) {
        let fitted = FittedShadows { fit: Fit::Windows, ..default() };
        let light = self.app.world_mut().spawn((DirectionalLight::default(), fitted)).id();
        self.settle(SHADER_UPDATES);
        self.app.world_mut().despawn(light);
        self.reads_windows = true;
    }

    /// Replaces the light, and thereby resets the memory of fits.
    pub(crate) fn set_light(&mut self, frame: &Frame, entrant: Entrant) {
        if entrant.cascades == Cascades::Windows && !self.reads_windows {
            self.wait_for_windows();
        }
        let world = self.app.world_mut();
        if let Some(sun) = self.sun.take() {
            world.despawn(sun);
        }
        let [x, y, z] = frame.light_dir.map(|part| part as f32);
        let light = DirectionalLight {
            shadow_maps_enabled: true,
            shadow_depth_bias: self.settings.depth_bias,
            shadow_normal_bias: self.settings.normal_bias,
            ..default()
        };
        let toward = Transform::default().looking_to(Vec3::new(x, y, z), Vec3::Y);
        let mut sun = world.spawn((Sun, light, Entrant::config(frame.far as f32).build(), toward));
        entrant.take(&mut sun, self.settings.splits);
        self.sun = Some(sun.id());
        let mut camera = world.entity_mut(self.camera);
        camera.remove::<DepthPrepass>();
        if entrant.reads_depth() {
            camera.insert(DepthPrepass);
        }
    }

    /// Moves the camera to the pose of a frame.
    pub(crate) fn set_camera(&mut self, frame: &Frame) {
        let world_from_view = frame.view_from_world().inverse().to_cols_array().map(|number| number as f32);
        let projection = PerspectiveProjection {
            fov: frame.fov_y_deg.to_radians() as f32,
            aspect_ratio: frame.aspect as f32,
            near: frame.near as f32,
            far: frame.far as f32,
            ..default()
        };
        let pose = Transform::from_matrix(Mat4::from_cols_array(&world_from_view));
        let mut camera = self.app.world_mut().entity_mut(self.camera);
        camera.insert((pose, Projection::Perspective(projection)));
    }

    /// Updates the app this many times, as a game would with a still camera.
    pub(crate) fn settle(&mut self, updates: u32) {
        for _ in 0..updates {
            self.update();
        }
    }

    /// Updates once and returns the image: red channels, in rows from the top.
    pub(crate) fn draw(&mut self) -> Result<Vec<f32>> {
        self.update();
        self.read_back()
    }

    /// Draws the image without shadows.
    pub(crate) fn draw_unshadowed(&mut self) -> Result<Vec<f32>> {
        self.set_shadows(false);
        let picture = self.draw();
        self.set_shadows(true);
        picture
    }

    /// Makes points select cascades by their view depth in another frame, if there is one, in all images from
    /// now on.
    pub(crate) fn set_view_depths(&mut self, other: Option<&Frame>) {
        let world_from_view = |frame: &Frame| DMat4::from_cols_array(&frame.view).inverse();
        let renderer = self.app.sub_app_mut(RenderApp).world_mut();
        renderer.resource_mut::<ViewDepthsOf>().0 = other.map(world_from_view);
    }

    /// Draws the image with the maps of another frame instead of the light's own.
    pub(crate) fn draw_with(&mut self, maps: &SunMaps) -> Result<Vec<f32>> {
        self.app.world_mut().resource_mut::<Frozen>().0 = Some(maps.clone());
        let picture = self.draw();
        self.app.world_mut().resource_mut::<Frozen>().0 = None;
        let live = self.maps()?;
        let mut sun = self.sun();
        let (mut config, mut light) =
            sun.get_components_mut::<(&mut CascadeShadowConfig, &mut DirectionalLight)>().expect("a light's parts");
        light_maps::put(&live, &mut config, &mut light);
        picture
    }

    /// Returns the light's own maps in the last update.
    pub(crate) fn maps(&self) -> Result<SunMaps> {
        let live = &self.app.world().resource::<Live>().0;
        live.clone().ok_or_else(|| anyhow!("Bevy computed no cascades for the camera"))
    }

    /// Returns the width of each shadow map in texels.
    pub(crate) fn map_size(&self) -> u32 {
        self.settings.map_size
    }

    fn sun(&mut self) -> EntityWorldMut<'_> {
        self.app.world_mut().entity_mut(self.sun.expect("a light was set"))
    }

    fn set_shadows(&mut self, is_on: bool) {
        self.sun().get_mut::<DirectionalLight>().expect("a light").shadow_maps_enabled = is_on;
    }

    fn update(&mut self) {
        self.app.update();
        self.updates += 1;
    }

    /// Returns the red channels of the last update's image.
    fn read_back(&self) -> Result<Vec<f32>> {
        let world = self.app.sub_app(RenderApp).world();
        let (device, queue) = (world.resource::<RenderDevice>(), world.resource::<RenderQueue>());
        let pictures = world.resource::<RenderAssets<GpuImage>>();
        let picture = pictures.get(&self.picture).ok_or_else(|| anyhow!("Bevy drew no image"))?;
        let [width, height] = self.settings.size;
        let row_bytes = RenderDevice::align_copy_bytes_per_row((width * PIXEL_BYTES) as usize);
        let buffer = device.create_buffer(&BufferDescriptor {
            label: Some("picture"),
            size: (row_bytes * height as usize) as u64,
            usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row_bytes as u32), rows_per_image: None };
        let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor { label: Some("picture") });
        encoder.copy_texture_to_buffer(
            picture.texture.as_image_copy(),
            TexelCopyBufferInfo { buffer: &buffer, layout },
            picture.texture_descriptor.size,
        );
        queue.submit([encoder.finish()]);
        let slice = buffer.slice(..);
        slice.map_async(MapMode::Read, |_| ());
        device.poll(PollType::wait_indefinitely())?;
        let bytes = slice.get_mapped_range()?;
        let pixels = bytes.chunks(row_bytes).flat_map(|row| row[..(width * PIXEL_BYTES) as usize].chunks(16));
        Ok(pixels.map(|pixel| f32::from_le_bytes([pixel[0], pixel[1], pixel[2], pixel[3]])).collect())
    }
}

/// Creates Bevy without a window, an event loop or a render thread.
fn new_app() -> App {
    let window = WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() };
    let log = LogPlugin { level: Level::WARN, ..default() };
    let mut plugins = DefaultPlugins.set(window).set(log).disable::<WinitPlugin>();
    if plugins.contains::<PipelinedRenderingPlugin>() {
        plugins = plugins.disable::<PipelinedRenderingPlugin>();
    }
    let mut app = App::new();
    app.add_plugins(plugins.set(RenderPlugin { synchronous_pipeline_compilation: true, ..default() }));
    app
}

/// Creates the image that the camera draws into.
fn add_picture(world: &mut World, [width, height]: [u32; 2]) -> Handle<Image> {
    let mut image = Image::new_target_texture(width, height, TextureFormat::Rgba32Float, None);
    image.texture_descriptor.usage |= TextureUsages::COPY_SRC;
    world.resource_mut::<Assets<Image>>().add(image)
}

/// Creates the mesh of an object. Its normals are perpendicular to its triangles, as for rays.
fn mesh(object: &[Corners]) -> Mesh {
    let positions: Vec<[f32; 3]> = object.iter().flatten().map(|corner| corner.to_array()).collect();
    let normal = |[a, b, c]: &Corners| {
        let [a, b, c] = [a, b, c].map(|corner| corner.as_dvec3());
        (b - a).cross(c - a).normalize_or(shadowfit::glam::DVec3::Y).as_vec3().to_array()
    };
    let normals: Vec<[f32; 3]> = object.iter().flat_map(|triangle| [normal(triangle); 3]).collect();
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
}

/// Creates the material of all triangles: it reflects light from both sides and casts shadows with both.
fn white() -> StandardMaterial {
    StandardMaterial {
        base_color: Color::WHITE,
        perceptual_roughness: 1.0,
        metallic: 0.0,
        reflectance: 0.0,
        cull_mode: None,
        double_sided: true,
        ..default()
    }
}
