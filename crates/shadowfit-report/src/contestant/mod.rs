//! Judges the sun shadows of any renderer against rays: of a game engine, of a web page, or of matrices
//! alone.
//!
//! A renderer implements [`Contestant`]. [`Judging`] draws the paths of a scenario file ([`crate::peers`])
//! with each technique of the renderer and compares every pixel with a ray toward the light. It also draws
//! each frame with the maps of the previous frame, to measure how much the shadow edges crawl:
//!
//! ```no_run
//! use shadowfit_report::contestant::{Contestant, JudgeSettings, Judging};
//! use shadowfit_report::geometry::Source;
//! use shadowfit_report::peers::Scenarios;
//!
//! # fn judge(mut renderer: impl Contestant, source: &Source) -> anyhow::Result<()> {
//! let scenarios = Scenarios::read("peers/scenarios.json".as_ref())?;
//! let mut judging = Judging::new(&renderer, JudgeSettings::default());
//! for (index, scene) in scenarios.scenes.iter().enumerate() {
//!     let frames: Vec<_> = scenarios.frames.iter().filter(|frame| frame.scene == index).collect();
//!     judging.judge_scene(&mut renderer, &scene.name, &source.read(scene)?, &frames, |_| Ok(()))?;
//! }
//! println!("{}", judging.results().to_markdown(Some(0)));
//! # Ok(())
//! # }
//! ```
//!
//! [`Results::to_run`] returns the [`Run`](crate::run::Run) for tables, plots and the page.

mod lookup;
mod measure;
mod results;
mod sums;
mod surfaces;

use anyhow::Result;
use glam::DVec3;
use shadowfit_truth::{MapReading, MeasuredMap, PictureMaps};

pub use lookup::{LookupBlend, LookupFilter, LookupMap, ShadowLookup, SlopeBias};
pub use measure::{JudgeSettings, JudgeTimes, JudgedPicture, Judging};
pub use results::{FrameResult, Results, RunFacts};
pub use sums::Sums;
pub use surfaces::LitSurface;

use crate::geometry::Corners;
use crate::peers::Frame;

/// A renderer whose sun shadows are judged, with one or more techniques.
///
/// The scene is plain: every triangle is white, fully rough and opaque, and casts and receives shadows on both sides. The
/// light is a sun without a radius, and nothing else lights the scene. Pictures have one number for each pixel, in rows
/// from the top, before any tone mapping.
pub trait Contestant {
    /// The maps of a frame, in the renderer's own form.
    type Maps;

    /// Returns the names of the techniques. Each gets a row in the tables.
    fn techniques(&self) -> Vec<String>;

    /// Replaces the scene. `objects` has the triangles of each object.
    ///
    /// # Errors
    ///
    /// If the renderer cannot take the scene.
    fn set_scene(&mut self, objects: &[Vec<Corners>]) -> Result<()>;

    /// Begins a path with one of the techniques: takes the light of its first frame, and forgets all earlier frames.
    ///
    /// # Errors
    ///
    /// If the renderer cannot take the light.
    fn begin_path(&mut self, technique: usize, first: &Frame) -> Result<()>;

    /// Fits maps to the next frame of the path and draws it.
    ///
    /// # Errors
    ///
    /// If the frame cannot be drawn.
    fn draw(&mut self, frame: &Frame) -> Result<Drawn<Self::Maps>>;

    /// Draws a frame again without fitting maps. Returns `None` if the renderer cannot do this. Its pictures
    /// must then be light factors, and crawl is not measured.
    ///
    /// # Errors
    ///
    /// If the frame cannot be drawn.
    fn redraw(&mut self, _redraw: &Redraw<'_, Self::Maps>) -> Result<Option<Vec<f32>>> {
        Ok(None)
    }

    /// Describes the maps of a frame. `to_light` is the unit direction toward the light, world axes.
    fn light_maps(&self, maps: &Self::Maps, to_light: DVec3) -> LightMaps;

    /// Returns the brightness of a surface without shadows, in any unit. A pixel with another brightness
    /// shows another surface than its ray hits, so it is left out. The default is Lambert's law.
    fn brightness(&self, surface: &LitSurface) -> f64 {
        surface.normal.dot(surface.to_light).max(0.0)
    }
}

/// A drawn frame.
#[derive(Clone, Debug)]
pub struct Drawn<Maps> {
    /// Shadows of the frame.
    pub shadows: Shadows,
    /// Maps of the frame.
    pub maps: Maps,
}

/// Shadows of a frame, in one of the forms that renderers can give.
#[derive(Clone, Debug)]
pub enum Shadows {
    /// Brightness of each pixel. It is divided by the brightness without shadows, which comes from
    /// [`Contestant::redraw`].
    Brightness(Vec<f32>),
    /// Share of the light that reaches each pixel, 0..=1.
    Factors(Vec<f32>),
    /// Only matrices and the rules of a look-up. Rays find the depths that the maps would hold.
    Lookup(ShadowLookup),
}

/// A frame that is drawn again.
#[derive(Clone, Copy, Debug)]
pub struct Redraw<'a, Maps> {
    /// Camera and light.
    pub frame: &'a Frame,
    /// Maps to use instead of new ones. `None` draws without shadows.
    pub maps: Option<&'a Maps>,
    /// Frame whose view depths select the maps, if it is another frame.
    pub view_depths_of: Option<&'a Frame>,
}

/// The maps of a frame, as input to the measures.
#[derive(Clone, Debug)]
pub struct LightMaps {
    /// Maps. If they are selected by view depth, they are in the order of their splits.
    pub maps: Vec<MeasuredMap>,
    /// Rule for selecting the map of a point.
    pub reading: MapReading,
    /// Radius of the filter: greatest distance per axis, in texels, from the sample point to the centre of a texel of
    /// non-zero weight.
    pub filter_radius: f32,
    /// Whether the maps also hold casters before their near plane.
    pub depth_clamp: bool,
    /// Whether a point outside the map of its view depth reads a later map. If not, it is lit.
    pub reads_later_maps: bool,
}

impl LightMaps {
    /// Returns the maps in the form for judging a picture.
    pub fn picture_maps(&self) -> PictureMaps<'_> {
        PictureMaps {
            maps: &self.maps,
            reading: self.reading,
            filter_radius: self.filter_radius,
            depth_clamp: self.depth_clamp,
        }
    }

    /// Returns whether one of the maps that a point may read contains it.
    fn holds(&self, position: DVec3, view_depth: f64) -> bool {
        let is_inside = |map: &MeasuredMap| map.is_inside(&map.project(position));
        if matches!(self.reading, MapReading::Coverage { .. }) {
            return self.maps.iter().any(is_inside);
        }
        let mut read = self.maps.iter().skip_while(|map| view_depth >= map.split_far);
        if self.reads_later_maps { read.any(is_inside) } else { read.next().is_some_and(is_inside) }
    }
}
