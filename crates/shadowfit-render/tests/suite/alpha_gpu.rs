//! Surfaces by their alpha: whether they are drawn, and whether they cast.

use glam::{DVec3, Vec2, Vec3, Vec4};
use shadowfit_scene::{AlphaMode, BlendedCasters, Image, Material, Scene, Texture, Wrap};
use shadowfit_testing::renderer_gpu;

use crate::pictures::{Stage, camera, cheap_technique};

/// Source of a sheet's alpha.
#[derive(Clone, Copy, Debug)]
enum Source {
    Factor(f32),
    Texture(u8),
    Vertices(f32),
}

/// Returns a square that faces up.
fn square(half: f32, height: f32) -> Vec<[Vec3; 3]> {
    let [a, b, c, d] =
        [[-half, -half], [-half, half], [half, half], [half, -half]].map(|[x, z]| Vec3::new(x, height, z));
    vec![[a, b, c], [a, c, d]]
}

/// Returns a sheet above a floor.
fn scene(alpha: AlphaMode, source: Source) -> Scene {
    let mut scene = Scene::from_objects("sheets", &[square(6.0, 0.0), square(1.5, 1.5)]);
    let mut sheet = Material { alpha, double_sided: true, ..Material::default() };
    let primitive = &mut scene.meshes[1].primitives[0];
    primitive.material = 1;
    primitive.uvs = (0..6).map(|corner| Vec2::new(corner as f32 * 0.37, 1.3 - corner as f32 * 0.21)).collect();
    match source {
        Source::Factor(alpha) => sheet.base_color.w = alpha,
        Source::Vertices(alpha) => primitive.colors = vec![Vec4::new(1.0, 1.0, 1.0, alpha); 6],
        Source::Texture(alpha) => {
            let rgba = [255, 255, 255, alpha].repeat(16 * 16);
            scene.images = vec![Image { name: String::new(), width: 16, height: 16, rgba }];
            let uv_from_texcoord = [Vec3::new(3.1, 0.2, 0.1), Vec3::new(-0.3, 2.7, 0.4)];
            sheet.base_color_texture =
                Some(Texture { image: 0, wrap: [Wrap::Repeat; 2], nearest: false, uv_from_texcoord });
        }
    }
    scene.materials.push(sheet);
    scene
}

fn picture(scene: &Scene) -> Vec<[u8; 3]> {
    let camera = camera(DVec3::new(1.0, 4.0, 6.0), DVec3::Y * 0.4);
    let mut stage = Stage::on(renderer_gpu(), &cheap_technique().with_resolution(512, 512), 1, scene, camera);
    stage.picture(|_| ())
}

/// Returns the number of pixels of two pictures that differ by more than rounding.
fn difference(a: &[[u8; 3]], b: &[[u8; 3]]) -> usize {
    let differs = |(a, b): &(&[u8; 3], &[u8; 3])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 1);
    a.iter().zip(b).filter(differs).count()
}

#[test]
fn alpha_that_equals_the_cutoff_is_opaque_and_casts_everywhere_and_the_next_step_below_is_a_hole() {
    let without = {
        let mut scene = scene(AlphaMode::Opaque, Source::Factor(1.0));
        scene.nodes[1].mesh = None;
        picture(&scene)
    };
    for (cutoff, equal, below) in [
        (0.5, Source::Factor(0.5), Source::Factor(0.498)),
        (128.0 / 255.0, Source::Texture(128), Source::Texture(127)),
        (0.5, Source::Texture(128), Source::Texture(127)),
        (0.7, Source::Vertices(0.7), Source::Vertices(0.697)),
        (1.0, Source::Texture(255), Source::Texture(254)),
    ] {
        let masked = picture(&scene(AlphaMode::Mask { cutoff }, equal));
        let opaque = picture(&scene(AlphaMode::Opaque, equal));
        assert_eq!(difference(&masked, &opaque), 0, "{equal:?} at {cutoff}");
        assert!(difference(&opaque, &without) > 100, "the sheet and its shadow are seen");
        let holes = picture(&scene(AlphaMode::Mask { cutoff }, below));
        assert_eq!(difference(&holes, &without), 0, "{below:?} at {cutoff}");
    }
}

#[test]
fn blended_surfaces_cast_where_they_are_opaque_enough_unless_the_scene_forbids_it() {
    let shadows = |source| {
        let [casting, never] = [BlendedCasters::WhereOpaque, BlendedCasters::Never]
            .map(|blended_casters| picture(&Scene { blended_casters, ..scene(AlphaMode::Blend, source) }));
        difference(&casting, &never)
    };
    for source in [Source::Factor(0.5), Source::Texture(128), Source::Vertices(0.5), Source::Factor(1.0)] {
        assert!(shadows(source) > 100, "{source:?}: {} pixels of shadow", shadows(source));
    }
    for source in [Source::Factor(0.498), Source::Texture(127), Source::Vertices(0.497)] {
        assert_eq!(shadows(source), 0, "{source:?}");
    }
    let [blended, opaque] =
        [AlphaMode::Blend, AlphaMode::Opaque].map(|alpha| picture(&scene(alpha, Source::Factor(1.0))));
    assert_eq!(difference(&blended, &opaque), 0);
}

#[test]
fn materials_of_one_geometry_draw_it_each_in_its_own_way() {
    let mut scene = scene(AlphaMode::Mask { cutoff: 0.5 }, Source::Factor(0.2));
    let twin = scene.meshes[1].primitives[0].clone();
    let alone = picture(&scene);
    // The same triangles again, opaque.
    scene.meshes[1].primitives.push(shadowfit_scene::Primitive { material: 0, ..twin });
    let both = picture(&scene);
    scene.meshes[1].primitives.swap(0, 1);
    assert_eq!(picture(&scene), both);
    assert!(difference(&alone, &both) > 100);
}
