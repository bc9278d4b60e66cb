//! Kept maps: the texels that stay valid from frame to frame, and the rectangles to draw again.

use shadowfit::FittedMap;
use shadowfit::glam::UVec2;
use shadowfit::scroll::{Scroll, StoredRect, TexelRect};

use crate::error::Failure;
use crate::pointer::BoxList;
use crate::state::{Kept, State};
use crate::types::{
    SHADOWFIT_MAX_RECTS, SHADOWFIT_UPDATE_NOTHING, SHADOWFIT_UPDATE_RECTS, SHADOWFIT_UPDATE_WHOLE, ShadowfitRect,
    ShadowfitUpdate,
};

/// Greatest number of rectangles around changed casters, before storage cuts them. A rectangle costs a pass over
/// its casters. With two strips, each cut into four pieces, they fit into `SHADOWFIT_MAX_RECTS`.
const CHANGED: usize = 4;

/// Plans the update of a kept map. Assumes that the caller carries it out.
pub(crate) fn update(state: &mut State, map: u32, changed: Option<BoxList>) -> Result<ShadowfitUpdate, Failure> {
    let now = *state.map(map)?;
    state.keeps = true;
    let kept = &mut state.kept[map as usize];
    if now.projection.is_empty {
        // No point in view reads the map, and the next one is drawn as a whole.
        *kept = Kept { map: None, is_current: true, is_lost: false };
        return Ok(NOTHING);
    }
    // A second call in a frame only adds changes.
    let before = kept.map.filter(|_| !kept.is_lost);
    let size = now.projection.resolution;
    let scroll = before.as_ref().map(|before| Scroll::between(before, &now));
    let scroll = scroll.filter(|scroll| !scroll.is_redraw());
    let offset = scroll.map_or(UVec2::ZERO, |scroll| {
        scroll.texel_offset(before.map_or(UVec2::ZERO, |before| before.texel_offset), size)
    });
    *kept = Kept { map: Some(FittedMap { texel_offset: offset, ..now }), is_current: true, is_lost: false };
    let mut update = ShadowfitUpdate { texel_offset: offset.to_array(), ..NOTHING };
    // One viewport for each piece of the whole map.
    for (piece, viewport) in TexelRect::all(size).stored(offset, size).zip(&mut update.viewports) {
        *viewport = piece.viewport().to_array();
        update.viewport_count += 1;
    }
    let Some(scroll) = scroll else {
        update.kind = SHADOWFIT_UPDATE_WHOLE;
        push(&mut update, TexelRect::all(size), offset, size);
        return Ok(update);
    };
    for strip in scroll.exposed() {
        push(&mut update, strip, offset, size);
    }
    for rect in rects(&now, changed).into_iter().flatten() {
        push(&mut update, rect, offset, size);
    }
    if update.rect_count > 0 {
        update.kind = SHADOWFIT_UPDATE_RECTS;
    }
    Ok(update)
}

const NOTHING: ShadowfitUpdate = ShadowfitUpdate {
    size: size_of::<ShadowfitUpdate>() as u32,
    kind: SHADOWFIT_UPDATE_NOTHING,
    texel_offset: [0; 2],
    rect_count: 0,
    rects: [ShadowfitRect { x: 0, y: 0, width: 0, height: 0, viewport_x: 0, viewport_y: 0 }; SHADOWFIT_MAX_RECTS],
    viewport_count: 0,
    viewports: [[0; 2]; 4],
};

/// Adds the stored pieces of a rectangle.
fn push(update: &mut ShadowfitUpdate, rect: TexelRect, offset: UVec2, size: UVec2) {
    for piece in rect.stored(offset, size) {
        if let Some(free) = update.rects.get_mut(update.rect_count as usize) {
            *free = written(&piece);
            update.rect_count += 1;
        }
    }
}

fn written(piece: &StoredRect) -> ShadowfitRect {
    let (TexelRect { min, size }, viewport) = (piece.stored, piece.viewport());
    ShadowfitRect { x: min.x, y: min.y, width: size.x, height: size.y, viewport_x: viewport.x, viewport_y: viewport.y }
}

/// Returns a few rectangles around the shadows of changed casters. Casters join the rectangle that grows least.
fn rects(map: &FittedMap, changed: Option<BoxList>) -> [Option<TexelRect>; CHANGED] {
    let mut rects = [None; CHANGED];
    let Some(changed) = changed else { return rects };
    for aabb in changed.iter() {
        let texels = TexelRect::of_box(&map.projection, &aabb, changed.origin);
        if texels.is_empty() {
            continue;
        }
        let growth = |rect: &Option<TexelRect>| rect.map_or(0, |rect| rect.union(texels).area() - rect.area());
        let is_inside = |rect: &Option<TexelRect>| rect.is_some() && growth(rect) == 0;
        let free = rects.iter().position(is_inside).or_else(|| rects.iter().position(Option::is_none));
        let least = (0..CHANGED).min_by_key(|index| growth(&rects[*index])).unwrap_or(0);
        let rect = &mut rects[free.unwrap_or(least)];
        *rect = Some(rect.map_or(texels, |rect| rect.union(texels)));
    }
    rects
}

#[cfg(test)]
mod tests {
    use shadowfit::glam::{DVec2, DVec3, Vec3};
    use shadowfit::{Aabb, FitInput, FitState, PerspectiveCamera, Scratch, Technique};

    use super::*;

    #[test]
    fn the_rectangles_of_an_update_hold_the_shadows_of_all_changed_casters() {
        let camera = PerspectiveCamera {
            eye: DVec3::new(3.0, 1.7, 20.0),
            forward: Vec3::NEG_Z,
            up: Vec3::Y,
            fov_y: 0.9,
            aspect: 1.6,
            near: 0.1,
            far: 150.0,
        };
        let views = [camera.frustum().expect("a camera")];
        let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
        let input = FitInput::new(&views, Vec3::new(0.4, -0.8, 0.3));
        let mut scratch = Scratch::new(&mut storage);
        let maps = FitState::new().fit(&input, &Technique::default(), &mut scratch).expect("maps");
        let boxes: Vec<Aabb> = (0..40_u8)
            .map(|index| {
                let at = Vec3::new(f32::from(index % 8) * 9.0 - 30.0, 0.0, f32::from(index / 8) * -17.0 + 10.0);
                Aabb::new(at, at + Vec3::new(1.0, f32::from(index % 5), 2.0))
            })
            .collect();
        let numbers: Vec<[f32; 3]> = boxes.iter().flat_map(|aabb| [aabb.min.into(), aabb.max.into()]).collect();
        for count in [1, 3, 5, boxes.len()] {
            let list =
                crate::types::ShadowfitBoxes { min_max: numbers.as_ptr().cast(), count, stride: 0, origin: [0.0; 3] };
            // SAFETY: the list has at least this many boxes.
            let list = unsafe { BoxList::new(&list) }.map_err(|failure| failure.code).expect("a list");
            for map in maps.iter() {
                let rects = rects(map, list);
                for aabb in &boxes[..count] {
                    let texels = TexelRect::of_box(&map.projection, aabb, DVec3::ZERO);
                    let holds = |rect: &TexelRect| rect.union(texels) == *rect;
                    assert!(texels.is_empty() || rects.iter().flatten().any(holds), "{texels:?} in {rects:?}");
                }
            }
        }
    }
}
