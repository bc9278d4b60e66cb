// The pixels whose rays are traced.

struct List {
    count: LIST_COUNT,
    // Pixels that face the light within the distance of shadows, and those of them that are left to the filter.
    facing: LIST_COUNT,
    filtered: LIST_COUNT,
    // Of a list from which some were left out: how many there were before. Otherwise 0.
    unsure: u32,
    // Column, and row in the upper half.
    pixels: array<u32>,
}
