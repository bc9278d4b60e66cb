//! The explanation of the pixel under the pointer: requested when the pointer rests, computed by a thread,
//! and shown until the pointer moves.

use std::sync::mpsc::{Receiver, TryRecvError, channel};

use glam::DVec3;
use shadowfit_egui::{PixelClass, WhyCard};
use shadowfit_render::{PixelQuery, PixelRead, TexelBlock};
use shadowfit_study::{Judging, StoredTexels, View, Why, WhyInput, in_background, why};
use shadowfit_truth::{Class, PixelCamera};

use super::Stage;
use super::live::Key;

/// Least rest time of the pointer, in seconds.
const REST: f32 = 0.25;
/// Greatest movement of a resting pointer, as a share of the picture.
const SLACK: f32 = 0.001;

/// Progress of an answer.
#[derive(Debug)]
enum Step {
    /// A thread finds the texel that is read.
    Finding(WhyInput, Receiver<Option<Why>>),
    /// The GPU reads the pixel, and the texels around that texel.
    Reading(WhyInput, PixelRead, [u32; 2]),
    /// A thread finds the reason.
    Answering(Receiver<Option<Why>>),
    Done,
}

/// The pixel under the resting pointer, and the progress of its answer.
#[derive(Debug, Default)]
pub(super) struct PixelQuestion {
    /// Position of the pointer, content of the picture, and the time since which both have not changed, by
    /// the stage's clock in seconds.
    at: Option<([f32; 2], Key, f32)>,
    step: Option<Step>,
    why: Option<Why>,
}

impl Stage {
    /// Requests the explanation of the pixel under the resting pointer while the picture does not change.
    /// `hover` is in shares of its width and height from the top left. Call it once a frame.
    pub fn ask_why(&mut self, hover: Option<[f32; 2]>, size: [u32; 2]) {
        let asked = hover.and_then(|hover| Some((hover, self.shown_at(hover, size)?)));
        let same = |old: [f32; 2], new: [f32; 2]| (0..2).all(|axis| (old[axis] - new[axis]).abs() <= SLACK);
        let at = match (asked, &self.why.at) {
            (Some((at, shown)), Some((old, before, since))) if same(*old, at) && *before == shown => {
                (self.clock - since >= REST).then_some(at)
            }
            (asked, _) => {
                self.why =
                    PixelQuestion { at: asked.map(|(at, shown)| (at, shown, self.clock)), ..PixelQuestion::default() };
                None
            }
        };
        let Some(at) = at else { return };
        let step = self.why.step.take();
        self.why.step = match step {
            None => self.question(at, size).map(|question| {
                let answer = think(question.clone());
                Step::Finding(question, answer)
            }),
            Some(step) => Some(self.go_on(step)),
        };
    }

