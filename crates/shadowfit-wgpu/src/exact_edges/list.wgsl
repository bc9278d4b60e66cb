// List of the pixels to trace.

struct List {
    count: LIST_COUNT,
    // Number of pixels that face the light within the shadow distance, and number of these that the filter
    // decides.
    facing: LIST_COUNT,
    filtered: LIST_COUNT,
    // Number of listed pixels before the budget removed some; 0 without a budget.
    unsure: u32,
    pixels: array<Listed>,
}

struct Listed {
    // Column, and row in the upper half.
    pixel: u32,
    // Triangle of the pixel's first sample, after the third pass: its slot among the rays' triangles, or
    // SHADOWFIT_RAYS_NONE, and its instance.
    slot: u32,
    instance: u32,
}

fn pixel_of(listed: Listed) -> vec2<i32> {
    return vec2<i32>(i32(listed.pixel & 0xffffu), i32(listed.pixel >> 16u));
}
