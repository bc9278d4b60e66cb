//! The drawn sky box against its picture.

use std::collections::BTreeSet;

use glam::{DVec3, Mat4, UVec2, Vec2, Vec3};
use shadowfit::PerspectiveCamera;
use shadowfit_classics::mapped::{
    FrameExtras, LightImage, LightPlace, SampleFormat, SampleFrame, SampleLight, SampleMapSettings, SampleRenderer,
    Shading, ShadowTest,
};
use shadowfit_classics::sky_box::{SkyBox, SkyPicture, face_of};
use shadowfit_testing::{filter_step, subpixel_step};

use crate::scenes::{Pictures, SIZE, camera};

const LIGHTS: [Vec3; 3] = [Vec3::new(0.3, 0.8, -0.5), Vec3::new(-0.9, 0.25, 0.1), Vec3::new(0.5, 0.5, 0.5)];

/// Texels of a face of the drawn sky.
const FACE: u32 = 512;

/// Draws only the sky, over a red background.
fn seen(pictures: &mut Pictures, sky: &SkyBox, camera: &PerspectiveCamera) -> Vec<[u8; 3]> {
    let frame = SampleFrame {
        camera: *camera,
        light: SampleLight {
            clip_from_world: Mat4::IDENTITY,
            place: LightPlace::Toward(Vec3::Y),
            image: LightImage::Square,
        },
        map: SampleMapSettings::new([1; 2], SampleFormat::R32Float),
        test: ShadowTest::OFF,
        shading: Shading::modern(1.0, 1.0),
        background: [255, 0, 0],
        double_sided: false,
    };
    sky.prepare(&pictures.gpu, camera);
    let behind = |pass: &mut wgpu::RenderPass<'_>| sky.draw(pass);
    let extras = FrameExtras { behind: Some(&behind), ..FrameExtras::default() };
    let mut renderer = SampleRenderer::new(&pictures.gpu, 1);
    renderer.draw(&pictures.gpu, &mut pictures.scene, &frame, extras, &pictures.target).expect("a picture");
    pictures.read()
}

/// Returns a pixel's middle, in pixels.
fn middle(pixel: usize) -> Vec2 {
    UVec2::new(pixel as u32 % SIZE[0], pixel as u32 / SIZE[0]).as_vec2() + 0.5
}

/// Returns the world direction through a point of the picture, in pixels.
fn ray(camera: &PerspectiveCamera, at: Vec2) -> Vec3 {
    let ndc = at / Vec2::new(SIZE[0] as f32, SIZE[1] as f32) * 2.0 - 1.0;
    let tangent = (camera.fov_y * 0.5).tan();
    let view = Vec3::new(ndc.x * tangent * camera.aspect, -ndc.y * tangent, -1.0);
    camera.view_from_world().transpose().transform_vector3(view)
}

/// Returns the number of texels of a face that a pixel's width and height cover together, along u or v,
/// whichever is greater.
fn texels_per_pixel(camera: &PerspectiveCamera, pixel: usize) -> f32 {
    // Small enough to stay on the same face.
    const PART: f32 = 0.01;
    let uv = |offset: Vec2| face_of(ray(camera, middle(pixel) + offset)).1;
    let [right, down] = [Vec2::X, Vec2::Y].map(|axis| (uv(axis * PART) - uv(Vec2::ZERO)).abs());
    (right + down).max_element() * FACE as f32 / PART
}

/// A colour between four texels.
struct Filtered {
    color: Vec3,
    /// Change over a texel along u and along v, added. It is the maximum over the channels and over both rows
    /// or columns.
    change: f32,
}

