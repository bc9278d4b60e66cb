//! Random whole scenes: views through any lens, boxes in view, and visible points.
//!
//! Each view is built in two independent ways: as a [`ViewFrustum`], through a matrix or a camera, and as a
//! [`Lens`] with the camera's axes, from which visible points are sampled.

use proptest::prelude::*;
use shadowfit::glam::{DMat4, DQuat, DVec3, DVec4, UVec2, Vec3};
use shadowfit::settings::{
    CasterPolicy, FitKind, FitSettings, MapSelection, MapSettings, RectangleKind, Shape, SplitScheme,
};
use shadowfit::{Aabb, Cascades, DepthConvention, PerspectiveCamera, Technique, ViewFrustum};

use crate::support::{any_direction, double, every_stabilise, float, sliced};

/// Every fit that guarantees coverage: all except the XNA sample's.
pub(crate) const COVERING: [FitKind; 4] = [FitKind::FrustumAabb, FitKind::Oriented, FitKind::Sphere, FitKind::Focused];

/// Extent of the picture, in metres per metre of view depth (perspective) or in metres (orthographic).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lens {
    pub(crate) is_perspective: bool,
    pub(crate) left: f64,
    pub(crate) right: f64,
    pub(crate) bottom: f64,
    pub(crate) top: f64,
    pub(crate) near: f64,
    pub(crate) far: f64,
    /// Whether the projection's far plane is at infinity. If so, `far` is the maximum shadow distance.
    pub(crate) is_infinite: bool,
    pub(crate) is_mirrored: bool,
    pub(crate) depth: DepthConvention,
}

/// A lens with a position and orientation in the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SceneView {
    pub(crate) lens: Lens,
    pub(crate) eye: DVec3,
    pub(crate) forward: Vec3,
    pub(crate) up: Vec3,
}

impl Lens {
    /// Returns the clip-from-view matrix (x right, y up, looking along -z).
    fn clip_from_view(&self) -> DMat4 {
        let Self { left: l, right: r, bottom: b, top: t, near: n, far: f, .. } = *self;
        let sign = if self.is_mirrored { -1.0 } else { 1.0 };
        let (sx, sy) = (2.0 / (r - l), 2.0 / (t - b));
        let (cx, cy) = ((r + l) / (r - l), (t + b) / (t - b));
        if self.is_perspective {
            let (scale, offset) = match (self.depth, self.is_infinite) {
                (DepthConvention::ZeroToOne, true) => (-1.0, -n),
                (DepthConvention::Reversed, true) => (0.0, n),
                (DepthConvention::NegativeOneToOne, true) => (-1.0, -2.0 * n),
                (DepthConvention::ZeroToOne, false) => (f / (n - f), n * f / (n - f)),
                (DepthConvention::Reversed, false) => (n / (f - n), n * f / (f - n)),
                (DepthConvention::NegativeOneToOne, false) => ((f + n) / (n - f), 2.0 * n * f / (n - f)),
            };
            return DMat4::from_cols(
                DVec4::new(sx * sign, 0.0, 0.0, 0.0),
                DVec4::new(0.0, sy, 0.0, 0.0),
                DVec4::new(cx * sign, cy, scale, -1.0),
                DVec4::new(0.0, 0.0, offset, 0.0),
            );
        }
        let (scale, offset) = match self.depth {
            DepthConvention::ZeroToOne => (-1.0 / (f - n), -n / (f - n)),
            DepthConvention::Reversed => (1.0 / (f - n), f / (f - n)),
            DepthConvention::NegativeOneToOne => (-2.0 / (f - n), -(f + n) / (f - n)),
        };
        DMat4::from_cols(
            DVec4::new(sx * sign, 0.0, 0.0, 0.0),
            DVec4::new(0.0, sy, 0.0, 0.0),
            DVec4::new(0.0, 0.0, scale, 0.0),
            DVec4::new(-cx * sign, -cy, offset, 1.0),
        )
    }
}

