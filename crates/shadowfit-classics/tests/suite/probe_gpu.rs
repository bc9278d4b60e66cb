//! Probes of samples are equal, whether the shader uses primitive indices or vertices that number the
//! triangles.

use shadowfit_classics::mapped::{FrameExtras, SampleRenderer};
use shadowfit_classics::{SAMPLES, SampleDrawing, SampleValues};
use shadowfit_render::passes::material_layout;
use shadowfit_render::{Gpu, GpuScene, Probe, ProbeTargets, Wanted};
use shadowfit_testing::renderer_gpu;

use super::scenes::SIZE;

/// Opens the software adapter without features.
fn featureless_gpu() -> Gpu {
    let wanted = Wanted { features: wgpu::Features::empty(), limits: Some(wgpu::Limits::default()) };
    pollster::block_on(Gpu::of_adapter(renderer_gpu().adapter, &wanted)).expect("a device")
}

#[test]
fn probes_of_samples_without_the_primitive_index_are_those_with_it() {
    let devices = [renderer_gpu(), featureless_gpu()];
    let mut probed = 0;
    for sample in &SAMPLES {
        let camera = sample.lens(SIZE[0] as f32 / SIZE[1] as f32);
        let drawing = sample.drawing(&SampleValues::new(sample), &camera).expect("a drawing");
        let SampleDrawing::Mapped(frame) = drawing else { continue };
        let scene = sample.scene();
        let probe = |gpu: &Gpu| -> Probe {
            let layout = material_layout(&gpu.device);
            let mut gpu_scene = GpuScene::new(gpu, &layout, &scene, &scene.pose(None, 0.0)).expect("memory");
            let targets = ProbeTargets::new(&gpu.device, SIZE);
            let extras = FrameExtras::default();
            let mut renderer = SampleRenderer::new(gpu, 1);
            let probe = renderer.probe(gpu, &mut gpu_scene, &frame, extras, &targets);
            pollster::block_on(probe).expect("a map").expect("a probe")
        };
        let [indexed, unrolled] = devices.each_ref().map(probe);
        assert!(indexed.pixels == unrolled.pixels, "{}", sample.id);
        probed += usize::from(indexed.pixels.iter().flatten().count() > 1000);
    }
    assert!(probed >= 5, "{probed} samples show surfaces");
}
