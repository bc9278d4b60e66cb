
// Every opaque hit counts.
fn shadowfit_rays_counts(hit: shadowfit_RayHit) -> bool {
    return true;
}
