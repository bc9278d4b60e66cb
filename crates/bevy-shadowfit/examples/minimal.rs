//! The minimum that a user adds: the plugin, and [`FittedShadows`] on the sun.
//!
//! ```text
//! cargo run --example minimal
//! ```

use bevy::prelude::*;
use bevy_shadowfit::prelude::*;

fn main() {
    App::new().add_plugins((DefaultPlugins, ShadowfitPlugin)).add_systems(Startup, spawn).run();
}

fn spawn(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, mut materials: ResMut<Assets<StandardMaterial>>) {
    let sun = DirectionalLight { shadow_maps_enabled: true, illuminance: 8_000.0, ..default() };
    let down = Transform::default().looking_to(Vec3::new(0.4, -0.8, -0.5), Vec3::Y);
    commands.spawn((sun, FittedShadows::default(), down));

    let (grey, red) = (materials.add(Color::srgb(0.6, 0.6, 0.6)), materials.add(Color::srgb(0.7, 0.2, 0.15)));
    let ground = meshes.add(Plane3d::default().mesh().size(200.0, 200.0));
    commands.spawn((Mesh3d(ground), MeshMaterial3d(grey)));
    let post = meshes.add(Cuboid::new(0.4, 4.0, 0.4));
    for i in 0..100 {
        let at = Transform::from_xyz((i % 10) as f32 * 4.0 - 18.0, 2.0, (i / 10) as f32 * -6.0);
        commands.spawn((Mesh3d(post.clone()), MeshMaterial3d(red.clone()), at));
    }
    let eye = Transform::from_xyz(0.0, 3.0, 12.0).looking_at(Vec3::new(0.0, 1.0, -10.0), Vec3::Y);
    // With the depth prepass, the fit uses the visible points; without it, bounding boxes.
    commands.spawn((Camera3d::default(), bevy::core_pipeline::prepass::DepthPrepass, eye));
}
