
// A surface to find again with a short ray from the eye.
struct shadowfit_RaySought {
    // Length of the ray, in metres. The surface lies at its middle, give or take half the length.
    distance: f32,
    // Usual greatest distance of the surface from the middle, in metres.
    sure: f32,
    // Greatest distance between the ray and a triangle beside it, in metres.
    beside: f32,
    // Unit geometric normal against the ray. Zero if unknown.
    normal: vec3<f32>,
}

// Cosine of the greatest angle between a known normal and its triangle. The angle is far greater than the
// rounding of normals.
const SHADOWFIT_RAYS_SAME_NORMAL: f32 = 0.9995;

// A triangle that a short ray from the eye hits.
struct shadowfit_RaySurface {
    // Distance from the ray's origin, in metres. SHADOWFIT_RAYS_FAR if the ray hits no triangle.
    distance: f32,
    // Unit geometric normal, against the ray.
    normal: vec3<f32>,
    // Place of the triangle among all triangles of the scene, and index of its instance. SHADOWFIT_RAYS_NONE
    // if there is none.
    slot: u32,
    instance: u32,
}

fn shadowfit_rays_no_surface() -> shadowfit_RaySurface {
    return shadowfit_RaySurface(SHADOWFIT_RAYS_FAR, vec3<f32>(0.0), SHADOWFIT_RAYS_NONE, SHADOWFIT_RAYS_NONE);
}

// Limits of a ray, in its own space.
struct shadowfit_rays_Reach {
    // Length along the ray, in units of its inverses.
    most: f32,
    // Distance beside the ray.
    beside: f32,
}

// Returns a packed node, or NONE if it is outside the limits of a ray.
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

// Returns limits in metres along and beside a ray, converted to the space of the ray.
fn shadowfit_rays_scaled(most: f32, beside: f32, ray: shadowfit_rays_Ray) -> shadowfit_rays_Reach {
    let size = abs(ray.direction);
    return shadowfit_rays_Reach(most * max(max(size.x, size.y), size.z), beside * length(ray.direction));
}

// The hit of a ray in the space of a mesh on the plane of a triangle.
struct shadowfit_rays_Met {
    // Normal of any length.
    normal: vec3<f32>,
    // Distance in metres. SHADOWFIT_RAYS_FAR for a ray in the plane.
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

// Returns whether a ray passes a triangle at most this far outside any edge, in the space of the ray.
fn shadowfit_rays_is_beside(triangle: shadowfit_rays_Triangle, ray: shadowfit_rays_Ray, distance: f32) -> bool {
    let e1 = triangle.a - triangle.b;
    let e2 = triangle.c - triangle.a;
    let r = cross(ray.direction, triangle.a - ray.origin);
    let determinant = dot(cross(e1, e2), ray.direction);
    let side = select(-1.0, 1.0, determinant > 0.0);
    // The volume of an edge and the ray is the distance of their lines times the length of this product.
    let u = side * dot(r, e2);
    let v = side * dot(r, e1);
    return u >= -distance * length(cross(ray.direction, e2))
        && v >= -distance * length(cross(ray.direction, e1))
        && abs(determinant) - u - v >= -distance * length(cross(ray.direction, e1 + e2));
}

// Returns the misfit between a hit at distance `at` and a surface at the middle of a ray, in metres. Within
// `sure` of the middle the first hit fits best, farther away the nearest to the middle. All arguments are in
// metres.
fn shadowfit_rays_misfit(at: f32, middle: f32, sure: f32) -> f32 {
    let off = abs(at - middle);
    return select(off, at - middle - sure, off <= sure);
}

// Returns the triangle of a surface: the first one that the ray hits within `sure` of its middle, or else the
// nearest one to the middle. Both sides of triangles count. A hit more than `sure` in front of the middle may
// be a side that the picture culls. Holes count only if there is no other hit, because pictures decide holes
// by smaller images. origin: relative to the origin of the scene, in metres. direction: of unit length.
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
        // Descends to a leaf first, as in shadowfit_rays_blocked. `current` is NONE at the end.
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

// Returns the hit of a ray on the plane of one triangle. Its normal has unit length and points against the
// ray.
fn shadowfit_rays_plane(origin: vec3<f32>, direction: vec3<f32>, slot: u32, instance: u32) -> shadowfit_rays_Met {
    let inside = shadowfit_rays_in_mesh(instance, shadowfit_rays_ray(origin, direction));
    var met = shadowfit_rays_met(shadowfit_rays_triangle(slot), inside);
    met.normal = shadowfit_rays_normal(met.normal, instance, direction);
    return met;
}
