// A scene of rays: two levels of bounding volume hierarchies. Every name begins with a prefix.

struct shadowfit_rays_Node {
    least: vec3<f32>,
    // Triangles of a leaf, or its one instance; 0 for an inner node.
    count: u32,
    most: vec3<f32>,
    // A leaf's first triangle or its instance, or the first of an inner node's two children, which stand side by side.
    first: u32,
}

// In leaf order, in the space of its mesh.
struct shadowfit_rays_Triangle {
    a: vec3<f32>,
    // Index of its cut-out plus 1, 0 for none.
    cut_out: u32,
    b: vec3<f32>,
    index: u32,
    c: vec3<f32>,
    padding: u32,
}
