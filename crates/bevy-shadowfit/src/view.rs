//! Views with shadows, and the boxes of the receivers in each.

use std::any::TypeId;

use bevy::camera::Camera;
use bevy::camera::primitives::Aabb;
use bevy::camera::visibility::{NoCpuCulling, NoFrustumCulling, RenderLayers, VisibleEntities};
use bevy::core_pipeline::prepass::DepthPrepass;
use bevy::ecs::query::QueryData;
use bevy::ecs::system::SystemParam;
use bevy::light::{NotShadowReceiver, ShadowFilteringMethod};
use bevy::math::{Affine3A, DMat4};
use bevy::mesh::morph::MeshMorphWeights;
use bevy::mesh::skinning::SkinnedMesh;
use bevy::prelude::*;
use shadowfit::glam as fit_glam;
use shadowfit::settings::MapSettings;
use shadowfit::{DepthConvention, ViewFrustum};
use shadowfit_wgpu::demand::DemandView;

use crate::clusters::{MeshClusters, WholeBox};
use crate::problem::Problem;

/// A view of the frame.
pub(crate) struct View {
    pub(crate) camera: Entity,
    pub(crate) layers: RenderLayers,
    pub(crate) filter: ShadowFilteringMethod,
    /// Matrix of the view, up to the greatest shadow distance of all lights.
    world_from_clip: fit_glam::DMat4,
    eye: fit_glam::DVec3,
    /// Whether its depth prepass can be counted.
    pub(crate) has_prepass: bool,
    pub(crate) receivers: Receivers,
}

/// Receivers of a view.
#[derive(Default)]
pub(crate) struct Receivers {
    /// Boxes in world space, in metres.
    pub(crate) boxes: Vec<shadowfit::Aabb>,
    /// Whether there are receivers without a known box, so that everything in view may receive shadows.
    pub(crate) has_unknown: bool,
}

/// A camera that shows meshes.
#[derive(QueryData)]
pub(crate) struct ViewCamera {
    entity: Entity,
    camera: &'static Camera,
    projection: &'static Projection,
    transform: &'static GlobalTransform,
    visible: &'static VisibleEntities,
    layers: Option<&'static RenderLayers>,
    filter: Option<&'static ShadowFilteringMethod>,
    has_prepass: Has<DepthPrepass>,
}

/// Meshes that are not culled on the CPU.
type Unculled<'w, 's> = Query<
    'w,
    's,
    (MeshBox, &'static InheritedVisibility, Option<&'static RenderLayers>),
    (With<Mesh3d>, With<NoCpuCulling>, Without<NotShadowReceiver>),
>;

/// Components that decide a mesh's box.
#[derive(QueryData)]
pub(crate) struct MeshBox {
    transform: &'static GlobalTransform,
    mesh: &'static Mesh3d,
    aabb: Option<&'static Aabb>,
    is_unbounded: Has<NoFrustumCulling>,
    is_whole: Has<WholeBox>,
    is_skinned: Has<SkinnedMesh>,
    is_morphed: Has<MeshMorphWeights>,
}

/// Input for computing views.
#[derive(SystemParam)]
pub(crate) struct Scene<'w, 's> {
    cameras: Query<'w, 's, ViewCamera, With<Camera3d>>,
    clusters: Res<'w, MeshClusters>,
    meshes: Query<'w, 's, MeshBox, (With<Mesh3d>, Without<NotShadowReceiver>)>,
    unculled: Unculled<'w, 's>,
}

impl Scene<'_, '_> {
    /// Returns the active views with their receivers. Meshes that extend more than `large` metres from their
    /// centre use their clusters.
    pub(crate) fn views(&self, large: f32) -> Result<Vec<View>, Problem> {
        self.cameras.iter().filter(|item| item.camera.is_active).map(|item| self.view(&item, large)).collect()
    }

    fn view(&self, item: &ViewCameraItem, large: f32) -> Result<View, Problem> {
        let layers = item.layers.cloned().unwrap_or_default();
        let receivers = self.receivers(item, &layers, large)?;
        let world_from_view = world_from_view(item.transform).ok_or(Problem::View(item.entity))?;
        let clip_from_view = match &item.camera.sub_camera_view {
            Some(part) => item.projection.get_clip_from_view_for_sub(part),
            None => item.projection.get_clip_from_view(),
        };
        let clip_from_view = DMat4::from_cols_array(&clip_from_view.to_cols_array().map(f64::from));
        let world_from_clip = world_from_view * clip_from_view.inverse();
        Ok(View {
            camera: item.entity,
            layers,
            filter: item.filter.copied().unwrap_or_default(),
            world_from_clip: fit_glam::DMat4::from_cols_array(&world_from_clip.to_cols_array()),
            eye: fit_glam::DVec3::from_array(world_from_view.w_axis.truncate().to_array()),
            has_prepass: item.has_prepass,
            receivers,
        })
    }

