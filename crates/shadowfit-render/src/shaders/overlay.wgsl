// Shared by the overlays. Each overlay has a function `overlaid` that colours a visible point. Comes after
// scene.wgsl.

@fragment
fn fs_overlay(in: SceneOut) -> @location(0) vec4<f32> {
    let color = overlaid(in);
    if is_cut_out(in.uv, in.color.a) {
        discard;
    }
    return color;
}

// Returns the luminance of a linear colour (ITU-R BT.709).
fn luminance(color: vec3<f32>) -> f32 {
    return dot(color, vec3<f32>(0.2126, 0.7152, 0.0722));
}

// Decodes an sRGB colour to a linear one.
fn decoded(color: vec3<f32>) -> vec3<f32> {
    return select(pow((color + 0.055) / 1.055, vec3<f32>(2.4)), color / 12.92, color <= vec3<f32>(0.04045));
}

// Returns thin diagonal lines, 1 on a line and 0 between lines, with smooth edges. pixel: in the picture.
fn hatching(pixel: vec2<f32>) -> f32 {
    // Pixels between two lines, measured along a row.
    let period = 8.0;
    let place = fract((pixel.x + pixel.y) / period) * period;
    return saturate(1.5 - abs(place - 0.5 * period));
}

// Returns the map with the greatest weight in a point's shadow, by its place in the order; -1 outside every
// map.
fn place_read(position: vec3<f32>) -> i32 {
    let selection = shadowfit_select(position);
    let is_second = selection.second >= 0 && selection.weight < 0.5;
    return select(selection.first, selection.second, is_second);
}

// Returns the light on a surface without a colour, 0..1, to show shapes and shadows under an overlay.
fn relief(surface: Surface, factor: f32) -> f32 {
    let facing = smoothstep(0.0, 0.08, dot(surface.geometric, frame.to_light));
    let sun = saturate(dot(surface.normal, frame.to_light)) * facing * factor;
    let sky = surface.normal.y * 0.5 + 0.5;
    return sqrt(saturate(0.18 + 0.32 * sky + 0.5 * sun));
}

// Change of a point's position in a map from one pixel to the next, in texels.
struct Footprint {
    right: vec2<f32>,
    down: vec2<f32>,
}

// Returns how far a visible point moves on its tangent plane when its line of sight is moved by `across`; for
// a perspective, at a view depth of 1.
fn slide(position: vec3<f32>, normal: vec3<f32>, across: vec3<f32>) -> vec3<f32> {
    let sight = line_of_sight(position);
    let moved = across * select(dot(position, frame.ray_forward.xyz), 1.0, frame.parallel > 0.0);
    return moved - sight * (dot(moved, normal) / dot(sight, normal));
}

fn footprint(map: shadowfit_Map, position: vec3<f32>, normal: vec3<f32>) -> Footprint {
    let to_right = slide(position, normal, frame.ray_right.xyz * (2.0 / frame.viewport.x));
    let to_down = slide(position, normal, frame.ray_up.xyz * (-2.0 / frame.viewport.y));
    let right = (map.uv_from_world * vec4<f32>(to_right, 0.0)).xy * map.size;
    let down = (map.uv_from_world * vec4<f32>(to_down, 0.0)).xy * map.size;
    return Footprint(right, down);
}
