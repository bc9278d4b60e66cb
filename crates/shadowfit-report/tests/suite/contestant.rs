//! Contestants with known shadows: the library finds exactly the errors that they have.

use anyhow::Result;
use glam::dcamera::rh::{proj::directx::orthographic, view::look_to_mat4};
use glam::{DMat4, DVec2, DVec3, Vec3};
use shadowfit_report::contestant::{
    Contestant, Drawn, JudgeSettings, Judging, LightMaps, LitSurface, LookupBlend, LookupFilter, LookupMap, Redraw,
    Results, RunFacts, ShadowLookup, Shadows, SlopeBias,
};
use shadowfit_report::geometry::Corners;
use shadowfit_report::peers::Frame;
use shadowfit_truth::{MapReading, MeasuredMap, PixelCamera, Tracer, Truth, TruthSettings};

/// Width and height of the pictures, in pixels.
const SIZE: [u32; 2] = [96, 54];
/// Texels along each side of the map, which is 40 m wide.
const TEXELS: u32 = 2048;

/// A renderer that traces its shadows.
#[derive(Default)]
struct Traced {
    tracer: Option<Tracer>,
    technique: usize,
}

/// Indices of its techniques.
const RAYS: usize = 0;
const NO_SHADOWS: usize = 1;
const FACTORS: usize = 2;
const LOOKUP: usize = 3;

impl Traced {
    /// Returns brightness and light factor of each pixel.
    fn pixels(&self, frame: &Frame) -> Vec<[f32; 2]> {
        let tracer = self.tracer.as_ref().expect("a scene");
        let camera = PixelCamera::new(frame.camera(), SIZE);
        let seen = Truth::seen_by_rays(tracer, &camera);
        let truth = Truth::trace(tracer, &camera, &TruthSettings::new(frame.to_light()), &seen);
        let points = truth.points.iter().map(|point| {
            let Some(point) = point else { return [0.0, 1.0] };
            let cosine = point.normal.dot(frame.to_light()).max(0.0);
            [cosine as f32, point.lit]
        });
        points.collect()
    }
}

impl Contestant for Traced {
    type Maps = DMat4;

    fn techniques(&self) -> Vec<String> {
        ["rays", "no shadows", "factors", "look-up"].map(str::to_owned).to_vec()
    }

    fn set_scene(&mut self, objects: &[Vec<Corners>]) -> Result<()> {
        self.tracer = Some(Tracer::new(objects.iter().flatten().copied()));
        Ok(())
    }

    fn begin_path(&mut self, technique: usize, _first: &Frame) -> Result<()> {
        self.technique = technique;
        Ok(())
    }

    fn draw(&mut self, frame: &Frame) -> Result<Drawn<DMat4>> {
        let pixels = self.pixels(frame);
        let shadows = match self.technique {
            RAYS => Shadows::Brightness(pixels.iter().map(|[brightness, factor]| brightness * factor).collect()),
            NO_SHADOWS => Shadows::Brightness(pixels.iter().map(|[brightness, _]| *brightness).collect()),
            FACTORS => Shadows::Factors(pixels.iter().map(|[_, factor]| *factor).collect()),
            _ => Shadows::Lookup(lookup(frame)),
        };
        Ok(Drawn { shadows, maps: clip_from_world(frame.to_light()) })
    }

    fn redraw(&mut self, redraw: &Redraw<'_, DMat4>) -> Result<Option<Vec<f32>>> {
        let pixels = self.pixels(redraw.frame);
        let is_shadowed = redraw.maps.is_some() && self.technique != NO_SHADOWS;
        let pixel = |[brightness, factor]: &[f32; 2]| match (self.technique, is_shadowed) {
            (FACTORS, true) => *factor,
            (_, true) => brightness * factor,
            (_, false) => *brightness,
        };
        Ok(Some(pixels.iter().map(pixel).collect()))
    }