    /// Returns the answer, once it has arrived.
    pub fn why(&self) -> Option<WhyCard<'_>> {
        let why = self.why.why.as_ref()?;
        Some(WhyCard {
            class: class(why.class),
            reason: &why.reason,
            map_reason: &why.map_reason,
            position: Some(why.position.to_array()),
            map: why.map.map(|map| map as u32),
            texel: why.texel.map(|texel| texel.map(|at| at.max(0.0) as u32)),
            stored_depth: why.stored,
            compared_depth: why.compared,
            pixels_per_texel: why.pixels_per_texel,
        })
    }

    /// Returns the content of the picture at a point, in views of the camera.
    fn shown_at(&self, at: [f32; 2], size: [u32; 2]) -> Option<Key> {
        let in_other = self.is_comparing() && at[0] > self.split;
        let (side, technique) = self.side_at(in_other).filter(|_| self.settings.view.mode.shows_camera())?;
        let View { camera, direction, .. } = self.view(size);
        let maps = side.evaluator.drawn_fits().to_vec();
        let (seconds, ray_offset) = (self.seconds, self.ray_offset());
        Some(Key { camera, technique, direction, seconds, ray_offset, maps })
    }

    fn question(&self, at: [f32; 2], size: [u32; 2]) -> Option<WhyInput> {
        let in_other = self.is_comparing() && at[0] > self.split;
        let (side, technique) = self.side_at(in_other)?;
        let fitted = side.fitted.as_ref()?;
        Some(WhyInput {
            scene: self.scene.shared_scene(),
            rays: self.scene.ready_rays()?,
            view: self.view(size),
            judging: Judging { size, ray_offset: self.ray_offset(), ..Judging::default() },
            pixel: [at[0] * size[0] as f32, at[1] * size[1] as f32],
            technique,
            maps: side.evaluator.drawn_fits().to_vec(),
            descriptor: *side.evaluator.renderer.shadow_map().descriptor(),
            factor: None,
            stored: None,
        })
        .filter(|_| fitted.camera.is_some())
    }

    fn go_on(&mut self, step: Step) -> Step {
        match step {
            Step::Finding(question, answer) => match answer.try_recv() {
                Ok(found) => {
                    let texel = found.as_ref().and_then(|why| Some((why.map?, why.texel?)));
                    self.why.why = found;
                    self.read_pixel(question, texel)
                }
                Err(TryRecvError::Empty) => Step::Finding(question, answer),
                Err(TryRecvError::Disconnected) => Step::Done,
            },
            Step::Reading(mut question, mut read, texel) => match read.take(&self.gpu) {
                None => Step::Reading(question, read, texel),
                Some(Ok(facts)) => {
                    question.factor = facts.seen.map(|pixel| pixel.factor);
                    question.stored = stored(&facts.depths, texel);
                    Step::Answering(think(question))
                }
                // The device is lost, which is reported when pictures are presented.
                Some(Err(_)) => Step::Done,
            },
            Step::Answering(answer) => match answer.try_recv() {
                Ok(found) => {
                    self.why.why = found;
                    Step::Done
                }
                Err(TryRecvError::Empty) => Step::Answering(answer),
                Err(TryRecvError::Disconnected) => Step::Done,
            },
            Step::Done => Step::Done,
        }
    }

    /// Makes the GPU read the pixel, and the map around the texel that it reads.
    fn read_pixel(&mut self, question: WhyInput, texel: Option<(usize, [f32; 2])>) -> Step {
        let Some((map, texel)) = texel else { return Step::Done };
        let texel = texel.map(|at| at.max(0.0) as u32);
        let size = question.judging.size;
        let in_other = self.is_comparing() && question.pixel[0] > self.split * size[0] as f32;
        let block = TexelBlock { map, texel: texel.map(u32::cast_signed), radius: 1 };
        let query = PixelQuery { size, pixel: question.pixel.map(|at| at as u32), texels: Some(block) };
        let read =
            self.with_side(in_other, |side, gpu, scene| side.evaluator.read_pixel(gpu, scene, &question.view, &query));
        match read {
            Some(Ok(read)) => Step::Reading(question, read, texel),
            _ => Step::Done,
        }
    }

    /// Returns the world position of the surface at a point of the picture, in metres.
    pub fn pick(&self, at: [f32; 2], size: [u32; 2]) -> Option<DVec3> {
        let rays = self.scene.ready_rays()?;
        let camera = self.scene.camera_for_rays(self.camera_of(size));
        let pixel = [0, 1].map(|axis| (at[axis] * size[axis] as f32) as u32);
        let ray = PixelCamera::new(camera, size).ray(pixel[0], pixel[1]);
        let hit = rays.tracer.first_hit(ray.origin.as_vec3(), ray.direction.as_vec3())?;
        Some(rays.origin + ray.at(f64::from(hit.distance)))
    }
}

/// Returns the nine depths around a texel.
fn stored(depths: &[f32], texel: [u32; 2]) -> Option<StoredTexels> {
    let depths: [f32; 9] = depths.try_into().ok()?;
    let row = |row: usize| [depths[row * 3], depths[row * 3 + 1], depths[row * 3 + 2]];
    Some(StoredTexels { texel, depths: [row(0), row(1), row(2)] })
}

/// Computes the answer on a thread.
fn think(question: WhyInput) -> Receiver<Option<Why>> {
    let (sender, answer) = channel();
    let work = move || {
        // The receiver is gone once the pointer has moved.
        let _ = sender.send(why(&question));
    };
    // Without a thread the channel is closed, and there is no answer.
    let _ = in_background("why", work);
    answer
}

fn class(class: Class) -> Option<PixelClass> {
    match class {
        Class::NotJudged => None,
        Class::Right => Some(PixelClass::Right),
        Class::FalseShadow => Some(PixelClass::FalseShadow),
        Class::FalseLight => Some(PixelClass::FalseLight),
        Class::Hole => Some(PixelClass::Hole),
        Class::Edge => Some(PixelClass::Edge),
    }
}
