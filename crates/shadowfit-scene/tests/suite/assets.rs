//! Real scenes and unusual but valid files, compared with the numbers of other tools.

use std::path::{Path, PathBuf};

use glam::Vec3;
use shadowfit_scene::{AlphaMode, Lens, Scene, Wrap, load_gltf, load_gltf_scene};

/// Returns the folder of the collection. Prints a message and returns `None` if it is missing.
pub(crate) fn folder() -> Option<PathBuf> {
    // Set by cargo, or by the runner of a bundle of tests.
    let package =
        std::env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| env!("CARGO_MANIFEST_DIR").into(), PathBuf::from);
    let folder = package.join("../../../shared/assets");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: {} does not exist", folder.display());
    None
}

/// Path, number of triangles and of triangles without area, extents at rest without skinning, animations,
/// skins, cameras, suns.
type Row = (&'static str, (usize, usize), [f32; 3], [f32; 3], [usize; 4]);

const SCENES: [Row; 11] = [
    ("zdm2/zdm2.glb", (58_772, 1134), [-33.879, -11.968, -29.29], [43.321, 23.984, 30.31], [0, 0, 0, 0]),
    ("dutch_ship/dutch_ship_medium_1k.gltf", (69_162, 0), [-10.326, -2.0, -3.488], [13.745, 22.657, 3.321], [0; 4]),
    (
        "kaykit_graveyard/kaykit_graveyard.glb",
        (49_655, 0),
        [-22.25, -0.555, -22.25],
        [22.25, 8.0, 22.385],
        [0, 0, 2, 1],
    ),
    ("mask_fence/mask_fence.glb", (14, 0), [-20.0, 0.0, -20.0], [20.0, 2.4, 20.0], [0; 4]),
    ("fox/Fox.glb", (576, 0), [-12.593, -0.122, -88.095], [12.593, 78.907, 66.625], [3, 1, 0, 0]),
    ("flight_helmet/FlightHelmet.gltf", (94_722, 0), [-0.204, 0.0, -0.172], [0.163, 0.716, 0.2], [0; 4]),
    ("plastic_chair/plastic_monobloc_chair_01_1k.gltf", (3356, 0), [-0.321, 0.0, -0.336], [0.321, 0.88, 0.292], [0; 4]),
    ("morph_stress/MorphStressTest.gltf", (2412, 0), [-2.0, -0.1, -0.5], [2.0, 0.5, 0.5], [3, 0, 0, 0]),
    ("truck_vehicles/meshes.glb", (884, 14), [-0.656, -0.437, -2.006], [0.654, 1.424, 2.193], [0; 4]),
    ("kenney_town/kenney_town.glb", (312_482, 5889), [-16.5, 0.0, -16.5], [15.572, 1.75, 15.506], [0, 0, 2, 1]),
    ("bevy_terrain/Mountains.gltf", (25_600, 0), [-1.0, -0.086, -1.0], [1.002, 0.249, 1.006], [0; 4]),
];

fn load(folder: &Path, file: &str) -> Scene {
    load_gltf(&folder.join(file)).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn real_scenes_have_the_triangles_and_extents_that_other_tools_count() {
    let Some(folder) = folder() else { return };
    for (file, (triangles, without_area), min, max, [animations, skins, cameras, suns]) in SCENES {
        let scene = load(&folder, file);
        let rest = scene.pose(None, 0.0);
        let drawn = rest.triangles(&scene).len();
        println!("{file}: {drawn} triangles; notes: {:?}", scene.notes);
        assert_eq!(drawn + without_area, triangles, "{file}");
        let dropped = scene.notes.iter().any(|note| note.contains("triangles without area dropped"));
        assert_eq!(dropped, without_area > 0, "{file}");
        let bounds = scene.bounds(&rest).unwrap();
        let tolerance = 0.001 + 1e-3 * bounds.size().max_element();
        let agree = |a: Vec3, b: [f32; 3]| (a - Vec3::from_array(b)).abs().max_element() < tolerance;
        assert!(agree(bounds.min, min) && agree(bounds.max, max), "{file}: {bounds:?}");
        let counts = [scene.animations.len(), scene.skins.len(), scene.cameras.len(), scene.sun.iter().count()];
        assert_eq!(counts, [animations, skins, cameras, suns], "{file}");
        check_consistent(&scene, file);
    }
}

/// Checks the guarantees in the docs of the scene types.
fn check_consistent(scene: &Scene, file: &str) {
    for (index, node) in scene.nodes.iter().enumerate() {
        assert!(node.parent.is_none_or(|parent| parent < index), "{file}");
    }
    for primitive in scene.meshes.iter().flat_map(|mesh| &mesh.primitives) {
        let count = primitive.positions.len();
        assert_eq!(primitive.normals.len(), count, "{file}");
        assert!([0, count].contains(&primitive.uvs.len()), "{file}");
        assert!([0, count].contains(&primitive.tangents.len()), "{file}");
        assert!([0, count].contains(&primitive.joints.len()), "{file}");
        assert_eq!(primitive.joints.len(), primitive.weights.len(), "{file}");
        assert!(primitive.normals.iter().all(|normal| normal.is_normalized()), "{file}");
        assert!(primitive.indices.iter().all(|&index| (index as usize) < count), "{file}");
        assert!(primitive.morphs.iter().all(|target| target.positions.len() == count), "{file}");
        let material = &scene.materials[primitive.material];
        assert_eq!(material.normal_texture.is_some(), !primitive.tangents.is_empty() || count == 0, "{file}");
    }
    for image in &scene.images {
        assert_eq!(image.rgba.len(), (image.width * image.height * 4) as usize, "{file}");
    }
}

#[test]
fn every_part_kit_file_loads_whole() {
    let Some(folder) = folder() else { return };
    let files = files_below(&folder.join("kenney_city")).into_iter();
    let files = files.chain(files_below(&folder.join("parts_kaykit_halloween")));
    for file in files {
        let scene = load_gltf(&file).unwrap_or_else(|error| panic!("{error}"));
        assert!(!scene.instances().is_empty(), "{}", file.display());
        check_consistent(&scene, &file.display().to_string());
    }
}

/// Returns all glTF files below a folder, sorted.
pub(crate) fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(files_below(&path));
        } else if path.extension().is_some_and(|e| e == "gltf" || e == "glb") {
            files.push(path);
        }
    }
    files.sort();
    files
}

