//! The results of the figures, frame by frame, and the files that show them.

use anyhow::{Context, Result};
use image::RgbaImage;
use shadowfit_render::Gpu;
use shadowfit_report::page::{Output, PictureName, heat, overlay};
use shadowfit_report::peers::Frame;
use shadowfit_report::run::{Columns, FrameInfo, FramePictures, Run, TechniqueRun};
use shadowfit_truth::{Judged, PictureTally};

use super::contestants::{Contestant, Shown};
use super::scenes::FRAMES;
use crate::scene::{columns, pool};

/// All results.
pub(super) struct Measured {
    /// Graphics adapter that drew.
    pub(super) adapter: String,
    /// Size of the pictures, in pixels.
    pub(super) size: [u32; 2],
    /// Frames of a path to each judged one.
    pub(super) step: u32,
    /// Triangles of all scenes.
    pub(super) triangles: u64,
    /// Remarks, in whole sentences.
    pub(super) notes: Vec<String>,
    /// Whether all frames were measured.
    pub(super) is_finished: bool,
    pub(super) frames: Vec<JudgedFrame>,
    pub(super) rows: Vec<Row>,
}

/// A judged frame.
pub(super) struct JudgedFrame {
    pub(super) scene: String,
    /// Name of its group, such as `town/40`.
    pub(super) group: String,
    pub(super) id: String,
}

/// The results of a contestant, a tally for each frame.
pub(super) struct Row {
    pub(super) name: String,
    pub(super) shown: Shown,
    what: String,
    settings: String,
    pub(super) tallies: Vec<PictureTally>,
    pictures: Vec<FramePictures>,
}

impl Measured {
    pub(super) fn new(gpu: &Gpu, size: [u32; 2], step: u32, contestants: &[Contestant]) -> Self {
        let row = |contestant: &Contestant| Row {
            name: contestant.name.clone(),
            shown: contestant.shown,
            what: contestant.what.clone(),
            settings: contestant.settings.clone(),
            tallies: Vec::new(),
            pictures: Vec::new(),
        };
        Self {
            adapter: gpu.name(),
            size,
            step,
            triangles: 0,
            notes: Vec::new(),
            is_finished: false,
            frames: Vec::new(),
            rows: contestants.iter().map(row).collect(),
        }
    }

    pub(super) fn begin_frame(&mut self, scene: &str, frame: &Frame) {
        let group = format!("{scene}/{}", frame.elevation_deg);
        self.frames.push(JudgedFrame { scene: scene.to_owned(), group, id: frame.id.clone() });
    }

    pub(super) fn add(&mut self, place: usize, tally: PictureTally) {
        self.rows[place].tallies.push(tally);
    }

    /// Writes the pictures of a contestant for the frame that was begun last.
    pub(super) fn add_pictures(
        &mut self,
        place: usize,
        pixels: Vec<u8>,
        judged: &Judged,
        output: &Output,
    ) -> Result<()> {
        let [width, height] = self.size;
        let picture = RgbaImage::from_raw(width, height, pixels).context("a picture of another size")?;
        let frame = self.frames.len() - 1;
        let row = &mut self.rows[place];
        let name = PictureName { place, technique: &row.name, frame: &self.frames[frame].id, kind: "picture" };
        let write = |kind, picture: &RgbaImage| output.write_picture(&PictureName { kind, ..name }, picture);
        let pictures = FramePictures {
            frame,
            overlay: write("overlay", &overlay(&picture, &judged.classes)?)?,
            heat: write("heat", &heat(self.size, &judged.pixels_per_texel)?)?,
            picture: write("picture", &picture)?,
        };
        row.pictures.push(pictures);
        Ok(())
    }

    /// Leaves out the last frame if it was interrupted before all contestants had it.
    pub(super) fn drop_unfinished(&mut self) {
        let whole = self.rows.iter().map(|row| row.tallies.len()).min().unwrap_or(0);
        self.frames.truncate(whole);
        self.rows.iter_mut().for_each(|row| row.tallies.truncate(whole));
    }

    /// Returns the data of the page.
    pub(super) fn run(&self) -> Run {
        let of_row = |row: &Row| TechniqueRun {
            name: row.name.clone(),
            what: row.what.clone(),
            settings: row.settings.clone(),
            overall: columns(&row.tallies),
            groups: self.groups().map(|group| (group.to_owned(), self.group_columns(row, group))).collect(),
            frames: row.tallies.iter().map(|tally| columns([tally])).collect(),
            pictures: row.pictures.clone(),
        };
        Run {
            title: "Shadow figures".to_owned(),
            scene: self.scenes().collect::<Vec<_>>().join(", "),
            triangles: self.triangles,
            size: self.size,
            adapter: self.adapter.clone(),
            light: None,
            notes: self.notes.iter().cloned().chain([self.frames_note()]).collect(),
            scene_notes: Vec::new(),
            frames: self.frames.iter().map(|f| FrameInfo { name: f.id.clone(), group: f.group.clone() }).collect(),
            techniques: self.rows.iter().map(of_row).collect(),
            finished: self.is_finished,
        }
    }

    /// Returns a sentence about the frames.
    pub(super) fn frames_note(&self) -> String {
        let judged = FRAMES / self.step;
        format!("{judged} of the {FRAMES} frames of each path were judged; all were fitted, in order.")
    }

    /// Returns the names of the scenes, in order.
    fn scenes(&self) -> impl Iterator<Item = &str> {
        self.frames.chunk_by(|a, b| a.scene == b.scene).map(|frames| frames[0].scene.as_str())
    }

    /// Returns the names of the groups, in order.
    pub(super) fn groups(&self) -> impl Iterator<Item = &str> {
        self.frames.chunk_by(|a, b| a.group == b.group).map(|frames| frames[0].group.as_str())
    }

    /// Returns the sums of a row over the frames that `is_wanted`.
    pub(super) fn sum(&self, row: &Row, is_wanted: impl Fn(&JudgedFrame) -> bool) -> PictureTally {
        let own = self.frames.iter().zip(&row.tallies).filter(|(frame, _)| is_wanted(frame));
        pool(own.map(|(_, tally)| tally))
    }

    fn group_columns(&self, row: &Row, group: &str) -> Columns {
        columns([&self.sum(row, |frame| frame.group == group)])
    }
}