/// Filters a picture linearly in a direction. Returns `None` if the filter would read across an edge.
fn filtered(picture: &SkyPicture, direction: Vec3) -> Option<Filtered> {
    let (face, uv) = face_of(direction);
    let at = uv * picture.size as f32 - 0.5;
    let corner = at.floor();
    if corner.min_element() < 0.0 || corner.max_element() + 1.0 >= picture.size as f32 {
        return None;
    }
    let texel = |x: u32, y: u32| {
        let at = corner.as_uvec2() + UVec2::new(x, y);
        let [r, g, b, _] = picture.faces[face][(at.y * picture.size + at.x) as usize].map(f32::from);
        Vec3::new(r, g, b)
    };
    let part = at - corner;
    let [[a, b], [c, d]] = [0, 1].map(|y| [0, 1].map(|x| texel(x, y)));
    let greatest = |one: Vec3, other: Vec3| one.abs().max(other.abs()).max_element();
    let change = greatest(b - a, d - c) + greatest(c - a, d - b);
    Some(Filtered { color: a.lerp(b, part.x).lerp(c.lerp(d, part.x), part.y), change })
}

#[test]
fn every_direction_shows_what_its_face_has_there() {
    let mut pictures = Pictures::new(&[], 1);
    let sky = SkyBox::new(&pictures.gpu, LIGHTS[0], 1);
    let picture = SkyPicture::new(LIGHTS[0], FACE);
    let info = pictures.gpu.adapter.get_info();
    let (weights, corners) = (filter_step(&info), subpixel_step(&info));
    let mut compared = [0; 6];
    for forward in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z, Vec3::ONE, Vec3::NEG_ONE] {
        let camera = PerspectiveCamera { forward, up: Vec3::new(0.4, 0.5, 0.7), fov_y: 1.4, ..camera() };
        for (pixel, color) in seen(&mut pictures, &sky, &camera).into_iter().enumerate() {
            let direction = ray(&camera, middle(pixel));
            let Some(expected) = filtered(&picture, direction) else { continue };
            let error = (Vec3::from(color.map(f32::from)) - expected.color).abs().max_element();
            // Half a level for rounding, and a step of the filter's weights in each axis. Rasterisation
            // rounds the box's corners to a fraction of a pixel, which moves points between them by at most
            // that much.
            let moved = weights + corners * texels_per_pixel(&camera, pixel);
            let tolerance = 0.7 + moved * expected.change;
            let Filtered { color: expected, .. } = expected;
            assert!(error <= tolerance, "{direction}: {color:?}, not {expected}: {error} levels of {tolerance}");
            compared[face_of(direction).0] += 1;
        }
    }
    assert!(compared.iter().all(|count| *count > 5000), "{compared:?}");
}

#[test]
fn the_sky_stays_when_the_camera_moves() {
    let mut pictures = Pictures::new(&[], 1);
    let sky = SkyBox::new(&pictures.gpu, LIGHTS[0], 1);
    let here = PerspectiveCamera { forward: LIGHTS[0], ..camera() };
    let there = PerspectiveCamera { eye: DVec3::new(-4000.0, 70.0, 1e6), near: 3.0, far: 20.0, ..here };
    let first = seen(&mut pictures, &sky, &here);
    assert_eq!(first, seen(&mut pictures, &sky, &there));
    // The sky fills the picture and has more than one colour.
    assert!(!first.contains(&[255, 0, 0]) && first.iter().collect::<BTreeSet<_>>().len() > 100);
}

#[test]
fn the_sun_is_where_the_light_is() {
    let mut pictures = Pictures::new(&[], 1);
    let mut sky = SkyBox::new(&pictures.gpu, Vec3::Y, 1);
    for to_light in LIGHTS {
        sky.set_light(&pictures.gpu, to_light);
        let camera = PerspectiveCamera { forward: to_light + Vec3::new(0.05, -0.03, 0.04), fov_y: 0.4, ..camera() };
        let picture = seen(&mut pictures, &sky, &camera);
        let bright = |(_, color): &(usize, &[u8; 3])| color[0] == 255 && color[2] >= 249;
        let sun: Vec<Vec3> =
            picture.iter().enumerate().filter(bright).map(|(pixel, _)| ray(&camera, middle(pixel))).collect();
        let middle: Vec3 = sun.iter().map(|direction| direction.normalize()).sum();
        let angle = middle.angle_between(to_light).to_degrees();
        println!("{} pixels of sun, {angle} degrees from the light", sun.len());
        // A pixel is 0.24 degrees wide.
        assert!(sun.len() > 20 && sun.len() < 200 && angle < 0.1, "{} {angle}", sun.len());
    }
}
