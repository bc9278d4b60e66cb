// Which maps a caster is to be drawn into: the twin of shadowfit's CasterVolume. Shapes are in world axes relative to
// the origin of the volumes, in metres. No shape that may throw a shadow is culled; rounding may keep one that the Rust
// test culls, or the other way round, within 1e-6 of the coordinates. NaN is not promised to count as touching.

struct shadowfit_CasterPlanes {
    // (n, d): a point p is inside where dot(n, p) + d >= 0 for all of them.
    planes: array<vec4<f32>, MAX_PLANES>,
    count: u32,
}

struct shadowfit_Culling {
    volume_count: u32,
    padding_0: u32,
    padding_1: u32,
    padding_2: u32,
    volumes: array<shadowfit_CasterPlanes, MAX_MAPS>,
}

@group(GROUP) @binding(0) var<uniform> shadowfit_culling: shadowfit_Culling;

// Rounding that the tests allow for, as a share of the coordinates: 16 times 2^-24.
const SHADOWFIT_ROUNDING: f32 = 9.5367431640625e-7;

// Whether what reaches so far along a plane's normal is behind the plane. size: sum of the shape's coordinates.
fn shadowfit_is_behind(plane: vec4<f32>, reach: f32, size: f32) -> bool {
    return reach + (plane.w + abs(plane.w) * SHADOWFIT_ROUNDING) < -size * SHADOWFIT_ROUNDING;
}

// Whether an axis-aligned box may throw a shadow into a map.
fn shadowfit_touches_box(map: u32, box_min: vec3<f32>, box_max: vec3<f32>) -> bool {
    let size = dot(abs(box_min) + abs(box_max), vec3<f32>(1.0));
    for (var i = 0u; i < shadowfit_culling.volumes[map].count; i += 1u) {
        let plane = shadowfit_culling.volumes[map].planes[i];
        let farthest = select(box_max, box_min, plane.xyz < vec3<f32>(0.0));
        if shadowfit_is_behind(plane, dot(plane.xyz, farthest), size) {
            return false;
        }
    }
    return all(box_min <= box_max);
}

// Whether a sphere may throw a shadow into a map.
fn shadowfit_touches_sphere(map: u32, centre: vec3<f32>, radius: f32) -> bool {
    let size = dot(abs(centre), vec3<f32>(1.0)) + radius;
    for (var i = 0u; i < shadowfit_culling.volumes[map].count; i += 1u) {
        let plane = shadowfit_culling.volumes[map].planes[i];
        if shadowfit_is_behind(plane, dot(plane.xyz, centre) + radius, size) {
            return false;
        }
    }
    return radius >= 0.0;
}

// Whether an oriented box may throw a shadow into a map. half_axes: from its centre to the middles of three faces.
fn shadowfit_touches_oriented_box(map: u32, centre: vec3<f32>, half_axes: mat3x3<f32>) -> bool {
    let size = dot(abs(centre) + abs(half_axes[0]) + abs(half_axes[1]) + abs(half_axes[2]), vec3<f32>(1.0));
    for (var i = 0u; i < shadowfit_culling.volumes[map].count; i += 1u) {
        let plane = shadowfit_culling.volumes[map].planes[i];
        // A vector times a matrix: its dot products with the columns.
        let along = dot(abs(plane.xyz * half_axes), vec3<f32>(1.0));
        if shadowfit_is_behind(plane, dot(plane.xyz, centre) + along, size) {
            return false;
        }
    }
    return true;
}

// The maps that an axis-aligned box may throw a shadow into: bit i for map i.
fn shadowfit_cull_box(box_min: vec3<f32>, box_max: vec3<f32>) -> u32 {
    var mask = 0u;
    for (var map = 0u; map < shadowfit_culling.volume_count; map += 1u) {
        mask |= select(0u, 1u << map, shadowfit_touches_box(map, box_min, box_max));
    }
    return mask;
}
