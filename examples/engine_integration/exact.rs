//! Exact edges: rays where the maps are not sure. The engine runs this with `--exact`.
//!
//! What the engine has to do for it is marked with EXACT, here and in `engine_integration.rs`, by what it is for: a depth
//! pre-pass, which many engines have anyway, the triangles, and the factors of the picture, which are found from both.
//! Each part begins at its comment and ends at the next empty line. A test counts these lines.

use anyhow::Result;

use super::{Camera, DepthConvention, Engine, WgslOptions, depth_attachment, dvec3, mat4, vec3};
use crate::gpu::{Gpu, Pipeline};
use crate::scene::Scene;

// EXACT triangles: take `shadowfit-rays`.
use shadowfit_rays::glam::{Affine3A, Quat};
use shadowfit_rays::{MeshId, RayInstance, RayMesh, RayScene};

// EXACT edges: take `shadowfit-wgpu` with its feature `rays`.
use shadowfit_wgpu::exact_edges::{EdgePass, EdgeView, exact_factor_wgsl};

// EXACT edges: the sun's part of the light is multiplied by the factor of the picture, in place of step 6.
const FILTERED: &str = "sun *= shadowfit_factor(in.position, normal);";
const EXACT_FACTOR: &str = "
    sun *= shadowfit_exact_factor(in.position, normal, in.clip.xy);
";

/// What exact edges take beside the maps.
pub(crate) struct Exact {
    // EXACT pre-pass: a pipeline of its own.
    depth_pipeline: wgpu::RenderPipeline,

    // EXACT triangles: those of all meshes, and where these stand.
    rays: RayScene,
    meshes: Vec<MeshId>,

    // EXACT edges: one object for each view.
    edges: EdgePass,
}

/// Bind groups of a pipeline.
type Layouts<'a> = Vec<Option<&'a wgpu::BindGroupLayout>>;

impl Exact {
    /// `shaded` is the pipeline of the shaded pass, with the bind groups of its vertices alone.
    pub(crate) fn new(gpu: &Gpu, shaded: Pipeline<'_>) -> Result<Self> {
        // EXACT pre-pass: the vertices of the shaded pass, without its fragments.
        let depth_pipeline = gpu.pipeline(Pipeline { color: None, ..shaded });

        // EXACT triangles: build and upload each mesh once.
        let mut rays = RayScene::new(&gpu.device, &gpu.queue)?;
        let mut meshes = Vec::new();
        for triangles in Scene::triangles() {
            let corners = triangles.into_iter().map(|triangle| triangle.map(Into::into));
            meshes.push(rays.add_mesh(&RayMesh::from_triangles(corners)?)?);
        }

        // EXACT edges: make the pass.
        let edges = EdgePass::new(&gpu.device, &gpu.queue)?;

        Ok(Self { depth_pipeline, rays, meshes, edges })
    }

    /// The shaded pass's WGSL and bind groups, from those that read the maps alone.
    pub(crate) fn shaded<'a>(&'a self, wgsl: &str, mut groups: Layouts<'a>) -> (String, Layouts<'a>) {
        // EXACT edges: paste what reads the factors beside the look-up, and put its layout into the pipeline.
        let wgsl = exact_factor_wgsl(&WgslOptions::group(2), 0) + &wgsl.replace(FILTERED, EXACT_FACTOR);
        groups.push(Some(self.edges.layout()));

        (wgsl, groups)
    }

    /// Binds what the shaded pass reads of it.
    pub(crate) fn bind(&self, pass: &mut wgpu::RenderPass<'_>) {
        // EXACT edges: bind the factors of this frame where the pasted WGSL looks for them.
        pass.set_bind_group(2, self.edges.group(), &[]);
    }

    /// How edges came out in the last frame, and what rays decided in the last one that the GPU has finished.
    pub(crate) fn report(&mut self) -> String {
        let counts = self.edges.take_counts();
        let traced = counts.map(|counts| format!(", {} of {} pixels", counts.traced, counts.facing));
        format!("{:?}{}", self.edges.result(), traced.unwrap_or_default())
    }
}

impl Engine {
    /// Fills the depth buffer, and finds the factors of the picture: after the maps, and before it is shaded.
    pub(crate) fn record_exact(&mut self, encoder: &mut wgpu::CommandEncoder, camera: &Camera) -> Result<()> {
        let Some(exact) = &mut self.exact else { return Ok(()) };
        let (cell, clip_from_eye, depth) = (camera.cell(), camera.clip_from_eye(), &self.targets.depth);
        // EXACT pre-pass: draw what the picture shows, and store its depths.
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            depth_stencil_attachment: Some(depth_attachment(depth, wgpu::LoadOp::Clear(0.0))),
            ..Default::default()
        });
        pass.set_pipeline(&exact.depth_pipeline);
        pass.set_bind_group(0, &self.camera.1, &[]);
        self.scene.draw(&mut pass, 0..self.scene.objects.len() as u32);
        drop(pass);

        // EXACT triangles: in each frame, say where the meshes stand. What stands still is not uploaded again.
        let instances = self.scene.placed(cell).map(|(mesh, center, half_size)| {
            let place = Affine3A::from_scale_rotation_translation(vec3(half_size), Quat::IDENTITY, vec3(center));
            RayInstance::new(exact.meshes[mesh as usize], place)
        });
        exact.rays.set_instances(dvec3(cell), &instances.collect::<Vec<_>>())?;

        // EXACT edges: find the factors. What comes back says why, where edges are filtered.
        let view = EdgeView::new(depth, mat4(clip_from_eye), DepthConvention::Reversed, dvec3(camera.eye));
        exact.edges.record(encoder, &self.sun, Some(&exact.rays), &view)?;

        Ok(())
    }
}
