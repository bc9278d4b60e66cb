// Powers by squaring: the general pow is the most expensive operation in these shaders.
fn pow5(x: f32) -> f32 {
    let square = x * x;
    return square * square * x;
}

fn pow8(x: f32) -> f32 {
    let square = x * x;
    let fourth = square * square;
    return fourth * fourth;
}
