// The shaded pass: sun with shadow, sky and ground light, tone curve.

struct SceneIn {
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec4<f32>,
    @location(3) uv: vec2<f32>,
    @location(4) color: vec4<f32>,
    @location(5) row0: vec4<f32>,
    @location(6) row1: vec4<f32>,
    @location(7) row2: vec4<f32>,
    // Number of the instance: its first triangle, or the map that holds it for the overlay of casters.
    @location(8) number: u32,
}

struct SceneOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec4<f32>,
    @location(3) uv: vec2<f32>,
    @location(4) color: vec4<f32>,
    @location(5) @interpolate(flat) number: u32,
}

fn scene_vertex(in: SceneIn) -> SceneOut {
    let local = vec4<f32>(in.position, 1.0);
    let position = vec3<f32>(dot(in.row0, local), dot(in.row1, local), dot(in.row2, local));
    // Normals use the cofactors of the transform, which also handle non-uniform and mirrored scales.
    let a = in.row0.xyz;
    let b = in.row1.xyz;
    let c = in.row2.xyz;
    let cofactors = mat3x3<f32>(cross(b, c), cross(c, a), cross(a, b));
    let mirror = sign(dot(a, cofactors[0]));
    let normal = vec3<f32>(
        dot(cofactors[0], in.normal), dot(cofactors[1], in.normal), dot(cofactors[2], in.normal)) * mirror;
    let tangent = vec3<f32>(dot(a, in.tangent.xyz), dot(b, in.tangent.xyz), dot(c, in.tangent.xyz));
    var out: SceneOut;
    out.clip = frame.clip_from_world * vec4<f32>(position, 1.0);
    out.position = position;
    out.normal = normal;
    out.tangent = vec4<f32>(tangent, in.tangent.w * mirror);
    out.uv = in.uv;
    out.color = in.color;
    out.number = in.number;
    return out;
}

@vertex
fn vs_scene(in: SceneIn) -> SceneOut {
    return scene_vertex(in);
}

// Returns the unit normal of the triangle itself, on the eye's side. `dx`, `dy`: the derivatives of the
// position, taken in uniform control flow.
fn geometric_normal(position: vec3<f32>, dx: vec3<f32>, dy: vec3<f32>) -> vec3<f32> {
    let normal = normalize(cross(dy, dx));
    return select(normal, -normal, dot(normal, line_of_sight(position)) > 0.0);
}

// Returns the interpolated normal, perturbed by the normal map, on the side of the geometric normal.
fn shading_normal(in: SceneOut, geometric: vec3<f32>, texel: vec3<f32>) -> vec3<f32> {
    let length_squared = dot(in.normal, in.normal);
    var normal = select(geometric, in.normal * inverseSqrt(max(length_squared, 1e-30)), length_squared > 1e-20);
    normal = select(normal, -normal, dot(normal, geometric) < 0.0);
    let tangent = in.tangent.xyz - normal * dot(in.tangent.xyz, normal);
    let tangent_squared = dot(tangent, tangent);
    if material.normal_scale > 0.0 && tangent_squared > 1e-12 {
        let t = tangent * inverseSqrt(tangent_squared);
        let b = cross(normal, t) * in.tangent.w;
        let bend = (texel * 2.0 - 1.0) * vec3<f32>(material.normal_scale, material.normal_scale, 1.0);
        normal = normalize(t * bend.x + b * bend.y + normal * max(bend.z, 1e-3));
    }
    return normal;
}

// Returns the light of sky and ground on a surface.
fn ambient(base: vec3<f32>, normal: vec3<f32>, to_eye: vec3<f32>) -> vec3<f32> {
    let up = normal.y * 0.5 + 0.5;
    let sky = mix(frame.zenith.rgb, frame.horizon.rgb, 0.55);
    let light = mix(frame.ground.rgb, sky, up);
    let f0 = mix(vec3<f32>(0.04), base, material.metallic);
    let gloss = (1.0 - material.roughness) * (1.0 - material.roughness);
    let grazing = pow5(1.0 - saturate(dot(normal, to_eye)));
    let mirrored = sky_radiance(reflect(-to_eye, normal)) * (f0 + (1.0 - f0) * grazing) * gloss;
    return base * light * (1.0 - material.metallic * 0.6) + mirrored;
}

// Shading inputs of a visible point.
struct Surface {
    // Base colour and alpha.
    base: vec4<f32>,
    // Unit normal of the triangle, on the eye's side, and the shading normal.
    geometric: vec3<f32>,
    normal: vec3<f32>,
    to_eye: vec3<f32>,
}

// Takes derivatives, so call it in uniform control flow.
fn surface_of(in: SceneOut) -> Surface {
    let texel = textureSample(normal_texture, normal_sampler, transformed_uv(material.normal_uv, in.uv)).xyz;
    let base = base_color(in.uv) * in.color;
    let geometric = geometric_normal(in.position, dpdx(in.position), dpdy(in.position));
    return Surface(base, geometric, shading_normal(in, geometric, texel), -normalize(line_of_sight(in.position)));
}

// Returns the share of the sun's light that reaches a visible point. Edges of blended surfaces are not
// traced.
fn mapped_factor(in: SceneOut, surface: Surface) -> f32 {
    // No branch depends on a uniform only: software rasterisers would compile a shader for each draw.
    var factor = select(shadowfit_stored_factor(in.clip.xy), -1.0, material.blended > 0.0);
    if factor < 0.0 {
        factor = shadowfit_factor_at(in.position, surface.geometric, in.clip.xy);
    }
    return mix(1.0, factor, frame.shadows);
}

// Returns the colour of a visible point that a share of the sun's light reaches.
fn lit(in: SceneOut, surface: Surface, factor: f32) -> vec3<f32> {
    // A surface that faces away from the sun is dark, regardless of its interpolated normal.
    let facing = smoothstep(0.0, 0.08, dot(surface.geometric, frame.to_light));
    let sunlight = frame.sun * (factor * facing);
    let radiance = reflectance(surface.base.rgb, surface.normal, surface.to_eye, frame.to_light) * sunlight
        + ambient(surface.base.rgb, surface.normal, surface.to_eye)
        + material.emissive;
    return tone_map(with_haze(radiance, in.position));
}

fn opacity(surface: Surface) -> f32 {
    return mix(1.0, surface.base.a, material.blended);
}

// Returns the colour of a visible point. Takes derivatives, so call it in uniform control flow.
fn shaded(in: SceneOut) -> vec4<f32> {
    let surface = surface_of(in);
    return vec4<f32>(lit(in, surface, mapped_factor(in, surface)), opacity(surface));
}

@fragment
fn fs_scene(in: SceneOut) -> @location(0) vec4<f32> {
    let color = shaded(in);
    if is_cut_out(in.uv, in.color.a) {
        discard;
    }
    return color;
}
