// What the passes share: the scene's triangles, the picture's camera, light and maps, and the pixels.

struct Node {
    least: vec3<f32>,
    // Triangles of a leaf, 0 for an inner node.
    count: u32,
    most: vec3<f32>,
    // A leaf's first triangle, or the first of an inner node's two children, which stand side by side.
    first: u32,
}

// Corners relative to the origin, in leaf order.
struct Triangle {
    a: vec3<f32>,
    // Index of its cut-out plus 1, 0 for none.
    cut_out: u32,
    b: vec3<f32>,
    padding_0: u32,
    c: vec3<f32>,
    padding_1: u32,
}

struct CutOut {
    uv_a: vec2<f32>,
    uv_b: vec2<f32>,
    uv_c: vec2<f32>,
    base_alpha: f32,
    cutoff: f32,
    alphas: vec3<f32>,
    // Index of its image plus 1, 0 for none.
    image: u32,
    wrap: vec2<u32>,
    nearest: u32,
    padding: u32,
}

struct Image {
    // Its first byte among all alphas.
    first: u32,
    width: i32,
    height: i32,
    padding: u32,
}

struct Map {
    // Rows of clip from positions relative to the eye.
    row_x: vec4<f32>,
    row_y: vec4<f32>,
    row_z: vec4<f32>,
    row_w: vec4<f32>,
    size: vec2<f32>,
    split_far: f32,
    is_reversed: u32,
    blend_near: f32,
    index: u32,
    // Of the edge zone where it is read: in pixels, or in texels where those are wider than pixels on screen.
    edge_width: f32,
    padding: u32,
}

// The maps of the frame before.
struct Before {
    // Its unit direction of view.
    forward: vec3<f32>,
    // View depth of this frame's eye in it.
    eye_depth: f32,
    map_count: u32,
    by_coverage: u32,
    padding_0: u32,
    padding_1: u32,
    // Their rows are of positions relative to this frame's eye.
    maps: array<Map, 8>,
}

struct Judge {
    // Relative to the origin.
    eye: vec3<f32>,
    near: f32,
    right: vec3<f32>,
    far: f32,
    up: vec3<f32>,
    ray_offset: f32,
    forward: vec3<f32>,
    max_distance: f32,
    to_light: vec3<f32>,
    // Of the edge zone where no map is read, in pixels.
    edge_width: f32,
    tan_half_fov: vec2<f32>,
    size: vec2<u32>,
    map_count: u32,
    depth_clamp: u32,
    triangles: u32,
    by_coverage: u32,
    // In texels.
    reach: f32,
    blend: f32,
    padding_0: u32,
    padding_1: u32,
    // In the order in which points try them.
    maps: array<Map, 8>,
    before: Before,
}

struct Pixel {
    flags: u32,
    // Pixels per texel along the worse axis.
    pixels_per_texel: f32,
    // Distance along the row to the nearest transition, in pixels.
    along_row: u32,
}

// Bits of Pixel.flags; above them stands the place in the order, plus 1, of the map that is read.
const JUDGED: u32 = 1u;
const LIT: u32 = 2u;
const SEEMS_LIT: u32 = 4u;
const GRAZING: u32 = 8u;
const COVERED_BEFORE: u32 = 16u;
const MAP_SHIFT: u32 = 8u;

// Greater than any pixels per texel or distance that matters; used where the CPU uses infinity.
const FAR: f32 = 3.0e38;
const NONE: u32 = 0xffffffffu;

@group(0) @binding(0) var<storage, read> nodes: array<Node>;
@group(0) @binding(1) var<storage, read> triangles: array<Triangle>;
// Leaf-order index of each triangle by its own index.
@group(0) @binding(2) var<storage, read> slots: array<u32>;
@group(0) @binding(3) var<storage, read> cut_outs: array<CutOut>;
@group(0) @binding(4) var<storage, read> images: array<Image>;
// Four bytes each, the first one lowest.
@group(0) @binding(5) var<storage, read> alphas: array<u32>;

@group(1) @binding(0) var<uniform> judge: Judge;
// Triangle's index plus 1 (0 for the sky), and the bits of the filtered factor.
@group(1) @binding(1) var seen: texture_2d<u32>;
@group(1) @binding(2) var<storage, read_write> pixels: array<Pixel>;

fn pixel_index(pixel: vec2<u32>) -> u32 {
    return pixel.y * judge.size.x + pixel.x;
}
