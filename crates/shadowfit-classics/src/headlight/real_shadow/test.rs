//! The shadow test of the street's second stage in Rust. A test compares it with `test.wgsl`.

/// Returns 1 inside the light's image where `depth - bias <= stored`, else 0. Depths are after the division
/// by w. `inside` is 1 inside the image and 0 outside.
pub fn share(inside: f32, stored: f32, depth: f32, bias: f32) -> f32 {
    if depth - bias <= stored { inside } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_headlight_lights_what_it_sees_inside_its_image() {
        // 0.91 - 0.01 = 0.9 <= 0.9001; 0.92 - 0.01 = 0.91 > 0.9001.
        assert_eq!(share(1.0, 0.9001, 0.91, 0.01), 1.0);
        assert_eq!(share(1.0, 0.9001, 0.92, 0.01), 0.0);
        assert_eq!(share(0.0, 0.9001, 0.5, 0.01), 0.0);
    }
}
