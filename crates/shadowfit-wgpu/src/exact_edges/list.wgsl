// The pixels whose rays are traced.

struct List {
    count: LIST_COUNT,
    // Pixels that face the light within the distance of shadows, and those of them that are left to the filter.
    facing: LIST_COUNT,
    filtered: LIST_COUNT,
    // Of a list from which some were left out: how many there were before. Otherwise 0.
    unsure: u32,
    pixels: array<Listed>,
}

struct Listed {
    // Column, and row in the upper half.
    pixel: u32,
    // The triangle of its first sample, once it is looked for: its place among those of the rays, or SHADOWFIT_RAYS_NONE, and its
    // instance.
    slot: u32,
    instance: u32,
}

fn pixel_of(listed: Listed) -> vec2<i32> {
    return vec2<i32>(i32(listed.pixel & 0xffffu), i32(listed.pixel >> 16u));
}