impl SceneView {
    /// Returns the unit vectors right, up and forward.
    pub(crate) fn axes(&self) -> [DVec3; 3] {
        let forward = self.forward.as_dvec3().normalize();
        let right = forward.cross(self.up.as_dvec3()).normalize();
        [right, right.cross(forward), forward]
    }

    /// Returns the matrix from world axes, relative to the eye, to clip space.
    pub(crate) fn clip_from_eye(&self) -> DMat4 {
        let [right, up, forward] = self.axes();
        let world = DMat4::from_cols(right.extend(0.0), up.extend(0.0), (-forward).extend(0.0), DVec4::W);
        self.lens.clip_from_view() * world.transpose()
    }

    pub(crate) fn frustum(&self) -> ViewFrustum {
        let matrix = DMat4::from_translation(self.eye) * self.clip_from_eye().inverse();
        let far = if self.lens.is_infinite { self.lens.far as f32 } else { f32::MAX };
        ViewFrustum::from_world_from_clip_f64(&matrix, self.eye, self.lens.depth, far).unwrap()
    }

    /// Returns a point of the view relative to the eye: position in the picture, 0..1 from the left and from
    /// the bottom, and view depth in metres.
    pub(crate) fn point(&self, x: f64, y: f64, depth: f64) -> DVec3 {
        let [right, up, forward] = self.axes();
        let size = if self.lens.is_perspective { depth } else { 1.0 };
        let across = self.lens.left + (self.lens.right - self.lens.left) * x;
        let above = self.lens.bottom + (self.lens.top - self.lens.bottom) * y;
        right * (across * size) + up * (above * size) + forward * depth
    }

    /// Returns whether a point relative to the eye is visible, up to a view depth.
    pub(crate) fn sees(&self, p: DVec3, last: f64) -> bool {
        let [right, up, forward] = self.axes();
        let depth = p.dot(forward);
        let size = if self.lens.is_perspective { depth } else { 1.0 };
        let (x, y) = (p.dot(right), p.dot(up));
        depth >= self.lens.near
            && depth <= last.min(self.lens.far)
            && x >= self.lens.left * size
            && x <= self.lens.right * size
            && y >= self.lens.bottom * size
            && y <= self.lens.top * size
    }
}

/// A share. Its ends and middle are more frequent.
pub(crate) fn share() -> impl Strategy<Value = f64> {
    prop_oneof![1 => Just(0.0), 1 => Just(1.0), 6 => double(0.0, 1.0)]
}

pub(crate) fn any_depth() -> impl Strategy<Value = DepthConvention> {
    prop_oneof![
        Just(DepthConvention::ZeroToOne),
        Just(DepthConvention::Reversed),
        Just(DepthConvention::NegativeOneToOne)
    ]
}

/// Perspective (symmetric or off-axis) and orthographic lenses, mirrored or not, of all depth conventions,
/// with 5 to 1,000 m of depth and near planes down to a thousandth of it.
pub(crate) fn any_lens() -> impl Strategy<Value = Lens> {
    let spans = (double(-0.9, 0.2), double(0.3, 1.2), double(-0.7, 0.1), double(0.2, 0.9));
    let planes = (double(0.7, 3.0), double(-3.0, -0.5));
    (any::<(bool, bool, bool, bool)>(), spans, planes, any_depth()).prop_map(
        |((is_perspective, is_off_axis, is_mirrored, is_infinite), (l, r, b, t), (far, near), depth)| {
            // Rounded to f32, since a frustum's planes are f32.
            let far = f64::from(10.0_f64.powf(far) as f32);
            let near = f64::from((far * 10.0_f64.powf(near)) as f32);
            let size = if is_perspective { 1.0 } else { far * 0.5 };
            let (left, bottom) = if is_off_axis { (l, b) } else { (-r, -t) };
            Lens {
                is_perspective,
                left: left * size,
                right: r * size,
                bottom: bottom * size,
                top: t * size,
                near,
                far,
                is_infinite: is_infinite && is_perspective,
                is_mirrored,
                depth,
            }
        },
    )
}

