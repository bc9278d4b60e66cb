// Reflected sunlight per unit of irradiance: Lambert plus GGX (Walter et al., 2007) with the
// visibility term of Hammon (2017) and Schlick's Fresnel (1994).
fn reflectance(base: vec3<f32>, normal: vec3<f32>, to_eye: vec3<f32>, to_light: vec3<f32>) -> vec3<f32> {
    let halfway = normalize(to_eye + to_light);
    let n_l = saturate(dot(normal, to_light));
    let n_v = max(dot(normal, to_eye), 1e-3);
    let n_h = saturate(dot(normal, halfway));
    let roughness = clamp(material.roughness * material.roughness, 0.03, 1.0);
    let a2 = roughness * roughness;
    let denominator = n_h * n_h * (a2 - 1.0) + 1.0;
    let distribution = a2 / (3.14159265 * denominator * denominator);
    let visibility = 0.5 / max(mix(2.0 * n_l * n_v, n_l + n_v, roughness), 1e-4);
    let f0 = mix(vec3<f32>(0.04), base, material.metallic);
    let fresnel = f0 + (1.0 - f0) * pow5(1.0 - saturate(dot(to_eye, halfway)));
    let diffuse = base * (1.0 - material.metallic) * (1.0 - fresnel) / 3.14159265;
    return (diffuse + fresnel * distribution * visibility) * n_l * 3.14159265;
}
