//! A fitted map as numbers for the caller.

use shadowfit::glam::{DVec3, Vec4};
use shadowfit::{Bias, FittedMap};

/// Numbers of a map, in the order of [`write`].
pub(crate) const MAP: usize = 22;

/// Writes a map: its axes, the middle of its near plane, its size, its biases and its view depths. A point
/// reads it from the begin to the end, and the next map is blended in from the fade on.
pub(crate) fn write(numbers: &mut [f64; MAP], map: &FittedMap, bias: &Bias, next: Option<&FittedMap>) {
    let fit = &map.projection;
    let m = &fit.light_from_world;
    let row = |part: fn(Vec4) -> f32| [m.x_axis, m.y_axis, m.z_axis].map(|column| f64::from(part(column)));
    let range = map.depths;
    let end = range.map_or(f64::MIN, |range| range.far.unwrap_or(f64::MAX));
    let begin = range.map_or(f64::MAX, |range| range.covered_from.unwrap_or(range.near));
    let fade = next.and_then(|next| next.depths).and_then(|range| range.covered_from).map_or(end, |from| from.min(end));
    let size = (fit.box_max - fit.box_min).as_dvec3();
    let values = [
        row(|c| c.x),
        row(|c| c.y),
        row(|c| c.z),
        near_plane(map).to_array(),
        [size.x, size.y, f64::from(fit.depth_range)],
        [bias.constant_depth, bias.receiver_plane, bias.normal_offset].map(f64::from),
        [begin, end, fade],
    ];
    for (number, value) in numbers.iter_mut().zip(values.as_flattened()) {
        *number = *value;
    }
    numbers[MAP - 1] = f64::from(u8::from(fit.is_empty));
}

/// Returns the middle of the near plane in the world.
fn near_plane(map: &FittedMap) -> DVec3 {
    let fit = &map.projection;
    fit.light_position() - fit.direction.as_dvec3() * f64::from(fit.box_max.z)
}
