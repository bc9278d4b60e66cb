//! Effects of the plugin with a GPU: visible demand is read back, and the shader reads windows.

use std::sync::{Arc, Mutex};

use bevy::app::PluginsState;
use bevy::camera::{ImageRenderTarget, RenderTarget};
use bevy::core_pipeline::prepass::DepthPrepass;
use bevy::light::cascade::Cascades;
use bevy::light::{CascadeShadowConfig, CascadeShadowConfigBuilder};
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::gpu_readback::{Readback, ReadbackComplete};
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::render_resource::{TextureFormat, TextureUsages};
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use bevy_shadowfit::prelude::*;

/// An app without a window, its light, and its last image.
struct Stage {
    app: App,
    light: Entity,
    picture: Arc<Mutex<Vec<u8>>>,
}

/// Creates Bevy without a window.
fn app() -> App {
    let window = WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() };
    let mut plugins = DefaultPlugins.set(window).disable::<WinitPlugin>();
    if plugins.contains::<PipelinedRenderingPlugin>() {
        plugins = plugins.disable::<PipelinedRenderingPlugin>();
    }
    let mut app = App::new();
    let plugins = plugins.set(RenderPlugin { synchronous_pipeline_compilation: true, ..default() });
    app.add_plugins((plugins, ShadowfitPlugin));
    while app.plugins_state() == PluginsState::Adding {
        bevy::tasks::tick_global_task_pools_on_main_thread();
    }
    app.finish();
    app.cleanup();
    app
}

/// Creates a ground with a post and a ring. Without a fit, the light keeps Bevy's cascades. An optional
/// slanted wall behind the post hides everything beyond it. Its bounding box contains the eye, so that boxes
/// alone do not show this.
fn stage(fit: Option<Fit>, has_prepass: bool, has_wall: bool, samples: Msaa) -> Stage {
    let mut app = app();
    let world = app.world_mut();
    world.insert_resource(GlobalAmbientLight::NONE);
    // Rows of 256 bytes are read back without padding.
    let mut target = Image::new_target_texture(192, 108, TextureFormat::Rgba8UnormSrgb, None);
    target.texture_descriptor.usage |= TextureUsages::COPY_SRC;
    let target = world.resource_mut::<Assets<Image>>().add(target);
    let picture = Arc::new(Mutex::new(Vec::new()));
    let last = picture.clone();
    let keep = move |read: On<ReadbackComplete>| last.lock().unwrap().clone_from(&read.data);
    world.spawn(Readback::texture(target.clone())).observe(keep);
    let material = StandardMaterial { perceptual_roughness: 1.0, reflectance: 0.0, ..default() };
    let material = world.resource_mut::<Assets<StandardMaterial>>().add(material);
    let mut mesh = |mesh: Mesh, at: Transform| {
        let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
        world.spawn((Mesh3d(mesh), MeshMaterial3d(material.clone()), at));
    };
    mesh(Torus::new(20.0, 20.5).into(), Transform::from_xyz(0.0, 5.0, -40.0));
    mesh(Plane3d::default().mesh().size(300.0, 300.0).into(), Transform::default());
    mesh(Cuboid::new(1.0, 4.0, 1.0).into(), Transform::from_xyz(1.0, 2.0, -12.0));
    if has_wall {
        let turned = Transform::from_xyz(0.0, 0.0, -16.0).with_rotation(Quat::from_rotation_y(0.7));
        mesh(Cuboid::new(90.0, 80.0, 0.2).into(), turned);
    }
    let sun = DirectionalLight { shadow_maps_enabled: true, ..default() };
    let mut light = world.spawn((sun, Transform::default().looking_to(Vec3::new(0.4, -0.8, -0.5), Vec3::Y)));
    if let Some(fit) = fit {
        light.insert(FittedShadows { fit, ..default() });
    }
    let light = light.id();
    let target = RenderTarget::Image(ImageRenderTarget { handle: target, scale_factor: 1.0 });
    let eye = Transform::from_xyz(0.0, 2.0, 0.0).looking_at(Vec3::new(0.0, 1.0, -10.0), Vec3::Y);
    let mut camera = world.spawn((Camera3d::default(), target, samples, eye));
    if has_prepass {
        camera.insert(DepthPrepass);
    }
    for _ in 0..12 {
        app.update();
    }
    Stage { app, light, picture }
}

