// Selects the casters to draw into the regions of a frame's passes: the GPU version of the tests of
// shadowfit's CasterVolume. Shapes are in world axes relative to the frame's origin, in metres. No shape that
// may cast a visible shadow is culled. Because of rounding, the results may differ from the Rust test within
// 1e-6 of the coordinates. Shapes with NaN may be culled.

struct shadowfit_CullingRegion {
    // (n, d): a point p is inside if dot(n, p) + d >= 0 for all planes.
    planes: array<vec4<f32>, MAX_REGION_PLANES>,
    viewport: vec4<f32>,
    scissor: vec4<u32>,
    map: u32,
    // 1 if static casters belong in the region, and 1 if moving casters do.
    fixed: u32,
    moving: u32,
    // Number of leading planes that static casters and moving casters are culled by.
    fixed_planes: u32,
    moving_planes: u32,
    padding_0: u32,
    padding_1: u32,
    padding_2: u32,
}

@group(GROUP) @binding(0) var<storage, read> shadowfit_regions: array<shadowfit_CullingRegion>;

// Rounding that the tests allow for, relative to the coordinates: 16 times 2^-24.
const SHADOWFIT_ROUNDING: f32 = 9.5367431640625e-7;

// Returns whether moving or static casters belong in a region.
fn shadowfit_takes(region: u32, moves: bool) -> bool {
    return select(shadowfit_regions[region].fixed, shadowfit_regions[region].moving, moves) != 0u;
}

// Returns the number of planes that moving or static casters are culled by.
fn shadowfit_plane_count(region: u32, moves: bool) -> u32 {
    return select(shadowfit_regions[region].fixed_planes, shadowfit_regions[region].moving_planes, moves);
}

// Returns whether a shape lies behind a plane. reach: its greatest distance along the plane's normal. size:
// sum of its coordinates.
fn shadowfit_is_behind(plane: vec4<f32>, reach: f32, size: f32) -> bool {
    return reach + (plane.w + abs(plane.w) * SHADOWFIT_ROUNDING) < -size * SHADOWFIT_ROUNDING;
}

// Returns whether a caster in an axis-aligned box is drawn into a region.
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

// Returns whether a caster in a sphere is drawn into a region.
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

// Returns whether a caster in an oriented box is drawn into a region. half_axes: vectors from its centre to
// the centres of three faces.
fn shadowfit_draws_oriented_box(region: u32, moves: bool, centre: vec3<f32>, half_axes: mat3x3<f32>) -> bool {
    if !shadowfit_takes(region, moves) {
        return false;
    }
    let size = dot(abs(centre) + abs(half_axes[0]) + abs(half_axes[1]) + abs(half_axes[2]), vec3<f32>(1.0));
    let count = shadowfit_plane_count(region, moves);
    for (var i = 0u; i < count; i += 1u) {
        let plane = shadowfit_regions[region].planes[i];
        // Vector times matrix: the dot products with the columns.
        let along = dot(abs(plane.xyz * half_axes), vec3<f32>(1.0));
        if shadowfit_is_behind(plane, dot(plane.xyz, centre) + along, size) {
            return false;
        }
    }
    return true;
}
