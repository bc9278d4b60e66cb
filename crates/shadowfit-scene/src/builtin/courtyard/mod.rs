//! The courtyard: a figure in the sun, among columns, posts and arches.
//!
//! It has what shadow maps have difficulty with: a face that shadows itself, thin posts and a tall pole, columns under
//! an overhanging roof, a lattice with holes, and a floor of 120 m with a metre grid to read distances from.

mod architecture;
mod body;
mod character;
mod face;
mod garden;
mod palette;
mod textures;
mod walk;

use glam::Vec3;

use super::build::{Builder, sunlight};
use crate::Scene;

/// Direction of the sun from +z toward +x, in radians.
const SUN_AZIMUTH: f32 = 0.6;
/// Height of the sun above the horizon, in radians: shadows about as long as things are tall.
const SUN_ELEVATION: f32 = 0.75;
/// Vertical field of view of the start view, in radians: a quarter of a right angle each way.
const FOV_Y: f32 = 0.785;
/// Far plane of the start view, in metres: beyond the far corners of the floor.
const FAR: f32 = 200.0;

/// The scene, as [`super::default_scene`] describes it.
pub(super) fn build() -> Scene {
    let mut builder = Builder::new("courtyard", palette::materials(), textures::images());
    let joints = character::build(&mut builder, &walk::standing());
    architecture::build(&mut builder);
    garden::build(&mut builder);
    builder.start_view(start_view(), FOV_Y, FAR);
    let mut scene = builder.scene;
    scene.subject = Some(joints.root());
    scene.animations = walk::animations(&joints);
    scene.sun = Some(sunlight(SUN_AZIMUTH, SUN_ELEVATION));
    scene
}

/// Eye and target of the start view, world positions in metres.
pub(super) fn start_view() -> (Vec3, Vec3) {
    (Vec3::new(-2.1, 1.6, 4.5), Vec3::new(1.3, 1.3, -1.0))
}

/// Adds the figure alone to another scene, with the materials that it needs: standing at the origin with its arms
/// hanging, about 1.8 m tall, facing +z. Returns its root.
pub fn figure_at_ease(builder: &mut Builder) -> usize {
    let first = builder.scene.meshes.len();
    let root = character::build(builder, &walk::at_ease()).root();
    let materials = palette::materials();
    let mut moved = vec![None; materials.len()];
    let scene = &mut builder.scene;
    for primitive in scene.meshes[first..].iter_mut().flat_map(|mesh| &mut mesh.primitives) {
        primitive.material = *moved[primitive.material].get_or_insert_with(|| {
            scene.materials.push(materials[primitive.material].clone());
            scene.materials.len() - 1
        });
    }
    root
}
