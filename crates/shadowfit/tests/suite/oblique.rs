//! Views with tilted near planes: mirrors, water and portals, of all lenses and depth conventions. All that such a view
//! shows lies in its frustum and in a map, with its casters, and the frustum is not much larger than that.

use proptest::prelude::*;
use shadowfit::glam::{DMat4, DVec3, DVec4, Vec3};
use shadowfit::proof::{CoverageQuery, prove};
use shadowfit::{
    Aabb, Boxes, DepthConvention, FitError, FitInput, PRESETS, Scratch, ShadowFitter, Technique, ViewFrustum,
};

use crate::scenes::{SceneView, any_light, any_view};
use crate::support::{any_direction, cases, double};

/// A plane through a point of a view, on whose other side the eye lies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TiltedPlane {
    /// Unit normal away from the eye.
    normal: DVec3,
    /// Distance of the eye, in metres.
    distance: f64,
    /// Factor of the clip depth: 1 puts the far plane at the farthest corner of the view.
    scale: f64,
}

/// A view whose near plane is another.
#[derive(Clone, Copy, Debug)]
struct Oblique {
    view: SceneView,
    plane: TiltedPlane,
    /// Where shadows end, in metres.
    distance: f32,
}

impl Oblique {
    /// E. Lengyel's matrix, "Oblique view frustum depth projection and clipping", 2005, for any depth convention: clip
    /// space from world axes relative to the eye.
    fn clip_from_eye(&self) -> DMat4 {
        let matrix = self.view.clip_from_eye();
        let depth = self.view.lens.depth;
        let plane = self.plane.normal.extend(-self.plane.distance);
        let clip_plane = matrix.inverse().transpose() * plane;
        let corner = DVec4::new(clip_plane.x.signum(), clip_plane.y.signum(), f64::from(depth.far()), 1.0);
        let plane = plane * (self.plane.scale / plane.dot(matrix.inverse() * corner));
        let mut rows = matrix.transpose();
        rows.z_axis = match depth {
            DepthConvention::ZeroToOne => plane,
            DepthConvention::Reversed => rows.w_axis - plane,
            DepthConvention::NegativeOneToOne => plane * 2.0 - rows.w_axis,
        };
        rows.transpose()
    }

    fn frustum(&self) -> Result<ViewFrustum, FitError> {
        let world_from_clip = DMat4::from_translation(self.view.eye) * self.clip_from_eye().inverse();
        ViewFrustum::from_world_from_clip_f64(&world_from_clip, self.view.eye, self.view.lens.depth, self.distance)
    }

    /// Whether a point relative to the eye is in the picture, before the end of shadows.
    fn sees(&self, p: DVec3) -> bool {
        let clip = self.clip_from_eye() * p.extend(1.0);
        let (low, high) = match self.view.lens.depth {
            DepthConvention::NegativeOneToOne => (-clip.w, clip.w),
            _ => (0.0, clip.w),
        };
        let forward = self.view.axes()[2];
        clip.w > 0.0
            && clip.x.abs() <= clip.w
            && clip.y.abs() <= clip.w
            && (low..=high).contains(&clip.z)
            && p.dot(forward) <= f64::from(self.distance)
    }

    /// Points of the picture relative to the eye, by shares of its width, its height and its depth.
    fn points(&self, shares: &[[f64; 3]]) -> Vec<DVec3> {
        let (least, most) = (self.view.lens.near * 0.1, f64::from(self.distance));
        let depth = |share: f64| least * (most / least).powf(share);
        let points = shares.iter().map(|[x, y, share]| self.view.point(*x, *y, depth(*share)));
        points.filter(|p| self.sees(*p)).collect()
    }
}

/// Tilted planes that cut the view of a lens, as far away as a share of its depth.
fn any_plane() -> impl Strategy<Value = (Vec3, f64, f64)> {
    let scale = prop_oneof![3 => Just(1.0), 1 => double(0.4, 1.0)];
    (any_direction(), double(-3.0, -0.2).prop_map(|e| 10.0_f64.powf(e)), scale)
}