#[test]
fn edge_cases_have_their_triangles_and_refused_ones_name_the_extension() {
    let Some(folder) = folder() else { return };
    let counts = [
        ("box_sparse/box_sparse.glb", 12),
        ("box_sparse/box_sparse.gltf", 12),
        ("cameras/Cameras.gltf", 2),
        ("cube_textransform/Cube-textransform.gltf", 12),
        ("khronos_embedded/MultipleScenes.gltf", 2),
        ("khronos_embedded/TriangleWithoutIndices.gltf", 1),
        ("non_ascii_raw/fence-❤.gltf", 380),
        ("primitive_mode/Mesh_PrimitiveMode_00.gltf", 0),
        ("primitive_mode/Mesh_PrimitiveMode_02.gltf", 0),
        ("primitive_mode/Mesh_PrimitiveMode_04.gltf", 2),
        ("primitive_mode/Mesh_PrimitiveMode_06.gltf", 2),
        ("primitive_mode/Mesh_PrimitiveMode_08.gltf", 0),
        ("primitive_mode/Mesh_PrimitiveMode_10.gltf", 0),
        ("primitive_mode/Mesh_PrimitiveMode_12.gltf", 2),
        ("primitive_mode/Mesh_PrimitiveMode_14.gltf", 2),
        ("simple_morph/glTF/SimpleMorph.gltf", 1),
        ("simple_skin/SimpleSkin.gltf", 8),
        ("uri_spaces/CubeImageUriMultipleSpaces.gltf", 12),
        ("uri_spaces/CubeImageUriSpaces.gltf", 12),
    ];
    for (file, triangles) in counts {
        let scene = load(&folder.join("edge_shared"), file);
        println!("{file}: {:?}", scene.notes);
        let drawn = scene.pose(None, 0.0).triangles(&scene).len();
        assert_eq!(drawn, triangles, "{file}");
        check_consistent(&scene, file);
    }
    for (file, name) in [
        ("refuse/arch_gate_draco.glb", "KHR_draco_mesh_compression"),
        ("refuse/tree_dead_large_meshopt.glb", "EXT_meshopt_compression"),
    ] {
        let error = load_gltf(&folder.join("edge_shared").join(file)).unwrap_err().to_string();
        assert!(error.contains(name) && error.contains(file), "{error}");
    }
}

