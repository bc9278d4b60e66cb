//! Rays and classes on the GPU: the time of a live judgement.

use std::path::PathBuf;

use anyhow::Result;
use shadowfit::{ShadowFitter, Technique};
use shadowfit_params::Inputs;
use shadowfit_params::tool::{CameraSettings, LightSettings};
use shadowfit_render::{FlyCamera, Renderer};
use shadowfit_scene::{Scene, builtin, load_gltf};
use shadowfit_study::{Evaluator, Judging, LiveTruth, PreparedScene, View};
use shadowfit_wgpu::ShadowMapDescriptor;

use super::Bench;
use crate::table::{Table, ms};

/// Size of the judged picture, in pixels.
const SIZE: [u32; 2] = [1280, 720];

pub(crate) fn time(bench: &Bench, files: &[PathBuf]) -> Result<Table> {
    let gpu = &bench.gpu;
    let mut scenes: Vec<Scene> = vec![builtin::default_scene()];
    for file in files {
        scenes.push(load_gltf(file)?);
    }
    let mut rows = Vec::new();
    for scene in scenes {
        let name = scene.name.clone();
        let technique = Technique::default().with_resolution(bench.map, bench.map);
        let renderer = Renderer::new(gpu, &ShadowMapDescriptor::from(&technique), 1)?;
        let mut prepared = PreparedScene::new(gpu, renderer.material_layout(), scene)?;
        let bounds = prepared.bounds();
        let middle = ((bounds.min + bounds.max) * 0.5).as_dvec3();
        let eye = if rows.is_empty() { builtin::default_camera().0.as_dvec3() } else { middle };
        let fly = FlyCamera::look_at(eye, middle + glam::DVec3::new(0.1, 0.0, -1.0));
        let aspect = SIZE[0] as f32 / SIZE[1] as f32;
        let camera = fly.camera(&CameraSettings::default(), aspect);
        let view = View { camera, direction: LightSettings::default().direction(), is_first: true };
        let mut evaluator = Evaluator::new(renderer, Judging { size: SIZE, ..Judging::default() });
        let maps = prepared.fit_alone(&mut ShadowFitter::new(&technique), Inputs::default(), &view)?;
        let mut live = LiveTruth::new(gpu, &prepared)?;
        let repeats = bench.frames.clamp(1, 100) as u32;
        let triangles = prepared.casting_triangles();
        let time = evaluator.time_live(gpu, &mut prepared, &view, &maps, &mut live, repeats)?;
        rows.push(vec![name, format!("{triangles}"), ms(time)]);
    }
    Ok(Table {
        title: "Truth on the GPU",
        note: "One ray for each of 1280 × 720 pixels, the distances to edges, and the class.".to_owned(),
        columns: ["scene", "triangles", "time"].map(str::to_owned).to_vec(),
        rows,
    })
}
