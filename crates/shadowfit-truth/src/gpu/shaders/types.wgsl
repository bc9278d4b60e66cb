// Types shared by the passes: the picture's camera, light and maps, and the pixels.

struct Map {
    // Rows of the matrix clip from eye-relative position.
    row_x: vec4<f32>,
    row_y: vec4<f32>,
    row_z: vec4<f32>,
    row_w: vec4<f32>,
    size: vec2<f32>,
    split_far: f32,
    is_reversed: u32,
    blend_near: f32,
    index: u32,
    // Width of the edge zone if this map is read: in pixels, or in texels if these are wider than pixels on
    // screen.
    edge_width: f32,
    padding: u32,
}

// The maps of the previous frame.
struct Before {
    // The previous frame's unit view direction.
    forward: vec3<f32>,
    // View depth of this frame's eye in the previous frame.
    eye_depth: f32,
    map_count: u32,
    by_coverage: u32,
    padding_0: u32,
    padding_1: u32,
    // Rows apply to positions relative to this frame's eye.
    maps: array<Map, 8>,
}

struct Judge {
    // Relative to the triangles' origin.
    eye: vec3<f32>,
    near: f32,
    right: vec3<f32>,
    far: f32,
    up: vec3<f32>,
    ray_offset: f32,
    forward: vec3<f32>,
    max_distance: f32,
    to_light: vec3<f32>,
    // Width of the edge zone if no map is read, in pixels.
    edge_width: f32,
    // Half size of the picture: at a view depth of 1, or at any view depth if the lens is orthographic.
    half_size: vec2<f32>,
    size: vec2<u32>,
    map_count: u32,
    depth_clamp: u32,
    triangles: u32,
    by_coverage: u32,
    // In texels.
    reach: f32,
    blend: f32,
    is_orthographic: u32,
    padding: u32,
    // In the order of selection.
    maps: array<Map, 8>,
    before: Before,
}

struct Pixel {
    flags: u32,
    // Pixels per texel along the worse axis.
    pixels_per_texel: f32,
    // Distance along the row to the nearest transition, in pixels.
    along_row: u32,
    // Cosine between the surface normal and the direction toward the light.
    facing: f32,
}

// Bits of Pixel.flags. The bits from MAP_SHIFT on hold the place in the order, plus 1, of the map that is
// read.
const JUDGED: u32 = 1u;
const LIT: u32 = 2u;
const SEEMS_LIT: u32 = 4u;
const GRAZING: u32 = 8u;
const COVERED_BEFORE: u32 = 16u;
const MAP_SHIFT: u32 = 8u;

// Greater than any relevant number of pixels per texel or distance. Used where the CPU uses infinity.
const FAR: f32 = 3.0e38;
const NONE: u32 = 0xffffffffu;

@group(1) @binding(0) var<uniform> judge: Judge;
// Triangle's index plus 1 (0 for the sky), and the bits of the filtered factor.
@group(1) @binding(1) var seen: texture_2d<u32>;
@group(1) @binding(2) var<storage, read_write> pixels: array<Pixel>;

fn pixel_index(pixel: vec2<u32>) -> u32 {
    return pixel.y * judge.size.x + pixel.x;
}
