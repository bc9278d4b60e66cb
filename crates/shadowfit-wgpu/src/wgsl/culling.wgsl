// Which casters are drawn into the regions of a frame's passes: the twin of the tests of shadowfit's CasterVolume. Shapes
// are in world axes relative to the frame's origin, in metres. No shape that may throw a shadow is culled; rounding may
// keep one that the Rust test culls, or the other way round, within 1e-6 of the coordinates. NaN is not promised to count
// as touching.

struct shadowfit_CullingRegion {
    // (n, d): a point p is inside where dot(n, p) + d >= 0 for all of them.
    planes: array<vec4<f32>, MAX_REGION_PLANES>,
    viewport: vec4<f32>,
    scissor: vec4<u32>,
    map: u32,
    // 1 where casters that stand still, and where casters that move, belong into the region.
    fixed: u32,
    moving: u32,
    // The planes, from the first one on, that each of them lie inside.
    fixed_planes: u32,
    moving_planes: u32,
    padding_0: u32,
    padding_1: u32,
    padding_2: u32,
}

@group(GROUP) @binding(0) var<storage, read> shadowfit_regions: array<shadowfit_CullingRegion>;

// Rounding that the tests allow for, as a share of the coordinates: 16 times 2^-24.
const SHADOWFIT_ROUNDING: f32 = 9.5367431640625e-7;

// Whether casters that move, or those that stand still, belong into a region.
fn shadowfit_takes(region: u32, moves: bool) -> bool {
    return select(shadowfit_regions[region].fixed, shadowfit_regions[region].moving, moves) != 0u;
}

// The planes that casters that move, or those that stand still, lie inside, by their number.
fn shadowfit_plane_count(region: u32, moves: bool) -> u32 {
    return select(shadowfit_regions[region].fixed_planes, shadowfit_regions[region].moving_planes, moves);
}

// Whether what reaches so far along a plane's normal is behind the plane. size: sum of the shape's coordinates.
fn shadowfit_is_behind(plane: vec4<f32>, reach: f32, size: f32) -> bool {
    return reach + (plane.w + abs(plane.w) * SHADOWFIT_ROUNDING) < -size * SHADOWFIT_ROUNDING;
}

// Whether a caster in an axis-aligned box is drawn into a region.
fn shadowfit_draws_box(region: u32, moves: bool, box_min: vec3<f32>, box_max: vec3<f32>) -> bool {
    if !shadowfit_takes(region, moves) {
        return false;
    }
    let size = dot(abs(box_min) + abs(box_max), vec3<f32>(1.0));
    let count = shadowfit_plane_count(region, moves);
    for (var i = 0u; i < count; i += 1u) {
        let plane = shadowfit_regions[region].planes[i];
        let farthest = select(box_max, box_min, plane.xyz < vec3<f32>(0.0));
        if shadowfit_is_behind(plane, dot(plane.xyz, farthest), size) {
            return false;
        }
    }
    return all(box_min <= box_max);
}

// Whether a caster in a sphere is drawn into a region.
fn shadowfit_draws_sphere(region: u32, moves: bool, centre: vec3<f32>, radius: f32) -> bool {
    if !shadowfit_takes(region, moves) {
        return false;
    }
    let size = dot(abs(centre), vec3<f32>(1.0)) + radius;
    let count = shadowfit_plane_count(region, moves);
    for (var i = 0u; i < count; i += 1u) {
        let plane = shadowfit_regions[region].planes[i];
        if shadowfit_is_behind(plane, dot(plane.xyz, centre) + radius, size) {
            return false;
        }
    }
    return radius >= 0.0;
}

// Whether a caster in an oriented box is drawn into a region. half_axes: from its centre to the middles of three faces.
fn shadowfit_draws_oriented_box(region: u32, moves: bool, centre: vec3<f32>, half_axes: mat3x3<f32>) -> bool {
    if !shadowfit_takes(region, moves) {
        return false;
    }
    let size = dot(abs(centre) + abs(half_axes[0]) + abs(half_axes[1]) + abs(half_axes[2]), vec3<f32>(1.0));
    let count = shadowfit_plane_count(region, moves);
    for (var i = 0u; i < count; i += 1u) {
        let plane = shadowfit_regions[region].planes[i];
        // A vector times a matrix: its dot products with the columns.
        let along = dot(abs(plane.xyz * half_axes), vec3<f32>(1.0));
        if shadowfit_is_behind(plane, dot(plane.xyz, centre) + along, size) {
            return false;
        }
    }
    return true;
}
