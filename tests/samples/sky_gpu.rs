//! The sky box: infinitely far away, with its sun at the light's direction.

use shadowfit::glam::{DVec3, Vec3};
use shadowfit_classics::mapped::point::image_uv;
use shadowfit_render::RenderTarget;

use super::bench::Bench;

const ID: &str = "sky-box";
const SIZE: [u32; 2] = [300, 180];

#[test]
fn the_sky_is_the_same_wherever_the_camera_stands() {
    let mut bench = Bench::new(ID);
    let values = bench.values(None, &[("shadows", "off")]);
    let camera = bench.sample.seen_by(None, 300.0 / 180.0);
    let mut seen = |eye: DVec3| {
        let target = RenderTarget::new(&bench.gpu.device, SIZE, 1);
        // Straight up over the courtyard, with a free view.
        let camera = shadowfit::PerspectiveCamera { eye, forward: Vec3::new(0.02, 1.0, 0.0), up: Vec3::Z, ..camera };
        bench.draw(&values, &camera, &target)
    };
    let (here, there) = (seen(DVec3::new(0.0, 30.0, 0.0)), seen(DVec3::new(-41.0, 65.0, 23.0)));
    assert_eq!(here, there);
    assert!(here.iter().any(|pixel| pixel[2] > pixel[0].saturating_add(30)), "it is blue");
}

#[test]
fn the_sun_of_the_sky_is_where_the_light_is() {
    let mut bench = Bench::new(ID);
    for (elevation, azimuth) in [("20", "90"), ("55", "250")] {
        let values = bench.values(None, &[("elevation", elevation), ("azimuth", azimuth), ("shadows", "off")]);
        let [elevation, azimuth]: [f32; 2] =
            [elevation, azimuth].map(|text| text.parse::<f32>().expect("a number").to_radians());
        let to_light = Vec3::new(azimuth.sin() * elevation.cos(), elevation.sin(), azimuth.cos() * elevation.cos());
        let camera = bench.sample.seen_by(None, 300.0 / 180.0);
        let forward = (to_light + Vec3::new(0.05, -0.08, 0.04)).normalize();
        let camera = shadowfit::PerspectiveCamera { eye: DVec3::new(0.0, 60.0, 0.0), forward, fov_y: 0.6, ..camera };
        let target = RenderTarget::new(&bench.gpu.device, SIZE, 1);
        let picture = bench.draw(&values, &camera, &target);
        let clip = camera.clip_from_world(shadowfit::DepthConvention::Reversed) * to_light.extend(0.0);
        let at = image_uv(clip) * shadowfit::glam::Vec2::new(300.0, 180.0);
        let sun = picture[at.y as usize * 300 + at.x as usize];
        assert!(sun[..3].iter().all(|channel| *channel > 240), "{sun:?} at {at}");
    }
}

#[test]
fn without_the_sky_the_background_is_plain_and_the_scene_stays() {
    let mut bench = Bench::new(ID);
    let [with, without] = ["on", "off"].map(|sky| {
        let values = bench.values(None, &[("sky", sky)]);
        bench.picture(None, &values, SIZE)
    });
    let plain = [100, 149, 237];
    let mut sky = 0;
    for (with, without) in with.iter().zip(&without) {
        if without[..3] == plain {
            sky += 1;
        } else {
            assert_eq!(with, without);
        }
    }
    assert!(sky > with.len() / 4, "{sky}");
}
