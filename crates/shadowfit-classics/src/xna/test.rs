//! The XNA sample's shadow test in Rust. A test compares it with `test.wgsl`.

/// Returns 0 in shadow, which is where `stored < depth - bias`, else 1. Depths are after the division by w.
pub fn share(stored: f32, depth: f32, bias: f32) -> f32 {
    if stored < depth - bias { 0.0 } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_behind_the_stored_depth_is_in_shadow() {
        // 0.5 < 0.502 - 0.001 = 0.501, but not 0.5 < 0.5005 - 0.001 = 0.4995.
        assert_eq!((share(0.5, 0.502, 0.001), share(0.5, 0.5005, 0.001)), (0.0, 1.0));
    }
}
