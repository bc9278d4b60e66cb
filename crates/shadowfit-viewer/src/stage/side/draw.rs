//! The pictures of a side: fitted, judged and drawn for the chosen view.

use shadowfit::{Camera, FittedMap, PerspectiveCamera, VisibleDemand};
use shadowfit_params::tool::{ErrorMarks, InsetMaps, Settings, ViewMode};
use shadowfit_render::{Culling, Frame, Inset, Marks, Overlay, RenderTarget, Statistics};
use shadowfit_study::{View, atmosphere};
use shadowfit_wgpu::ShadowMapError;
use shadowfit_wgpu::exact_edges::EdgeOutcome;

use super::Side;
use crate::stage::fitted::Fitted;
use crate::stage::shot::Shot;
use crate::stage::{boards, demand_view, inset, outside};

/// Everything that a picture depends on.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PictureKey {
    settings: Settings,
    camera: Camera,
    sight: f32,
    blink: f32,
    pose: u64,
    maps: Vec<FittedMap>,
    judged: Option<wgpu::TextureView>,
    target: wgpu::Texture,
}

/// A view and its maps.
struct Plan<'a> {
    view: View,
    maps: &'a [FittedMap],
    /// Whether the maps were already drawn for the judge.
    maps_stay: bool,
}

/// Returns why edges are filtered although the technique traces them.
pub(in crate::stage) fn filtered_edges(settings: &Settings, result: EdgeOutcome) -> Option<String> {
    let wants = settings.technique.edges.are_traced() && settings.view.shadows;
    let EdgeOutcome::Filtered(why) = result else { return None };
    wants.then(|| format!("Edges are filtered: {why}"))
}

impl Side {
    /// Fits, judges and draws the view of the settings.
    pub(in crate::stage) fn draw(&mut self, shot: &mut Shot<'_>, target: &RenderTarget) {
        self.problem = None;
        self.evaluator.judging.ray_offset = shot.ray_offset();
        self.draw_anew(shot, target);
        let result = self.evaluator.renderer.edge_result();
        self.problem =
            self.problem.take().or_else(|| filtered_edges(shot.settings, result)).or_else(|| self.live.notice());
    }

    /// Draws the view unless it would equal the last picture.
    fn draw_anew(&mut self, shot: &mut Shot<'_>, target: &RenderTarget) {
        let fitted = self.fit(shot);
        let seen = shot.view();
        // A frozen fit was made for another camera, whose view depths may still select among its maps.
        let view = View { camera: fitted.camera.unwrap_or(seen.camera), ..seen };
        let is_frozen = view.camera != seen.camera;
        let mut maps_stay = false;
        if shot.wants_rays(self.reads_depths() || self.live.waits) && !is_frozen {
            let judged = self.live.judge(&mut self.evaluator, shot, &view, &fitted.maps, target.size);
            match judged {
                Ok(drawn) => maps_stay = drawn,
                Err(error) => self.problem = Some(format!("{error:#}")),
            }
            if self.live.has_compared {
                self.forget_picture();
            }
        }
        let picture = self.picture_key(shot, &fitted.maps, target);
        if picture.is_some() && picture == self.picture {
            return;
        }
        self.picture = picture;
        match shot.settings.view.mode {
            ViewMode::Outside => self.draw_outside(shot, &fitted, false, target),
            ViewMode::Demand => self.draw_demand(shot, &fitted, target),
            ViewMode::Updates => self.draw_boards(shot, &Plan { view, maps: &fitted.maps, maps_stay }, target),
            mode => {
                self.draw_view(shot, &Plan { view, maps: &fitted.maps, maps_stay }, Overlay::of(mode), target);
            }
        }
        if !is_frozen && !matches!(shot.settings.view.mode, ViewMode::Outside | ViewMode::Demand) {
            self.unread = Some(view.camera);
            self.evaluator.note_view(&view, &fitted.maps);
        }
    }

    /// Returns everything that a whole picture depends on, if pictures are made one by one, so that an equal
    /// picture is not drawn again. Views that show how the maps were found or drawn depend on more, and return `None`.
    fn picture_key(&self, shot: &Shot<'_>, maps: &[FittedMap], target: &RenderTarget) -> Option<PictureKey> {
        let is_known = !matches!(shot.settings.view.mode, ViewMode::Demand | ViewMode::Updates);
        let is_alone = self.live.waits && !self.follows && shot.scissor.is_none();
        (is_alone && is_known).then(|| PictureKey {
            settings: *shot.settings,
            camera: shot.camera,
            sight: shot.sight,
            blink: shot.blink,
            pose: shot.scene.gpu_scene.pose(),
            maps: maps.to_vec(),
            judged: self.live.judged_view(),
            target: target.texture().clone(),
        })
    }

    /// Draws the camera's picture.
    fn draw_view(&mut self, shot: &mut Shot<'_>, plan: &Plan<'_>, overlay: Overlay, target: &RenderTarget) {
        let insets = insets_of(shot, plan.maps, target.size);
        let judged = self.live.picture();
        let atmosphere = atmosphere(shot.sight);
        let frame = Frame {
            overlay,
            judged,
            marks: marks_of(shot).filter(|_| judged.is_some()),
            insets: &insets,
            shadows: shot.settings.view.shadows,
            maps_stay: plan.maps_stay,
            scissor: shot.scissor,
            ..plan.view.frame(plan.maps, &atmosphere)
        };
        // Maps that are viewed by another camera hold all their casters, not only those of this picture's
        // shadows.
        let frame = if plan.view.camera == shot.camera {
            frame
        } else {
            Frame { culling: Culling::WholeMap, ..frame.seen_through(shot.camera) }
        };
        let drawn = self.evaluator.draw(shot.gpu, shot.scene, &frame, target);
        self.take_statistics(drawn);
    }

