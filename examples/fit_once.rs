//! The core crate alone: pass in a camera, a sun and the scene's boxes, and get four shadow maps and the
//! casters of each one, frame by frame. No GPU, no window.
//!
//! ```sh
//! cargo run --example fit_once
//! ```

use shadowfit::glam::{DVec3, Vec3};
use shadowfit::{Aabb, Boxes, FitError, FitInput, PerspectiveCamera, ShadowFitter, Technique};

fn main() -> Result<(), FitError> {
    let ground = Aabb::new(Vec3::new(-80.0, -0.1, -80.0), Vec3::new(80.0, 0.0, 80.0));
    let house = Aabb::new(Vec3::new(-4.0, 0.0, -12.0), Vec3::new(4.0, 6.0, -6.0));
    let objects = [ground, house];
    let boxes = Boxes::world(&objects);
    let sun = Vec3::new(0.3, -0.8, 0.2); // the way its light travels
    let technique = Technique::default(); // 4 maps of 2048 × 2048 texels
    let mut fitter = ShadowFitter::new(&technique); // remembers the last frame's maps, to keep them still

    for frame in 0..3 {
        let eye = DVec3::new(0.0, 1.7, 20.0 - 0.1 * f64::from(frame));
        let (forward, up) = (Vec3::NEG_Z, Vec3::Y);
        let camera = PerspectiveCamera { eye, forward, up, fov_y: 0.8, aspect: 16.0 / 9.0, near: 0.1, far: 200.0 };
        let views = [camera.frustum()?];
        let input = FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&views, sun) };
        let maps = fitter.fit(&input)?;
        for (map, casters) in maps.iter().zip(maps.caster_volumes(&views, &technique)?) {
            let drawn: Vec<usize> = casters.casters_in(&boxes).collect();
            println!("draw objects {drawn:?} with {}", map.projection.clip_from_world);
            println!("look the map up with {}, biased by {}", map.projection.uv_from_world, map.bias.constant_depth);
        }
    }
    Ok(())
}
