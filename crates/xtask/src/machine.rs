//! Detects which tools and drivers this machine has. It looks for the files and programs themselves, not in
//! the package manager, so that it does not matter how they were installed.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::process;

/// Program names of Chromium and related browsers.
pub(crate) const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// The target of browsers.
pub(crate) const WEB_TARGET: &str = "wasm32-unknown-unknown";

/// A part of the machine that some task needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Part {
    /// `libvulkan.so.1`, which loads every Vulkan driver.
    VulkanLoader,
    /// The manifest of any Vulkan driver.
    VulkanDriver,
    /// The manifest of Mesa's software driver (lavapipe), which renders the golden images.
    SoftwareDriver,
    /// `SwiftShader`'s Vulkan driver, a second software implementation, included in Chromium.
    SwiftShader,
    /// One of [`WINDOW_LIBRARIES`].
    WindowLibrary(&'static str),
    /// The virtual X server.
    Xvfb,
    /// The tool that presses keys in tests.
    Xdotool,
    /// `ImageMagick`'s screenshot tool, `import`.
    Import,
    /// A browser of the Chromium family, which runs the tests of the page.
    Chromium,
    /// Node.js, which drives the browser.
    Node,
    /// npm, which installs the driver library for Node.js.
    Npm,
    /// `CMake`, which builds a program against the C library.
    Cmake,
    /// glslang, which compiles the shaders of engines without wgpu.
    Glslang,
    /// EGL, with Mesa's software driver for OpenGL.
    Egl,
    /// GLX, with a driver for OpenGL.
    Gl,
    /// The header of an X11 extension that GLFW needs.
    XHeader(&'static str),
    /// `pkg-config` and libudev's development files, for building the gamepad feature.
    Libudev,
}

/// The detected parts of this machine.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Machine {
    /// Available parts.
    pub(crate) parts: BTreeSet<Part>,
    /// Display that could show a window.
    pub(crate) display: Display,
}

/// The display that could show a window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Display {
    /// No display.
    #[default]
    None,
    /// The X server that `DISPLAY` names.
    X11,
    /// The compositor that `WAYLAND_DISPLAY` names.
    Wayland,
    /// The desktop of a system that always has one.
    Desktop,
}

/// Tools for the tests of the page, with their Debian packages.
pub(crate) const PAGE_TOOLS: [(Part, &str); 3] =
    [(Part::Chromium, "chromium"), (Part::Node, "nodejs"), (Part::Npm, "npm")];

/// Shared libraries that winit loads at run time for a window on X11, with their Debian packages.
pub(crate) const WINDOW_LIBRARIES: [(&str, &str); 5] = [
    ("libX11.so.6", "libx11-6"),
    ("libX11-xcb.so.1", "libx11-xcb1"),
    ("libXcursor.so.1", "libxcursor1"),
    ("libXi.so.6", "libxi6"),
    ("libxkbcommon-x11.so.0", "libxkbcommon-x11-0"),
];

/// Headers of X11 that GLFW includes, with their Debian packages.
pub(crate) const X_HEADERS: [(&str, &str); 5] = [
    ("X11/Xlib.h", "libx11-dev"),
    ("X11/Xcursor/Xcursor.h", "libxcursor-dev"),
    ("X11/extensions/XInput2.h", "libxi-dev"),
    ("X11/extensions/Xinerama.h", "libxinerama-dev"),
    ("X11/extensions/Xrandr.h", "libxrandr-dev"),
];

