// A point reads the finest map that covers it, blended into the next such map toward the border. If no map
// covers the point and the filter's footprint, it reads the finest map that contains the point. Maps are
// tried one after the other, the finest first. SHADOWFIT_REACH is the radius of the filter's footprint, and
// SHADOWFIT_BLEND the width of the blend, both in texels.

// Returns whether a map may still change the selection. far, blend_near: its view depths.
fn shadowfit_is_open(selection: shadowfit_Selection, entry: i32, view_depth: f32, far: f32, blend_near: f32) -> bool {
    return selection.first < 0 || (selection.second < 0 && selection.weight < 1.0);
}

// Returns the selection with one more map. free: texels between the point and the map's nearest side.
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
