//! A scene with all kinds of parts: deformed by a morph target or a skin, with holes, of glass, mirrored.

use glam::{Mat4, Quat, Vec2, Vec3, Vec4};
use shadowfit_scene::{
    AlphaMode, Geometry, Image, Material, Mesh, MorphTarget, Node, Primitive, Scene, Skin, Texture, Transform, Wrap,
};

/// Materials of the scene.
const PLAIN: usize = 0;
const HOLES: usize = 1;
const GLASS: usize = 2;

/// Cells along a sheet.
const CELLS: u32 = 6;

/// Returns sheets above a floor.
pub(crate) fn sheets() -> Scene {
    let mesh = |primitive| Mesh { primitives: vec![primitive], ..Mesh::default() };
    let meshes = vec![
        mesh(sheet(PLAIN)),
        Mesh { morph_weights: vec![1.0], ..mesh(morphed()) },
        mesh(skinned()),
        mesh(sheet(HOLES)),
        mesh(sheet(GLASS)),
    ];
    let nodes = vec![
        node(Some(0), [0.0, 0.0, 0.0], [8.0, 1.0, 8.0]),
        node(Some(1), [-2.0, 1.0, 0.0], [1.0; 3]),
        Node { skin: Some(0), ..node(Some(2), [0.0; 3], [1.0; 3]) },
        node(Some(3), [0.0, 2.0, 0.5], [1.0; 3]),
        node(Some(4), [0.5, 1.5, 1.0], [1.0; 3]),
        node(Some(0), [0.0, 0.7, -2.0], [-1.0, 1.0, 1.0]),
        node(None, [2.0, 1.0, 0.0], [1.0; 3]),
        node(None, [2.0, 1.6, 0.2], [1.0; 3]),
    ];
    let skins = vec![Skin { joints: vec![6, 7], joint_from_mesh: vec![Mat4::IDENTITY; 2] }];
    Scene { nodes, meshes, skins, materials: materials(), images: vec![holes()], ..Scene::default() }
}

fn node(mesh: Option<usize>, place: [f32; 3], scale: [f32; 3]) -> Node {
    let rest = Transform::new(place.into(), Quat::IDENTITY, scale.into());
    Node { mesh, rest, ..Node::default() }
}

/// Returns a square of two metres that faces up, whose triangles share vertices.
fn sheet(material: usize) -> Primitive {
    let side = CELLS + 1;
    let corners = (0..side * side).map(|index| Vec2::new((index % side) as f32, (index / side) as f32) / CELLS as f32);
    let uvs: Vec<Vec2> = corners.collect();
    let cells = (0..CELLS * CELLS).map(|cell| cell / CELLS * side + cell % CELLS);
    let geometry = Geometry {
        positions: uvs.iter().map(|uv| Vec3::new(uv.x * 2.0 - 1.0, 0.0, uv.y * 2.0 - 1.0)).collect(),
        normals: vec![Vec3::Y; uvs.len()],
        indices: cells.flat_map(|a| [a, a + side, a + 1, a + 1, a + side, a + side + 1]).collect(),
        uvs,
        ..Geometry::default()
    };
    Primitive { material, ..geometry.into() }
}

fn morphed() -> Primitive {
    let mut primitive = sheet(PLAIN);
    let positions = primitive.positions.iter().map(|at| Vec3::Y * (at.x * 2.0).sin() * 0.4).collect();
    primitive.morphs = vec![MorphTarget { positions, normals: Vec::new() }];
    primitive
}

/// Returns a sheet of which each half follows a joint.
fn skinned() -> Primitive {
    let mut primitive = sheet(PLAIN);
    primitive.weights = primitive.uvs.iter().map(|uv| Vec4::new(1.0 - uv.x, uv.x, 0.0, 0.0)).collect();
    primitive.joints = vec![[0, 1, 0, 0]; primitive.uvs.len()];
    primitive
}

fn materials() -> Vec<Material> {
    let plain = Material { double_sided: true, ..Material::default() };
    let texture = Texture { image: 0, wrap: [Wrap::Repeat; 2], nearest: true, uv_from_texcoord: [Vec3::X, Vec3::Y] };
    let holes = Material {
        base_color_texture: Some(texture),
        alpha: AlphaMode::Mask { cutoff: 0.5 },
        double_sided: false,
        ..plain.clone()
    };
    let glass = Material { base_color: Vec4::new(0.3, 0.5, 0.9, 0.4), alpha: AlphaMode::Blend, ..plain.clone() };
    vec![plain, holes, glass]
}

/// Returns an image in which every other texel is a hole.
fn holes() -> Image {
    let rgba = (0..16).flat_map(|index| [200, 120, 60, if (index + index / 4) % 2 == 0 { 255 } else { 0 }]).collect();
    Image { name: "holes".to_owned(), width: 4, height: 4, rgba }
}
