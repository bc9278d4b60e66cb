//! Cameras, lights, boxes and settings of every kind.

use shadowfit::Clusters;
use shadowfit::NormalCone;
use shadowfit::demand::DepthHistogram;
use shadowfit::glam::{DMat4, DVec3, DVec4, UVec2, Vec3};
use shadowfit::settings::{
    BiasSettings, CasterPolicy, Edges, FilterKind, FitKind, FitSettings, Hysteresis, MapFormat, MapSelection,
    MapSettings, RectangleKind, Shape, Softness, SplitScheme, Stabilise,
};
use shadowfit::{
    Aabb, Boxes, Cascades, DepthConvention, FitError, FitInput, Maps, PerspectiveCamera, Technique, ViewFrustum,
};

use crate::random::Random;

const DEPTHS: [DepthConvention; 3] =
    [DepthConvention::ZeroToOne, DepthConvention::Reversed, DepthConvention::NegativeOneToOne];

/// The inputs of one fit.
pub(crate) struct Scene {
    pub(crate) camera: PerspectiveCamera,
    pub(crate) views: Vec<ViewFrustum>,
    pub(crate) direction: Vec3,
    pub(crate) origin: DVec3,
    pub(crate) receivers: Option<Vec<Aabb>>,
    pub(crate) cones: Vec<NormalCone>,
    pub(crate) casters: Vec<Aabb>,
    pub(crate) histogram: Option<Vec<u32>>,
}

impl Scene {
    pub(crate) fn new(random: &mut Random) -> Result<Self, FitError> {
        let size = random.scale(-3, 7);
        let far_out = random.pick(&[0.0, 1e3, 1e5]);
        let eye = random.place(far_out);
        let near = size * random.scale(-8, -4);
        let camera = PerspectiveCamera {
            eye,
            forward: random.vector(),
            up: if random.once_in(4) { random.vector() } else { Vec3::Y },
            fov_y: random.between(0.2, 2.0),
            aspect: random.between(0.5, 3.0),
            near,
            far: near + size * random.scale(0, 2),
        };
        let mut views = vec![view(random, &camera)?];
        if random.once_in(4) {
            let other = PerspectiveCamera { eye: eye + random.place(f64::from(size) * 0.25), ..camera };
            views.push(other.frustum()?);
        }
        let origin = if random.once_in(2) { DVec3::ZERO } else { eye + random.place(10.0) };
        let centre = (eye - origin).as_vec3();
        let mut boxes = |limit: u32| -> Vec<Aabb> {
            let count = random.below(limit);
            (0..count).map(|_| aabb(random, centre, size)).collect()
        };
        let (receivers, casters, other) = (boxes(24), boxes(24), boxes(3));
        let (mut receivers, mut cones) = (Some(receivers).filter(|_| other.len() < 2), Vec::new());
        if random.once_in(16) {
            let clusters = clusters(random, centre, size)?;
            (receivers, cones) = (Some(clusters.boxes().to_vec()), clusters.cones().to_vec());
        }
        let direction = random.vector() * random.scale(-2, 2);
        let bins = random.once_in(3).then(|| (0..2 * BINS).map(|_| random.below(100)).collect());
        Ok(Self { camera, views, direction, origin, receivers, cones, casters, histogram: bins })
    }

    pub(crate) fn input(&self) -> FitInput<'_> {
        let boxes = |boxes| Boxes { origin: self.origin, boxes };
        FitInput {
            receivers: self.receivers.as_deref().map(boxes),
            receiver_cones: &self.cones,
            casters: Some(boxes(&self.casters)),
            histogram: self.histogram.as_deref().map(|bins| DepthHistogram {
                near: self.camera.near,
                far: self.camera.far,
                bins,
                classes: 2,
            }),
            ..FitInput::new(&self.views, self.direction)
        }
    }

    /// Advances to the next frame of a camera that moves and turns.
    pub(crate) fn advance(&mut self, random: &mut Random) -> Result<(), FitError> {
        let step = f64::from(self.camera.far) * 0.01;
        self.camera.eye += random.place(step);
        self.camera.forward += random.vector() * 0.01;
        self.views[0] = self.camera.frustum()?;
        Ok(())
    }
}

