
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

// A node in a word, or NONE if a ray does not meet it at a distance of at most `most`, in units of the ray's inverses.
fn shadowfit_rays_child_within(node: u32, ray: shadowfit_rays_Ray, most: f32) -> u32 {
    let child = shadowfit_rays_node(node);
    let a = (child.least - ray.origin) * ray.inverses;
    let b = (child.most - ray.origin) * ray.inverses;
    let near = min(a, b);
    let far = max(a, b);
    let enter = max(max(near.x, near.y), near.z);
    let leave = min(min(far.x, far.y), far.z);
    let meets = leave * SHADOWFIT_RAYS_LATER >= max(enter, 0.0) && enter <= most * SHADOWFIT_RAYS_LATER;
    return select(SHADOWFIT_RAYS_NONE, shadowfit_rays_packed(child), meets);
}

// A distance in metres, in units of a ray's inverses.
fn shadowfit_rays_scaled(distance: f32, ray: shadowfit_rays_Ray) -> f32 {
    let size = abs(ray.direction);
    return distance * max(max(size.x, size.y), size.z);
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

// How well a triangle fits a surface that lies in the middle of a part of a ray; less is better. Within `sure` of the middle the
// first one fits best, and beyond it the one that is nearest to the middle. All in metres.
fn shadowfit_rays_misfit(at: f32, middle: f32, sure: f32) -> f32 {
    let off = abs(at - middle);
    return select(off, at - middle - sure, off <= sure);
}

// The triangle of a surface that lies half a distance along a ray, give or take as much: the first one that the ray meets
// within `sure` of the middle, else the one nearest to the middle. Both sides of triangles count: what lies before the middle
// by more than `sure` may be a side that the picture leaves out. Holes count if nothing else is met: pictures decide by smaller
// images what is a hole.
// origin: relative to the origin of the scene, in metres. direction: of unit length. distance, sure: in metres.
fn shadowfit_rays_surface(
    origin: vec3<f32>,
    direction: vec3<f32>,
    distance: f32,
    sure: f32,
) -> shadowfit_RaySurface {
    var found = shadowfit_rays_no_surface();
    var hole = found;
    let world = shadowfit_rays_ray(origin, direction);
    let middle = 0.5 * distance;
    var least = SHADOWFIT_RAYS_FAR;
    var least_hole = SHADOWFIT_RAYS_FAR;
    var most = distance;
    var ray = world;
    var reach = shadowfit_rays_scaled(most, world);
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
                    reach = shadowfit_rays_scaled(most, world);
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
                reach = shadowfit_rays_scaled(most, ray);
                instance = first;
                entered = height;
                next = root;
            }
        } else {
            for (var slot = first; slot < first + count; slot++) {
                let met = shadowfit_rays_met(shadowfit_rays_triangle(slot), ray);
                if !(met.is_inside && met.distance >= 0.0 && met.distance <= most) {
                    continue;
                }
                let misfit = shadowfit_rays_misfit(met.distance, middle, sure);
                if misfit >= least {
                    continue;
                }
                let surface = shadowfit_RaySurface(met.distance, met.normal, slot, instance);
                if shadowfit_rays_ends(slot, instance, ray, met.distance) {
                    found = surface;
                    least = misfit;
                    most = select(middle + misfit, met.distance, misfit <= 0.0);
                    reach = shadowfit_rays_scaled(most, ray);
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
                reach = shadowfit_rays_scaled(most, world);
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
