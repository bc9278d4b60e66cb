// Vertex stage of a sample's picture, and the data of a visible point.

struct PointIn {
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(3) uv: vec2<f32>,
    @location(5) row0: vec4<f32>,
    @location(6) row1: vec4<f32>,
    @location(7) row2: vec4<f32>,
    // Number of the instance's first triangle.
    @location(8) number: u32,
}

struct PointOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    @location(3) @interpolate(flat) number: u32,
}

fn sample_vertex(in: PointIn) -> PointOut {
    let local = vec4<f32>(in.position, 1.0);
    let position = vec3<f32>(dot(in.row0, local), dot(in.row1, local), dot(in.row2, local));
    let cofactors = mat3x3<f32>(
        cross(in.row1.xyz, in.row2.xyz), cross(in.row2.xyz, in.row0.xyz), cross(in.row0.xyz, in.row1.xyz));
    let normal = vec3<f32>(dot(cofactors[0], in.normal), dot(cofactors[1], in.normal), dot(cofactors[2], in.normal));
    return PointOut(sample.clip_from_world * vec4<f32>(position, 1.0), position, normal, in.uv, in.number);
}

@vertex
fn vs_sample(in: PointIn) -> PointOut {
    return sample_vertex(in);
}

// A visible point in the light's image.
struct Seen {
    // Texture coordinates in the light's image, u right, v down.
    uv: vec2<f32>,
    // Depth after the division by w, 0 near.
    depth: f32,
    // Distance along the light's axis. 1 for a light without a position.
    w: f32,
}

fn seen_at(position: vec3<f32>) -> Seen {
    let clip = sample.light_from_world * vec4<f32>(position, 1.0);
    let ndc = clip.xyz / clip.w;
    return Seen(ndc.xy * vec2<f32>(0.5, -0.5) + 0.5, ndc.z, clip.w);
}

// Data of a visible point for tests and shadings.
struct Point {
    seen: Seen,
    position: vec3<f32>,
    // Unit normals: the triangle's on the side of the eye, and the interpolated one.
    geometric: vec3<f32>,
    normal: vec3<f32>,
    // Unit directions.
    to_light: vec3<f32>,
    to_eye: vec3<f32>,
    // The texture's colour, in display values.
    base: vec3<f32>,
}

// Requires uniform control flow, because it takes derivatives.
fn point_of(in: PointOut) -> Point {
    let across = normalize(cross(dpdy(in.position), dpdx(in.position)));
    let geometric = select(across, -across, dot(across, in.position) > 0.0);
    let to_light = normalize(sample.light.xyz - in.position * sample.light.w);
    let base = encoded(base_color(in.uv).rgb);
    return Point(
        seen_at(in.position), in.position, geometric, normalize(in.normal), to_light, -normalize(in.position), base);
}
