//! The core alone: a camera, a sun and boxes of the scene in, the matrices of four shadow maps out, frame by frame. No
//! GPU, no window.
//!
//! ```sh
//! cargo run --example fit_once
//! ```

use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::{Aabb, Boxes, FitError, FitInput, MapFitter, PerspectiveCamera, Technique, Workspace};

fn main() -> Result<(), FitError> {
    let technique = Technique::default(); // 4 maps of 2048 × 2048 texels
    let ground = Aabb::new(Vec3::new(-80.0, -0.1, -80.0), Vec3::new(80.0, 0.0, 80.0));
    let house = Aabb::new(Vec3::new(-4.0, 0.0, -12.0), Vec3::new(4.0, 6.0, -6.0));
    let objects = [ground, house];
    let boxes = Boxes { origin: DVec3::ZERO, boxes: &objects };
    let sun = Vec3::new(0.3, -0.8, 0.2); // the way its light travels

    let mut fitter = MapFitter::new(); // remembers the last frame's maps, to keep them still
    let mut storage = [DVec2::ZERO; Workspace::required(2, 1)]; // for 2 boxes and 1 view
    for frame in 0..3 {
        let camera = PerspectiveCamera {
            eye: DVec3::new(0.0, 1.7, 20.0 - 0.1 * f64::from(frame)),
            forward: Vec3::NEG_Z,
            up: Vec3::Y,
            fov_y: 0.8,
            aspect: 16.0 / 9.0,
            near: 0.1,
            far: 200.0,
        };
        let views = [camera.frustum()?];
        // In `need` goes what the last frame's depth buffer showed; without it, as here, placing the maps takes longer.
        let need = &[];
        let input = FitInput { receivers: Some(boxes), casters: Some(boxes), need, ..FitInput::new(&views, sun) };
        let maps = fitter.fit(&input, &technique, &mut Workspace::new(&mut storage))?;

        println!("frame {frame}: positions are relative to the eye, {}", camera.eye);
        let volumes = maps.caster_volumes(&views, &technique)?;
        for (index, map) in maps.iter().enumerate() {
            let casters = volumes[index].relative_to(boxes.origin);
            let drawn = objects.iter().filter(|object| casters.intersects_aabb(object.min, object.max)).count();
            let size = map.fit.box_max - map.fit.box_min;
            println!("map {index} is {} m wide and {} m high; its texels are {} m", size.x, size.y, map.fit.texel_size);
            println!("  draw {drawn} of {} objects into it with {}", objects.len(), map.fit.clip_from_world);
            println!("  look it up with {}", map.fit.uv_from_world);
            println!("  move the depth that is compared by {}", map.bias.constant_depth);
        }
    }
    Ok(())
}
