//! Installs missing packages for a task. This works for root on Debian and its derivatives. Elsewhere it
//! prints the missing packages and continues, since the task may work without them.

use std::process::Command;

use anyhow::{Result, bail};

use crate::machine::{Display, Machine, PAGE_TOOLS, Part, WINDOW_LIBRARIES, X_HEADERS};
use crate::process;

/// The purpose of preparing the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// Running the viewer: any Vulkan driver, gamepads, and a window if there is a display.
    Run,
    /// Measuring also the fits of npm packages: any Vulkan driver, Node.js and npm.
    Peers,
    /// Rendering pictures that must be the same everywhere: the software driver.
    Pictures,
    /// Testing the page: the software driver, and a browser with its driver tools.
    Page,
    /// Testing the C library: `CMake`.
    C,
    /// Building the example with raylib, and running it without a display.
    Raylib,
    /// Running the tests: the software driver of the golden images, and the tools of the window test.
    Test,
    /// Also drawing on a second software driver.
    SecondDriver,
    /// Running all tests, including the tests of the page.
    TestAll,
}

/// The environment variable of automatic runs that forbids skipping tests because a GPU is missing.
pub(crate) const REQUIRE_GPU: &str = "SHADOWFIT_REQUIRE_GPU";

/// Returns whether [`REQUIRE_GPU`] is set.
pub(crate) fn gpu_is_required() -> bool {
    std::env::var(REQUIRE_GPU).is_ok_and(|value| !value.is_empty() && value != "0")
}

/// Installs missing packages for `purpose` if possible. Returns the parts that are available afterwards.
///
/// # Errors
/// If [`REQUIRE_GPU`] is set and a part is still missing.
pub(crate) fn prepare(purpose: Purpose) -> Result<Machine> {
    let machine = Machine::probe();
    let packages = missing_packages(purpose, &machine);
    if packages.is_empty() {
        return Ok(machine);
    }
    let release = std::fs::read_to_string("/etc/os-release").unwrap_or_default();
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    match remedy(is_debian_like(&release), effective_uid(&status) == Some(0), &packages) {
        Remedy::Install => install(&packages),
        Remedy::Say(text) => eprintln!("{text}"),
    }
    let machine = Machine::probe();
    let still_missing = missing_packages(purpose, &machine);
    if gpu_is_required() && !still_missing.is_empty() {
        bail!("still missing after the installation: {} ({REQUIRE_GPU} is set)", still_missing.join(" "));
    }
    Ok(machine)
}

/// Returns the workspace's features that can be built here. All tasks use them, so that they share one build.
pub(crate) fn features(machine: &Machine) -> &'static [&'static str] {
    if viewer_features(machine).is_empty() {
        return &["--features", "xtask/tools"];
    }
    &["--features", "gamepad,xtask/tools"]
}

/// Returns the viewer's features that can be built here.
pub(crate) fn viewer_features(machine: &Machine) -> &'static [&'static str] {
    if machine.has(Part::Libudev) {
        return &["--features", "gamepad"];
    }
    eprintln!("no gamepad support in this build: libudev's development files and pkg-config are missing");
    &[]
}

