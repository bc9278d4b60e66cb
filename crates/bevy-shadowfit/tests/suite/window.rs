//! The example `minimal` in a real window.

use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A child process that ends with the test.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        self.0.kill().ok();
        self.0.wait().ok();
    }
}

/// Starts a separate display, and returns its number.
fn display() -> (Running, String) {
    let mut server = Command::new("Xvfb");
    server.args(["-screen", "0", "1280x720x24", "-nolisten", "tcp", "-displayfd", "1"]);
    let mut server = server.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("Xvfb starts");
    let mut number = String::new();
    let output = server.stdout.take().expect("it is piped");
    let server = Running(server);
    BufReader::new(output).read_line(&mut number).expect("Xvfb prints its display");
    (server, format!(":{}", number.trim()))
}

/// Returns the path of an example, which is built with the tests.
fn example(name: &str) -> PathBuf {
    let test = std::env::current_exe().expect("a path");
    test.parent().and_then(|deps| deps.parent()).expect("a folder").join("examples").join(name)
}

/// Returns the pixels of the display.
fn picture(display: &str) -> Vec<[u8; 3]> {
    let import =
        Command::new("import").args(["-window", "root", "-depth", "8", "rgb:-"]).env("DISPLAY", display).output();
    import.expect("import starts").stdout.as_chunks::<3>().0.to_vec()
}

#[test]
fn a_real_window_shows_shadows_on_the_ground() {
    let (_server, display) = display();
    let mut minimal = Command::new(example("minimal"));
    let minimal = minimal.env("DISPLAY", &display).env_remove("WAYLAND_DISPLAY").stderr(Stdio::null());
    let mut minimal = Running(minimal.spawn().expect("cargo test built the example"));
    let is_grey = |pixel: &&[u8; 3]| pixel[0].abs_diff(pixel[2]) < 6;
    let began = Instant::now();
    loop {
        assert!(minimal.0.try_wait().expect("a state").is_none(), "the example ended");
        let pixels = picture(&display);
        // The lower part of the image shows ground and red posts on it.
        let ground: Vec<_> = pixels[pixels.len() / 2..].iter().filter(is_grey).collect();
        let lit = ground.iter().filter(|pixel| pixel[0] > 150).count();
        let dark = ground.iter().filter(|pixel| pixel[0] < 60).count();
        // Shadows of posts, and more light than shadow.
        if lit > 150_000 && dark > 2_000 && dark < lit / 10 {
            return;
        }
        assert!(began.elapsed() < Duration::from_secs(180), "{lit} lit pixels of the ground and {dark} dark ones");
        std::thread::sleep(Duration::from_millis(500));
    }
}
