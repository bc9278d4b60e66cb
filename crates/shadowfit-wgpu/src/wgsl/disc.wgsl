// Look-ups spread evenly over a disc. Each is rotated from the previous one by the golden angle, at radii
// that give each the same area (H. Vogel, "A better way to construct the sunflower head", Mathematical
// Biosciences 44, 1979). SHADOWFIT_TAPS is their number.

// Returns a direction rotated by the golden angle, pi (3 - sqrt 5), whose cosine and sine are `turn`.
fn shadowfit_golden(direction: vec2<f32>) -> vec2<f32> {
    let turn = vec2<f32>(-0.7373688781, 0.6754902943);
    return vec2<f32>(direction.x * turn.x - direction.y * turn.y, direction.x * turn.y + direction.y * turn.x);
}

// A disc that lies inside its map: stored position of its centre, its axes, and the plane's depth change
// along them.
struct shadowfit_Disc {
    at: vec2<f32>,
    a: vec2<f32>,
    b: vec2<f32>,
    rise: vec2<f32>,
}

// Does a look-up at a position in the unit disc.
fn shadowfit_disc_tap(disc: shadowfit_Disc, place: vec2<f32>, projected: shadowfit_Projected) -> f32 {
    return shadowfit_look_up_at(
        disc.at + disc.a * place.x + disc.b * place.y, projected.depth + dot(disc.rise, place), projected);
}

// Returns the mean of the look-ups over an ellipse around the point. radii: along u and v, in texels. turn:
// rotation in radians.
fn shadowfit_disc(radii: vec2<f32>, projected: shadowfit_Projected, turn: f32) -> f32 {
    var direction = vec2<f32>(cos(turn), sin(turn));
    var sum = 0.0;
    let least = radii + vec2<f32>(0.5);
    if all(projected.texel >= least) && all(projected.texel <= projected.size - least) {
        let a = radii * direction;
        let b = radii * vec2<f32>(-direction.y, direction.x);
        let at = vec2<f32>(
            shadowfit_along_u(projected.texel.x, projected).x, shadowfit_along_v(projected.texel.y, projected).x);
        let rise = vec2<f32>(dot(projected.gradient, a), dot(projected.gradient, b));
        let disc = shadowfit_Disc(at, a * projected.unit, b * projected.unit, rise);
        sum = shadowfit_disc_taps(disc, projected);
    } else {
        for (var tap = 0u; tap < SHADOWFIT_TAPS; tap += 1u) {
            let radius = sqrt((f32(tap) + 0.5) / f32(SHADOWFIT_TAPS));
            sum += shadowfit_look_up(projected.texel + radii * radius * direction, projected);
            direction = shadowfit_golden(direction);
        }
    }
    return sum / f32(SHADOWFIT_TAPS);
}
