// A disc as wide as the penumbra (R. Fernando, "Percentage-closer soft shadows", SIGGRAPH sketches, 2005),
// for a light at infinite distance: a penumbra's radius is the distance to the caster times the tangent of
// the light's angular radius. Two deviations from the source: a texel counts as a caster only if it lies
// within the cone from the point to the light's disc. Otherwise high casters beside the cone would widen the
// penumbrae of low ones. And the radii of the search grow in proportion, so that a small penumbra is found
// within the wide disc for the highest casters.

// Texels that the search reads.
const SHADOWFIT_SEARCH: u32 = 20u;
// First radius of the search, in texels: the point's own texel.
const SHADOWFIT_SEARCH_START: f32 = 0.5;
// Width that look-ups read outside the disc's edge, in texels, which counts as well.
const SHADOWFIT_SEARCH_BESIDE: f32 = 0.5;

// Returns the sum of the distances to the casters between the point and the light's disc, in units of the
// stored depth and with its sign, and the number of casters.
fn shadowfit_casters(projected: shadowfit_Projected, turn: f32) -> vec2<f32> {
    let last = projected.size - vec2<f32>(1.0);
    let start = min(SHADOWFIT_SEARCH_START / max(projected.disc.x, projected.disc.y), 1.0);
    let growth = pow(1.0 / start, 1.0 / f32(SHADOWFIT_SEARCH));
    var radius = start * sqrt(growth);
    var direction = vec2<f32>(cos(turn), sin(turn));
    var found = vec2<f32>(0.0);
    for (var tap = 0u; tap < SHADOWFIT_SEARCH; tap += 1u) {
        let texel = clamp(floor(projected.texel + projected.disc * radius * direction), vec2<f32>(0.0), last);
        let offset = texel + vec2<f32>(0.5) - projected.texel;
        let stored = shadowfit_stored_texel(texel + projected.texel_offset, projected);
        let distance = projected.surface - stored;
        // Penumbra of a caster at this distance, or the least disc.
        let cone = max(distance * projected.penumbra, vec2<f32>(shadowfit_receiver.least_disc));
        // Tests the ellipse of these radii without a division.
        let radii = cone + SHADOWFIT_SEARCH_BESIDE;
        let place = offset * radii.yx;
        let is_within = dot(place, place) <= radii.x * radii.x * radii.y * radii.y;
        let is_lit = saturate(projected.depth + dot(projected.gradient, offset)) COMPARE stored;
        if is_within && !is_lit {
            found += vec2<f32>(distance, 1.0);
        }
        radius *= growth;
        direction = shadowfit_golden(direction);
    }
    return found;
}

fn shadowfit_compare(projected: shadowfit_Projected, turn: f32) -> f32 {
    let found = shadowfit_casters(projected, turn);
    if found.y == 0.0 {
        return 1.0;
    }
    let radius = found.x / found.y * projected.penumbra;
    // Subtract the blur of each look-up.
    let own = sqrt(max(radius * radius - vec2<f32>(SHADOWFIT_LOOK_UP_SQUARE), vec2<f32>(0.0)));
    let least = vec2<f32>(shadowfit_receiver.least_disc);
    return shadowfit_disc(clamp(own, least, vec2<f32>(shadowfit_receiver.greatest_disc)), projected, turn);
}
