//! Scenes of plain triangles without a file, for measurements of fits.

use glam::Vec3;

use crate::{Geometry, Material, Mesh, Node, Scene, Transform};

impl Scene {
    /// Creates a scene of plain triangles (corners in world space, metres), with one node and one mesh for
    /// each of `objects`. All have the same opaque, double-sided material and flat normals.
    pub fn from_objects(name: &str, objects: &[Vec<[Vec3; 3]>]) -> Self {
        let material = Material { double_sided: true, ..Material::default() };
        Self {
            name: name.to_owned(),
            nodes: (0..objects.len()).map(node).collect(),
            meshes: objects.iter().map(|triangles| mesh(triangles)).collect(),
            materials: vec![material],
            ..Self::default()
        }
    }
}

fn node(index: usize) -> Node {
    Node { name: format!("object {index}"), rest: Transform::default(), mesh: Some(index), ..Node::default() }
}

/// Builds a mesh in which every triangle has its own vertices, with its normal.
fn mesh(triangles: &[[Vec3; 3]]) -> Mesh {
    let normal = |[a, b, c]: &[Vec3; 3]| (*b - *a).cross(*c - *a).normalize_or(Vec3::Y);
    let positions: Vec<Vec3> = triangles.iter().flatten().copied().collect();
    let geometry = Geometry {
        normals: triangles.iter().flat_map(|triangle| [normal(triangle); 3]).collect(),
        indices: (0..positions.len() as u32).collect(),
        positions,
        ..Geometry::default()
    };
    Mesh { primitives: vec![geometry.into()], ..Mesh::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_triangles_of_a_plain_scene_are_those_it_was_made_of() {
        let triangle = |x: f32| [Vec3::new(x, 0.0, 0.0), Vec3::new(x + 1.0, 0.0, 0.0), Vec3::new(x, 0.0, -1.0)];
        let objects = [vec![triangle(0.0), triangle(2.0)], Vec::new(), vec![triangle(5.0)]];
        let scene = Scene::from_objects("plain", &objects);
        let found: Vec<_> = scene.pose(None, 0.0).triangles(&scene);
        let vertices: Vec<_> = found.iter().map(|triangle| triangle.vertices).collect();
        assert_eq!(vertices, objects.concat());
        assert_eq!(found.iter().map(|triangle| triangle.instance).collect::<Vec<_>>(), [0, 0, 2]);
        assert_eq!(scene.meshes[0].primitives[0].normals[0], Vec3::Y);
    }
}
