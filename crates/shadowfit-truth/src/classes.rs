//! The kinds of wrong pixels: false shadow (acne), false light (peter-panning, leaks), hole
//! (clipping) and edge (aliasing).

use glam::Vec3;
use rayon::prelude::*;
use shadowfit::LightFit;

use crate::Tracer;
use crate::edges::distance_to_transition;

/// What a picture shows at a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Visible point, world space, in metres.
    pub position: Vec3,
    /// Unit geometric normal on the side of the eye, world axes.
    pub normal: Vec3,
    /// Share of the light that the shadow map lets through, 0..=1.
    pub factor: f32,
    /// Screen pixels per shadow texel along the worse axis; infinite where the point is outside
    /// every map or edge-on to the light.
    pub pixels_per_texel: f32,
    /// Whether the pixel counts in the shares. Those that don't still make edges.
    pub counts: bool,
}

/// How pixels are judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JudgeSettings {
    /// Unit direction of travel of the light.
    pub direction: Vec3,
    /// Shadow rays start this far along the geometric normal, in metres.
    pub ray_offset: f32,
    /// Reach of the filter: greatest distance per axis, in texels, from the sample point to the
    /// centre of a texel of non-zero weight (0.5 point, 1 hardware 2×2).
    pub reach: f32,
    /// Whether the maps were drawn with depth clamp, so that they also hold what stands before
    /// their near plane.
    pub depth_clamp: bool,
}

impl JudgeSettings {
    /// The settings of a light and filter, with rays offset by a millimetre and no depth clamp.
    pub fn new(direction: Vec3, reach: f32) -> Self {
        Self { direction, ray_offset: 1e-3, reach, depth_clamp: false }
    }

    /// Width of the edge zone, in pixels or in shadow texels, whichever is more on screen.
    pub fn edge_width(&self) -> f32 {
        (self.reach + 1.0).max(1.5)
    }
}

/// Verdict on a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// Sky, or a surface that faces away from the light: not judged.
    NotJudged,
    /// The map agrees with the truth.
    Right,
    /// Lit in truth, shadowed by the map, away from edges: acne.
    FalseShadow,
    /// Shadowed in truth, lit by the map, away from edges, though an occluder is in the map:
    /// peter-panning or a leak.
    FalseLight,
    /// Shadowed in truth, lit because none of the occluders is in the map, or no map covers the
    /// point: the hole from clipping.
    Hole,
    /// Wrong within the edge zone: aliasing.
    Edge,
}

/// A judged picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// Verdicts, rows from the top.
    pub classes: Vec<Class>,
    /// Whether the light reaches the point in truth; `None` where not judged.
    pub truth: Vec<Option<bool>>,
    /// Distance from the pixel's centre to the nearest change of the true shadow, in pixels;
    /// infinite where the picture has none.
    pub edge_distance: Vec<f32>,
    /// Whether the pixel lies in the edge zone.
    pub edge_zone: Vec<bool>,
    /// Shares of the facing pixels that count.
    pub shares: Shares,
}

/// Shares, 0..=1, of the facing pixels that count.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shares {
    /// Number of pixels that count and face the light.
    pub facing: usize,
    /// Number of pixels that count, facing or not.
    pub counted: usize,
    /// Verdict differs from the truth, edges included.
    pub wrong: f32,
    /// [`Class::FalseShadow`].
    pub false_shadow: f32,
    /// [`Class::FalseLight`].
    pub false_light: f32,
    /// [`Class::Hole`].
    pub hole: f32,
    /// [`Class::Edge`].
    pub edge: f32,
    /// Share of pixels inside the edge zone, right or wrong.
    pub edge_zone: f32,
    /// Mean of |factor − truth|.
    pub mean_error: f32,
}

