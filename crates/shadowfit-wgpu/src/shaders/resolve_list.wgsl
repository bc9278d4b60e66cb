// The pixels whose rays are traced.

struct List {
    count: LIST_COUNT,
    // Pixels that face the light within the distance of shadows, and those of them that are left to the filter.
    facing: LIST_COUNT,
    filtered: LIST_COUNT,
    padding: u32,
    // Column, and row in the upper half.
    pixels: array<u32>,
}
