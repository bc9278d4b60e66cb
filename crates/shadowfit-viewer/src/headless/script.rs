//! Scripts played without a window.

use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::Result;
use shadowfit_render::{Gpu, own_time};

use super::timings::Timings;
use super::{FORMAT, FRAME, SAMPLES, input};
use crate::arguments::Arguments;
use crate::interface::Canvas;
use crate::platform::output;
use crate::stage::Stage;
use crate::viewer::{Renewals, Start, Viewer};

/// Plays the script in the arguments. Its files go into the folder.
pub(super) fn play(arguments: &Arguments, folder: &Path) -> Result<()> {
    let mut session = Session::start(arguments, folder)?;
    while !session.viewer.has_played() && !session.viewer.window_requests.quit {
        session.frame()?;
    }
    session.end()
}

/// A viewer that plays a script and draws into a canvas.
struct Session<'a> {
    arguments: &'a Arguments,
    viewer: Viewer,
    canvas: Canvas,
    /// Size of the canvas, in pixels.
    size: [u32; 2],
    /// Time of the script, in seconds.
    clock: f64,
    renewals: Renewals,
    timings: Timings,
}

impl<'a> Session<'a> {
    fn start(arguments: &'a Arguments, folder: &Path) -> Result<Self> {
        let mut timings = Timings::start();
        let start = Start::new(arguments)?.saving_into(folder);
        let gpu = pollster::block_on(Gpu::headless(&arguments.adapter()))?;
        timings.step("graphics device");
        gpu.keep_faults();
        let mut stage = Stage::empty(gpu, SAMPLES)?;
        stage.read_depths();
        stage.wait_for_rays();
        timings.step("renderer");
        let viewer = Viewer::new(stage, FORMAT, start, None);
        let size = arguments.size();
        let canvas = Canvas::new(&viewer.stage.gpu().device, size, FORMAT);
        timings.step("interface");
        Ok(Self { arguments, viewer, canvas, size, clock: 0.0, renewals: Renewals::default(), timings })
    }

    /// Draws a frame, and yields to background work that the script may be waiting for.
    fn frame(&mut self) -> Result<()> {
        let begin = Instant::now();
        let gpu = self.viewer.stage.gpu().clone();
        let (_, own) = own_time(|| {
            gpu.unless_lost(|| {
                let (layout, _) = self.viewer.frame(input(self.size, self.clock), FRAME);
                self.viewer.paint(&layout, &self.canvas.view, self.size);
            })
        });
        self.clock += f64::from(FRAME);
        if let Some(why) = gpu.lost() {
            self.renew(&why)?;
        }
        self.viewer.tell_faults();
        if let Some(wanted) = self.viewer.window_requests.resize.take() {
            self.size = wanted;
            self.canvas = Canvas::new(&self.viewer.stage.gpu().device, wanted, FORMAT);
        }
        if self.viewer.is_waiting() {
            // A software driver draws on the cores that the awaited thread needs.
            let share = if self.viewer.stage.gpu().is_software() { 3 * begin.elapsed() } else { Duration::ZERO };
            std::thread::sleep(share.max(Duration::from_millis(5)));
        }
        self.timings.frame(self.viewer.player.place().as_deref().unwrap_or("random actions"), own);
        Ok(())
    }

    /// Opens a new device after a lost one.
    fn renew(&mut self, why: &str) -> Result<()> {
        self.renewals.next(why)?;
        let gpu = pollster::block_on(Gpu::headless(&self.arguments.adapter()))?;
        gpu.keep_faults();
        self.canvas = Canvas::new(&gpu.device, self.size, FORMAT);
        self.viewer.move_to(gpu, FORMAT, why)
    }

    fn end(self) -> Result<()> {
        let Self { arguments, mut viewer, canvas, mut timings, .. } = self;
        let ended = viewer.outcome();
        drop((viewer, canvas));
        timings.step("end");
        if arguments.timings {
            output::tell(timings.table().trim_end());
        }
        ended
    }
}