/// Judges a picture of `size` pixels (`surfaces` in rows from the top, `None` where the sky is
/// seen) that was shadowed by `fits` (nearest first; the first one that covers a point is read).
///
/// # Panics
///
/// If `surfaces` does not have `size[0] * size[1]` elements.
pub fn judge(
    tracer: &Tracer,
    fits: &[LightFit],
    settings: &JudgeSettings,
    size: [usize; 2],
    surfaces: &[Option<Surface>],
) -> Judged {
    assert_eq!(surfaces.len(), size[0] * size[1], "as many surfaces as pixels");
    let to_light = -settings.direction;
    let ray_origin = |surface: &Surface| surface.position + surface.normal * settings.ray_offset;
    let truth: Vec<Option<bool>> = surfaces
        .par_iter()
        .map(|surface| {
            let surface = surface.as_ref().filter(|surface| surface.normal.dot(to_light) > 0.0)?;
            Some(!tracer.is_occluded(ray_origin(surface), to_light))
        })
        .collect();
    let edge_distance = distance_to_transition(size, &truth);
    let width = settings.edge_width();
    let edge_zone: Vec<bool> = surfaces
        .iter()
        .zip(&edge_distance)
        .map(|(surface, distance)| surface.is_some_and(|s| *distance <= width * s.pixels_per_texel.max(1.0)))
        .collect();
    let classes = (0..surfaces.len())
        .into_par_iter()
        .map(|index| match (&surfaces[index], truth[index]) {
            (Some(surface), Some(lit)) => classify(surface, lit, edge_zone[index], || {
                is_hole(tracer, fits, settings, surface, ray_origin(surface))
            }),
            _ => Class::NotJudged,
        })
        .collect::<Vec<_>>();
    let shares = shares(surfaces, &truth, &classes, &edge_zone);
    Judged { classes, truth, edge_distance, edge_zone, shares }
}

fn classify(surface: &Surface, lit: bool, in_edge_zone: bool, is_hole: impl FnOnce() -> bool) -> Class {
    let seems_lit = surface.factor >= 0.5;
    match (lit, seems_lit) {
        _ if lit == seems_lit => Class::Right,
        (false, true) if is_hole() => Class::Hole,
        _ if in_edge_zone => Class::Edge,
        (true, _) => Class::FalseShadow,
        (false, _) => Class::FalseLight,
    }
}

/// Whether no occluder of the point is inside the map that is read for it.
fn is_hole(tracer: &Tracer, fits: &[LightFit], settings: &JudgeSettings, surface: &Surface, origin: Vec3) -> bool {
    let to_light = -settings.direction;
    let Some(fit) = fits.iter().find(|fit| fit.covers(surface.position.as_dvec3())) else {
        return true;
    };
    if settings.depth_clamp {
        // All that stands toward the light from a covered point is.
        return false;
    }
    let inside = |distance: f32| fit.covers(origin.as_dvec3() + to_light.as_dvec3() * f64::from(distance));
    !tracer.all_hits(origin, to_light).iter().any(|hit| inside(hit.distance))
}

