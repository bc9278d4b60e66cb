// Shadow test with a comparison sampler. test.x: epsilon, test.y: its sign.

// Least arc cosine. In perpendicular light the term is at its limit anyway.
const LEAST_ANGLE: f32 = 1e-6;
const MOST_EPSILON: f32 = 0.1;

fn comparison_epsilon(epsilon: f32, n_l: f32) -> f32 {
    return clamp(epsilon / max(acos(saturate(n_l)), LEAST_ANGLE), 0.0, MOST_EPSILON);
}

// All points outside the light's image, or in front of its near plane, are lit.
fn comparison_is_inside(uv: vec2<f32>, depth: f32) -> bool {
    return all(uv >= vec2<f32>(0.0)) && all(uv <= vec2<f32>(1.0)) && depth > 0.0;
}

fn light_share(point: Point) -> f32 {
    let epsilon = comparison_epsilon(sample.test.x, dot(point.normal, point.to_light)) * sample.test.y;
    let share = compared(point.seen.uv, point.seen.depth + epsilon);
    return select(1.0, share, comparison_is_inside(point.seen.uv, point.seen.depth));
}
