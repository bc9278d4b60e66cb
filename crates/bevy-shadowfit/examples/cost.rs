//! Measures the cost per frame of the plugin's system, and of Bevy's cascade system before it: medians over a
//! camera path, for growing numbers of meshes. Runs without a window or a GPU.
//!
//! ```text
//! cargo run --release --example cost
//! ```

use std::time::{Duration, Instant};

use bevy::asset::AssetPlugin;
use bevy::camera::CameraPlugin;
use bevy::camera::primitives::Aabb;
use bevy::camera::visibility::{VisibilitySystems, VisibleEntities};
use bevy::light::cascade::build_directional_light_cascades;
use bevy::light::{DirectionalLight, LightPlugin, SimulationLightSystems};
use bevy::mesh::MeshPlugin;
use bevy::prelude::*;
use bevy_shadowfit::prelude::*;

const FRAMES: usize = 400;

/// Times of the systems in each frame.
#[derive(Resource)]
struct Times {
    start: Instant,
    ours: Vec<Duration>,
    bevys: Vec<Duration>,
}

fn main() {
    println!(
        "| objects | in view | fit | ours, median, ms | ours, 95%, ms | Bevy's own, median, ms |\n|--|--|--|--|--|--|"
    );
    for side in [14, 32, 100] {
        for fit in [Fit::Stable, Fit::Calm, Fit::Histogram] {
            let mut app = app(side, fit);
            for frame in 0..FRAMES {
                fly(&mut app, frame, side);
                app.update();
            }
            let times = app.world_mut().remove_resource::<Times>().expect("it was inserted");
            let in_view = in_view(&mut app);
            let [ours, most] = [0.5, 0.95].map(|share| quantile(&times.ours, share));
            let bevys = quantile(&times.bevys, 0.5);
            println!("| {} | {in_view} | {fit:?} | {ours:.3} | {most:.3} | {bevys:.3} |", side * side + 1);
        }
    }
}

fn app(side: usize, fit: Fit) -> App {
    let mut app = App::new();
    let light = (TransformPlugin, AssetPlugin::default(), MeshPlugin, CameraPlugin, LightPlugin);
    app.add_plugins((MinimalPlugins, light, ShadowfitPlugin)).init_asset::<Image>();
    app.insert_resource(Times { start: Instant::now(), ours: Vec::new(), bevys: Vec::new() });
    let before_bevys = start.before(build_directional_light_cascades).after(TransformSystems::Propagate);
    let after_bevys = end_of_bevys.after(build_directional_light_cascades);
    let before_ours = start.after(end_of_bevys).after(VisibilitySystems::CheckVisibility).before(ShadowfitSystems::Fit);
    let after_ours = end_of_ours.after(ShadowfitSystems::Fit).before(SimulationLightSystems::UpdateLightFrusta);
    app.add_systems(PostUpdate, (before_bevys, after_bevys, before_ours, after_ours));
    spawn(&mut app, side, fit);
    app.finish();
    app.cleanup();
    app
}

fn start(mut times: ResMut<Times>) {
    times.start = Instant::now();
}

fn end_of_bevys(mut times: ResMut<Times>) {
    let taken = times.start.elapsed();
    times.bevys.push(taken);
}

fn end_of_ours(mut times: ResMut<Times>) {
    let taken = times.start.elapsed();
    times.ours.push(taken);
}

/// Spawns a city of boxes on a ground, each with a different rotation.
fn spawn(app: &mut App, side: usize, fit: Fit) {
    let world = app.world_mut();
    let mesh = |half: Vec3| (Mesh3d::default(), Aabb { center: Vec3::ZERO.into(), half_extents: half.into() });
    let reach = side as f32 * 3.0;
    world.spawn((mesh(Vec3::new(reach, 0.1, reach)), Transform::default()));
    for i in 0..side * side {
        let (x, z) = ((i % side) as f32 * 6.0 - reach, (i / side) as f32 * 6.0 - reach);
        let height = 1.0 + (i * 7 % 11) as f32 * 0.7;
        let turn = Quat::from_rotation_y(i as f32);
        world.spawn((mesh(Vec3::new(1.5, height, 1.0)), Transform::from_xyz(x, height, z).with_rotation(turn)));
    }
    let sun = DirectionalLight { shadow_maps_enabled: true, ..default() };
    let at = Transform::default().looking_to(Vec3::new(0.5, -0.8, 0.2), Vec3::Y);
    world.spawn((sun, FittedShadows { fit, ..default() }, at));
    let lens = PerspectiveProjection { aspect_ratio: 16.0 / 9.0, fov: 1.0, ..default() };
    world.spawn((Camera3d::default(), Projection::Perspective(lens), Transform::default()));
}

fn fly(app: &mut App, frame: usize, side: usize) {
    let share = frame as f32 / FRAMES as f32;
    let eye = Vec3::new(share * 4.0 - 2.0, 6.0, side as f32 * 3.0 * (1.0 - share));
    let to = eye + Quat::from_rotation_y((share * 20.0).sin() * 0.5) * Vec3::new(0.0, -0.15, -1.0);
    let mut cameras = app.world_mut().query_filtered::<&mut Transform, With<Camera3d>>();
    for mut transform in cameras.iter_mut(app.world_mut()) {
        *transform = Transform::from_translation(eye).looking_at(to, Vec3::Y);
    }
}

fn in_view(app: &mut App) -> usize {
    let world = app.world_mut();
    let mut cameras = world.query::<&VisibleEntities>();
    cameras.iter(world).map(|visible| visible.len(std::any::TypeId::of::<Mesh3d>())).sum()
}

fn quantile(times: &[Duration], share: f32) -> f64 {
    let mut times = times.to_vec();
    times.sort();
    times.get((times.len() as f32 * share) as usize).map_or(0.0, |time| time.as_secs_f64() * 1e3)
}
