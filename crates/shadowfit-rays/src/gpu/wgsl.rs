//! The WGSL of rays, put together from the pieces in `shaders/`. Every name starts with a prefix, so that the text can be
//! pasted into any shader.

use crate::STACK;
use crate::error::RayError;

/// How the WGSL fits into an engine's shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RayWgslOptions<'a> {
    /// Bind group that it reads; any will do.
    pub group: u32,
    /// Prefix of all its names, before an underscore: with `sun` the function `shadowfit_rays_blocked` is called
    /// `sun_rays_blocked` and constants begin with `SUN_`. A prefix that is not an identifier makes invalid WGSL;
    /// [`Self::with_prefix`] refuses it.
    pub prefix: &'a str,
    /// WGSL that defines `fn shadowfit_rays_counts(hit: shadowfit_RayHit) -> bool`, which says of an opaque hit whether it
    /// blocks the ray; without it all of them do. Its names get the prefix as well.
    ///
    /// A hit has `instance`, the index in the list of instances (`u32`); `custom`, its own number (`u32`); `triangle`, the
    /// triangle's own index in its mesh (`u32`); `slot`, its place among the triangles of the scene (`u32`); `weights` of
    /// its second and third corner (`vec2<f32>`); and `distance`, in metres (`f32`). Hits come in no order.
    pub counts: Option<&'a str>,
}

impl<'a> RayWgslOptions<'a> {
    /// The usual prefix.
    pub const PREFIX: &'static str = "shadowfit";

    /// Bind group `group`, the prefix `shadowfit`, and every opaque hit counts.
    pub const fn group(group: u32) -> Self {
        Self { group, prefix: Self::PREFIX, counts: None }
    }

    /// The same with another prefix: ASCII letters, digits and underscores, with a letter first.
    ///
    /// # Errors
    ///
    /// [`RayError::Prefix`] for anything else.
    pub fn with_prefix(self, prefix: &'a str) -> Result<Self, RayError> {
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        if prefix.starts_with(|c: char| c.is_ascii_alphabetic()) && prefix.chars().all(is_word) {
            Ok(Self { prefix, ..self })
        } else {
            Err(RayError::Prefix(prefix.to_owned()))
        }
    }

    /// The same with [`Self::counts`].
    #[must_use]
    pub const fn with_counts(self, counts: &'a str) -> Self {
        Self { counts: Some(counts), ..self }
    }
}

/// WGSL for shaders that trace rays, in compute and fragment shaders:
///
/// | function | tells |
/// |---|---|
/// | `shadowfit_rays_blocked(origin, direction) -> bool` | whether anything stands on the ray from a point, at any distance from 0 on: `origin` (`vec3<f32>`) is in metres relative to the origin of [`RayScene::set_instances`](crate::RayScene::set_instances), `direction` (`vec3<f32>`) of unit length, toward the light |
/// | `shadowfit_rays_blocked_above(origin, direction, normal, reach) -> bool` | the same for a ray from a large surface, whose points are rounded by more than the ray starts above it: triangles in the plane of the unit `normal` count from a distance of `reach` metres on |
/// | `shadowfit_rays_surface(origin, direction, sought) -> shadowfit_RaySurface` | the triangle of a surface whose place is roughly known, such as that of a pixel's depth. `sought` (`shadowfit_RaySought`) has in metres the ray's `distance`, in whose middle the surface lies, how far from there it lies at most if all is well (`sure`), and how far `beside` a triangle the ray may pass; and the surface's unit `normal`, or zero. Found is the first triangle within `sure` of the middle, else the one nearest to the middle: where (`distance`), its unit normal against the ray (`normal`), and which (`slot` and `instance`; `SHADOWFIT_RAYS_NONE` if there is none). Both sides of triangles count |
///
/// `shadowfit_rays_triangle(slot)` is the triangle of a hit's slot, with corners `a`, `b` and `c` in the space of its mesh.
///
/// A ray that starts on a surface meets it: start it a little above. Reads the bindings 0 to 4 of the group, which is
/// [`RayScene::group`](crate::RayScene::group); no derivatives.
pub fn rays_wgsl(options: &RayWgslOptions<'_>) -> String {
    let rays = include_str!("../shaders/rays.wgsl")
        .replace("GROUP", &options.group.to_string())
        .replace("NODES_ON_STACK", &STACK.to_string());
    let counts = options.counts.unwrap_or(include_str!("../shaders/counts.wgsl"));
    let text = [include_str!("../shaders/types.wgsl"), &rays, include_str!("../shaders/surface.wgsl"), counts].concat();
    if options.prefix == RayWgslOptions::PREFIX {
        return text;
    }
    text.replace("shadowfit_", &format!("{}_", options.prefix))
        .replace("SHADOWFIT_", &format!("{}_", options.prefix.to_ascii_uppercase()))
}

/// The WGSL of the passes of [`RayScene::refit`](crate::RayScene::refit).
pub fn refit_wgsl() -> String {
    [include_str!("../shaders/types.wgsl"), include_str!("../shaders/refit.wgsl")].concat()
}
