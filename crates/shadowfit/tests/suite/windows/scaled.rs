//! A scene in another unit has the same windows.

use proptest::prelude::*;
use shadowfit::glam::Vec3;
use shadowfit::settings::SoftRadius;
use shadowfit::settings::Softness;
use shadowfit::{Aabb, FittedMaps};

use super::{Run, World, any_seen, any_windows};
use crate::scenes::{Lens, SceneView, any_box, any_light, any_view, any_walk};
use crate::support::cases;

/// Returns a view in another unit: all lengths are multiplied by `by`.
fn scaled(view: &SceneView, by: f64) -> SceneView {
    let lens = view.lens;
    // The extents of a perspective lens are per metre of depth.
    let size = if lens.is_perspective { 1.0 } else { by };
    let lens = Lens {
        left: lens.left * size,
        right: lens.right * size,
        bottom: lens.bottom * size,
        top: lens.top * size,
        near: lens.near * by,
        far: lens.far * by,
        ..lens
    };
    SceneView { lens, eye: view.eye * by, ..*view }
}

/// Returns whether the windows of one frame, scaled, equal the other's.
fn is_scaled(maps: &FittedMaps, other: &FittedMaps, by: f64) -> bool {
    maps.iter().zip(other.iter()).all(|(one, other)| {
        let (a, b) = (one.grid_position.unwrap(), other.grid_position.unwrap());
        a.first == b.first && a.texel * by == b.texel && a.depth.map(|z| z * by) == b.depth
    })
}

proptest! {
    #![proptest_config(cases(100))]

    /// By powers of four, which scale without rounding, also in the costs.
    #[test]
    fn a_scene_in_another_unit_has_the_same_windows(
        view in any_view(), direction in any_light(), technique in any_windows(), walk in any_walk(), is_seen in any_seen(),
        plans in prop::collection::vec(any_box(), 1..10), octaves in -5..5_i32,
    ) {
        let by = f64::from(octaves * 2).exp2();
        let technique = technique.with_max_distance(f32::MAX);
        // The sun's angle gives penumbrae in metres, independent of the unit.
        let metres = technique.softness.tangent() * Softness::USUAL_DISTANCE;
        let soft = |metres| technique.softness.with_radius(SoftRadius::Metres(metres));
        let technique = technique.with_softness(soft(metres));
        prop_assume!(!view.lens.is_infinite);
        // A frustum's corners come from the inverse of a matrix, whose rounding may differ.
        let corners = |view: &SceneView| view.frustum().corners;
        let walked = [view, walk.moved(&view), walk.moved(&walk.moved(&view))];
        let same = |view: &SceneView| corners(view).map(|c| c * by as f32) == corners(&scaled(view, by));
        prop_assume!(walked.iter().all(same));
        let origin = view.eye.round();
        let boxes: Vec<Aabb> = plans.iter().map(|plan| plan.aabb(&view, origin)).collect();
        let size = |v: Vec3| v * by as f32;
        let larger = boxes.iter().map(|b| Aabb::new(size(b.min), size(b.max))).collect();
        let mut run = Run::new(World { origin, boxes }, &technique).seen_if(is_seen);
        let extension = technique.fit.caster_extension * by as f32;
        let fit = technique.fit.with_caster_extension(extension);
        let in_unit = technique.with_fit(fit).with_softness(soft(metres * by as f32));
        let mut other = Run::new(World { origin: origin * by, boxes: larger }, &in_unit).seen_if(is_seen);
        for view in walked {
            let (maps, scaled_maps) = (run.frame(&view, direction), other.frame(&scaled(&view, by), direction));
            prop_assert!(is_scaled(&maps, &scaled_maps, by), "{maps:?} {scaled_maps:?}");
        }
    }
}
