//! Probes are the same whether fragments have a primitive index or vertices number the triangles.

use glam::DVec3;
use shadowfit_render::Probe;
use shadowfit_scene::Scene;
use shadowfit_scene::builtin::BuiltinScene;

use super::devices::test_gpu;
use super::pictures::{Stage, camera, cheap_technique};
use super::sheets::sheets;

/// Creates a stage of a scene in its rest pose on a device with the features.
fn stage(features: wgpu::Features, scene: &Scene, eye: DVec3) -> Stage {
    let gpu = test_gpu(features, wgpu::Limits::default());
    Stage::on(gpu, &cheap_technique().with_resolution(512, 512), 1, scene, camera(eye, DVec3::Y))
}

/// Compares texel by texel. Returns the number of visible triangles.
fn assert_same([indexed, unrolled]: [&Probe; 2], name: &str) -> usize {
    let mut triangles = std::collections::BTreeSet::new();
    for (index, (a, b)) in indexed.pixels.iter().zip(&unrolled.pixels).enumerate() {
        assert_eq!(a, b, "{name}: pixel {index}");
        triangles.extend(a.map(|pixel| pixel.triangle));
    }
    triangles.len()
}

const FEATURES: [wgpu::Features; 2] = [wgpu::Features::PRIMITIVE_INDEX, wgpu::Features::empty()];

#[test]
fn probes_without_the_primitive_index_are_those_with_it() {
    let forest = BuiltinScene::Forest.build();
    for (name, scene, eye) in
        [("sheets", sheets(), DVec3::new(1.0, 4.0, 6.0)), ("forest", forest, DVec3::new(4.0, 3.0, 12.0))]
    {
        let [indexed, unrolled] = FEATURES.map(|features| stage(features, &scene, eye).probe());
        let seen = assert_same([&indexed, &unrolled], name);
        assert!(seen > 100, "{name}: {seen} triangles");
        let shadowed = indexed.pixels.iter().flatten().filter(|pixel| pixel.factor < 0.5).count();
        assert!(shadowed > 50, "{name}: {shadowed} pixels in shadow");
    }
}

#[test]
fn what_deforms_is_probed_in_its_pose_without_the_primitive_index() {
    let mut scene = sheets();
    let at_rest = scene.clone();
    scene.nodes[1].morph_weights = vec![-1.0];
    scene.nodes[7].rest.translation.y += 0.8;
    let eye = DVec3::new(1.0, 4.0, 6.0);
    let [indexed, unrolled] = FEATURES.map(|features| {
        let mut stage = stage(features, &at_rest, eye);
        let before = stage.probe();
        stage.pictures.scene.set_pose(&stage.pictures.gpu, &scene, &scene.pose(None, 0.0));
        let after = stage.probe();
        assert_ne!(before.pixels, after.pixels, "nothing moved");
        after
    });
    assert_same([&indexed, &unrolled], "posed");
}