/// Views through tilted planes that show something.
fn any_oblique() -> impl Strategy<Value = Oblique> {
    (any_view(), any_plane(), double(0.3, 1.5))
        .prop_map(|(view, (normal, distance, scale), end)| {
            let distance = distance * view.lens.far;
            let plane = TiltedPlane { normal: normal.as_dvec3().normalize(), distance, scale };
            Oblique { view, plane, distance: (view.lens.far * end) as f32 }
        })
        .prop_filter("the plane must leave some of the picture", |oblique| {
            // What an orthographic view shows before a plane that faces it lies behind the camera.
            let is_ahead = view_is_ahead(oblique);
            is_ahead && oblique.points(&grid(9)).len() > 12 && oblique.frustum().is_ok()
        })
}

fn view_is_ahead(oblique: &Oblique) -> bool {
    oblique.view.lens.is_perspective || oblique.plane.normal.dot(oblique.view.axes()[2]) > 0.02
}

/// Shares at even steps along all three axes.
fn grid(side: u32) -> Vec<[f64; 3]> {
    let at = |i: u32| f64::from(i) / f64::from(side - 1);
    (0..side.pow(3)).map(|i| [at(i % side), at(i / side % side), at(i / side / side)]).collect()
}

/// Whether a frustum holds a point relative to its eye, up to a share of its distance.
fn holds(frustum: &ViewFrustum, p: DVec3, tolerance: f64) -> bool {
    let depth = p.dot(frustum.forward.as_dvec3());
    let (near, far) = (f64::from(frustum.near), f64::from(frustum.far));
    let free = tolerance * (p.length() + far.abs());
    let corners = frustum.corners.map(Vec3::as_dvec3);
    let centre = corners.iter().sum::<DVec3>() / 8.0;
    let is_inside = |side: usize| {
        let (a, b) = (corners[side + 4], corners[(side + 1) % 4 + 4]);
        let normal = (b - a).cross(a - corners[side]).normalize();
        let inward = if normal.dot(centre - a) < 0.0 { -normal } else { normal };
        inward.dot(p - a) >= -free
    };
    depth >= near - free && depth <= far + free && (0..4).all(is_inside)
}

proptest! {
    #![proptest_config(cases(300))]

    #[test]
    fn all_that_a_tilted_near_plane_leaves_lies_in_the_frustum(oblique in any_oblique(), shares in prop::collection::vec([double(0.0, 1.0), double(0.0, 1.0), double(0.0, 1.0)], 200)) {
        let frustum = oblique.frustum().unwrap();
        let forward = oblique.view.axes()[2].as_vec3();
        prop_assert!(frustum.forward.abs_diff_eq(forward, 1e-5), "{} for {forward}", frustum.forward);
        for p in oblique.points(&shares).into_iter().chain(oblique.points(&grid(9))) {
            prop_assert!(holds(&frustum, p, 1e-6), "{p} is not in {frustum:?}");
        }
    }
}

#[test]
fn tightness_experiment() {
    use proptest::strategy::ValueTree;
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let mut ratios = Vec::new();
    let mut polys = Vec::new();
    for _ in 0..300 {
        let oblique = any_oblique().new_tree(&mut runner).unwrap().current();
        let frustum = oblique.frustum().unwrap();
        let c = frustum.corners.map(Vec3::as_dvec3);
        // depth-weighted sampling: density by area at depth
        let (mut inside, mut all, mut rays) = (0.0, 0.0, 0.0);
        let n = 16;
        for i in 0..n {
            for j in 0..n {
                let mut any = false;
                let mut col = 0.0;
                for k in 0..n {
                    let f = |i: i32| (f64::from(i) + 0.5) / f64::from(n);
                    let (x, y, z) = (f(i), f(j), f(k));
                    let at = |o: usize| {
                        (c[o] * (1.0 - x) + c[o + 1] * x) * (1.0 - y) + (c[o + 3] * (1.0 - x) + c[o + 2] * x) * y
                    };
                    let p = at(0) * (1.0 - z) + at(4) * z;
                    let s = |o: usize| (c[o + 1] - c[o]).length();
                    let w = (s(0) * (1.0 - z) + s(4) * z).powi(2);
                    all += w;
                    col += w;
                    if oblique.sees(p) {
                        inside += w;
                        any = true;
                    }
                }
                if any {
                    rays += col;
                }
            }
        }
        ratios.push(inside / all);
        polys.push(inside / rays);
    }
    ratios.sort_by(f64::total_cmp);
    polys.sort_by(f64::total_cmp);
    println!("polygon: {:?}", [0, 15, 30, 75, 150, 225, 299].map(|i| polys[i]));
    println!("share of frustum that is visible: {:?}", [0, 15, 30, 75, 150, 225, 299].map(|i| ratios[i]));
}
