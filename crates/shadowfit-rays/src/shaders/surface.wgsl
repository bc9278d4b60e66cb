
// A surface that a short ray from the eye shall find again.
struct shadowfit_RaySought {
    // Length of the ray, in metres. The surface lies in its middle, give or take half of it.
    distance: f32,
    // How far from the middle it lies at most if all is well, in metres.
    sure: f32,
    // How far beside a triangle the ray may pass, in metres.
    beside: f32,
    // Unit geometric normal against the ray; zero if it is not known.
    normal: vec3<f32>,
}

// Cosine of the greatest angle between a known normal and its triangle: far more than the rounding of normals.
const SHADOWFIT_RAYS_SAME_NORMAL: f32 = 0.9995;

// A triangle that a short ray from the eye meets.
struct shadowfit_RaySurface {
    // From the ray's origin, in metres; SHADOWFIT_RAYS_FAR if the ray meets no triangle.
    distance: f32,
    // Unit geometric normal, against the ray.
    normal: vec3<f32>,
    // Place of the triangle among those of the scene, and index of its instance; SHADOWFIT_RAYS_NONE without one.
    slot: u32,
    instance: u32,
}

fn shadowfit_rays_no_surface() -> shadowfit_RaySurface {
    return shadowfit_RaySurface(SHADOWFIT_RAYS_FAR, vec3<f32>(0.0), SHADOWFIT_RAYS_NONE, SHADOWFIT_RAYS_NONE);
}

// How far a ray is followed, in its own space.
struct shadowfit_rays_Reach {
    // Along it, in units of its inverses.
    most: f32,
    // Beside it.
    beside: f32,
}

// A node in a word, or NONE if a ray does not come near to it within a reach.
fn shadowfit_rays_child_within(node: u32, ray: shadowfit_rays_Ray, reach: shadowfit_rays_Reach) -> u32 {
    let child = shadowfit_rays_node(node);
    let a = (child.least - reach.beside - ray.origin) * ray.inverses;
    let b = (child.most + reach.beside - ray.origin) * ray.inverses;
    let near = min(a, b);
    let far = max(a, b);
    let enter = max(max(near.x, near.y), near.z);
    let leave = min(min(far.x, far.y), far.z);
    let meets = leave * SHADOWFIT_RAYS_LATER >= max(enter, 0.0) && enter <= reach.most * SHADOWFIT_RAYS_LATER;
    return select(SHADOWFIT_RAYS_NONE, shadowfit_rays_packed(child), meets);
}

// Distances in metres along and beside a ray, in the space of the ray.
fn shadowfit_rays_scaled(most: f32, beside: f32, ray: shadowfit_rays_Ray) -> shadowfit_rays_Reach {
    let size = abs(ray.direction);
    return shadowfit_rays_Reach(most * max(max(size.x, size.y), size.z), beside * length(ray.direction));
}

// Where a ray in the space of a mesh meets the plane of a triangle.
struct shadowfit_rays_Met {
    // Of any length.
    normal: vec3<f32>,
    // In metres; SHADOWFIT_RAYS_FAR for a ray in the plane.
    distance: f32,
    is_inside: bool,
}

fn shadowfit_rays_met(triangle: shadowfit_rays_Triangle, ray: shadowfit_rays_Ray) -> shadowfit_rays_Met {
    let e1 = triangle.a - triangle.b;
    let e2 = triangle.c - triangle.a;
    let n = cross(e1, e2);
    let c = triangle.a - ray.origin;
    let r = cross(ray.direction, c);
    let determinant = dot(n, ray.direction);
    if determinant == 0.0 {
        return shadowfit_rays_Met(n, SHADOWFIT_RAYS_FAR, false);
    }
    let inverse_determinant = 1.0 / determinant;
    let u = dot(r, e2) * inverse_determinant;
    let v = dot(r, e1) * inverse_determinant;
    return shadowfit_rays_Met(n, dot(n, c) * inverse_determinant, u >= 0.0 && v >= 0.0 && u + v <= 1.0);
}

// Whether a ray passes a triangle no farther outside of any edge than a distance, in the space of the ray.
fn shadowfit_rays_is_beside(triangle: shadowfit_rays_Triangle, ray: shadowfit_rays_Ray, distance: f32) -> bool {
    let e1 = triangle.a - triangle.b;
    let e2 = triangle.c - triangle.a;
    let r = cross(ray.direction, triangle.a - ray.origin);
    let determinant = dot(cross(e1, e2), ray.direction);
    let side = select(-1.0, 1.0, determinant > 0.0);
    // The volume of each edge and the ray is the distance of their lines times the length of this product.
    let u = side * dot(r, e2);
    let v = side * dot(r, e1);
    return u >= -distance * length(cross(ray.direction, e2))
        && v >= -distance * length(cross(ray.direction, e1))
        && abs(determinant) - u - v >= -distance * length(cross(ray.direction, e1 + e2));
}

// How well a triangle fits a surface that lies in the middle of a part of a ray; less is better. Within `sure` of the middle the
// first one fits best, and beyond it the one that is nearest to the middle. All in metres.
fn shadowfit_rays_misfit(at: f32, middle: f32, sure: f32) -> f32 {
    let off = abs(at - middle);
    return select(off, at - middle - sure, off <= sure);
}