impl Machine {
    /// Detects the parts of this machine.
    pub(crate) fn probe() -> Self {
        let display = display_from(
            std::env::consts::OS,
            std::env::var("WAYLAND_DISPLAY").ok().as_deref(),
            std::env::var("DISPLAY").ok().as_deref(),
        );
        if std::env::consts::OS != "linux" {
            return Self::complete(display);
        }
        let libraries = LoaderCache::read();
        let drivers = vulkan_manifests();
        let is_there = |part: &Part| match *part {
            Part::VulkanLoader => libraries.has("libvulkan.so.1"),
            Part::VulkanDriver => !drivers.is_empty(),
            Part::SoftwareDriver => drivers.iter().any(|name| is_software_driver(name)),
            Part::SwiftShader => swiftshader_manifest().is_some(),
            Part::WindowLibrary(name) => libraries.has(name),
            Part::Xvfb => in_path("Xvfb"),
            Part::Xdotool => in_path("xdotool"),
            Part::Import => in_path("import"),
            Part::Chromium => BROWSERS.iter().any(|name| in_path(name)),
            Part::Node => in_path("node"),
            Part::Npm => in_path("npm"),
            Part::Cmake => in_path("cmake"),
            Part::Glslang => in_path("glslangValidator"),
            Part::Egl => libraries.has("libEGL.so.1"),
            Part::Gl => libraries.has("libGL.so.1"),
            Part::XHeader(name) => Path::new("/usr/include").join(name).is_file(),
            Part::Libudev => process::succeeds(Command::new("pkg-config").args(["--exists", "libudev"])),
        };
        Self { parts: all_parts().filter(is_there).collect(), display }
    }

    /// Returns a machine with all parts. Systems other than Linux count as complete: they have their own
    /// drivers and windows.
    pub(crate) fn complete(display: Display) -> Self {
        Self { parts: all_parts().collect(), display }
    }

    /// Returns whether `part` is available.
    pub(crate) fn has(&self, part: Part) -> bool {
        self.parts.contains(&part)
    }

    /// Returns whether anything can be rendered.
    pub(crate) fn can_render(&self) -> bool {
        self.has(Part::VulkanLoader) && self.has(Part::VulkanDriver)
    }

    /// Returns whether the tools for the tests of the page are available.
    pub(crate) fn can_test_page(&self) -> bool {
        self.can_render() && PAGE_TOOLS.iter().all(|&(part, _)| self.has(part))
    }

    /// Returns whether programs with raylib can be built and run without a display.
    pub(crate) fn can_test_raylib(&self) -> bool {
        let headers = X_HEADERS.map(|(name, _)| Part::XHeader(name));
        [Part::Xvfb, Part::Gl].into_iter().chain(headers).all(|part| self.has(part))
    }

    /// Returns whether the tools for the window test are available.
    pub(crate) fn can_test_window(&self) -> bool {
        let mut window_tools = [Part::Xvfb, Part::Xdotool, Part::Import].into_iter().chain(window_libraries());
        self.can_render() && window_tools.all(|part| self.has(part))
    }
}

fn window_libraries() -> impl Iterator<Item = Part> {
    WINDOW_LIBRARIES.iter().map(|&(library, _)| Part::WindowLibrary(library))
}

fn all_parts() -> impl Iterator<Item = Part> {
    [
        Part::VulkanLoader,
        Part::VulkanDriver,
        Part::SoftwareDriver,
        Part::SwiftShader,
        Part::Xvfb,
        Part::Xdotool,
        Part::Import,
        Part::Chromium,
        Part::Node,
        Part::Npm,
        Part::Cmake,
        Part::Glslang,
        Part::Egl,
        Part::Gl,
        Part::Libudev,
    ]
    .into_iter()
    .chain(window_libraries())
    .chain(X_HEADERS.map(|(name, _)| Part::XHeader(name)))
}

/// Returns the display, given the system's name and the two environment variables (empty counts as unset).
fn display_from(os: &str, wayland: Option<&str>, x11: Option<&str>) -> Display {
    let set = |value: Option<&str>| value.is_some_and(|text| !text.is_empty());
    if os == "macos" || os == "windows" {
        Display::Desktop
    } else if set(wayland) {
        Display::Wayland
    } else if set(x11) {
        Display::X11
    } else {
        Display::None
    }
}

/// The shared libraries that the dynamic loader finds.
struct LoaderCache {
    listing: String,
}

impl LoaderCache {
    fn read() -> Self {
        // Not every user has /sbin in the path.
        let listing = ["ldconfig", "/sbin/ldconfig", "/usr/sbin/ldconfig"]
            .iter()
            .find_map(|program| process::output_of(Command::new(program).arg("-p")));
        Self { listing: listing.unwrap_or_default() }
    }

    fn has(&self, soname: &str) -> bool {
        listed(&self.listing, soname) || {
            let extra = std::env::var_os("LD_LIBRARY_PATH").unwrap_or_default();
            std::env::split_paths(&extra)
                .chain(["/usr/lib", "/usr/lib64", "/usr/local/lib"].map(PathBuf::from))
                .any(|folder| folder.join(soname).exists())
        }
    }
}

