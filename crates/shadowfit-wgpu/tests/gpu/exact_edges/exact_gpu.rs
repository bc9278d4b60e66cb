//! Factors of one ray equal the truth: one ray on the CPU from the exact point of the visible triangle.

use shadowfit::glam::{DMat4, DVec3, DVec4, Vec3};
use shadowfit::{DepthConvention, PerspectiveCamera, Technique};
use shadowfit_scene::builtin::BuiltinScene;
use shadowfit_testing::pairs::{all_pairs, full_product};
use shadowfit_truth::Tracer;
use shadowfit_wgpu::exact_edges::NormalEncoding;

use super::soft_gpu::{sized, tracer};
use super::stage::{Look, Stage, Thing, traced};
use super::twin_gpu::{start, things};

/// Distance above the surface at which the true rays start, in metres.
const RAY_OFFSET: f64 = 1e-3;

/// Wrong pixels allowed per image in addition to a share. Two were found in images of 160×90 pixels.
const SOME: f64 = 2.0;

/// Share of the facing pixels that may be wrong. A drawn triangle ends within 1/256 pixel of some pixels'
/// centres, where the eye's ray hits its neighbour, and some rays pass an edge within the rounding of f32.
/// With Mesa's driver and on NVIDIA, 0.009% were found on the plain of 2 km, next to boxes that are nearer to
/// a point than rounding raises the rays, and 0.002% elsewhere.
const WRONG: f64 = 1e-4;

/// Share of wrong pixels for 16 bits of depth, whose steps show the ground through the foot of a wall. 0.02%
/// were found.
const WRONG_BY_16_BITS: f64 = 5e-4;

/// Share of the facing pixels that may be wrong away from edges of the true shadow, without normals. 0.001%
/// were found at triangles narrower than a pixel, and none with normals.
const AWAY: f64 = 2e-5;

/// The true image.
struct Truth {
    /// Whether the light reaches each pixel; `None` if no surface faces the light within the shadow distance.
    lit: Vec<Option<bool>>,
    size: [u32; 2],
}

impl Truth {
    fn new(stage: &Stage, look: &Look, tracer: &Tracer) -> Self {
        let corners: Vec<Vec3> = stage.things.iter().flat_map(|thing| thing.corners.iter().copied()).collect();
        let triangles = corners.as_chunks::<3>().0;
        let eye_from_clip = look.camera.clip_from_world(look.convention).as_dmat4().inverse();
        // Nearer than the beginning of the fade.
        let max_distance = 0.9 * f64::from(Technique::default().fit.max_distance);
        let pixel = |(index, triangle): (usize, &Option<usize>)| {
            let sight = Sight::new(look, &eye_from_clip, index as u32);
            let found = triangle.and_then(|triangle| sight.meets(triangles[triangle], look.camera.eye));
            found.and_then(|(point, normal)| {
                let is_near = point.dot(look.camera.forward.as_dvec3()) < max_distance;
                let to_light = -look.direction.as_dvec3().normalize();
                let start = (look.camera.eye + point + normal * RAY_OFFSET).as_vec3();
                let is_facing = is_near && normal.dot(to_light) > 0.0;
                is_facing.then(|| !tracer.is_occluded(start, to_light.as_vec3()))
            })
        };
        Self { lit: stage.triangles(look).iter().enumerate().map(pixel).collect(), size: look.size }
    }

    /// Returns whether a neighbour of a pixel has a different truth.
    fn is_at_edge(&self, index: usize) -> bool {
        let [width, height] = self.size.map(u32::cast_signed);
        let (x, y) = ((index as u32).cast_signed() % width, (index as u32).cast_signed() / width);
        let is_other = |x: i32, y: i32| {
            let is_inside = x >= 0 && y >= 0 && x < width && y < height;
            is_inside && self.lit[(y * width + x) as usize] != self.lit[index]
        };
        (-1..=1).any(|down| (-1..=1).any(|across| is_other(x + across, y + down)))
    }
}

/// The line of sight through a pixel's centre, relative to the eye.
struct Sight {
    origin: DVec3,
    direction: DVec3,
}

impl Sight {
    fn new(look: &Look, eye_from_clip: &DMat4, index: u32) -> Self {
        let [width, height] = look.size;
        let x = (f64::from(index % width) + 0.5) / f64::from(width) * 2.0 - 1.0;
        let y = 1.0 - (f64::from(index / width) + 0.5) / f64::from(height) * 2.0;
        let at = |depth: f64| {
            let homogeneous = *eye_from_clip * DVec4::new(x, y, depth, 1.0);
            homogeneous.truncate() / homogeneous.w
        };
        let origin = at(f64::from(look.convention.near()));
        Self { origin, direction: (at(0.5) - origin).normalize() }
    }

