//! How far each pixel is from a change of the true shadow.

/// Distance, in pixels, from each pixel's centre to the nearest boundary between two neighbouring
/// pixels whose truths differ; infinite where there is none. `truth` holds rows from the top;
/// `None` (sky, or facing away) has no boundary with anything.
pub(crate) fn distance_to_transition(size: [usize; 2], truth: &[Option<bool>]) -> Vec<f32> {
    let [width, height] = size;
    let transition = |x: usize, y: usize| {
        let here = truth[y * width + x];
        let differs = |x: usize, y: usize| here.is_some() && truth[y * width + x].is_some_and(|t| Some(t) != here);
        (x > 0 && differs(x - 1, y))
            || (x + 1 < width && differs(x + 1, y))
            || (y > 0 && differs(x, y - 1))
            || (y + 1 < height && differs(x, y + 1))
    };
    let mut along_row = vec![f32::INFINITY; width * height];
    for y in 0..height {
        let row = &mut along_row[y * width..(y + 1) * width];
        let mut last = f32::INFINITY;
        for (x, distance) in row.iter_mut().enumerate() {
            last = if transition(x, y) { 0.0 } else { last + 1.0 };
            *distance = last;
        }
        last = f32::INFINITY;
        for distance in row.iter_mut().rev() {
            last = (last + 1.0).min(*distance);
            *distance = last;
        }
    }
    columns(size, &along_row)
}

/// Second pass of the exact Euclidean transform: the least of horizontal² + vertical² over a
/// column, plus the half pixel from a centre to its boundary.
fn columns([width, height]: [usize; 2], along_row: &[f32]) -> Vec<f32> {
    use rayon::prelude::*;
    (0..width * height)
        .into_par_iter()
        .map(|index| {
            let (x, y) = (index % width, index / width);
            let mut best = f32::INFINITY;
            // Rows in order of their distance, until they cannot do better.
            for step in 0..height {
                let vertical = (step * step) as f32;
                if vertical >= best {
                    break;
                }
                for row in [y.checked_sub(step), Some(y + step).filter(|row| *row < height)].into_iter().flatten() {
                    let horizontal = along_row[row * width + x];
                    best = best.min(horizontal * horizontal + vertical);
                }
            }
            best.sqrt() + 0.5
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_equal_a_search_of_every_pixel() {
        let size = [17, 11];
        let truth: Vec<Option<bool>> = (0..17 * 11u64)
            .map(|i| {
                let hash = i.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 59;
                if hash < 4 { None } else { Some(hash == 5) }
            })
            .collect();
        let distances = distance_to_transition(size, &truth);
        let at = |x: i32, y: i32| {
            ((0..17).contains(&x) && (0..11).contains(&y)).then(|| truth[(y * 17 + x) as usize]).flatten()
        };
        for y in 0..11 {
            for x in 0..17 {
                let mut best = f32::INFINITY;
                for v in 0..11 {
                    for u in 0..17 {
                        let here = at(u, v);
                        let is_transition = [(1, 0), (-1, 0), (0, 1), (0, -1)]
                            .iter()
                            .any(|(dx, dy)| matches!((here, at(u + dx, v + dy)), (Some(a), Some(b)) if a != b));
                        if is_transition {
                            best = best.min((((u - x).pow(2) + (v - y).pow(2)) as f32).sqrt() + 0.5);
                        }
                    }
                }
                assert_eq!(distances[(y * 17 + x) as usize], best, "pixel {x}, {y}");
            }
        }
    }

    #[test]
    fn without_a_transition_every_distance_is_infinite() {
        let distances = distance_to_transition([3, 2], &[Some(true); 6]);
        assert!(distances.iter().all(|distance| distance.is_infinite()));
    }
}