fn shares(surfaces: &[Option<Surface>], truth: &[Option<bool>], classes: &[Class], edge_zone: &[bool]) -> Shares {
    let mut shares = Shares::default();
    let mut counts = [0usize; 6];
    let mut error = 0.0f64;
    for (index, surface) in surfaces.iter().enumerate() {
        let Some(surface) = surface.filter(|surface| surface.counts) else { continue };
        shares.counted += 1;
        let Some(lit) = truth[index] else { continue };
        shares.facing += 1;
        error += f64::from((surface.factor - f32::from(u8::from(lit))).abs());
        counts[0] += usize::from(classes[index] != Class::Right);
        counts[1] += usize::from(classes[index] == Class::FalseShadow);
        counts[2] += usize::from(classes[index] == Class::FalseLight);
        counts[3] += usize::from(classes[index] == Class::Hole);
        counts[4] += usize::from(classes[index] == Class::Edge);
        counts[5] += usize::from(edge_zone[index]);
    }
    let share = |count: usize| if shares.facing == 0 { 0.0 } else { count as f32 / shares.facing as f32 };
    Shares {
        wrong: share(counts[0]),
        false_shadow: share(counts[1]),
        false_light: share(counts[2]),
        hole: share(counts[3]),
        edge: share(counts[4]),
        edge_zone: share(counts[5]),
        mean_error: if shares.facing == 0 { 0.0 } else { (error / shares.facing as f64) as f32 },
        ..shares
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use shadowfit::settings::{FitKind, FitSettings};
    use shadowfit::{PerspectiveCamera, fit};

    /// A floor seen from above by parallel columns of pixels a decimetre apart, and a roof over
    /// its left half at height 2, under a vertical sun.
    fn floor(factor: impl Fn(f32) -> f32, pixels_per_texel: f32) -> ([usize; 2], Vec<Option<Surface>>) {
        let size = [40, 10];
        let surfaces = (0..400)
            .map(|index| {
                let x = (index % 40) as f32 * 0.1 - 1.95;
                Some(Surface {
                    position: Vec3::new(x, 0.0, (index / 40) as f32 * 0.1),
                    normal: Vec3::Y,
                    factor: factor(x),
                    pixels_per_texel,
                    counts: true,
                })
            })
            .collect();
        (size, surfaces)
    }

    fn roof() -> Tracer {
        let corner = |x, z| Vec3::new(x, 2.0, z);
        Tracer::new([
            [corner(-9.0, -9.0), corner(-9.0, 9.0), corner(0.0, 9.0)],
            [corner(-9.0, -9.0), corner(0.0, 9.0), corner(0.0, -9.0)],
        ])
    }

    /// A map around the floor whose near plane lies `extension` metres above what the camera sees.
    fn map(extension: f32) -> LightFit {
        let camera = PerspectiveCamera {
            eye: DVec3::new(0.0, 1.0, 6.0),
            forward: Vec3::new(0.0, -0.1, -1.0),
            up: Vec3::Y,
            fov_y: 0.4,
            aspect: 3.0,
            near: 1.0,
            far: 8.0,
        };
        let settings = FitSettings {
            kind: FitKind::FrustumAabb,
            caster_extension: extension,
            max_distance: 8.0,
            ..FitSettings::default()
        };
        fit(&camera.frustum().expect("a frustum"), Vec3::NEG_Y, &settings).expect("a fit")
    }

    fn shares_of(factor: impl Fn(f32) -> f32, pixels_per_texel: f32, extension: f32) -> Shares {
        let (size, surfaces) = floor(factor, pixels_per_texel);
        let settings = JudgeSettings::new(Vec3::NEG_Y, 0.5);
        judge(&roof(), &[map(extension)], &settings, size, &surfaces).shares
    }

    #[test]
    fn a_perfect_map_has_no_wrong_pixel() {
        let shares = shares_of(|x| if x < 0.0 { 0.0 } else { 1.0 }, 1.0, 9.0);
        assert_eq!((shares.facing, shares.wrong, shares.mean_error), (400, 0.0, 0.0));
    }

    #[test]
    fn a_map_that_shadows_everything_is_false_shadow_but_for_the_edge_zone() {
        let shares = shares_of(|_| 0.0, 1.0, 9.0);
        // Half of 40 columns is wrong; the edge zone of 1.5 pixels takes the first (0.5 from the
        // boundary) and the second (1.5).
        assert_eq!((shares.wrong, shares.false_shadow, shares.edge), (0.5, 18.0 / 40.0, 2.0 / 40.0));
        assert_eq!((shares.false_light, shares.hole), (0.0, 0.0));
    }

    #[test]
    fn coarse_texels_widen_the_edge_zone_by_their_footprint() {
        let shares = shares_of(|_| 0.0, 4.0, 9.0);
        // 1.5 texels of 4 pixels: columns up to 6 pixels from the boundary.
        assert_eq!((shares.false_shadow, shares.edge), (14.0 / 40.0, 6.0 / 40.0));
    }

    #[test]
    fn a_roof_inside_the_map_that_casts_nothing_is_false_light() {
        let shares = shares_of(|_| 1.0, 1.0, 9.0);
        assert_eq!((shares.false_light, shares.hole, shares.edge), (18.0 / 40.0, 0.0, 2.0 / 40.0));
    }

    #[test]
    fn a_roof_outside_the_map_is_a_hole_and_nothing_else() {
        let shares = shares_of(|_| 1.0, 1.0, 0.0);
        assert_eq!((shares.hole, shares.false_light, shares.edge, shares.wrong), (0.5, 0.0, 0.0, 0.5));
    }

    #[test]
    fn depth_clamp_leaves_no_hole_since_the_map_holds_what_stands_before_it() {
        let (size, surfaces) = floor(|_| 1.0, 1.0);
        let settings = JudgeSettings { depth_clamp: true, ..JudgeSettings::new(Vec3::NEG_Y, 0.5) };
        let shares = judge(&roof(), &[map(0.0)], &settings, size, &surfaces).shares;
        assert_eq!((shares.hole, shares.false_light, shares.edge), (0.0, 18.0 / 40.0, 2.0 / 40.0));
    }

    #[test]
    fn surfaces_that_face_away_or_do_not_count_are_left_out_of_the_shares() {
        let (size, mut surfaces) = floor(|_| 0.0, 1.0);
        for (index, surface) in surfaces.iter_mut().enumerate() {
            let surface = surface.as_mut().expect("floor everywhere");
            surface.counts = index % 40 != 39;
            if index % 40 == 38 {
                surface.normal = Vec3::NEG_Y;
            }
        }
        let settings = JudgeSettings::new(Vec3::NEG_Y, 0.5);
        let shares = judge(&roof(), &[map(9.0)], &settings, size, &surfaces).shares;
        assert_eq!((shares.counted, shares.facing), (390, 380));
        assert_eq!(shares.false_shadow, 16.0 / 38.0);
    }
}
