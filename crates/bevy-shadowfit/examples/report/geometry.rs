//! Triangles of the scenes that fits are compared on, by object, and the meshes that Bevy draws of them.

use std::error::Error;
use std::path::Path;

use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Mesh, PrimitiveTopology};
use shadowfit::glam::{DVec3, Vec3};
use shadowfit_scene::load_gltf;
use shadowfit_truth::peers::{Ground, Scene};

/// Corners of a triangle, world space, metres.
pub(crate) type Corners = [Vec3; 3];

/// The triangles of a scene: a list for each object in the order of [`Scene::objects`].
pub(crate) fn read(assets: &Path, scene: &Scene) -> Result<Vec<Vec<Corners>>, Box<dyn Error>> {
    let name = &scene.name;
    let file = scene.file.as_ref().ok_or_else(|| format!("the scenarios name no \"file\" for scene \"{name}\""))?;
    let loaded = load_gltf(&assets.join(file))?;
    // One object for each node with a mesh; nodes are depth first.
    let mut object_of_node = vec![usize::MAX; loaded.nodes.len()];
    let mut objects = Vec::new();
    for (node, _) in loaded.nodes.iter().enumerate().filter(|(_, node)| node.mesh.is_some()) {
        object_of_node[node] = objects.len();
        objects.push(Vec::new());
    }
    let instances = loaded.instances();
    let scaled = |corner: Vec3| (corner.as_dvec3() * scene.scale).as_vec3();
    for triangle in loaded.pose(None, 0.0).triangles(&loaded) {
        let object = object_of_node[instances[triangle.instance as usize].node];
        objects[object].push(triangle.vertices.map(scaled));
    }
    objects.extend(scene.ground.map(ground));
    if objects.len() != scene.objects.len() {
        let (found, wanted) = (objects.len(), scene.objects.len());
        return Err(format!("{file}: {found} objects, but the scenarios say {wanted} of scene \"{name}\"").into());
    }
    Ok(objects)
}

fn ground(ground: Ground) -> Vec<Corners> {
    let half = ground.size * 0.5;
    let corner = |x: f64, z: f64| DVec3::new(x * half, ground.y, z * half).as_vec3();
    let [a, b, c, d] = [corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
    vec![[a, b, c], [a, c, d]]
}

/// A mesh of an object, with the normals of its triangles' planes, as truth has them.
pub(crate) fn mesh(object: &[Corners]) -> Mesh {
    let positions: Vec<[f32; 3]> = object.iter().flatten().map(Vec3::to_array).collect();
    let normal = |[a, b, c]: &Corners| {
        let [a, b, c] = [a, b, c].map(|corner| corner.as_dvec3());
        (b - a).cross(c - a).normalize_or(DVec3::Y).as_vec3().to_array()
    };
    let normals: Vec<[f32; 3]> = object.iter().flat_map(|triangle| [normal(triangle); 3]).collect();
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
}
