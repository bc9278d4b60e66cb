// Convex quadrilaterals in the picture's pixels. Each is drawn as its bounding rectangle. The fragment shader
// clips it at its edges, smoothed over one pixel. A rectangle on whole pixels covers exactly these.

struct QuadIn {
    @builtin(vertex_index) corner: u32,
    // Two corners each, in pixels, y down.
    @location(0) first: vec4<f32>,
    @location(1) second: vec4<f32>,
    @location(2) color: vec4<f32>,
}

struct QuadOut {
    @builtin(position) pixel: vec4<f32>,
    // Distance of a pixel inside of each edge is dot(xy, pixel) + z.
    @location(0) @interpolate(flat) edge_0: vec3<f32>,
    @location(1) @interpolate(flat) edge_1: vec3<f32>,
    @location(2) @interpolate(flat) edge_2: vec3<f32>,
    @location(3) @interpolate(flat) edge_3: vec3<f32>,
    @location(4) @interpolate(flat) color: vec4<f32>,
}

// Distance inside of an edge for which the edge clips nothing, in pixels.
const WELL_INSIDE: f32 = 1e6;

// Returns the edge from a to b. turn: 1 if the corners turn from x to y, -1 if they turn the other way.
fn edge(a: vec2<f32>, b: vec2<f32>, turn: f32) -> vec3<f32> {
    let along = b - a;
    let size = length(along);
    if size < 1e-6 {
        return vec3<f32>(0.0, 0.0, WELL_INSIDE);
    }
    let inward = vec2<f32>(-along.y, along.x) * (turn / size);
    return vec3<f32>(inward, -dot(inward, a));
}

@vertex
fn vs_quad(in: QuadIn) -> QuadOut {
    let a = in.first.xy;
    let b = in.first.zw;
    let c = in.second.xy;
    let d = in.second.zw;
    let low = min(min(a, b), min(c, d)) - 1.0;
    let high = max(max(a, b), max(c, d)) + 1.0;
    let corner = vec2<f32>(f32(in.corner & 1u), f32(in.corner >> 1u));
    let ndc = mix(low, high, corner) / frame.viewport * vec2<f32>(2.0, -2.0) + vec2<f32>(-1.0, 1.0);
    // Twice the area, from the diagonals.
    let area = (c.x - a.x) * (d.y - b.y) - (c.y - a.y) * (d.x - b.x);
    let turn = sign(area);
    let clip = select(vec4<f32>(ndc, 0.0, 1.0), vec4<f32>(2.0, 2.0, 2.0, 1.0), turn == 0.0);
    return QuadOut(clip, edge(a, b, turn), edge(b, c, turn), edge(c, d, turn), edge(d, a, turn), in.color);
}

// Returns the share of a pixel's width that lies inside of an edge.
fn inside(edge: vec3<f32>, pixel: vec2<f32>) -> f32 {
    return saturate(dot(edge.xy, pixel) + edge.z + 0.5);
}

@fragment
fn fs_quad(in: QuadOut) -> @location(0) vec4<f32> {
    let pixel = in.pixel.xy;
    // Coverage between opposite edges, which may both cut the pixel.
    let across = saturate(inside(in.edge_0, pixel) + inside(in.edge_2, pixel) - 1.0);
    let down = saturate(inside(in.edge_1, pixel) + inside(in.edge_3, pixel) - 1.0);
    return vec4<f32>(in.color.rgb, in.color.a * across * down);
}