/// Positions 0, 1, 10 and 100 km from the world's origin, varied by a few metres.
pub(crate) fn any_eye() -> impl Strategy<Value = DVec3> {
    let distance = prop_oneof![Just(0.0), Just(1e3), Just(1e4), Just(1e5)];
    (distance, any_direction(), (double(-9.0, 9.0), double(-9.0, 9.0), double(-9.0, 9.0)))
        .prop_map(|(distance, d, (x, y, z))| d.as_dvec3() * distance + DVec3::new(x, y, z))
}

pub(crate) fn any_view() -> impl Strategy<Value = SceneView> {
    (any_lens(), any_eye(), any_direction(), any_direction())
        .prop_filter("up must not be parallel to forward", |(_, _, f, u)| f.cross(*u).length() > 0.1)
        .prop_map(|(lens, eye, forward, up)| SceneView { lens, eye, forward, up })
}

/// Lights from any direction. Vertical and level ones are more frequent.
pub(crate) fn any_light() -> impl Strategy<Value = Vec3> {
    prop_oneof![8 => any_direction(), 1 => Just(Vec3::NEG_Y), 1 => Just(Vec3::Y), 1 => Just(Vec3::new(0.6, 0.0, -0.8))]
}

/// A box by its position in a view and its half extents, as shares of the view's depth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoxPlan {
    place: [f64; 3],
    half: [f64; 3],
}

/// Boxes from a thousandth of the view's depth to all of it, some of them flat, some out of view.
pub(crate) fn any_box() -> impl Strategy<Value = BoxPlan> {
    let half = || prop_oneof![1 => Just(0.0), 4 => double(-3.0, 0.0).prop_map(|e| 10.0_f64.powf(e))];
    ([double(-0.3, 1.3), double(-0.3, 1.3), double(-0.2, 1.2)], [half(), half(), half()])
        .prop_map(|(place, half)| BoxPlan { place, half })
}

impl BoxPlan {
    /// Returns the box relative to an origin.
    pub(crate) fn aabb(&self, view: &SceneView, origin: DVec3) -> Aabb {
        let [x, y, z] = self.place;
        let (near, far) = (view.lens.near, view.lens.far);
        let centre = view.eye - origin + view.point(x, y, near + (far - near) * z);
        let half = DVec3::from_array(self.half) * far * 0.5;
        Aabb::new((centre - half).as_vec3(), (centre + half).as_vec3())
    }
}

/// Settings of a fit that guarantees coverage, without a caster policy.
pub(crate) fn any_covering_fit() -> impl Strategy<Value = FitSettings> {
    let kind = prop::sample::select(COVERING.to_vec());
    let rectangle = prop::sample::select(vec![
        RectangleKind::AxisAligned,
        RectangleKind::MinimumArea,
        RectangleKind::MinimumSquare,
    ]);
    let size = || prop::sample::select(vec![64_u32, 500, 1024, 2048]);
    let up = prop_oneof![2 => Just(Vec3::Y), 1 => Just(Vec3::Z), 1 => any_direction()];
    let margins = (prop_oneof![Just(0.0), float(0.0, 8.0)], prop_oneof![3 => Just(0.0), 1 => float(0.0, 3.0)]);
    let distance = prop_oneof![Just(f32::MAX), float(3.0, 500.0)];
    (kind, rectangle, (size(), size()), up, margins, distance, any_depth()).prop_map(
        |(kind, rectangle, (width, height), up, (border, margin), max_distance, depth)| FitSettings {
            shape: Shape { kind, rectangle, max_texel_ratio: f32::MAX },
            map: MapSettings {
                max_distance,
                margin,
                border: Some(border),
                casters: CasterPolicy::None,
                caster_extension: 0.0,
                up,
                least_texel: 0.0,
                resolution: UVec2::new(width, height),
                depth,
            },
        },
    )
}

