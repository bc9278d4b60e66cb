//! The terrain sample's shadow test in Rust. A test compares it with `test.wgsl`.

/// Returns 0 in shadow, which is where `stored - off_stored > from - depth`, else 1. The map stores 1 - z/w.
pub fn share(stored: f32, depth: f32, off_stored: f32, from: f32) -> f32 {
    if stored - off_stored > from - depth { 0.0 } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_behind_the_reversed_depth_is_in_shadow() {
        // Stored 1 - 0.5 = 0.5: 0.47 > 0.98 - 0.52 = 0.46 is shadow, 0.47 > 0.98 - 0.505 = 0.475 is not.
        assert_eq!((share(0.5, 0.52, 0.03, 0.98), share(0.5, 0.505, 0.03, 0.98)), (0.0, 1.0));
    }
}