    fn light_maps(&self, maps: &DMat4, to_light: DVec3) -> LightMaps {
        LightMaps {
            maps: vec![MeasuredMap::new(maps, DVec2::splat(TEXELS.into()), 100.0, to_light)],
            reading: MapReading::ViewDepth,
            filter_radius: 1.0,
            depth_clamp: true,
            reads_later_maps: false,
        }
    }

    fn brightness(&self, surface: &LitSurface) -> f64 {
        surface.normal.dot(surface.to_light).max(0.0)
    }
}

/// Returns the matrix of a map of 40 m around the origin, with depth 1 nearest to the light.
fn clip_from_world(to_light: DVec3) -> DMat4 {
    orthographic(-20.0, 20.0, -20.0, 20.0, 80.0, 0.0) * look_to_mat4(to_light * 40.0, -to_light, DVec3::X)
}

fn lookup(frame: &Frame) -> ShadowLookup {
    let to_light = frame.to_light();
    let texel = 40.0 / f64::from(TEXELS);
    ShadowLookup {
        maps: vec![LookupMap { clip_from_world: clip_from_world(to_light), texel, bound: 100.0 }],
        size: TEXELS,
        blend: LookupBlend::ViewDepth { overlap: 0.0 },
        depth_bias: 0.02,
        normal_bias: 1.0,
        slope_bias: SlopeBias::default(),
        to_light,
        filter: LookupFilter::Hardware2x2,
    }
}

/// Returns a floor and a box on it.
fn objects() -> Vec<Vec<Corners>> {
    let floor = [[-10.0, -10.0], [-10.0, 10.0], [10.0, 10.0], [10.0, -10.0]].map(|[x, z]| Vec3::new(x, 0.0, z));
    let [a, b, c, d] = floor;
    let corners = shadowfit::Aabb::new(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 2.0, 1.0)).corners();
    let faces = [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4], [2, 3, 7, 6], [0, 3, 7, 4], [1, 2, 6, 5]];
    let sides = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    vec![vec![[a, b, c], [a, c, d]], sides.map(|side| side.map(|corner: usize| corners[corner])).collect()]
}

/// Returns two frames of a path, 10 cm apart.
fn frames() -> Vec<Frame> {
    let light = DVec3::new(0.5, -0.7, 0.2).normalize();
    let frame = |frame: u32| Frame {
        id: format!("box/45/{frame}"),
        scene: 0,
        elevation_deg: 45.0,
        frame,
        view: look_to_mat4(DVec3::new(4.0 + 0.1 * f64::from(frame), 4.0, 6.0), DVec3::new(-0.5, -0.5, -0.8), DVec3::Y)
            .to_cols_array(),
        fov_y_deg: 50.0,
        aspect: 16.0 / 9.0,
        near: 0.1,
        far: 30.0,
        light_dir: light.to_array(),
    };
    (0..2).map(frame).collect()
}

fn judged() -> Results {
    let (mut traced, frames) = (Traced::default(), frames());
    let mut judging = Judging::new(&traced, JudgeSettings { size: SIZE, ..JudgeSettings::default() });
    let mut pictures = Vec::new();
    let frames: Vec<&Frame> = frames.iter().collect();
    let looked = judging.judge_scene(&mut traced, "box", &objects(), &frames, |picture| {
        assert_eq!(picture.factors.len(), picture.truth.points.len());
        pictures.push((picture.technique, picture.frame.id.clone()));
        Ok(())
    });
    looked.expect("judged");
    assert_eq!(pictures.len(), 8, "{pictures:?}");
    assert_eq!(judging.times().frames, 2);
    judging.results().clone()
}