// The triangle of a surface: the first one that the ray meets within `sure` of its middle, else the one nearest to the middle. Both
// sides of triangles count: what lies before the middle by more than `sure` may be a side that the picture leaves out. Holes
// count if nothing else is met: pictures decide by smaller images what is a hole.
// origin: relative to the origin of the scene, in metres. direction: of unit length.
fn shadowfit_rays_surface(
    origin: vec3<f32>,
    direction: vec3<f32>,
    sought: shadowfit_RaySought,
) -> shadowfit_RaySurface {
    var found = shadowfit_rays_no_surface();
    var hole = found;
    let world = shadowfit_rays_ray(origin, direction);
    let middle = 0.5 * sought.distance;
    var least = SHADOWFIT_RAYS_FAR;
    var least_hole = SHADOWFIT_RAYS_FAR;
    var most = sought.distance;
    var ray = world;
    var reach = shadowfit_rays_scaled(most, sought.beside, world);
    var stack: array<u32, SHADOWFIT_RAYS_STACK>;
    var height = 0u;
    var instance = SHADOWFIT_RAYS_NONE;
    var entered = 0u;
    var current = shadowfit_rays_packed(shadowfit_rays_node(0));
    loop {
        // Down to a leaf first, as in shadowfit_rays_blocked; NONE at the end.
        while current >> SHADOWFIT_RAYS_COUNT_AT == 0u {
            let first = current;
            let met = vec4<u32>(
                shadowfit_rays_child_within(first, ray, reach), shadowfit_rays_child_within(first + 1u, ray, reach),
                shadowfit_rays_child_within(first + 2u, ray, reach), shadowfit_rays_child_within(first + 3u, ray, reach));
            var next = met.w;
            if met.z != SHADOWFIT_RAYS_NONE {
                if next != SHADOWFIT_RAYS_NONE {
                    stack[height] = next;
                    height++;
                }
                next = met.z;
            }
            if met.y != SHADOWFIT_RAYS_NONE {
                if next != SHADOWFIT_RAYS_NONE {
                    stack[height] = next;
                    height++;
                }
                next = met.y;
            }
            if met.x != SHADOWFIT_RAYS_NONE {
                if next != SHADOWFIT_RAYS_NONE {
                    stack[height] = next;
                    height++;
                }
                next = met.x;
            }
            if next == SHADOWFIT_RAYS_NONE {
                if height == 0u {
                    current = SHADOWFIT_RAYS_NONE;
                    break;
                }
                if instance != SHADOWFIT_RAYS_NONE && height == entered {
                    instance = SHADOWFIT_RAYS_NONE;
                    ray = world;
                    reach = shadowfit_rays_scaled(most, sought.beside, world);
                }
                height--;
                next = stack[height];
            }
            current = next;
        }
        if current == SHADOWFIT_RAYS_NONE {
            break;
        }
        let first = current & SHADOWFIT_RAYS_FIRST;
        let count = current >> SHADOWFIT_RAYS_COUNT_AT;
        var next = SHADOWFIT_RAYS_NONE;
        if instance == SHADOWFIT_RAYS_NONE {
            let root = shadowfit_rays_instances[first].root;
            if root != SHADOWFIT_RAYS_NONE {
                ray = shadowfit_rays_in_mesh(first, world);
                reach = shadowfit_rays_scaled(most, sought.beside, ray);
                instance = first;
                entered = height;
                next = root;
            }
        } else {
            for (var slot = first; slot < first + count; slot++) {
                let triangle = shadowfit_rays_triangle(slot);
                let met = shadowfit_rays_met(triangle, ray);
                let misfit = shadowfit_rays_misfit(met.distance, middle, sought.sure);
                if !(met.distance >= 0.0 && met.distance <= most && misfit < least) {
                    continue;
                }
                if !met.is_inside && !(reach.beside > 0.0 && shadowfit_rays_is_beside(triangle, ray, reach.beside)) {
                    continue;
                }
                if any(sought.normal != vec3<f32>(0.0)) {
                    let normal = shadowfit_rays_normal(met.normal, instance, direction);
                    if dot(normal, sought.normal) < SHADOWFIT_RAYS_SAME_NORMAL {
                        continue;
                    }
                }
                let surface = shadowfit_RaySurface(met.distance, met.normal, slot, instance);
                if shadowfit_rays_ends(slot, instance, ray, met.distance) {
                    found = surface;
                    least = misfit;
                    most = select(middle + misfit, met.distance, misfit <= 0.0);
                    reach = shadowfit_rays_scaled(most, sought.beside, ray);
                } else if misfit < least_hole {
                    hole = surface;
                    least_hole = misfit;
                }
            }
        }
        if next == SHADOWFIT_RAYS_NONE {
            if height == 0u {
                break;
            }
            if instance != SHADOWFIT_RAYS_NONE && height == entered {
                instance = SHADOWFIT_RAYS_NONE;
                ray = world;
                reach = shadowfit_rays_scaled(most, sought.beside, world);
            }
            height--;
            next = stack[height];
        }
        current = next;
    }
    if found.slot == SHADOWFIT_RAYS_NONE {
        found = hole;
    }
    if found.slot != SHADOWFIT_RAYS_NONE {
        found.normal = shadowfit_rays_normal(found.normal, found.instance, direction);
    }
    return found;
}

// Where a ray meets the plane of one triangle: its normal is a unit one, against the ray.
fn shadowfit_rays_plane(origin: vec3<f32>, direction: vec3<f32>, slot: u32, instance: u32) -> shadowfit_rays_Met {
    let inside = shadowfit_rays_in_mesh(instance, shadowfit_rays_ray(origin, direction));
    var met = shadowfit_rays_met(shadowfit_rays_triangle(slot), inside);
    met.normal = shadowfit_rays_normal(met.normal, instance, direction);
    return met;
}
