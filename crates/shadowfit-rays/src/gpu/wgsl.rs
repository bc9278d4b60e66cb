//! The WGSL for rays, assembled from the pieces in `shaders/`. Every name starts with a prefix, so the text
//! can be pasted into any shader.

use crate::STACK;
use crate::error::RayError;

/// Options for inserting the WGSL into an engine's shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RayWgslOptions<'a> {
    /// Index of the bind group that the WGSL reads.
    pub group: u32,
    /// Prefix of all names in the WGSL, before an underscore. With `sun`, the function
    /// `shadowfit_rays_blocked` is called `sun_rays_blocked`, and constants begin with `SUN_`. A prefix that
    /// is not an identifier makes the WGSL invalid. [`Self::with_prefix`] rejects it.
    pub prefix: &'a str,
    /// WGSL that defines `fn shadowfit_rays_counts(hit: shadowfit_RayHit) -> bool`. It returns whether an
    /// opaque hit blocks the ray. `None` lets all opaque hits block. Its names get the prefix as well.
    ///
    /// A hit has these fields:
    ///
    /// - `instance` (`u32`): the index in the list of instances.
    /// - `custom` (`u32`): the instance's number from the engine.
    /// - `triangle` (`u32`): the triangle's index in its mesh.
    /// - `slot` (`u32`): the triangle's place among all triangles of the scene.
    /// - `weights` (`vec2<f32>`): the weights of its second and third corner.
    /// - `distance` (`f32`): in metres.
    ///
    /// Hits come in no particular order.
    pub counts: Option<&'a str>,
}

impl<'a> RayWgslOptions<'a> {
    /// The usual prefix.
    pub const PREFIX: &'static str = "shadowfit";

    /// Returns the options for the bind group `group`, with the prefix `shadowfit`, in which every opaque hit
    /// blocks.
    pub const fn group(group: u32) -> Self {
        Self { group, prefix: Self::PREFIX, counts: None }
    }

    /// Returns the options with another prefix: ASCII letters, digits and underscores, with a letter first.
    ///
    /// # Errors
    ///
    /// Returns [`RayError::Prefix`] for any other prefix.
    pub fn with_prefix(self, prefix: &'a str) -> Result<Self, RayError> {
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        if prefix.starts_with(|c: char| c.is_ascii_alphabetic()) && prefix.chars().all(is_word) {
            Ok(Self { prefix, ..self })
        } else {
            Err(RayError::Prefix(prefix.to_owned()))
        }
    }

    /// Returns the options with [`Self::counts`].
    #[must_use]
    pub const fn with_counts(self, counts: &'a str) -> Self {
        Self { counts: Some(counts), ..self }
    }
}

/// Returns the WGSL for tracing rays in compute and fragment shaders:
///
/// - `shadowfit_rays_blocked(origin, direction) -> bool` returns whether a triangle blocks the ray from a
///   point, at any distance from 0 on. `origin` (`vec3<f32>`) is in metres relative to the origin of
///   [`RayScene::set_instances`](crate::RayScene::set_instances). `direction` (`vec3<f32>`) has unit length
///   and points toward the light.
/// - `shadowfit_rays_blocked_above(origin, direction, normal, reach) -> bool` does the same for a ray from a
///   large surface, where rounding may exceed the height of the ray's start above the surface. Triangles in
///   the plane of the unit `normal` count only from a distance of `reach` metres on.
/// - `shadowfit_rays_surface(origin, direction, sought) -> shadowfit_RaySurface` finds the triangle of a
///   surface whose place is known roughly, such as from a pixel's depth. `sought` (`shadowfit_RaySought`) has
///   these fields, with lengths in metres: `distance` is the length of the ray, with the expected place at
///   its middle. `sure` is the usual greatest distance of the surface from the middle. `beside` is the
///   greatest distance at which the ray may miss a triangle. `normal` is the surface's unit normal, or zero
///   if it is unknown. The result is the first triangle within `sure` of the middle, or else the triangle
///   nearest to the middle: its `distance`, its unit `normal` against the ray, and its `slot` and `instance`
///   (`SHADOWFIT_RAYS_NONE` if there is none). Both sides of triangles count.
/// - `shadowfit_rays_triangle(slot)` returns the triangle of a hit's slot, with corners `a`, `b` and `c` in
///   the space of its mesh.
///
/// A ray that starts on a surface hits it, so start it slightly above. The WGSL reads the bindings 0 to 4 of
/// the bind group [`RayScene::group`](crate::RayScene::group) and uses no derivatives.
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

/// Returns the WGSL of the passes of [`RayScene::refit`](crate::RayScene::refit).
pub fn refit_wgsl() -> String {
    [include_str!("../shaders/types.wgsl"), include_str!("../shaders/refit.wgsl")].concat()
}
