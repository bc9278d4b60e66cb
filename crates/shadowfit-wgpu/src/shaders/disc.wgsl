// Look-ups spread evenly over a disc: each turned from the last by the golden angle, at radii that give each the same
// area (H. Vogel, "A better way to construct the sunflower head", Mathematical Biosciences 44, 1979).
// SHADOWFIT_TAPS is their number.

// A direction turned by the golden angle, pi (3 - sqrt 5): its cosine and sine.
fn shadowfit_golden(direction: vec2<f32>) -> vec2<f32> {
    let turn = vec2<f32>(-0.7373688781, 0.6754902943);
    return vec2<f32>(direction.x * turn.x - direction.y * turn.y, direction.x * turn.y + direction.y * turn.x);
}

// Mean of the look-ups over an ellipse around the point. radii: along u and v, in texels. turn: in radians.
fn shadowfit_disc(radii: vec2<f32>, projected: shadowfit_Projected, turn: f32) -> f32 {
    var direction = vec2<f32>(cos(turn), sin(turn));
    var sum = 0.0;
    for (var tap = 0u; tap < SHADOWFIT_TAPS; tap += 1u) {
        let radius = sqrt((f32(tap) + 0.5) / f32(SHADOWFIT_TAPS));
        sum += shadowfit_look_up(projected.texel + radii * radius * direction, projected);
        direction = shadowfit_golden(direction);
    }
    return sum / f32(SHADOWFIT_TAPS);
}
