//! The drawing order of casters: front to back as seen from the light, so that the depth test rejects
//! hidden texels.

use alloc::vec::Vec;

use glam::Vec3;

use crate::Aabb;

/// Sorts casters by the end of their boxes toward the light, nearest first, and then by number. `to_light` is
/// the unit direction toward the light. `order` is scratch memory.
pub(super) fn sort(numbers: &mut [u32], to_light: Vec3, order: &mut Vec<u64>, aabb: impl Fn(u32) -> Aabb) {
    order.clear();
    order.extend(numbers.iter().map(|number| {
        // Maps floats to integers so that ascending integers are descending floats.
        let bits = height(&aabb(*number), to_light).to_bits();
        let descending = if bits >> 31 == 0 { !bits & 0x7fff_ffff } else { bits };
        u64::from(descending) << 32 | u64::from(*number)
    }));
    order.sort_unstable();
    for (number, sorted) in numbers.iter_mut().zip(order) {
        *number = *sorted as u32;
    }
}

/// Returns the coordinate of a box's end toward the light, in metres along `to_light`.
fn height(aabb: &Aabb, to_light: Vec3) -> f32 {
    aabb.max.dot(to_light.max(Vec3::ZERO)) + aabb.min.dot(to_light.min(Vec3::ZERO))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(x: f32, y: f32) -> Aabb {
        Aabb::new(Vec3::new(x, y, 0.0), Vec3::new(x + 1.0, y + 1.0, 1.0))
    }

    #[test]
    fn casters_are_sorted_nearest_to_the_light_first() {
        let boxes = [cube(0.0, 4.0), cube(0.0, -3.0), cube(0.0, 9.0), cube(0.0, -1.0), cube(5.0, 4.0)];
        let mut numbers = [4, 0, 1, 2, 3];
        sort(&mut numbers, Vec3::Y, &mut Vec::new(), |number| boxes[number as usize]);
        assert_eq!(numbers, [2, 0, 4, 3, 1]);
        sort(&mut numbers, Vec3::NEG_Y, &mut Vec::new(), |number| boxes[number as usize]);
        assert_eq!(numbers, [1, 3, 0, 4, 2]);
    }
}
