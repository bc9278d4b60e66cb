// A point reads the finest map that holds it with the filter's reach, blended into the next such map toward its border;
// where there is none, the finest that holds it at all. The maps are tried one after the other, the finest first.
// SHADOWFIT_REACH and SHADOWFIT_BLEND are texels: what the filter reads around a point, and the width of the blend.

// Whether the selection may still change by a map. far, blend_near: its view depths.
fn shadowfit_is_open(selection: shadowfit_Selection, entry: i32, view_depth: f32, far: f32, blend_near: f32) -> bool {
    return selection.first < 0 || (selection.second < 0 && selection.weight < 1.0);
}

// The selection with one more map, of which `free` texels lie around the point.
fn shadowfit_try(
    selection: shadowfit_Selection, entry: i32, view_depth: f32, far: f32, blend_near: f32, free: f32,
) -> shadowfit_Selection {
    var next = selection;
    if free >= SHADOWFIT_REACH {
        if selection.first < 0 {
            next.first = entry;
            let beyond = free - SHADOWFIT_REACH;
            next.weight = 1.0;
            if beyond < SHADOWFIT_BLEND {
                next.weight = beyond / SHADOWFIT_BLEND;
            }
        } else {
            next.second = entry;
        }
    } else if free >= 0.0 && selection.clamped < 0 {
        next.clamped = entry;
    }
    return next;
}