    /// Returns the boxes of the meshes that a camera sees. `layers` are the camera's layers.
    fn receivers(&self, item: &ViewCameraItem, layers: &RenderLayers, large: f32) -> Result<Receivers, Problem> {
        let mut receivers = Receivers::default();
        let visible = item.visible.get(TypeId::of::<Mesh3d>());
        receivers.boxes.reserve(visible.len());
        for (mesh, item) in visible.iter().filter_map(|&mesh| Some((mesh, self.meshes.get(mesh).ok()?))) {
            receivers.add(&item, &self.clusters, large).map_err(|()| Problem::Mesh(mesh))?;
        }
        for (mesh, visibility, mesh_layers) in &self.unculled {
            if visibility.get() && layers.intersects(mesh_layers.unwrap_or_default()) {
                receivers.add(&mesh, &self.clusters, large).map_err(|()| Problem::View(item.entity))?;
            }
        }
        Ok(receivers)
    }
}

/// Returns the matrix from a camera's view space to world space. Returns `None` if it scales, because Bevy
/// would compute different view depths.
fn world_from_view(transform: &GlobalTransform) -> Option<DMat4> {
    let matrix = DMat4::from_cols_array(&transform.to_matrix().to_cols_array().map(f64::from));
    let is_unit = |axis: usize| (matrix.col(axis).length() - 1.0).abs() < 1e-3;
    ((0..3).all(is_unit) && matrix.is_finite()).then_some(matrix)
}

impl View {
    /// Returns the frustum of the view up to `max_distance`, in metres of view depth.
    pub(crate) fn frustum(&self, max_distance: f32) -> Result<ViewFrustum, shadowfit::FitError> {
        ViewFrustum::from_world_from_clip_f64(&self.world_from_clip, self.eye, DepthConvention::Reversed, max_distance)
    }

    /// Returns the input for counting a frustum of this view, for a light that travels in `direction`. The
    /// rectangle is not known here.
    pub(crate) fn demand(&self, frustum: &ViewFrustum, direction: fit_glam::Vec3, max_distance: f32) -> DemandView {
        let eye_from_clip = fit_glam::DMat4::from_translation(-self.eye) * self.world_from_clip;
        DemandView {
            frustum: *frustum,
            clip_from_world: eye_from_clip.inverse().as_mat4(),
            depth: DepthConvention::Reversed,
            direction,
            up: MapSettings::default().up,
            max_distance,
            rectangle: [0; 4],
        }
    }
}

impl Receivers {
    /// Returns the distance of the farthest point of all boxes from an eye, in metres. Its view depth never
    /// exceeds this, for any direction of the camera.
    pub(crate) fn farthest(&self, eye: fit_glam::Vec3) -> f32 {
        if self.has_unknown {
            return f32::MAX;
        }
        let of_box = |aabb: &shadowfit::Aabb| (aabb.max - eye).abs().max((aabb.min - eye).abs()).length();
        self.boxes.iter().map(of_box).fold(0.0, f32::max)
    }

    fn add(&mut self, item: &MeshBoxItem, clusters: &MeshClusters, large: f32) -> Result<(), ()> {
        let Some(aabb) = item.aabb.filter(|_| !item.is_unbounded) else {
            self.has_unknown = true;
            return Ok(());
        };
        let world_from_mesh = item.transform.affine();
        let whole = world_box(aabb, &world_from_mesh).ok_or(())?;
        let is_large = (whole.max - whole.min).max_element() > 2.0 * large;
        let may_be_cut = !(item.is_whole || item.is_skinned || item.is_morphed);
        match (is_large && may_be_cut).then(|| clusters.of(item.mesh.id())).flatten() {
            Some(clusters) => {
                let boxes = clusters.iter().map(|cluster| {
                    let corner = |v: fit_glam::Vec3| Vec3::from_array(v.to_array());
                    Aabb::from_min_max(corner(cluster.min), corner(cluster.max))
                });
                self.boxes.extend(boxes.filter_map(|aabb| world_box(&aabb, &world_from_mesh)));
            }
            None => self.boxes.push(whole),
        }
        Ok(())
    }
}

/// Returns the world box around a mesh's own box, or `None` if it is not finite.
fn world_box(aabb: &Aabb, world_from_mesh: &Affine3A) -> Option<shadowfit::Aabb> {
    let centre = world_from_mesh.transform_point3a(aabb.center);
    let m = &world_from_mesh.matrix3;
    let half = aabb.half_extents;
    let half = m.x_axis.abs() * half.x + m.y_axis.abs() * half.y + m.z_axis.abs() * half.z;
    let (min, max) = (centre - half, centre + half);
    let vector = |v: bevy::math::Vec3A| fit_glam::Vec3::from_array(v.to_array());
    (min.is_finite() && max.is_finite()).then(|| shadowfit::Aabb::new(vector(min), vector(max)))
}
