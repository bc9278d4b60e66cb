// A point reads the first map that ends beyond its view depth and contains it, blended into the next map
// where the two overlap. Maps are tried in the order of their ends.

// Returns whether a map may still change the selection. far, blend_near: its view depths.
fn shadowfit_is_open(selection: shadowfit_Selection, entry: i32, view_depth: f32, far: f32, blend_near: f32) -> bool {
    if selection.first < 0 {
        return view_depth < far;
    }
    return selection.first + 1 == entry && view_depth > blend_near && blend_near < selection.far;
}

// Returns the selection with one more map, which contains the point if `free` is not negative.
fn shadowfit_try(
    selection: shadowfit_Selection, entry: i32, view_depth: f32, far: f32, blend_near: f32, free: f32,
) -> shadowfit_Selection {
    var next = selection;
    if free >= 0.0 {
        if selection.first < 0 {
            next.first = entry;
            next.far = far;
        } else {
            next.second = entry;
            next.weight = (selection.far - view_depth) / (selection.far - blend_near);
        }
    }
    return next;
}
