// Parts of the scene in the passes of screen-space ambient occlusion. Comes after frame.wgsl and
// material.wgsl.

struct PartIn {
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(3) uv: vec2<f32>,
    @location(4) color: vec4<f32>,
    @location(5) row0: vec4<f32>,
    @location(6) row1: vec4<f32>,
    @location(7) row2: vec4<f32>,
}

struct PartOut {
    @builtin(position) clip: vec4<f32>,
    // Relative to the eye.
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    @location(3) color: vec4<f32>,
}

// Computes positions as the shaded pass and the probe do, so that all of them show the same triangle at a
// pixel's middle.
@vertex
fn vs_part(in: PartIn) -> PartOut {
    let local = vec4<f32>(in.position, 1.0);
    let position = vec3<f32>(dot(in.row0, local), dot(in.row1, local), dot(in.row2, local));
    // Cofactors of the transform rotate the normals. The side is chosen for each pixel.
    let a = in.row0.xyz;
    let b = in.row1.xyz;
    let c = in.row2.xyz;
    let normal = vec3<f32>(
        dot(cross(b, c), in.normal), dot(cross(c, a), in.normal), dot(cross(a, b), in.normal));
    return PartOut(frame.clip_from_world * vec4<f32>(position, 1.0), position, normal, in.uv, in.color);
}

// Unit interpolated normal, on the side of the eye. Requires uniform control flow, because it takes
// derivatives.
fn part_normal(in: PartOut) -> vec3<f32> {
    let geometric = normalize(cross(dpdy(in.position), dpdx(in.position)));
    let facing = select(geometric, -geometric, dot(geometric, in.position) > 0.0);
    let squared = dot(in.normal, in.normal);
    let normal = select(facing, in.normal * inverseSqrt(max(squared, 1e-30)), squared > 1e-20);
    return select(normal, -normal, dot(normal, facing) < 0.0);
}