    /// Returns the intersection with a triangle's plane, clamped to the distances of its corners, and the
    /// normal that faces the eye.
    fn meets(&self, corners: [Vec3; 3], eye: DVec3) -> Option<(DVec3, DVec3)> {
        let [a, b, c] = corners.map(|corner| corner.as_dvec3() - eye);
        let normal = (b - a).cross(c - a).try_normalize()?;
        let normal = if normal.dot(self.direction) > 0.0 { -normal } else { normal };
        let along = [a, b, c].map(|corner| (corner - self.origin).dot(self.direction));
        let [nearest, farthest] = [f64::min, f64::max].map(|pick| along.into_iter().reduce(pick).expect("three"));
        let distance = normal.dot(a - self.origin) / normal.dot(self.direction);
        Some((self.origin + self.direction * distance.clamp(nearest, farthest), normal))
    }
}

/// Compares an image with the truth. `share` is the share of the facing pixels that may be wrong.
fn judge(what: &str, stage: &mut Stage, look: &Look, (tracer, share): (&Tracer, f64)) {
    let truth = Truth::new(stage, look, tracer);
    let drawn = stage.draw_surfaces(look);
    let (factors, counts) = stage.traced(look, &drawn, |_| ());
    let facing: Vec<(usize, bool)> =
        truth.lit.iter().enumerate().filter_map(|(index, is_lit)| Some((index, (*is_lit)?))).collect();
    let is_wrong = |(index, is_lit): &&(usize, bool)| factors[*index] >= 0.0 && (factors[*index] > 0.5) != *is_lit;
    let wrong: Vec<&(usize, bool)> = facing.iter().filter(is_wrong).collect();
    let away: Vec<&(usize, bool)> = wrong.iter().copied().filter(|(index, _)| !truth.is_at_edge(*index)).collect();
    let count = facing.len() as f64;
    println!("{what}: {} of {count} are wrong, {} away from edges; {counts:?}", wrong.len(), away.len());
    assert!(count > 500.0 && counts.traced > 50, "{what}: too few pixels: {counts:?}");
    assert!(wrong.len() as f64 <= SOME + share * count, "{what}: {wrong:?} are wrong");
    let most_away = if look.normals.is_some() { 0.0 } else { 1.0 + AWAY * count };
    assert!(away.len() as f64 <= most_away, "{what}: {away:?} are wrong away from edges");
}

/// Tested depth buffers.
const DEPTHS: [(DepthConvention, wgpu::TextureFormat); 3] = [
    (DepthConvention::Reversed, wgpu::TextureFormat::Depth32Float),
    (DepthConvention::ZeroToOne, wgpu::TextureFormat::Depth32Float),
    (DepthConvention::ZeroToOne, wgpu::TextureFormat::Depth24Plus),
];
const NORMALS: [Option<NormalEncoding>; 2] = [Some(NormalEncoding::Signed), None];
const HEIGHTS: [u32; 4] = [90, 180, 360, 720];

fn assert_exact(rows: &[Vec<usize>], heights: &[u32]) {
    for scene in BuiltinScene::ALL {
        let mut stage = Stage::new(&traced(Technique::default(), 1), things(scene));
        stage.gpu.require_fine_steps();
        let tracer = tracer(&stage);
        for row in rows {
            let (height, (convention, format), normals) = (heights[row[0]], DEPTHS[row[1]], NORMALS[row[2]]);
            let look = Look { convention, format, ..sized(start(scene, normals), [height * 16 / 9, height]) };
            stage.draw(&look);
            judge(
                &format!("{scene:?} {height} {convention:?} {format:?} {normals:?}"),
                &mut stage,
                &look,
                (&tracer, WRONG),
            );
        }
    }
}

// Four images with one CPU ray per pixel.
#[test]
fn one_ray_finds_the_truth_in_small_pictures_whatever_the_depth_buffer() {
    let heights = &HEIGHTS[..2];
    assert_exact(&all_pairs(&[heights.len(), DEPTHS.len(), NORMALS.len()]), heights);
}

#[test]
#[ignore = "the full product of sizes, depths and normals: cargo xtask test --all"]
fn one_ray_finds_the_truth_in_pictures_of_all_sizes_whatever_the_depth_buffer() {
    assert_exact(&full_product(&[HEIGHTS.len(), DEPTHS.len(), NORMALS.len()]), &HEIGHTS);
}

