//! Exact edges: rays decide the pixels where the maps are unsure. The engine runs this code with `--exact`.
//!
//! EXACT marks the code that the engine needs for it, here and in `engine_integration.rs`, with the name of
//! its part: a depth pre-pass (which many engines have anyway), the triangles, and the edges, whose pass
//! computes a shadow factor per pixel from both. Each part begins at its comment and ends at the next empty
//! line. A test counts these lines.

use anyhow::Result;

use super::{Camera, DepthConvention, Engine, WgslOptions, depth_attachment, dvec3, mat4, vec3};
use crate::gpu::{Gpu, Pipeline};
use crate::scene::Scene;

// EXACT triangles: use `shadowfit-rays`.
use shadowfit_rays::glam::{Affine3A, Quat};
use shadowfit_rays::{MeshId, RayInstance, RayMesh, RayScene};

// EXACT edges: use `shadowfit-wgpu` with its feature `rays`.
use shadowfit_wgpu::exact_edges::{EdgePass, EdgeView, exact_factor_wgsl};

// EXACT edges: multiply the sun's light by the pixel's exact factor, instead of step 6.
const FILTERED: &str = "sun *= shadowfit_factor(in.position, normal);";
const EXACT_FACTOR: &str = "
    sun *= shadowfit_exact_factor(in.position, normal, in.clip.xy);
";

/// Objects for exact edges, in addition to the maps.
pub(crate) struct Exact {
    // EXACT pre-pass: store its pipeline.
    depth_pipeline: wgpu::RenderPipeline,

    // EXACT triangles: store the triangles of all meshes and the placement of their instances.
    rays: RayScene,
    meshes: Vec<MeshId>,

    // EXACT edges: store one object for each view.
    edges: EdgePass,
}

/// Bind group layouts of a pipeline.
type Layouts<'a> = Vec<Option<&'a wgpu::BindGroupLayout>>;

impl Exact {
    /// Creates the pipelines and uploads the triangles. `shaded` is the pipeline of the shaded pass, with
    /// only the bind groups that its vertex shader uses.
    pub(crate) fn new(gpu: &Gpu, shaded: Pipeline<'_>) -> Result<Self> {
        // EXACT pre-pass: use the vertex shader of the shaded pass, without a fragment shader.
        let depth_pipeline = gpu.pipeline(Pipeline { color: None, ..shaded });

        // EXACT triangles: build and upload each mesh once.
        let mut rays = RayScene::new(&gpu.device, &gpu.queue)?;
        let mut meshes = Vec::new();
        for triangles in Scene::triangles() {
            let corners = triangles.into_iter().map(|triangle| triangle.map(Into::into));
            meshes.push(rays.add_mesh(&RayMesh::from_triangles(corners)?)?);
        }

        // EXACT edges: create the pass.
        let edges = EdgePass::new(&gpu.device, &gpu.queue)?;

        Ok(Self { depth_pipeline, rays, meshes, edges })
    }

    /// Returns WGSL and bind group layouts of the shaded pass with exact edges, made from those without them.
    pub(crate) fn shaded<'a>(&'a self, wgsl: &str, mut groups: Layouts<'a>) -> (String, Layouts<'a>) {
        // EXACT edges: paste the WGSL that reads the factors next to the look-up, and add its layout to the
        // pipeline.
        let wgsl = exact_factor_wgsl(&WgslOptions::group(2), 0) + &wgsl.replace(FILTERED, EXACT_FACTOR);
        groups.push(Some(self.edges.layout()));

        (wgsl, groups)
    }

    /// Binds the exact factors for the shaded pass.
    pub(crate) fn bind(&self, pass: &mut wgpu::RenderPass<'_>) {
        // EXACT edges: bind the factors of this frame at the group that the pasted WGSL uses.
        pass.set_bind_group(2, self.edges.group(), &[]);
    }

    /// Returns the result of the last frame, and how many pixels were traced in the last frame that the GPU
    /// has finished.
    pub(crate) fn report(&mut self) -> String {
        let counts = self.edges.take_counts();
        let traced = counts.map(|counts| format!(", {} of {} pixels", counts.traced, counts.facing));
        format!("{:?}{}", self.edges.result(), traced.unwrap_or_default())
    }
}

impl Engine {
    /// Draws the depth pre-pass and computes the exact factors. Call it after the maps are drawn and before
    /// the shaded pass.
    pub(crate) fn record_exact(&mut self, encoder: &mut wgpu::CommandEncoder, camera: &Camera) -> Result<()> {
        let Some(exact) = &mut self.exact else { return Ok(()) };
        let (cell, clip_from_eye, depth) = (camera.cell(), camera.clip_from_eye(), &self.targets.depth);
        // EXACT pre-pass: draw the visible objects and store their depths.
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            depth_stencil_attachment: Some(depth_attachment(depth, wgpu::LoadOp::Clear(0.0))),
            ..Default::default()
        });
        pass.set_pipeline(&exact.depth_pipeline);
        pass.set_bind_group(0, &self.camera.1, &[]);
        self.scene.draw(&mut pass, 0..self.scene.objects.len() as u32);
        drop(pass);

        // EXACT triangles: pass the placement of all instances in each frame. Unchanged instances are not
        // uploaded again.
        let instances = self.scene.placed(cell).map(|(mesh, center, half_size)| {
            let place = Affine3A::from_scale_rotation_translation(vec3(half_size), Quat::IDENTITY, vec3(center));
            RayInstance::new(exact.meshes[mesh as usize], place)
        });
        exact.rays.set_instances(dvec3(cell), &instances.collect::<Vec<_>>())?;

        // EXACT edges: compute the factors. The result gives the reason if edges are filtered instead.
        let view = EdgeView::new(depth, mat4(clip_from_eye), DepthConvention::Reversed, dvec3(camera.eye));
        exact.edges.record(encoder, &self.sun, Some(&exact.rays), &view)?;

        Ok(())
    }
}
