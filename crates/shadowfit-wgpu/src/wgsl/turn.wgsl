
// Returns the rotation of a disc of look-ups at a pixel, in radians: interleaved gradient noise (J. Jimenez,
// "Next generation post processing in Call of Duty: Advanced Warfare", SIGGRAPH courses, 2014), whose values
// are spread evenly over any 3x3 pixels. frame_shift moves it from frame to frame.
fn shadowfit_turn(pixel: vec2<f32>) -> f32 {
    let at = floor(pixel) + vec2<f32>(shadowfit_receiver.frame_shift);
    let noise = fract(52.9829189 * fract(dot(at, vec2<f32>(0.06711056, 0.00583715))));
    return noise * 6.283185307;
}
