//! Tests of cut-outs on the GPU against their documented rule.

use shadowfit_rays::glam::{Affine3A, DVec3, Vec2, Vec3};
use shadowfit_rays::{AlphaImage, CutMaterial, CutOut, RayError, RayInstance, RayMesh, Wrap};

use super::brute_force::Random;
use super::device::{Ray, gpu};

/// An image of random alpha.
struct Image {
    size: [i32; 2],
    alpha: Vec<u8>,
}

impl Image {
    fn new(random: &mut Random, size: [i32; 2]) -> Self {
        Self { size, alpha: (0..size[0] * size[1]).map(|_| (random.share() * 255.0) as u8).collect() }
    }

    fn alpha(&self) -> AlphaImage<'_> {
        let [width, height] = self.size.map(i32::cast_unsigned);
        AlphaImage::new(width, height, &self.alpha).expect("an alpha per texel")
    }

    /// Returns its alpha at texture coordinates.
    fn sample(&self, material: &CutMaterial, uv: Vec2) -> f32 {
        let position = uv * Vec2::new(self.size[0] as f32, self.size[1] as f32) - 0.5;
        let (corner, weight) = (position.floor().as_ivec2(), position - position.floor());
        let at = |right: i32, down: i32| {
            let x = wrapped(corner.x + right, self.size[0], material.wrap[0]);
            let y = wrapped(corner.y + down, self.size[1], material.wrap[1]);
            f32::from(self.alpha[(y * self.size[0] + x) as usize]) / 255.0
        };
        if material.nearest {
            return at((weight.x >= 0.5).into(), (weight.y >= 0.5).into());
        }
        let row = |down| at(0, down) * (1.0 - weight.x) + at(1, down) * weight.x;
        row(0) * (1.0 - weight.y) + row(1) * weight.y
    }
}

fn wrapped(index: i32, size: i32, wrap: Wrap) -> i32 {
    match wrap {
        Wrap::Repeat => index.rem_euclid(size),
        Wrap::Clamp => index.clamp(0, size - 1),
        Wrap::Mirror => {
            let folded = index.rem_euclid(size * 2);
            folded.min(size * 2 - 1 - folded)
        }
    }
}

/// Texture coordinates of a triangle in the plane y = 0, which are also the x and z of its corners.
const CORNERS: [Vec2; 3] = [Vec2::new(-1.3, -1.7), Vec2::new(2.9, -1.1), Vec2::new(0.2, 2.6)];

fn triangle() -> [Vec3; 3] {
    CORNERS.map(|uv| Vec3::new(uv.x, 0.0, uv.y))
}

/// Returns weights of points in the triangle, with a ray through each.
fn points(random: &mut Random, count: usize) -> Vec<(Vec3, Ray)> {
    let mut point = || {
        let [a, b, c] = [0; 3].map(|_| 0.02 + random.share());
        let weights = Vec3::new(a, b, c) / (a + b + c);
        let at: Vec3 = triangle().iter().zip(weights.to_array()).map(|(corner, weight)| *corner * weight).sum();
        (weights, [at - Vec3::Y, Vec3::Y])
    };
    (0..count).map(|_| point()).collect()
}

/// Greatest difference of alpha and cutoff that rounding may reverse.
const ROUNDING: f32 = 1e-3;

#[test]
fn a_triangle_blocks_where_base_vertex_and_image_alpha_reach_the_cutoff() {
    let gpu = gpu();
    let mut random = Random(7);
    let images = [[5, 3], [4, 4]].map(|size| Image::new(&mut random, size));
    let points = points(&mut random, 400);
    let rays: Vec<_> = points.iter().map(|(_, ray)| *ray).collect();
    let mut scene = gpu.scene();
    let ids = images.each_ref().map(|image| scene.add_image(image.alpha()).expect("room"));
    for (number, wrap) in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror].into_iter().cycle().take(6).enumerate() {
        let (image, id) = (&images[number % 2], ids[number % 2]);
        let wrap = [wrap, Wrap::Mirror];
        let material = CutMaterial { image: Some(id), wrap, nearest: number < 3, base_alpha: 0.9, cutoff: 0.3 };
        let cut_out = CutOut { uvs: CORNERS, alphas: [1.0, 0.8, 0.6], material };
        // The first triangle is far away and opaque.
        let mesh = RayMesh::from_triangles([triangle().map(|corner| corner + Vec3::X * 50.0), triangle()])
            .and_then(|mesh| mesh.with_cut_outs([(1, cut_out)]))
            .expect("a mesh");
        let mesh = scene.add_mesh(&mesh).expect("room");
        scene.set_instances(DVec3::ZERO, &[RayInstance::new(mesh, Affine3A::IDENTITY)]).expect("room");
        let mut decided = 0;
        for ((weights, ray), answer) in points.iter().zip(gpu.blocked(&scene, &rays)) {
            let at = ray[0];
            let alpha = image.sample(&material, Vec2::new(at.x, at.z)) * 0.9 * weights.dot(cut_out.alphas.into());
            let texel = Vec2::new(at.x, at.z) * Vec2::new(image.size[0] as f32, image.size[1] as f32);
            let is_between_texels = (texel - texel.round()).abs().min_element() < ROUNDING;
            if (alpha - material.cutoff).abs() > ROUNDING && !(material.nearest && is_between_texels) {
                assert_eq!(answer, alpha >= material.cutoff, "{ray:?}, {material:?}");
                decided += 1;
            }
        }
        assert!(decided > 350, "{decided}");
        let far = [[Vec3::new(50.5, -1.0, 0.0), Vec3::Y]];
        assert_eq!(gpu.blocked(&scene, &far), [true]);
    }
}

#[test]
fn one_material_gives_holes_to_all_triangles_of_a_mesh() {
    let gpu = gpu();
    let mut scene = gpu.scene();
    // The right half is opaque.
    let image = scene.add_image(AlphaImage::new(2, 1, &[0, 255]).expect("two texels")).expect("room");
    let uvs = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
    let positions = uvs.map(|uv| Vec3::new(uv.x, 0.0, uv.y));
    let material = CutMaterial { image: Some(image), nearest: true, wrap: [Wrap::Clamp; 2], ..CutMaterial::default() };
    let square = RayMesh::new(&positions, &[0, 1, 2, 0, 2, 3]).expect("a mesh");
    assert_eq!(square.clone().with_material(&uvs[..3], &material).err(), Some(RayError::Uvs { uvs: 3, vertices: 4 }));
    let mesh = scene.add_mesh(&square.with_material(&uvs, &material).expect("uvs of all")).expect("room");
    scene.set_instances(DVec3::ZERO, &[RayInstance::new(mesh, Affine3A::IDENTITY)]).expect("room");
    let below = |x: f32, z: f32| [Vec3::new(x, -1.0, z), Vec3::Y];
    let rays = [below(0.3, 0.8), below(0.3, 0.1), below(0.7, 0.8), below(0.7, 0.1)];
    assert_eq!(gpu.blocked(&scene, &rays), [false, false, true, true]);
    // An image of the same size takes its place.
    assert_eq!(scene.remove_image(image), Ok(()));
    assert_eq!(scene.remove_image(image), Err(RayError::NoImage));
    let other = scene.add_image(AlphaImage::new(2, 1, &[255, 0]).expect("two texels")).expect("room");
    assert!(other != image);
    assert_eq!(gpu.blocked(&scene, &rays), [true, true, false, false]);
}
