// A scene of rays: two levels of bounding volume hierarchies. Every name begins with a prefix.

struct shadowfit_rays_Node {
    least: vec3<f32>,
    // Number of triangles of a leaf, or 1 for a leaf with an instance. 0 for an inner node.
    count: u32,
    most: vec3<f32>,
    // First triangle or instance of a leaf, or first child of an inner node. NONE for no node.
    first: u32,
}

const SHADOWFIT_RAYS_NONE: u32 = 0xffffffffu;
// Consecutive places for the children of a node.
const SHADOWFIT_RAYS_WIDTH: u32 = 4u;

// A triangle in leaf order, in the space of its mesh.
struct shadowfit_rays_Triangle {
    a: vec3<f32>,
    // Index of its cut-out plus 1. 0 for none.
    cut_out: u32,
    b: vec3<f32>,
    index: u32,
    c: vec3<f32>,
    padding: u32,
}
