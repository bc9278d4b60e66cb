//! The wanderer: a jointed figure about 1.8 m tall that stands, walks and turns.

mod body;
mod face;
mod posture;
mod rig;
mod walk;
mod wear;

use super::build::Builder;
use crate::{Animation, Scene};
use posture::{Posture, at_ease, standing};
use rig::{JOINTS, Joints, RIG};
pub(crate) use wear::Wear;

/// Adds the figure to a scene, standing at the origin and facing +z, a hand on its hip. `paint` returns the
/// scene's material for each material of [`Wear`]. Returns the figure's root and its animations, "walk" and
/// "turn".
pub(crate) fn wanderer(builder: &mut Builder, paint: impl Fn(usize) -> usize) -> (usize, Vec<Animation>) {
    let joints = build(builder, &standing(), |_, wear| paint(wear));
    (joints.root(), walk::animations(&joints))
}

/// Adds the figure and its materials to another scene: standing at the origin with its arms hanging, about
/// 1.8 m tall, facing +z. Returns its root.
pub fn figure_at_ease(builder: &mut Builder) -> usize {
    let materials = Wear::all();
    let mut added = vec![None; materials.len()];
    let joints = build(builder, &at_ease(), |scene, wear| {
        *added[wear].get_or_insert_with(|| {
            scene.materials.push(materials[wear].clone());
            scene.materials.len() - 1
        })
    });
    joints.root()
}

/// Adds nodes and meshes of the figure in a posture. `paint` returns the scene's material for each material
/// of [`Wear`].
fn build(builder: &mut Builder, posture: &Posture, mut paint: impl FnMut(&mut Scene, usize) -> usize) -> Joints {
    let rest = posture.transforms();
    let mut nodes = [0; JOINTS];
    for (joint, bone) in RIG.iter().enumerate() {
        let parent = bone.parent.map(|parent| nodes[parent as usize]);
        nodes[joint] = builder.node(bone.name, parent, rest[joint], None);
    }
    for (joints, name, mut primitives) in body::meshes().into_iter().chain([face::mesh()]) {
        for primitive in &mut primitives {
            primitive.material = paint(&mut builder.scene, primitive.material);
        }
        let mesh = builder.mesh(name, primitives);
        for &joint in joints {
            builder.scene.nodes[nodes[joint as usize]].mesh = Some(mesh);
        }
    }
    Joints::new(nodes)
}
