// The test of the terrain sample, whose map stores 1 - z/w. test.x: what is taken from the stored depth, test.y: what z/w
// is taken from.

fn terrain_share(stored: f32, depth: f32, off_stored: f32, whole: f32) -> f32 {
    return select(1.0, 0.0, stored - off_stored > whole - depth);
}

fn light_share(point: Point) -> f32 {
    return terrain_share(stored_nearest(point.seen.uv), point.seen.depth, sample.test.x, sample.test.y);
}