pub(crate) fn any_splits() -> impl Strategy<Value = SplitScheme> {
    prop_oneof![
        Just(SplitScheme::Uniform),
        Just(SplitScheme::Logarithmic),
        float(0.0, 1.0).prop_map(SplitScheme::Practical),
        // Ascending. For most views, some are beyond their end.
        float(0.5, 20.0)
            .prop_map(|a| SplitScheme::Manual([0.0_f32, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0].map(|i| a * 1.7_f32.powf(i)))),
        Just(SplitScheme::FromBoxes),
        Just(SplitScheme::FromHistogram),
    ]
}

/// By coverage, and by view depth with any overlap.
pub(crate) fn any_choice() -> impl Strategy<Value = MapSelection> {
    let overlap = prop_oneof![Just(0.0), Just(1.0), float(0.0, 0.5)];
    prop_oneof![Just(MapSelection::default()), overlap.prop_map(|overlap| MapSelection::ViewDepth { overlap })]
}

/// One map, or cascades.
pub(crate) fn any_technique() -> impl Strategy<Value = Technique> {
    let stabilise = prop::sample::select(every_stabilise().to_vec());
    (any_covering_fit(), 1..=8_u32, any_splits(), any_choice(), stabilise).prop_map(
        |(fit, count, splits, selection, stabilise)| {
            sliced(&fit, Cascades { count, splits, selection, stabilise, ..Cascades::default() })
        },
    )
}

/// Returns a symmetric camera as a view of a scene.
pub(crate) fn of_camera(camera: &PerspectiveCamera) -> SceneView {
    let top = (f64::from(camera.fov_y) * 0.5).tan();
    let right = top * f64::from(camera.aspect);
    let lens = Lens {
        is_perspective: true,
        left: -right,
        right,
        bottom: -top,
        top,
        near: f64::from(camera.near),
        far: f64::from(camera.far),
        is_infinite: false,
        is_mirrored: false,
        depth: DepthConvention::ZeroToOne,
    };
    SceneView { lens, eye: camera.eye, forward: camera.forward, up: camera.up }
}

/// A step of a view from one frame to the next.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Walk {
    /// Movement of the eye, as a share of the view's depth.
    pub(crate) step: DVec3,
    pub(crate) axis: DVec3,
    /// Rotation about the axis, in radians.
    pub(crate) turn: f64,
}

impl Walk {
    pub(crate) fn moved(&self, view: &SceneView) -> SceneView {
        let (forward, up) = (self.turned(view.forward), self.turned(view.up));
        SceneView { eye: view.eye + self.step * view.lens.far, forward, up, ..*view }
    }

    pub(crate) fn moved_camera(&self, camera: &PerspectiveCamera) -> PerspectiveCamera {
        let (forward, up) = (self.turned(camera.forward), self.turned(camera.up));
        PerspectiveCamera { eye: camera.eye + self.step * f64::from(camera.far), forward, up, ..*camera }
    }

    fn turned(&self, direction: Vec3) -> Vec3 {
        (DQuat::from_axis_angle(self.axis, self.turn) * direction.as_dvec3()).as_vec3()
    }
}

/// Standing still, walking, turning, both, and leaps.
pub(crate) fn any_walk() -> impl Strategy<Value = Walk> {
    let step = prop_oneof![1 => Just(0.0), 3 => double(0.0, 0.01), 1 => double(0.0, 0.3)];
    let turn = prop_oneof![1 => Just(0.0), 3 => double(0.0, 0.02), 1 => double(0.0, 1.0)];
    (any_direction(), step, any_direction(), turn).prop_map(|(d, step, axis, turn)| Walk {
        step: d.as_dvec3() * step,
        axis: axis.as_dvec3().normalize(),
        turn,
    })
}