/// Number of bins of a histogram.
const BINS: u32 = 48;

/// Returns the camera's frustum through one of the constructors, or an orthographic one.
fn view(random: &mut Random, camera: &PerspectiveCamera) -> Result<ViewFrustum, FitError> {
    let frustum = camera.frustum()?;
    let depth = random.pick(&DEPTHS);
    let (near, far) = (f64::from(camera.near), f64::from(camera.far));
    let forward = frustum.forward.as_dvec3();
    // Matrix from clip space to world axes relative to the eye: the middle of the picture, and its sides.
    let [a, b, c] = [4, 5, 7].map(|i: usize| frustum.corners[i].as_dvec3());
    let (right, down) = ((b - a) * 0.5, (c - a) * 0.5);
    let middle = forward * (near - far) / f64::from(depth.near() - depth.far());
    let at_zero = forward * near - middle * f64::from(depth.near());
    let orthographic = DMat4::from_cols(
        right.extend(0.0),
        (-down).extend(0.0),
        middle.extend(0.0),
        DVec4::new(at_zero.x, at_zero.y, at_zero.z, 1.0),
    );
    let world = |matrix: DMat4| {
        let moved = |c: DVec4| (c.truncate() + camera.eye * c.w).extend(c.w);
        DMat4::from_cols(moved(matrix.x_axis), moved(matrix.y_axis), moved(matrix.z_axis), moved(matrix.w_axis))
    };
    match random.below(6) {
        0 => ViewFrustum::from_eye_from_clip(&orthographic.as_mat4(), camera.eye, depth, f32::MAX),
        1 => ViewFrustum::from_world_from_clip_f64(&world(orthographic), camera.eye, depth, camera.far * 0.75),
        2 => {
            let matrix = perspective(right / far, -down / far, forward, (near, far), depth);
            ViewFrustum::from_world_from_clip_f64(&world(matrix), camera.eye, depth, f32::MAX)
        }
        3 => {
            let matrix = perspective(right / far, -down / far, forward, (near, far), depth).as_mat4();
            ViewFrustum::from_eye_from_clip(&matrix, camera.eye, depth, camera.far * 0.5)
        }
        4 => frustum.slice(camera.near * 2.0, camera.far * 0.5),
        _ => Ok(frustum),
    }
}

/// Returns the matrix from clip space to world axes relative to the eye. It maps (x, y, z, 1) to (x right + y
/// up + forward) · depth, and w to 1 / depth, which is linear in z.
fn perspective(right: DVec3, up: DVec3, forward: DVec3, planes: (f64, f64), depth: DepthConvention) -> DMat4 {
    let (at_near, at_far) = (f64::from(depth.near()), f64::from(depth.far()));
    let slope = (1.0 / planes.0 - 1.0 / planes.1) / (at_near - at_far);
    let offset = 1.0 / planes.0 - slope * at_near;
    let column = DVec4::new(0.0, 0.0, 0.0, slope);
    DMat4::from_cols(right.extend(0.0), up.extend(0.0), column, forward.extend(offset))
}

fn aabb(random: &mut Random, centre: Vec3, size: f32) -> Aabb {
    let middle = centre + random.vector() * (2.0 * size);
    let half = (random.vector() * (size * random.scale(-5, -1))).abs();
    let half = if random.once_in(8) { half.with_y(0.0) } else { half };
    // Some are empty, as streamed objects may be.
    if random.once_in(32) { Aabb::EMPTY } else { Aabb::new(middle - half, middle + half) }
}

/// Returns the clusters of a crumpled sheet.
fn clusters(random: &mut Random, centre: Vec3, size: f32) -> Result<Clusters, FitError> {
    let mut heights = [[0.0; 9]; 9];
    for height in heights.iter_mut().flatten() {
        *height = random.between(-0.1, 0.1);
    }
    let corner = |i: usize, j: usize| {
        centre + Vec3::new(i as f32 * 0.25 - 1.0, heights[i][j] - 0.25, j as f32 * 0.25 - 1.0) * size
    };
    let cell = |i: usize, j: usize| {
        let [a, b, c, d] = [corner(i, j), corner(i, j + 1), corner(i + 1, j + 1), corner(i + 1, j)];
        [[a, b, c], [a, c, d]]
    };
    let triangles: Vec<[Vec3; 3]> = (0..8).flat_map(|i| (0..8).flat_map(move |j| cell(i, j))).collect();
    let (one, other) = triangles.split_at(50);
    Clusters::build(&[one, other], 12)
}

