//! A tracer's estimated memory, compared with the allocator. It is a separate program because it replaces the
//! allocator.

use allocation_counter::measure;
use glam::Vec3;
use shadowfit_truth::Tracer;

/// Returns a right triangle with legs of a metre.
fn at(corner: Vec3) -> [Vec3; 3] {
    [corner, corner + Vec3::X, corner + Vec3::Z]
}

/// Returns a hilly ground of `count` triangles side by side.
fn ground(count: u32) -> impl ExactSizeIterator<Item = [Vec3; 3]> {
    let side = f64::from(count).sqrt().ceil() as u32;
    (0..count).map(move |index| {
        let [x, z] = [index % side, index / side].map(|cell| cell as f32);
        at(Vec3::new(x, (x * 0.1).sin() + (z * 0.13).cos(), z))
    })
}

/// Returns `count` triangles anywhere in a cube of a kilometre.
fn soup(count: u32) -> impl ExactSizeIterator<Item = [Vec3; 3]> {
    (0..count).map(|index| {
        let hash = index.wrapping_mul(2_654_435_761);
        at(Vec3::from([hash, hash >> 10, hash >> 20].map(|bits| (bits & 1023) as f32)))
    })
}

/// Measures the peak bytes, and the bytes afterwards.
fn measured(triangles: impl Iterator<Item = [Vec3; 3]>) -> [f64; 2] {
    let mut tracer = None;
    let counted = measure(|| tracer = Some(Tracer::new(triangles)));
    [counted.bytes_max as f64, counted.bytes_current as f64]
}

#[test]
fn memory_is_estimated_within_a_factor_of_one_and_a_half() {
    for count in [1_000, 30_000] {
        let estimate = Tracer::memory(count as usize);
        let estimate = [estimate.building, estimate.kept].map(|bytes| bytes as f64);
        for (name, found) in [("ground", measured(ground(count))), ("soup", measured(soup(count)))] {
            for (estimate, found) in estimate.into_iter().zip(found) {
                let ratio = found / estimate;
                assert!(
                    (1.0 / 1.5..=1.5).contains(&ratio),
                    "{name} of {count}: {found} bytes, but the estimate is {estimate}"
                );
            }
        }
    }
}

#[test]
fn a_tracer_without_triangles_needs_nothing() {
    let memory = Tracer::memory(0);
    assert_eq!((memory.building, memory.kept), (0, 0));
    assert_eq!(measured(std::iter::empty()), [0.0, 0.0]);
}
