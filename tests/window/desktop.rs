//! An X server for the test, and the viewer as a program on it. Both end when their values are dropped, so
//! that a failed assertion leaves no process behind. The screenshots stay under `target/window-test`.

use std::cell::Cell;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStderr, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::thread::{JoinHandle, sleep};
use std::time::{Duration, Instant};

use super::shot::Shot;
use crate::support::{target_folder, viewer_program};

/// Width, height and depth of the screen.
pub(super) const SCREEN: &str = "1280x800x24";

/// Pause between two polls: a frame of a slow software driver.
const PAUSE: Duration = Duration::from_millis(50);

/// Returns the programs that the test needs and the machine lacks.
pub(super) fn missing_tools() -> Vec<&'static str> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let is_there = |tool: &str| std::env::split_paths(&path).any(|folder| folder.join(tool).is_file());
    ["Xvfb", "xdotool", "import"].into_iter().filter(|tool| !is_there(tool)).collect()
}

/// A child process that is killed when dropped.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended by itself, which is not an error here.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// An X server with an empty black screen.
pub(super) struct Desktop {
    _server: Running,
    display: String,
    shots: PathBuf,
    count: Cell<u32>,
}

impl Desktop {
    /// Starts the server on a free display number, and empties the folder of screenshots of the test `name`.
    pub(super) fn start(name: &str) -> Self {
        let shots = target_folder().join("window-test").join(name);
        let _ = std::fs::remove_dir_all(&shots);
        std::fs::create_dir_all(&shots).unwrap_or_else(|error| panic!("{}: {error}", shots.display()));
        let mut command = Command::new("Xvfb");
        // The server picks the number and writes it to its standard output when it is ready. -br is a black
        // screen.
        command.args(["-displayfd", "1", "-screen", "0", SCREEN, "-br", "-nolisten", "tcp", "-noreset"]);
        let mut server = Running(
            command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("Xvfb starts"),
        );
        let mut number = String::new();
        let output = server.0.stdout.take().expect("the output is piped");
        BufReader::new(output).read_line(&mut number).expect("Xvfb says its display number");
        assert!(!number.trim().is_empty(), "Xvfb ended at once; run `Xvfb :99` to see why");
        Self { _server: server, display: format!(":{}", number.trim()), shots, count: Cell::new(0) }
    }

    /// Returns the path of a file in the test's folder.
    pub(super) fn file(&self, name: &str) -> PathBuf {
        self.shots.join(name)
    }

    /// Takes a screenshot and saves it under a numbered name that contains `name`.
    pub(super) fn shoot(&self, name: &str) -> Shot {
        self.capture(&self.next_file(name))
    }

    /// Takes screenshots until `accept` returns true. Returns the accepted one, or `None` after `limit`.
    pub(super) fn wait_for(&self, limit: Duration, mut accept: impl FnMut(&Shot) -> bool) -> Option<Shot> {
        let latest = self.shots.join("latest.png");
        until(limit, || Some(self.capture(&latest)).filter(|shot| accept(shot)))
    }

    /// Saves `shot`, or a new screenshot for `None`, under a numbered name that contains `name`.
    pub(super) fn keep(&self, shot: Option<&Shot>, name: &str) -> Shot {
        shot.map_or_else(|| self.shoot(name), |shot| shot.clone().saved_as(self.next_file(name)))
    }

    fn next_file(&self, name: &str) -> PathBuf {
        self.count.set(self.count.get() + 1);
        self.shots.join(format!("{:02}-{name}.png", self.count.get()))
    }

    fn capture(&self, file: &Path) -> Shot {
        let mut command = Command::new("import");
        command.args(["-display", &self.display, "-window", "root"]).arg(file);
        let output = command.output().expect("import starts");
        assert!(output.status.success(), "import failed: {}", String::from_utf8_lossy(&output.stderr));
        Shot::read(file)
    }
}

/// The viewer on a [`Desktop`], with its own empty settings folder.
pub(super) struct Viewer {
    program: Running,
    display: String,
    log: Arc<Mutex<Vec<String>>>,
    reader: Option<JoinHandle<()>>,
    window: String,
}