/// Returns the Debian packages that `purpose` needs and `machine` lacks, in a fixed order.
fn missing_packages(purpose: Purpose, machine: &Machine) -> Vec<&'static str> {
    let testing = matches!(purpose, Purpose::Test | Purpose::TestAll);
    // To run the viewer, any driver will do. The golden images need the software driver.
    let driver =
        if matches!(purpose, Purpose::Run | Purpose::Peers) { Part::VulkanDriver } else { Part::SoftwareDriver };
    if purpose == Purpose::C {
        return if machine.has(Part::Cmake) { Vec::new() } else { vec!["cmake"] };
    }
    if purpose == Purpose::Raylib {
        let needs = [(Part::Xvfb, "xvfb"), (Part::Gl, "libgl1")].into_iter();
        let headers = X_HEADERS.map(|(header, package)| (Part::XHeader(header), package));
        return needs.chain(headers).filter(|&(part, _)| !machine.has(part)).map(|(_, package)| package).collect();
    }
    let mut needs = vec![(Part::VulkanLoader, "libvulkan1"), (driver, "mesa-vulkan-drivers")];
    if testing || machine.display == Display::X11 {
        needs.extend(WINDOW_LIBRARIES.map(|(library, package)| (Part::WindowLibrary(library), package)));
    }
    if testing {
        needs.extend([(Part::Xvfb, "xvfb"), (Part::Xdotool, "xdotool"), (Part::Import, "imagemagick")]);
        needs.extend([(Part::Glslang, "glslang-tools"), (Part::Egl, "libegl1"), (Part::Egl, "libgl1-mesa-dri")]);
    }
    if matches!(purpose, Purpose::TestAll | Purpose::Page) {
        needs.extend(PAGE_TOOLS);
    }
    if purpose == Purpose::Peers {
        needs.extend(PAGE_TOOLS.iter().filter(|(part, _)| *part != Part::Chromium));
    }
    if purpose == Purpose::SecondDriver {
        needs.push((Part::SwiftShader, "chromium"));
    }
    needs.extend([(Part::Libudev, "libudev-dev"), (Part::Libudev, "pkg-config")]);
    needs.into_iter().filter(|&(part, _)| !machine.has(part)).map(|(_, package)| package).collect()
}

#[derive(Debug, PartialEq, Eq)]
enum Remedy {
    /// Install the packages now.
    Install,
    /// Print this text.
    Say(String),
}

/// Returns the remedy for missing `packages`, which have their Debian names.
fn remedy(debian_like: bool, is_root: bool, packages: &[&str]) -> Remedy {
    let names = packages.join(" ");
    match (debian_like, is_root) {
        (true, true) => Remedy::Install,
        (true, false) => Remedy::Say(format!(
            "to install the missing packages: sudo apt-get install --no-install-recommends {names}"
        )),
        (false, _) => Remedy::Say(format!("missing here, by its Debian name (other systems differ): {names}")),
    }
}

/// Installs `packages`. Prints failures and continues, since the task may work without them.
fn install(packages: &[&str]) {
    let apt = |arguments: &[&str]| {
        process::run(
            Command::new("apt-get").env("DEBIAN_FRONTEND", "noninteractive").args(["-q", "-y"]).args(arguments),
        )
    };
    let mut arguments = vec!["install", "--no-install-recommends"];
    arguments.extend_from_slice(packages);
    // An old package list may be sufficient without network access, so try the second step regardless.
    for result in [apt(&["update"]), apt(&arguments)] {
        if let Err(error) = result {
            eprintln!("{error:#}; going on without");
        }
    }
}

/// Returns whether the text of `/etc/os-release` belongs to Debian or a derivative.
fn is_debian_like(os_release: &str) -> bool {
    os_release
        .lines()
        .filter_map(|line| line.split_once('='))
        .filter(|(key, _)| matches!(key.trim(), "ID" | "ID_LIKE"))
        .flat_map(|(_, value)| value.trim().trim_matches(['"', '\'']).split_whitespace())
        .any(|id| matches!(id, "debian" | "ubuntu"))
}