#[test]
fn cameras_and_scenes_are_picked_up() {
    let Some(folder) = folder() else { return };
    let edge = folder.join("edge_shared");
    let cameras = load(&edge, "cameras/Cameras.gltf").cameras;
    let lenses: Vec<Lens> = cameras.iter().map(|camera| camera.lens).collect();
    assert!(matches!(lenses[..], [Lens::Perspective { .. }, Lens::Orthographic { .. }]), "{lenses:?}");

    let path = edge.join("khronos_embedded/MultipleScenes.gltf");
    let default = load_gltf(&path).unwrap();
    let triangles = |scene: &Scene| scene.pose(None, 0.0).triangles(scene).len();
    let both = [0, 1].map(|index| load_gltf_scene(&path, Some(index)).unwrap());
    assert_eq!([triangles(&both[0]), triangles(&both[1]), triangles(&default)], [1, 2, 2]);
    assert!(load_gltf_scene(&path, Some(2)).unwrap_err().to_string().contains("scenes[2]"));
}

#[test]
fn images_load_through_spaces_and_non_ascii_names() {
    let Some(folder) = folder() else { return };
    for file in ["uri_spaces/CubeImageUriSpaces.gltf", "uri_spaces/CubeImageUriMultipleSpaces.gltf"] {
        let scene = load(&folder.join("edge_shared"), file);
        assert_eq!((scene.images[0].width, scene.images[0].height), (2, 2), "{file}: {:?}", scene.notes);
    }
    let fence = load(&folder.join("edge_shared"), "non_ascii_raw/fence-❤.gltf");
    assert!(fence.images[0].width > 1, "{:?}", fence.notes);
}

#[test]
fn a_cut_out_fence_keeps_its_mask_wrap_and_alpha() {
    let Some(folder) = folder() else { return };
    let scene = load(&folder, "mask_fence/mask_fence.glb");
    let masked = scene.materials.iter().find(|m| matches!(m.alpha, AlphaMode::Mask { .. })).unwrap();
    assert!(masked.double_sided);
    let texture = masked.base_color_texture.unwrap();
    assert_eq!(texture.wrap, [Wrap::Repeat; 2]);
    let alphas = scene.images[texture.image].rgba.chunks_exact(4).map(|pixel| pixel[3]);
    let opaque = alphas.clone().filter(|&alpha| alpha >= 128).count() as f32 / alphas.count() as f32;
    assert!((opaque - 0.27).abs() < 0.02, "{opaque}");
}

#[test]
fn the_fox_moves_its_vertices_and_loops_without_a_jump() {
    let Some(folder) = folder() else { return };
    let scene = load(&folder, "fox/Fox.glb");
    for (index, animation) in scene.animations.iter().enumerate() {
        let vertices = |seconds: f32| {
            let pose = scene.pose(Some(index), seconds);
            pose.deform(&scene, &scene.instances()[0]).unwrap().positions
        };
        let distance = |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        let (start, middle) = (vertices(0.0), vertices(animation.duration * 0.4));
        assert!(distance(&start, &middle) > 1.0, "{}", animation.name);
        let next_round = vertices(animation.duration * 1.4);
        assert!(distance(&middle, &next_round) < 0.05, "{}", animation.name);
    }
}

#[test]
fn the_mirrored_trees_of_the_graveyard_face_outward() {
    let Some(folder) = folder() else { return };
    let scene = load(&folder, "kaykit_graveyard/kaykit_graveyard.glb");
    let pose = scene.pose(None, 0.0);
    let instances = scene.instances();
    let mirrored = instances.iter().filter(|instance| pose.is_mirrored(&scene, instance)).count();
    assert_eq!(mirrored, 4);
    // The signed volume of a mesh that mostly faces outward is positive, mirrored or not.
    let mut volumes = vec![0.0; instances.len()];
    for triangle in pose.triangles(&scene) {
        let center = pose.world_from_node[instances[triangle.instance as usize].node].w_axis.truncate();
        let [a, b, c] = triangle.vertices.map(|vertex| vertex - center);
        volumes[triangle.instance as usize] += a.dot(b.cross(c));
    }
    for (instance, volume) in instances.iter().zip(volumes) {
        assert!(!pose.is_mirrored(&scene, instance) || volume > 0.0, "node {}", instance.node);
    }
}
