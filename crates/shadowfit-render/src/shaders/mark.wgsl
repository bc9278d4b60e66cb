// What marks look like, which both of their passes read.

struct Marks {
    // Opacity, 0..1.
    strength: f32,
    // 1 for outlines, 0 for filled marks.
    outline: u32,
    // Which classes are marked: bit i for class i.
    classes: u32,
    padding: u32,
}

@group(GROUP) @binding(0) var<uniform> marks: Marks;

// Pixels that marks reach from a wrong one.
const REACH: i32 = 7;
