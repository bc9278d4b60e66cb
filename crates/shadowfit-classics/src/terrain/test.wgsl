// Shadow test of the terrain sample, whose map stores 1 - z/w. test.x is subtracted from the stored depth.
// z/w is subtracted from test.y.

fn terrain_share(stored: f32, depth: f32, off_stored: f32, whole: f32) -> f32 {
    return select(1.0, 0.0, stored - off_stored > whole - depth);
}

fn light_share(point: Point) -> f32 {
    return terrain_share(stored_nearest(point.seen.uv), point.seen.depth, sample.test.x, sample.test.y);
}
