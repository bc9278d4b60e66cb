//! Conversion between directions and the faces of a cube map, as graphics APIs define it (Vulkan
//! specification, "Cube Map Face Selection"; WebGPU, Metal and Direct3D agree).

use glam::{Vec2, Vec3};

/// Returns the face of a direction (world axes, any length but 0; +x, -x, +y, -y, +z, -z from 0 to 5) and the
/// texture coordinates on it, 0..=1, u to the right and v down.
///
/// The greatest component chooses the face. Among equal components, z precedes y, and y precedes x.
pub fn face_of(direction: Vec3) -> (usize, Vec2) {
    let Vec3 { x, y, z } = direction;
    let size = direction.abs();
    let (face, along, down) = if size.z >= size.x && size.z >= size.y {
        if z >= 0.0 { (4, x, -y) } else { (5, -x, -y) }
    } else if size.y >= size.x {
        if y >= 0.0 { (2, x, z) } else { (3, x, -z) }
    } else if x >= 0.0 {
        (0, -z, -y)
    } else {
        (1, z, -y)
    };
    (face, Vec2::new(along, down) / size.max_element() * 0.5 + 0.5)
}

/// Returns the direction (world axes, greatest component ±1) of texture coordinates on a face, 0 to 5: the
/// inverse of [`face_of`].
pub fn direction_of(face: usize, uv: Vec2) -> Vec3 {
    let Vec2 { x: along, y: down } = uv * 2.0 - 1.0;
    match face {
        0 => Vec3::new(1.0, -down, -along),
        1 => Vec3::new(-1.0, -down, along),
        2 => Vec3::new(along, 1.0, down),
        3 => Vec3::new(along, -1.0, -down),
        4 => Vec3::new(along, -down, 1.0),
        _ => Vec3::new(-along, -down, -1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_have_their_faces_and_coordinates() {
        // Example: for (4, 1, -2), x is greatest, u = (2/4 + 1) / 2 = 0.75, v = (-1/4 + 1) / 2 = 0.375.
        for (direction, face, uv) in [
            (Vec3::new(4.0, 1.0, -2.0), 0, Vec2::new(0.75, 0.375)),
            (Vec3::new(-4.0, 1.0, -2.0), 1, Vec2::new(0.25, 0.375)),
            (Vec3::new(1.0, 4.0, -2.0), 2, Vec2::new(0.625, 0.25)),
            (Vec3::new(1.0, -4.0, -2.0), 3, Vec2::new(0.625, 0.75)),
            (Vec3::new(1.0, -2.0, 4.0), 4, Vec2::new(0.625, 0.75)),
            (Vec3::new(1.0, -2.0, -4.0), 5, Vec2::new(0.375, 0.75)),
        ] {
            assert_eq!(face_of(direction), (face, uv), "{direction}");
            let back = direction_of(face, uv) * 4.0;
            assert!((back - direction).length() < 1e-6, "{back} is not {direction}");
        }
    }

    #[test]
    fn the_middle_of_each_face_is_its_axis() {
        let axes = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
        for (face, axis) in axes.into_iter().enumerate() {
            assert_eq!(direction_of(face, Vec2::splat(0.5)), axis);
            assert_eq!(face_of(axis), (face, Vec2::splat(0.5)));
        }
    }
}
