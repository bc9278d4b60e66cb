//! Devices without features and with the limits of WebGL2 draw the same pictures as other devices.

use glam::DVec3;
use shadowfit_render::{Overlay, PixelQuery, TexelBlock};

use super::devices::test_gpu;
use super::pictures::{SIZE, Stage, camera, cheap_technique};
use super::sheets::sheets;

#[test]
fn pictures_need_no_features_and_no_more_than_the_limits_of_webgl2() {
    let technique = cheap_technique().with_resolution(512, 512);
    let all = (wgpu::Features::PRIMITIVE_INDEX | wgpu::Features::DEPTH_CLIP_CONTROL, wgpu::Limits::default());
    let least = (wgpu::Features::empty(), wgpu::Limits::downlevel_webgl2_defaults());
    let [mut all, mut least] = [all, least].map(|(features, limits)| {
        let camera = camera(DVec3::new(1.0, 4.0, 6.0), DVec3::Y);
        Stage::on(test_gpu(features, limits), &technique, 4, &sheets(), camera)
    });
    for overlay in [Overlay::None, Overlay::MapTint, Overlay::PixelsPerTexel] {
        let [all, least] = [&mut all, &mut least].map(|stage| stage.picture(|frame| frame.overlay = overlay));
        assert!(all == least, "{overlay:?}");
    }
    let step = DVec3::new(0.2, 0.1, 0.0);
    assert!(all.judged(Overlay::Error, step) == least.judged(Overlay::Error, step), "marks");
    let texels = Some(TexelBlock { map: 0, texel: [250, 250], radius: 31 });
    let query = PixelQuery { size: SIZE, pixel: [70, 50], texels };
    assert_eq!(all.pixel(&query), least.pixel(&query));
    assert!(all.pictures.renderer.sun().can_record_demand() && !least.pictures.renderer.sun().can_record_demand());
}
