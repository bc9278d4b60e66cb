
// Every hit that is opaque counts.
fn shadowfit_rays_counts(hit: shadowfit_RayHit) -> bool {
    return true;
}