/// Returns whether the listing of `ldconfig -p` has `soname` as the whole first word of a line.
fn listed(listing: &str, soname: &str) -> bool {
    listing.lines().any(|line| line.split_whitespace().next() == Some(soname))
}

/// Returns the file names of the Vulkan driver manifests that the loader would read.
fn vulkan_manifests() -> Vec<String> {
    for variable in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        if let Some(files) = std::env::var_os(variable).filter(|value| !value.is_empty()) {
            return std::env::split_paths(&files).filter(|file| file.exists()).filter_map(|f| name_of(&f)).collect();
        }
    }
    // The system folders from Khronos' "Vulkan-Loader: driver interface", section "Driver discovery on
    // Linux".
    ["/etc/vulkan/icd.d", "/usr/local/etc/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/usr/share/vulkan/icd.d"]
        .iter()
        .filter_map(|folder| std::fs::read_dir(folder).ok())
        .flat_map(Iterator::flatten)
        .filter_map(|entry| name_of(&entry.path()))
        .filter(|name| Path::new(name).extension().is_some_and(|extension| extension == "json"))
        .collect()
}

/// Returns the manifest of `SwiftShader`'s driver in the folder of Debian's Chromium.
pub(crate) fn swiftshader_manifest() -> Option<PathBuf> {
    let folders = ["/usr/lib/chromium", "/usr/lib/chromium-browser", "/opt/google/chrome"];
    folders.iter().map(|folder| Path::new(folder).join("vk_swiftshader_icd.json")).find(|file| file.is_file())
}

fn name_of(path: &Path) -> Option<String> {
    path.file_name().map(|name| name.to_string_lossy().into_owned())
}

/// Returns whether a driver manifest's file name is Mesa's lavapipe ("lvp" for short).
fn is_software_driver(manifest: &str) -> bool {
    manifest.starts_with("lvp_icd")
}

fn in_path(program: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|folder| folder.join(program).is_file())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_display_is_found_through_its_variable_and_an_empty_one_is_none() {
        let cases = [
            ("linux", None, None, Display::None),
            ("linux", None, Some(""), Display::None),
            ("linux", Some(""), Some(":0"), Display::X11),
            ("linux", Some("wayland-0"), Some(":0"), Display::Wayland),
            ("freebsd", None, Some(":0"), Display::X11),
            ("macos", None, None, Display::Desktop),
            ("windows", None, None, Display::Desktop),
        ];
        for (os, wayland, x11, expected) in cases {
            assert_eq!(display_from(os, wayland, x11), expected, "{os} {wayland:?} {x11:?}");
        }
    }

    #[test]
    fn a_library_is_listed_by_its_whole_name_only() {
        let listing = "312 libs found in cache `/etc/ld.so.cache'\n\
                       \tlibvulkan.so.1 (libc6,x86-64) => /lib/x86_64-linux-gnu/libvulkan.so.1\n\
                       \tlibXi.so.6 (libc6,x86-64) => /lib/x86_64-linux-gnu/libXi.so.6\n";
        assert!(listed(listing, "libvulkan.so.1"));
        assert!(!listed(listing, "libvulkan.so"));
        assert!(!listed(listing, "libX11.so.6"));
        assert!(!listed("", "libXi.so.6"));
    }

    #[test]
    fn only_lavapipe_is_the_software_driver() {
        assert!(is_software_driver("lvp_icd.x86_64.json"));
        assert!(is_software_driver("lvp_icd.json"));
        assert!(!is_software_driver("radeon_icd.x86_64.json"));
        assert!(!is_software_driver("nvidia_icd.json"));
    }

    #[test]
    fn a_window_test_needs_every_tool_and_library() {
        assert!(Machine::complete(Display::None).can_test_window());
        let window_tools = [Part::VulkanLoader, Part::VulkanDriver, Part::Xvfb, Part::Xdotool, Part::Import];
        for part in window_tools.into_iter().chain(window_libraries()) {
            let mut machine = Machine::complete(Display::None);
            machine.parts.remove(&part);
            assert!(!machine.can_test_window(), "{part:?}");
        }
    }
}