/// Returns settings of one map.
pub(crate) fn fit_settings(random: &mut Random, camera: &PerspectiveCamera) -> FitSettings {
    use CasterPolicy::{DepthClamp, Extend, None, PerObject, SceneBounds};
    let rectangles = [RectangleKind::AxisAligned, RectangleKind::MinimumArea, RectangleKind::MinimumSquare];
    let shape = Shape { kind: kind(random), rectangle: random.pick(&rectangles), max_texel_ratio: f32::MAX };
    let map = MapSettings {
        max_distance: if random.once_in(3) { camera.far * random.between(0.2, 1.5) } else { f32::MAX },
        margin: if random.once_in(4) { camera.far * random.between(0.0, 0.1) } else { 0.0 },
        border: Some(random.pick(&[0.0, 1.0, 2.5, 8.0])),
        casters: random.pick(&[None, Extend, SceneBounds, PerObject, DepthClamp]),
        caster_extension: camera.far * random.between(0.0, 2.0),
        up: random.pick(&[Vec3::Y, Vec3::Z, Vec3::new(0.3, 0.7, -0.2)]),
        least_texel: 0.0,
        resolution: random.pick(&[UVec2::splat(2048), UVec2::new(1024, 512), UVec2::new(333, 4096)]),
        depth: random.pick(&DEPTHS),
    };
    FitSettings { shape, map }
}

fn kind(random: &mut Random) -> FitKind {
    random.pick(&[FitKind::XnaSample, FitKind::FrustumAabb, FitKind::Oriented, FitKind::Sphere, FitKind::Focused])
}

/// Returns settings of several maps.
pub(crate) fn technique(random: &mut Random, camera: &PerspectiveCamera) -> Technique {
    let mut manual = [0.0; 7];
    for (share, cut) in (1_u8..).zip(&mut manual) {
        *cut = camera.near + (camera.far - camera.near) * (f32::from(share) / 8.0);
    }
    let schemes = [
        SplitScheme::Uniform,
        SplitScheme::Logarithmic,
        SplitScheme::Practical(random.between(0.0, 1.0)),
        SplitScheme::Manual(manual),
        SplitScheme::FromBoxes,
        SplitScheme::FromHistogram,
    ];
    let FitSettings { shape, map } = fit_settings(random, camera);
    let count = 1 + random.below(5);
    let (splits, overlap) = (random.pick(&schemes), random.pick(&[0.0, 0.1, 0.5]));
    let stability = random.pick(&[0, 1, 2]);
    let hold = Hysteresis { margin: 0.02, max_growth: 1.4, max_oversize: random.between(1.2, 3.0), look_ahead: 32 };
    // One in four once had a special rule for the nearest map. The draw stays, so that the later draws do not
    // change.
    if random.once_in(4) {
        kind(random);
    }
    let stabilise = match stability {
        0 => Stabilise::Off,
        1 => Stabilise::Snap { max_oversize: hold.max_oversize },
        _ => Stabilise::Hysteresis(hold),
    };
    let technique = Technique {
        maps: Cascades { count, shape, splits, selection: MapSelection::ViewDepth { overlap }, stabilise }.into(),
        fit: MapSettings { max_distance: f32::MAX, ..map },
        filter: FilterKind::Point,
        softness: Softness::default(),
        fade: 0.0,
        bias: BiasSettings { constant: 0.5, slope: 0.0, normal_offset: 0.0, receiver_plane: 0.0, depth_steps: 1.0 },
        format: MapFormat::Depth32Float,
        edges: Edges::Filtered,
    };
    technique.with_count(count)
}

/// Returns the technique with selection by coverage.
pub(crate) fn by_coverage(technique: Technique) -> Technique {
    match technique.maps {
        Maps::Cascades(cascades) => technique.with_maps(cascades.with_selection(MapSelection::default())),
        _ => technique,
    }
}