/// A depth of 16 bits has steps of metres in the distance, and shows one of several surfaces there. A single
/// surface with walls on it is as exact as with any other depth.
#[test]
fn one_ray_finds_the_truth_by_16_bits_of_depth() {
    let ground = Thing::solid(Vec3::new(-30.0, -0.5, -30.0), Vec3::new(30.0, 0.0, 30.0));
    let walls = (0..6_u8).map(|index| {
        let x = f32::from(index) * 7.0 - 20.0;
        Thing::solid(Vec3::new(x, 0.0, -15.0), Vec3::new(x + 0.4, 3.0, 5.0))
    });
    let mut stage = Stage::new(&traced(Technique::default(), 1), [ground].into_iter().chain(walls).collect());
    let tracer = tracer(&stage);
    for normals in NORMALS {
        let look = Look {
            convention: DepthConvention::ZeroToOne,
            format: wgpu::TextureFormat::Depth16Unorm,
            ..sized(super::twin_gpu::look(1, DepthConvention::ZeroToOne, normals), [320, 180])
        };
        stage.draw(&look);
        judge(&format!("16 bits, {normals:?}"), &mut stage, &look, (&tracer, WRONG_BY_16_BITS));
    }
}

/// Culled sides that cast shadows lie just in front of the visible ones: the inner side of a thin shell, or
/// the hull of an outline.
#[test]
fn culled_sides_close_before_a_surface_are_not_taken_for_it() {
    let ground = Thing::solid(Vec3::new(-30.0, -0.5, -30.0), Vec3::new(30.0, 0.0, 30.0));
    let wall = Thing::solid(Vec3::new(6.0, 0.0, -6.0), Vec3::new(6.4, 3.0, 6.0));
    for above in [0.002, 0.005, 0.01] {
        let corner = |x: f32, z: f32| Vec3::new(x * 4.0, above, z * 4.0);
        let [a, b, c, d] = [corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
        let sheet = Thing { corners: vec![a, b, c, a, c, d], is_culled: true, ..Thing::default() };
        let things = vec![ground.clone(), wall.clone(), sheet];
        for (rays, normals) in [(1, None), (4, None), (4, Some(NormalEncoding::Signed))] {
            let mut stage = Stage::new(&traced(Technique::default(), rays), things.clone());
            stage.gpu.require_fine_steps();
            let tracer = tracer(&stage);
            let look = sized(super::twin_gpu::look(1, DepthConvention::Reversed, normals), [320, 180]);
            let truth = Truth::new(&stage, &look, &tracer);
            let drawn = stage.draw(&look);
            let (factors, counts) = stage.traced(&look, &drawn, |_| ());
            let is_wrong = |index: &usize| {
                let is_lit = truth.lit[*index].filter(|_| factors[*index] >= 0.0 && !truth.is_at_edge(*index));
                is_lit.is_some_and(|is_lit| (factors[*index] > 0.5) != is_lit)
            };
            let wrong = (0..factors.len()).filter(is_wrong).count();
            println!("{above} m, {rays} rays, {normals:?}: {wrong} are wrong; {counts:?}");
            assert!(counts.traced > 500 && wrong == 0, "{above} m, {rays} rays, {normals:?}: {wrong}; {counts:?}");
        }
    }
}

/// Ten bits cannot represent zero: the normal of level ground leans by 0.08 degrees, and beyond a kilometre
/// it seems to face away from the eye.
#[test]
fn level_ground_is_lit_as_far_as_the_horizon_by_normals_of_ten_bits() {
    let ground = Thing::solid(Vec3::new(-3000.0, -0.5, -3000.0), Vec3::new(3000.0, 0.0, 3000.0));
    let mut technique = Technique::default();
    technique.fit.max_distance = 2900.0;
    let mut stage = Stage::new(&traced(technique, 1), vec![ground]);
    stage.gpu.require_fine_steps();
    let seen = super::twin_gpu::look(1, DepthConvention::Reversed, Some(NormalEncoding::Unsigned));
    for forward in [Vec3::NEG_Z, Vec3::X, Vec3::new(-0.6, 0.0, 0.8)] {
        let eye = DVec3::new(0.0, 1.7, 0.0);
        let camera =
            PerspectiveCamera { eye, forward, up: Vec3::Y, fov_y: 0.01, near: 0.5, far: 4000.0, ..seen.camera };
        let look = Look { camera, ..sized(seen, [160, 90]) };
        let drawn = stage.draw(&look);
        let (factors, counts) = stage.traced(&look, &drawn, |_| ());
        let dark = factors.iter().filter(|factor| (0.0..0.5).contains(*factor)).count();
        println!("{forward}: {dark} are dark; {counts:?}");
        assert!(counts.facing > 1000 && dark == 0, "{forward}: {dark} are dark; {counts:?}");
    }
}
