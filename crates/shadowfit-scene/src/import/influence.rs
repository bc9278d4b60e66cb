//! Joint influences of vertices: the four strongest of all sets, normalised.

use glam::Vec4;
use gltf::json::mesh::{self, Semantic};
use gltf::json::validation::Checked;

use super::accessor::{Elements, Integers, Reader};
use crate::error::Problem;

/// Sets of four influences read at most. Typical files have one or two.
const MAX_SETS: u32 = 8;

type Influences = (Vec<[u16; 4]>, Vec<Vec4>);

/// Loads joints and weights of some of `count` vertices. Both are empty if the primitive has none.
pub(crate) fn load(
    reader: &Reader,
    json: &mesh::Primitive,
    element: &str,
    count: usize,
    vertices: Elements<'_>,
) -> Result<Influences, Problem> {
    let mut strongest: Vec<[(u16, f32); 4]> = Vec::new();
    for set in 0..MAX_SETS {
        let find = |semantic| json.attributes.get(&Checked::Valid(semantic)).copied();
        let (joints, weights) = match (find(Semantic::Joints(set)), find(Semantic::Weights(set))) {
            (Some(joints), Some(weights)) => (joints, weights),
            (None, None) => break,
            _ => {
                let element = format!("{element}.attributes");
                return Err(Problem::new(element, format!("JOINTS_{set} and WEIGHTS_{set} must come together")));
            }
        };
        for (name, index) in [("JOINTS", joints), ("WEIGHTS", weights)] {
            reader.check_count(index, &format!("{element}.attributes.{name}_{set}"), count)?;
        }
        let joints = reader.integers::<4>(joints, &format!("{element}.attributes.JOINTS_{set}"), vertices)?;
        let name = format!("{element}.attributes.WEIGHTS_{set}");
        let weights = reader.some_floats::<4>(weights, &name, Integers::Normalized, vertices)?;
        strongest.resize(joints.len(), [(0, 0.0); 4]);
        for (slots, (joints, weights)) in strongest.iter_mut().zip(joints.into_iter().zip(weights)) {
            for (joint, weight) in joints.into_iter().zip(weights) {
                insert(slots, joint, weight);
            }
        }
    }
    Ok(strongest.into_iter().map(normalized).unzip())
}

/// Keeps the four greatest weights in descending order. Ignores weights that are not positive and finite,
/// with their joints.
fn insert(slots: &mut [(u16, f32); 4], joint: u32, weight: f32) {
    if !(weight > 0.0 && weight.is_finite()) {
        return;
    }
    let Some(slot) = slots.iter().position(|&(_, other)| weight > other) else { return };
    slots[slot..].rotate_right(1);
    // The specification allows u8 and u16 joints. A greater one is out of range in every skin.
    slots[slot] = (u16::try_from(joint).unwrap_or(u16::MAX), weight);
}

/// Normalises the weights of a vertex. A vertex without influences moves with the first joint.
fn normalized(slots: [(u16, f32); 4]) -> ([u16; 4], Vec4) {
    let weights = Vec4::from_array(slots.map(|(_, weight)| weight));
    let sum = weights.element_sum();
    let weights = if sum > 0.0 && sum.is_finite() { weights / sum } else { Vec4::X };
    (slots.map(|(joint, _)| joint), weights)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_four_strongest_influences_are_kept_and_sum_to_one() {
        let mut slots = [(0, 0.0); 4];
        let given = [(7, 0.1), (3, 0.4), (9, f32::NAN), (5, 0.2), (6, 0.4), (8, 0.05), (2, -1.0)];
        for (joint, weight) in given {
            insert(&mut slots, joint, weight);
        }
        let (joints, weights) = normalized(slots);
        assert_eq!(joints, [3, 6, 5, 7]);
        assert!((weights.element_sum() - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_vertex_without_weights_hangs_on_the_first_joint() {
        assert_eq!(normalized([(0, 0.0); 4]), ([0; 4], Vec4::X));
    }
}
