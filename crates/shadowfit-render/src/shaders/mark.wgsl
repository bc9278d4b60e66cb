// Style of the marks, shared by both of their passes.

struct Marks {
    // Opacity, 0..1.
    strength: f32,
    // 1 for outlines, 0 for filled marks.
    outline: u32,
    // Marked classes: bit i for class i.
    classes: u32,
    padding: u32,
}

@group(GROUP) @binding(0) var<uniform> marks: Marks;

// Greatest distance of a mark from a wrong pixel, in pixels.
const REACH: i32 = 7;
