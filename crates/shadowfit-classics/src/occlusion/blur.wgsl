// Averages occlusion over the random vectors of 4x4 pixels: a box of four pixels around the middle. The
// outermost of its five pixels have half weight. Only neighbours in the pixel's plane count. Comes after
// buffers.wgsl.

// Distance from the plane at which a neighbour's weight is 0, in units of the pixel height at the point.
const PLANE_PIXELS: f32 = 4.0;

@fragment
fn fs_blur(@builtin(position) at: vec4<f32>) -> @location(0) f32 {
    let middle = vec2<i32>(at.xy);
    let position = textureLoad(positions, middle, 0);
    if position.w == 0.0 {
        return 0.0;
    }
    let normal = textureLoad(normals, middle, 0).xyz;
    let limit = PLANE_PIXELS * occlusion.height * -position.z / f32(textureDimensions(positions).y);
    var sum = 0.0;
    var weights = 0.0;
    for (var y = -2; y <= 2; y++) {
        for (var x = -2; x <= 2; x++) {
            let pixel = within(middle + vec2<i32>(x, y));
            let neighbour = textureLoad(positions, pixel, 0);
            let apart = abs(dot(normal, neighbour.xyz - position.xyz));
            let side = select(1.0, 0.5, abs(x) == 2) * select(1.0, 0.5, abs(y) == 2);
            let weight = side * neighbour.w * saturate(1.0 - apart / limit);
            sum += textureLoad(third, pixel, 0).x * weight;
            weights += weight;
        }
    }
    return sum / weights;
}