    fn take_statistics(&mut self, drawn: Result<Statistics, ShadowMapError>) {
        match drawn {
            Ok(statistics) => self.statistics = statistics,
            Err(error) => (self.problem, self.picture) = (Some(error.to_string()), None),
        }
    }

    /// Draws the camera, its maps and their casters from outside. `maps_stay` means that the maps were just
    /// drawn for the camera itself.
    pub(in crate::stage) fn draw_outside(
        &mut self,
        shot: &mut Shot<'_>,
        fitted: &Fitted,
        maps_stay: bool,
        target: &RenderTarget,
    ) {
        let seen = shot.camera;
        let aspect = target.size[0] as f32 / target.size[1] as f32;
        let camera = PerspectiveCamera { aspect, ..outside::camera(&Camera { aspect, ..seen }, fitted) };
        let descriptor = *self.evaluator.renderer.shadow_map().descriptor();
        let lines = outside::lines(fitted, &fitted.maps, &descriptor);
        let view = View { camera: fitted.camera.unwrap_or(seen), ..shot.view() };
        let atmosphere = atmosphere(camera.far.max(shot.sight));
        let frame = Frame {
            culling: Culling::WholeMap,
            overlay: Overlay::Casters,
            maps_stay,
            lines: &lines,
            shadows: shot.settings.view.shadows,
            scissor: shot.scissor,
            ..view.frame(&fitted.maps, &atmosphere).seen_through(camera)
        };
        let drawn = self.evaluator.draw(shot.gpu, shot.scene, &frame, target);
        self.take_statistics(drawn);
    }

    /// Draws the scene from the light's direction, with the demand grid and the outlines of the maps.
    fn draw_demand(&mut self, shot: &mut Shot<'_>, fitted: &Fitted, target: &RenderTarget) {
        let shown = shot.settings.view.inset_index(fitted.maps.len() as u32);
        let Some(from_light) = demand_view::FromLight::new(fitted, shown, shot.scene.bounds(), target.size) else {
            let plan = Plan { view: shot.view(), maps: &fitted.maps, maps_stay: false };
            return self.draw_view(shot, &plan, Overlay::None, target);
        };
        let demand = self.sun().fitter().visible_demand().map(VisibleDemand::demand);
        let quads = demand_view::quads(&from_light, fitted, demand);
        let lines = demand_view::lines(fitted);
        let view = View { camera: fitted.camera.unwrap_or(shot.camera), ..shot.view() };
        // No haze between the light and the scene.
        let atmosphere = atmosphere(f32::MAX);
        let frame = Frame {
            culling: Culling::WholeMap,
            quads: &quads,
            lines: &lines,
            shadows: shot.settings.view.shadows,
            scissor: shot.scissor,
            ..view.frame(&fitted.maps, &atmosphere).seen_through(from_light.camera)
        };
        let drawn = self.evaluator.draw(shot.gpu, shot.scene, &frame, target);
        self.take_statistics(drawn);
    }

    /// Draws all maps side by side, with the redrawn parts.
    fn draw_boards(&mut self, shot: &mut Shot<'_>, plan: &Plan<'_>, target: &RenderTarget) {
        let bounds = shot.scene.bounds();
        let boards = boards::Boards::new(plan.maps, &bounds, shot.settings.view.inset_depths, target.size);
        // The updates of the previous frame, unless the maps stay. The updates of this frame are known only
        // after it is drawn.
        let quads = boards.quads(&self.sun().updates());
        let atmosphere = atmosphere(shot.sight);
        let frame = Frame {
            insets: &boards.insets,
            quads: &quads,
            maps_stay: plan.maps_stay,
            scissor: shot.scissor,
            ..plan.view.frame(plan.maps, &atmosphere)
        };
        let drawn = self.evaluator.draw(shot.gpu, shot.scene, &frame, target);
        self.take_statistics(drawn);
    }
}

/// Returns the marks of wrong pixels in the settings.
fn marks_of(shot: &Shot<'_>) -> Option<Marks> {
    let marks = shot.settings.view.marks;
    (marks != ErrorMarks::Off).then(|| Marks {
        outline: marks == ErrorMarks::Outline,
        strength: if marks == ErrorMarks::Blink { shot.blink } else { 1.0 },
        classes: [true; 4],
    })
}

/// Returns the insets in the settings, in a picture of `size` pixels.
fn insets_of(shot: &Shot<'_>, maps: &[FittedMap], size: [u32; 2]) -> Vec<Inset> {
    let settings = &shot.settings.view;
    let shown = match settings.inset {
        InsetMaps::Off => 0..0,
        InsetMaps::One => {
            let index = settings.inset_index(maps.len() as u32);
            index..(index + 1).min(maps.len())
        }
        InsetMaps::All => 0..maps.len(),
    };
    let left = shot.scissor.map_or(0, |[x, ..]| x);
    inset::insets(shown, maps, &shot.scene.bounds(), settings.inset_depths, left, size)
}