impl Viewer {
    pub(super) fn start(desktop: &Desktop, arguments: &[&str]) -> Self {
        let home = desktop.shots.join("home");
        std::fs::create_dir_all(&home).unwrap_or_else(|error| panic!("{}: {error}", home.display()));
        let mut command = Command::new(viewer_program());
        command.args(arguments).current_dir(&home).env("DISPLAY", &desktop.display).env_remove("WAYLAND_DISPLAY");
        for variable in ["XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_STATE_HOME"] {
            command.env(variable, &home);
        }
        // Xvfb's screen size in millimetres is arbitrary, so the scale must not be derived from it.
        command.env("WINIT_X11_SCALE_FACTOR", "1");
        // Without it the graphics driver writes warnings to the log.
        command.env("XDG_RUNTIME_DIR", &home);
        // Make the C library return freed memory. By default it keeps hundreds of megabytes for later
        // allocations of its threads, which looks like a leak.
        for (variable, value) in [("MALLOC_ARENA_MAX", "2"), ("MALLOC_MMAP_THRESHOLD_", "131072")] {
            command.env(variable, value);
        }
        let mut program =
            Running(command.stdin(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the viewer starts"));
        let (log, reader) = collect_lines(program.0.stderr.take().expect("the errors are piped"));
        Self { program, display: desktop.display.clone(), log, reader: Some(reader), window: String::new() }
    }

    /// Waits for a line that contains `word` on the viewer's standard error.
    pub(super) fn wait_for_line(&mut self, word: &str, limit: Duration) {
        let found = until(limit, || {
            let said = self.log.lock().expect("the log's thread does not panic").iter().any(|line| line.contains(word));
            (said || !self.is_running()).then_some(said)
        });
        assert_eq!(found, Some(true), "the viewer never says \"{word}\"; what it says:\n{}", self.log());
    }

    /// Finds the window, moves it to the screen's corner and gives it the keyboard focus.
    pub(super) fn focus(&mut self) {
        let pid = self.program.0.id().to_string();
        let search = || {
            let mut command = self.xdotool(&["search", "--onlyvisible", "--pid", &pid]);
            let output = command.output().expect("xdotool starts");
            String::from_utf8_lossy(&output.stdout).lines().last().map(str::to_owned)
        };
        let window = until(Duration::from_secs(20), search);
        self.window = window.unwrap_or_else(|| panic!("the viewer opens no window\n{}", self.log()));
        self.do_with_window("windowmove", &["0", "0"]);
        self.do_with_window("windowfocus", &[]);
    }

    /// Presses and releases a key, given by its X11 name.
    pub(super) fn press(&self, key: &str) {
        self.run(&["key", key]);
    }

    /// Presses a key and keeps it down.
    pub(super) fn hold(&self, key: &str) {
        self.run(&["keydown", key]);
    }

    /// Releases a key that is held.
    pub(super) fn release(&self, key: &str) {
        self.run(&["keyup", key]);
    }

    /// Sets the size of the window's content, in pixels.
    pub(super) fn resize(&self, (width, height): (u32, u32)) {
        self.do_with_window("windowsize", &[&width.to_string(), &height.to_string()]);
    }

    /// Unmaps the window.
    pub(super) fn hide(&self) {
        self.do_with_window("windowunmap", &[]);
    }

    /// Maps the window and gives it the keyboard focus again, which unmapping removes.
    pub(super) fn show(&self) {
        self.do_with_window("windowmap", &[]);
        self.do_with_window("windowfocus", &[]);
    }

    pub(super) fn is_running(&mut self) -> bool {
        matches!(self.program.0.try_wait(), Ok(None))
    }

    /// Returns the exit code, or `None` if the viewer does not end within `limit` or a signal ends it.
    pub(super) fn exit_code(&mut self, limit: Duration) -> Option<i32> {
        let status = until(limit, || self.program.0.try_wait().expect("the viewer can be waited for"))?;
        // After this, all of its output has been read.
        if let Some(reader) = self.reader.take() {
            reader.join().expect("the log's thread does not panic");
        }
        status.code()
    }

    /// Returns the viewer's standard error so far.
    pub(super) fn log(&self) -> String {
        self.log.lock().expect("the log's thread does not panic").join("\n")
    }

    fn do_with_window(&self, action: &str, arguments: &[&str]) {
        let mut all = vec![action, &self.window];
        all.extend_from_slice(arguments);
        self.run(&all);
    }

    fn run(&self, arguments: &[&str]) {
        let output = self.xdotool(arguments).output().expect("xdotool starts");
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "xdotool {} failed: {errors}\n{}", arguments.join(" "), self.log());
    }

    fn xdotool(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new("xdotool");
        command.args(arguments).env("DISPLAY", &self.display);
        command
    }
}

/// Calls `look` until it returns a value or `limit` has passed.
fn until<T>(limit: Duration, mut look: impl FnMut() -> Option<T>) -> Option<T> {
    let end = Instant::now() + limit;
    loop {
        let answer = look();
        if answer.is_some() || Instant::now() > end {
            return answer;
        }
        sleep(PAUSE);
    }
}

/// Reads lines on a separate thread, so that the writer never waits for a full pipe.
fn collect_lines(source: ChildStderr) -> (Arc<Mutex<Vec<String>>>, JoinHandle<()>) {
    let lines = Arc::new(Mutex::new(Vec::new()));
    let sink = Arc::clone(&lines);
    let reader = std::thread::spawn(move || {
        for line in BufReader::new(source).lines().map_while(Result::ok) {
            sink.lock().expect("no other thread panics with the log in hand").push(line);
        }
    });
    (lines, reader)
}
