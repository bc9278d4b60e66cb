//! `cargo xtask release`: prepares a release, so that publishing is one decision by a person. The dry run checks
//! everything and prints the commands. It neither publishes nor tags.
//!
//! Contradictions are errors. Open decisions, such as a date or an owner, are printed as things to do.

mod address;
mod folders;
mod matrix;
mod packages;

use std::process::Command;

use anyhow::{Context, Result, bail, ensure};

pub(crate) use self::address::set_owner;
pub(crate) use self::matrix::check as matrix;
use self::packages::Package;
use crate::process;

/// The npm package's manifest.
const NPM: &str = "crates/shadowfit-wasm/npm/package.json";
/// Text in place of the date in the changelog until the release.
const UNRELEASED: &str = "Unreleased";

/// Checks versions, changelog, tag and packages, and prints the commands of the release. A quick run packs
/// `bevy-shadowfit` without building it, and leaves out the [`matrix()`].
///
/// # Errors
/// If versions differ, the changelog lacks the version, or a package is too large or does not build.
pub(crate) fn dry_run(is_quick: bool) -> Result<()> {
    let packages = packages::in_order(packages::published()?)?;
    let version = one_version(&packages)?;
    let date = read("CHANGELOG.md").map(|text| date(&text, &version).map(str::to_owned))?;
    let date = date.with_context(|| format!("CHANGELOG.md has no section for {version}"))?;
    address::check()?;
    folders::check(&packages, is_quick)?;
    if !is_quick {
        matrix()?;
    }
    let decisions = decisions(&version, &date)?;
    println!("\nshadowfit {version} is ready to publish, except for {} things to do:", decisions.len());
    for decision in decisions {
        println!("- {decision}");
    }
    println!("\nThese commands publish it. Run each after the one before it:\n");
    for command in commands(&packages, &version) {
        println!("    {command}");
    }
    Ok(())
}

/// Returns the version of all packages and of the npm package.
fn one_version(packages: &[Package]) -> Result<String> {
    let npm: serde_json::Value = serde_json::from_str(&read(NPM)?).context(NPM)?;
    let version = npm["version"].as_str().with_context(|| format!("{NPM} has no version"))?;
    for package in packages {
        let Package { name, version: own, siblings, .. } = package;
        ensure!(own == version, "{name} has version {own}, but {NPM} has {version}");
        for (sibling, requirement) in siblings {
            let wanted = format!("^{version}");
            ensure!(*requirement == wanted, "{name} asks for {sibling} {requirement} in place of {wanted}");
        }
    }
    Ok(version.to_owned())
}

/// Returns the date of a version's section in the changelog.
fn date<'a>(changelog: &'a str, version: &str) -> Option<&'a str> {
    let heading = format!("## [{version}] - ");
    changelog.lines().find_map(|line| line.strip_prefix(heading.as_str())).map(str::trim)
}

/// Returns the decisions that only a person can make.
fn decisions(version: &str, date: &str) -> Result<Vec<String>> {
    let mut open = Vec::new();
    if address::owner()? == address::PLACEHOLDER {
        open.push("name the owner of the repository: cargo xtask release --owner NAME".to_owned());
    }
    if date == UNRELEASED {
        open.push(format!("write the date into CHANGELOG.md, in place of \"{UNRELEASED}\""));
    }
    if !git(&["status", "--porcelain"])?.is_empty() {
        open.push("commit or remove the changes in the working tree".to_owned());
    }
    let tag = format!("v{version}");
    if !git(&["tag", "--list", &tag])?.is_empty()
        && git(&["rev-list", "-n", "1", &tag])? != git(&["rev-parse", "HEAD"])?
    {
        open.push(format!("raise the version: the tag {tag} is at another commit"));
    }
    Ok(open)
}

/// Returns the commands that publish everything, in order. crates.io accepts five new crates at once and then one in
/// ten minutes, so each package has its own command. The push also publishes the viewer's page.
fn commands(packages: &[Package], version: &str) -> Vec<String> {
    let mut commands =
        vec![format!("git tag -a v{version} -m 'shadowfit {version}'"), format!("git push origin main v{version}")];
    commands.extend(packages.iter().map(|package| {
        if package.is_of_workspace {
            return format!("cargo publish --package {}", package.name);
        }
        let rust = package.manifest["rust_version"].as_str().unwrap_or("stable");
        format!("cargo +{rust} publish --manifest-path crates/{}/Cargo.toml", package.name)
    }));
    commands.push("cargo xtask npm".to_owned());
    commands.push(format!("npm publish out/npm/shadowfit-{version}.tgz"));
    commands
}

fn read(name: &str) -> Result<String> {
    std::fs::read_to_string(process::root().join(name)).with_context(|| format!("cannot read {name}"))
}

/// Returns what git prints.
fn git(arguments: &[&str]) -> Result<String> {
    let output = Command::new("git").args(arguments).current_dir(process::root()).output();
    let output = output.context("git does not start")?;
    if !output.status.success() {
        bail!("git {}: {}", arguments.join(" "), String::from_utf8_lossy(&output.stderr).trim());
    }
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_date_is_read_from_the_section_of_the_version() {
        let changelog = "# Changelog\n\n## [0.2.0] - Unreleased\n\n- a\n\n## [0.1.0] - 2026-12-01\n";
        assert_eq!(date(changelog, "0.2.0"), Some(UNRELEASED));
        assert_eq!(date(changelog, "0.1.0"), Some("2026-12-01"));
        assert_eq!(date(changelog, "0.1"), None);
    }

    #[test]
    fn all_versions_are_one_and_in_the_changelog() {
        let version = one_version(&packages::published().unwrap()).unwrap();
        assert!(date(&read("CHANGELOG.md").unwrap(), &version).is_some());
    }

    #[test]
    fn siblings_are_published_before_the_crates_that_use_them() {
        let packages = packages::in_order(packages::published().unwrap()).unwrap();
        let commands = commands(&packages, "1.2.3");
        let place = |end: &str| commands.iter().position(|command| command.ends_with(end)).expect(end);
        assert!(place("--package shadowfit") < place("--package shadowfit-gpu"));
        assert!(place("--package shadowfit-rays") < place("--package shadowfit-wgpu"));
        assert!(place("--package shadowfit-wgpu") < place("crates/bevy-shadowfit/Cargo.toml"));
        assert_eq!(commands[0], "git tag -a v1.2.3 -m 'shadowfit 1.2.3'");
    }
}
