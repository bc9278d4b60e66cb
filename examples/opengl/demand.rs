//! Counts the visible demand in the picture's depth buffer, for the maps of the next frame, and compares it with the CPU.

use anyhow::Result;
use bytemuck::{bytes_of, cast_slice, cast_slice_mut};
use glow::{HasContext, PixelPackData};
use shadowfit::demand::{COUNTS, DepthPicture, VisibleDemand, VisibleDemandSpace};
use shadowfit::glam::{Mat4, Vec3};
use shadowfit::uniform::DemandUniform;
use shadowfit::{DepthConvention, Technique};
use shadowfit_wgpu::demand::{DemandView, Depths, count_on_cpu};

use crate::courtyard::Courtyard;
use crate::{attach, link};

/// Points that a workgroup counts, across and down.
const SQUARE: u32 = 32;

/// Counts the demand of the bound target, whose depth texture is bound to unit 0. Returns the percentage of points in
/// other cells than by the CPU.
pub(crate) unsafe fn count(
    gl: &glow::Context,
    courtyard: &Courtyard,
    technique: &Technique,
    size: [u32; 2],
) -> Result<f64> {
    let view = &courtyard.camera.frustum()?;
    let (depth, fit) = (DepthConvention::NegativeOneToOne, &technique.fit);
    let clip_from_world = courtyard.camera.clip_from_world(depth);
    // OpenGL's row 0 is at the bottom.
    let turned = Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0)) * clip_from_world;
    let space = VisibleDemandSpace::new(view, courtyard.sun, fit.up, fit.max_distance)?;
    let uniform = DemandUniform::new(&DepthPicture { size, clip_from_world: turned, depth, view }, &space, 1, [0, 0])?;

    let mut counts = vec![0_u32; COUNTS];
    let mut depths = vec![0.0_f32; (size[0] * size[1]) as usize];
    let [width, height] = size.map(u32::cast_signed);
    unsafe {
        let program = gl.create_program().map_err(anyhow::Error::msg)?;
        attach(
            gl,
            program,
            glow::COMPUTE_SHADER,
            include_str!("../../crates/shadowfit-capi/shaders/shadowfit_demand.glsl"),
        )?;
        link(gl, program)?;
        for (target, content) in
            [(glow::UNIFORM_BUFFER, bytes_of(&uniform)), (glow::SHADER_STORAGE_BUFFER, cast_slice(&counts))]
        {
            gl.bind_buffer_base(target, 0, Some(gl.create_buffer().map_err(anyhow::Error::msg)?));
            gl.buffer_data_u8_slice(target, content, glow::STREAM_DRAW);
        }
        let [across, down] = size.map(|side| side.div_ceil(uniform.step * SQUARE));
        gl.dispatch_compute(across, down, 1);
        gl.memory_barrier(glow::BUFFER_UPDATE_BARRIER_BIT);
        gl.get_buffer_sub_data(glow::SHADER_STORAGE_BUFFER, 0, cast_slice_mut(&mut counts));
        let pixels = PixelPackData::Slice(Some(cast_slice_mut(&mut depths)));
        gl.read_pixels(0, 0, width, height, glow::DEPTH_COMPONENT, glow::FLOAT, pixels);
    }
    let rows = depths.chunks_exact(size[0] as usize).rev();
    let from_top = Depths { width: size[0], values: rows.flatten().copied().collect() };
    // The twin of the shader knows only depth of 0 to 1, which is also the stored depth.
    let twin = DemandView::from_camera(&courtyard.camera, DepthConvention::ZeroToOne, courtyard.sun, fit, size)?;
    let by_cpu = count_on_cpu(&twin, &from_top)?;
    let Some(by_gpu) = VisibleDemand::from_counts(space, counts) else { anyhow::bail!("counts are missing") };
    let (cells, wanted) = (by_gpu.demand().counts, by_cpu.demand().counts);
    let moved: u32 = cells.iter().zip(wanted).map(|(a, b)| a.abs_diff(*b)).sum();
    Ok(50.0 * f64::from(moved) / f64::from(wanted.iter().sum::<u32>()))
}