impl Stage {
    /// Updates until bounds differ from the given ones, which depends on when the GPU finishes, and then a
    /// little longer.
    fn bounds_other_than(mut self, given: &[f32]) -> Vec<f32> {
        for _ in 0..1000 {
            if self.bounds() != given {
                break;
            }
            self.app.update();
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        for _ in 0..12 {
            self.app.update();
        }
        self.bounds()
    }

    fn bounds(&self) -> Vec<f32> {
        self.app.world().get::<CascadeShadowConfig>(self.light).expect("a light").bounds.clone()
    }

    /// Returns the size of the finest texel, in metres.
    fn texel(&self) -> f32 {
        let cascades = self.app.world().get::<Cascades>(self.light).expect("a light");
        cascades.cascades.values().flatten().map(|cascade| cascade.texel_size).fold(f32::MAX, f32::min)
    }

    /// Returns the brightness of each pixel.
    fn brightness(&self) -> Vec<u8> {
        self.picture.lock().unwrap().as_chunks::<4>().0.iter().map(|pixel| pixel[1]).collect()
    }
}

#[test]
fn gpu_bounds_follow_what_a_depth_prepass_shows_with_and_without_multisampling() {
    let fit = Some(Fit::Histogram);
    let by_boxes = stage(fit, false, true, Msaa::Off).bounds();
    let [one, four] =
        [Msaa::Off, Msaa::Sample4].map(|samples| stage(fit, true, true, samples).bounds_other_than(&by_boxes));
    assert_ne!(one, by_boxes);
    assert_ne!(four, by_boxes);
    for (one, four) in one.iter().zip(&four) {
        assert!((one / four - 1.0).abs() < 0.2, "{one} m and {four} m");
    }
    assert_eq!(one.last(), by_boxes.last());
}

#[test]
fn gpu_every_fit_draws_the_shadows_that_bevys_own_cascades_draw() {
    let bevys = stage(None, true, false, Msaa::Off);
    let wanted = bevys.brightness();
    assert_eq!(wanted.len(), 192 * 108);
    let dark = wanted.iter().filter(|pixel| **pixel < 40).count();
    assert!(dark > 200, "{dark} dark pixels");
    for fit in [Fit::Stable, Fit::Calm, Fit::Histogram, Fit::Windows] {
        let ours = stage(Some(fit), true, false, Msaa::Off);
        let is_other = |(one, other): &(&u8, &u8)| one.abs_diff(**other) > 60;
        let different = ours.brightness().iter().zip(&wanted).filter(is_other).count();
        // Edges differ by a part of Bevy's texels.
        assert!(different < 150, "{fit:?}: {different} of {} pixels", wanted.len());
        let same_bounds = ours.bounds().iter().all(|bound| *bound == ours.bounds()[3]);
        assert_eq!(same_bounds, fit == Fit::Windows, "{:?}", ours.bounds());
        assert!(ours.texel() < bevys.texel() * 1.1, "{fit:?}: {} m to {} m", ours.texel(), bevys.texel());
    }
}

#[test]
fn gpu_windows_do_not_darken_lit_surfaces() {
    let dimmed = |fit| {
        let mut stage = stage(fit, true, false, Msaa::Off);
        let shadowed = stage.brightness();
        stage.app.world_mut().get_mut::<DirectionalLight>(stage.light).expect("a light").shadow_maps_enabled = false;
        for _ in 0..4 {
            stage.app.update();
        }
        let is_dimmed = |(dark, lit): &(&u8, &u8)| (**lit / 2..lit.saturating_sub(3)).contains(*dark);
        shadowed.iter().zip(&stage.brightness()).filter(is_dimmed).count()
    };
    // Only the soft edges of shadows are between light and shadow.
    let [bevys, windows] = [None, Some(Fit::Windows)].map(dimmed);
    assert!(bevys > 0 && windows <= bevys, "{windows} dimmed pixels, with Bevy's cascades {bevys}");
}

#[test]
fn gpu_a_single_cascade_has_the_biases_of_cascades_because_bevys_code_reads_it() {
    let mut stage = stage(Some(Fit::Windows), true, false, Msaa::Off);
    let bias =
        |stage: &Stage| stage.app.world().get::<DirectionalLight>(stage.light).expect("a light").shadow_normal_bias;
    let of_windows = bias(&stage);
    let one = CascadeShadowConfigBuilder { num_cascades: 1, ..default() }.build();
    stage.app.world_mut().entity_mut(stage.light).insert(one);
    for _ in 0..4 {
        stage.app.update();
    }
    assert!(bias(&stage) > 2.0 * of_windows, "{} and {of_windows}", bias(&stage));
}
