//! Devices of no features with the limits of WebGL2 draw what others draw.

use glam::DVec3;
use shadowfit::Technique;
use shadowfit_render::{Overlay, PixelQuery, TexelBlock};

use super::devices::software_gpu;
use super::pictures::{Pictures, SIZE};
use super::sheets::sheets;

#[test]
fn pictures_need_no_features_and_no_more_than_the_limits_of_webgl2() {
    let technique = Technique::default().with_resolution(1024, 1024);
    let all = (wgpu::Features::PRIMITIVE_INDEX | wgpu::Features::DEPTH_CLIP_CONTROL, wgpu::Limits::default());
    let least = (wgpu::Features::empty(), wgpu::Limits::downlevel_webgl2_defaults());
    let [mut all, mut least] = [all, least].map(|(features, limits)| {
        Pictures::new(software_gpu(features, limits), &technique, 4, &sheets(), DVec3::new(1.0, 4.0, 6.0))
    });
    for overlay in [Overlay::None, Overlay::MapTint, Overlay::PixelsPerTexel] {
        let [all, least] = [&mut all, &mut least].map(|pictures| pictures.picture(|frame| frame.overlay = overlay));
        assert!(all == least, "{overlay:?}");
    }
    let step = DVec3::new(0.2, 0.1, 0.0);
    assert!(all.judged(Overlay::Error, step) == least.judged(Overlay::Error, step), "marks");
    let texels = Some(TexelBlock { map: 0, texel: [500, 500], radius: 31 });
    let query = PixelQuery { size: SIZE, pixel: [70, 50], texels };
    assert_eq!(all.pixel(&query), least.pixel(&query));
    assert!(all.renderer.sun().can_record_demand() && !least.renderer.sun().can_record_demand());
}