/// Returns the effective user id from the text of `/proc/self/status`, whose line holds real, effective,
/// saved and file system id in this order.
fn effective_uid(status: &str) -> Option<u32> {
    let line = status.lines().find_map(|line| line.strip_prefix("Uid:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bare_machine_gets_a_driver_and_gamepads_to_run_headless() {
        let packages = missing_packages(Purpose::Run, &Machine::default());
        assert_eq!(packages, ["libvulkan1", "mesa-vulkan-drivers", "libudev-dev", "pkg-config"]);
    }

    #[test]
    fn a_bare_machine_with_a_display_gets_the_window_libraries_too() {
        let machine = Machine { display: Display::X11, ..Machine::default() };
        let packages = missing_packages(Purpose::Run, &machine);
        for (_, package) in WINDOW_LIBRARIES {
            assert!(packages.contains(&package), "{package} is not in {packages:?}");
        }
        assert!(!packages.contains(&"xvfb"));
    }

    #[test]
    fn a_bare_machine_gets_the_window_test_tools_to_test() {
        let packages = missing_packages(Purpose::Test, &Machine::default());
        for package in [
            "libvulkan1",
            "mesa-vulkan-drivers",
            "libxkbcommon-x11-0",
            "xvfb",
            "imagemagick",
            "glslang-tools",
            "libegl1",
        ] {
            assert!(packages.contains(&package), "{package} is not in {packages:?}");
        }
        assert!(!packages.contains(&"chromium"));
        assert!(missing_packages(Purpose::TestAll, &Machine::default()).contains(&"chromium"));
    }

    #[test]
    fn a_driver_that_is_there_is_kept_for_running_and_the_software_one_is_added_for_pictures() {
        let mut machine = Machine::complete(Display::X11);
        machine.parts.remove(&Part::SoftwareDriver);
        assert!(missing_packages(Purpose::Run, &machine).is_empty());
        for purpose in [Purpose::Pictures, Purpose::Test] {
            assert_eq!(missing_packages(purpose, &machine), ["mesa-vulkan-drivers"]);
        }
    }

    #[test]
    fn the_second_software_driver_comes_with_chromium() {
        let mut machine = Machine::complete(Display::None);
        machine.parts.remove(&Part::SwiftShader);
        assert_eq!(missing_packages(Purpose::SecondDriver, &machine), ["chromium"]);
        assert!(missing_packages(Purpose::Test, &machine).is_empty());
    }

    #[test]
    fn a_complete_machine_gets_nothing() {
        for display in [Display::None, Display::X11, Display::Wayland, Display::Desktop] {
            for purpose in [Purpose::Run, Purpose::Pictures, Purpose::Raylib, Purpose::TestAll] {
                assert!(missing_packages(purpose, &Machine::complete(display)).is_empty());
            }
        }
    }

    #[test]
    fn one_missing_library_brings_one_package() {
        let mut machine = Machine::complete(Display::X11);
        machine.parts.remove(&Part::WindowLibrary("libXi.so.6"));
        assert_eq!(missing_packages(Purpose::Run, &machine), ["libxi6"]);
    }

    #[test]
    fn only_root_on_debian_installs_and_others_get_one_line() {
        let packages = ["libvulkan1", "xvfb"];
        assert_eq!(remedy(true, true, &packages), Remedy::Install);
        assert_eq!(
            remedy(true, false, &packages),
            Remedy::Say(
                "to install the missing packages: sudo apt-get install --no-install-recommends libvulkan1 xvfb".into()
            )
        );
        for is_root in [false, true] {
            let Remedy::Say(text) = remedy(false, is_root, &packages) else { panic!("installed off Debian") };
            assert!(text.ends_with("libvulkan1 xvfb") && !text.contains('\n'));
        }
    }

    #[test]
    fn debian_and_its_kin_are_told_from_others() {
        let cases = [
            ("PRETTY_NAME=\"Debian GNU/Linux 12 (bookworm)\"\nID=debian\n", true),
            ("ID=ubuntu\nID_LIKE=debian\n", true),
            ("ID=linuxmint\nID_LIKE=\"ubuntu debian\"\n", true),
            ("ID=\"pop\"\nID_LIKE='ubuntu debian'\n", true),
            ("NAME=\"Arch, not debian\"\nID=arch\n", false),
            ("ID=fedora\nVERSION_ID=40\n", false),
            ("ID=debianish\n", false),
            ("", false),
        ];
        for (text, expected) in cases {
            assert_eq!(is_debian_like(text), expected, "{text:?}");
        }
    }

    #[test]
    fn the_effective_user_id_is_the_second_number() {
        assert_eq!(effective_uid("Name:\tx\nUid:\t1000\t0\t1000\t1000\nGid:\t7\n"), Some(0));
        assert_eq!(effective_uid("Uid:\t1000\t1000\t1000\t1000\n"), Some(1000));
        assert_eq!(effective_uid("Uid:\n"), None);
        assert_eq!(effective_uid(""), None);
    }
}
