//! The core alone, once: a camera and a sun in, the matrices and sizes of a shadow map out. No GPU, no window.
//!
//! ```sh
//! cargo run --example fit_once
//! ```

use shadowfit::glam::{DVec3, Vec3};
use shadowfit::{Bias, BiasSettings, FilterKind, FitError, FitSettings, PerspectiveCamera, fit};

fn main() -> Result<(), FitError> {
    let camera = PerspectiveCamera {
        eye: DVec3::new(0.0, 1.7, 5.0),
        forward: Vec3::NEG_Z,
        up: Vec3::Y,
        fov_y: 0.8,
        aspect: 16.0 / 9.0,
        near: 0.1,
        far: 200.0,
    };
    let direction = Vec3::new(0.3, -0.8, 0.2); // the way the light travels
    let settings = FitSettings::default().with_max_distance(30.0);
    let light = fit(&camera.frustum()?, direction, &settings)?;
    let bias = Bias::from_texels(&BiasSettings::automatic_normal_offset(FilterKind::Hardware2x2), &light);

    println!("positions are relative to the eye at {}", light.origin);
    println!("draw the map with clip_from_world {}", light.clip_from_world);
    println!("look it up with uv_from_world {}", light.uv_from_world);
    println!("offset the looked-up point along its normal by {} m times sin θ", bias.normal_offset);
    println!("a texel is {} m, the depth range {} m", light.texel_size, light.depth_range);
    Ok(())
}