#[test]
fn perfect_shadows_have_no_errors_and_missing_shadows_are_counted() {
    let results = judged();
    let of = |technique: usize, column: &str| results.frames[1].sums[technique].value(column);
    for technique in [RAYS, FACTORS] {
        for column in ["wrong %", "crawl %", "change %", "uncov %", "missed %"] {
            assert_eq!(of(technique, column), 0.0, "{column} of technique {technique}");
        }
    }
    // Every shadow is missing: each dark pixel is wrong.
    assert!(of(NO_SHADOWS, "wrong %") > 2.0, "{}", of(NO_SHADOWS, "wrong %"));
    assert_eq!(of(NO_SHADOWS, "false shadow %"), 0.0);
    // A fine map has errors only at edges.
    let (wrong, edge) = (of(LOOKUP, "wrong %"), of(LOOKUP, "edge %"));
    assert!(wrong < 0.5 && wrong == edge, "{wrong} {edge}");
    assert!(of(LOOKUP, "change %") < 0.05, "the map keeps its place");
}

#[test]
fn results_become_tables_json_and_the_run_of_a_page() {
    let results = judged();
    let text = results.to_markdown(Some(NO_SHADOWS));
    assert!(text.starts_with("## Overall\n\n| fit | wrong % | x no shadows | light error % |"), "{text}");
    assert!(text.contains("\n## box\n") && text.contains("| no shadows |"), "{text}");
    assert!(!results.to_markdown(None).contains("x no shadows"));
    let json = results.to_json(&serde_json::json!({ "every": 1 }));
    let flip = |technique: usize| json["fits"][technique]["overall"]["columns"]["flip"].as_f64().expect("a number");
    assert_eq!(flip(RAYS), 0.0, "true shadows look like true shadows");
    assert!(flip(NO_SHADOWS) > 0.01, "{}", flip(NO_SHADOWS));
    assert_eq!(json["fits"][RAYS]["groups"]["box/45"]["columns"]["wrong %"], 0.0);
    assert_eq!(json["fits"][NO_SHADOWS]["fit"], "no shadows");
    let run = results.to_run(RunFacts { title: "A box".into(), size: SIZE, ..RunFacts::default() });
    assert_eq!((run.frames.len(), run.techniques.len(), run.techniques[0].groups.len()), (2, 4, 1));
    assert!(shadowfit_report::tables::to_markdown(&run).contains("# A box"));
}

#[test]
fn pictures_of_another_place_are_refused() {
    /// A contestant that always draws from the wrong position, without shadows.
    struct Stuck(Traced);
    impl Contestant for Stuck {
        type Maps = DMat4;
        fn techniques(&self) -> Vec<String> {
            self.0.techniques()
        }
        fn set_scene(&mut self, objects: &[Vec<Corners>]) -> Result<()> {
            self.0.set_scene(objects)
        }
        fn begin_path(&mut self, technique: usize, first: &Frame) -> Result<()> {
            self.0.begin_path(technique, first)
        }
        fn draw(&mut self, frame: &Frame) -> Result<Drawn<DMat4>> {
            self.0.draw(frame)
        }
        fn redraw(&mut self, _redraw: &Redraw<'_, DMat4>) -> Result<Option<Vec<f32>>> {
            let view = look_to_mat4(DVec3::Y * 4.0, DVec3::Z, DVec3::Y).to_cols_array();
            let turned = Frame { view, ..frames()[0].clone() };
            self.0.redraw(&Redraw { frame: &turned, maps: None, view_depths_of: None })
        }
        fn light_maps(&self, maps: &DMat4, to_light: DVec3) -> LightMaps {
            self.0.light_maps(maps, to_light)
        }
    }
    let mut stuck = Stuck(Traced::default());
    let mut judging = Judging::new(&stuck, JudgeSettings { size: SIZE, ..JudgeSettings::default() });
    let refused = judging.judge_scene(&mut stuck, "box", &objects(), &frames().iter().collect::<Vec<_>>(), |_| Ok(()));
    let message = format!("{:#}", refused.expect_err("refused"));
    assert!(message.contains("box/45/0: the picture and rays show different surfaces"), "{message}");
}
