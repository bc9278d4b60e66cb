//! The published packages: names, versions and siblings, as cargo reads them from the manifests, and the order of
//! publishing.

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use serde_json::Value;

use crate::process;

/// Manifest of the package outside the workspace.
const BEVY: &str = "crates/bevy-shadowfit/Cargo.toml";

/// A package that is published.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Package {
    pub(crate) name: String,
    pub(crate) version: String,
    /// Folder with its manifest.
    pub(crate) folder: PathBuf,
    /// Packages of this repository that it uses outside its tests, each with the version that it asks for.
    pub(crate) siblings: Vec<(String, String)>,
    /// False for the package for Bevy.
    pub(crate) is_of_workspace: bool,
    /// Fields of the manifest, as `cargo metadata` prints them.
    pub(crate) manifest: Value,
}

impl Package {
    /// Returns the name of the package's folder and, with an ending, of its file.
    pub(crate) fn full_name(&self) -> String {
        format!("{}-{}", self.name, self.version)
    }
}

/// Returns the published packages of the workspace, and the package for Bevy.
///
/// # Errors
/// If cargo cannot read the manifests.
pub(crate) fn published() -> Result<Vec<Package>> {
    let workspace = packages("Cargo.toml", true)?;
    Ok(workspace.into_iter().chain(packages(BEVY, false)?).collect())
}

/// Returns the published packages of the workspace that a manifest belongs to.
fn packages(manifest: &str, is_of_workspace: bool) -> Result<Vec<Package>> {
    let mut cargo = process::cargo("metadata");
    cargo.args(["--no-deps", "--format-version", "1", "--manifest-path", manifest]);
    let metadata: Value = serde_json::from_str(&process::printed_by(&mut cargo)?).context("cargo metadata")?;
    let all = metadata["packages"].as_array().context("cargo metadata prints no packages")?;
    // The field is an empty list if the manifest forbids publishing.
    let published = all.iter().filter(|package| package["publish"].is_null());
    published.map(|package| read(package, is_of_workspace).context("cargo metadata lacks a field")).collect()
}

fn read(manifest: &Value, is_of_workspace: bool) -> Option<Package> {
    let text = |value: &Value| value.as_str().map(str::to_owned);
    let dependencies = manifest["dependencies"].as_array()?;
    let siblings = dependencies.iter().filter(|uses| uses["kind"] != "dev" && !uses["path"].is_null());
    Some(Package {
        name: text(&manifest["name"])?,
        version: text(&manifest["version"])?,
        folder: PathBuf::from(manifest["manifest_path"].as_str()?).parent()?.to_owned(),
        siblings: siblings.map(|uses| Some((text(&uses["name"])?, text(&uses["req"])?))).collect::<Option<_>>()?,
        is_of_workspace,
        manifest: manifest.clone(),
    })
}

/// Sorts packages so that each comes after its siblings.
///
/// # Errors
/// If a package uses one that is not published, or packages use each other.
pub(crate) fn in_order(mut packages: Vec<Package>) -> Result<Vec<Package>> {
    let mut sorted: Vec<Package> = Vec::new();
    while !packages.is_empty() {
        let is_ready = |package: &Package| {
            package.siblings.iter().all(|(sibling, _)| sorted.iter().any(|earlier| earlier.name == *sibling))
        };
        let Some(next) = packages.iter().position(is_ready) else {
            let names: Vec<&str> = packages.iter().map(|package| package.name.as_str()).collect();
            bail!("these packages use each other, or packages that are not published: {}", names.join(", "));
        };
        sorted.push(packages.remove(next));
    }
    Ok(sorted)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn package(name: &str, siblings: &[&str]) -> Package {
        Package {
            name: name.to_owned(),
            version: "1.0.0".to_owned(),
            folder: PathBuf::new(),
            siblings: siblings.iter().map(|&sibling| (sibling.to_owned(), "^1.0.0".to_owned())).collect(),
            is_of_workspace: true,
            manifest: Value::Null,
        }
    }

    #[test]
    fn siblings_come_first() {
        let sorted = in_order(vec![package("c", &["b", "a"]), package("b", &["a"]), package("a", &[])]).unwrap();
        assert_eq!(sorted.iter().map(|package| package.name.as_str()).collect::<String>(), "abc");
    }

    #[test]
    fn circles_and_unpublished_siblings_are_errors() {
        assert!(in_order(vec![package("a", &["b"]), package("b", &["a"])]).is_err());
        assert!(in_order(vec![package("a", &["tests"])]).is_err());
    }

    #[test]
    fn dependencies_of_tests_are_no_siblings() {
        let uses = |name: &str, kind: Value| json!({ "name": name, "req": "^1.0.0", "kind": kind, "path": "p" });
        let manifest = json!({
            "name": "a", "version": "1.0.0", "manifest_path": "f/Cargo.toml",
            "dependencies": [uses("b", Value::Null), uses("c", json!("dev")), { "name": "d", "path": null }],
        });
        assert_eq!(read(&manifest, true).unwrap().siblings, [("b".to_owned(), "^1.0.0".to_owned())]);
    }

    /// Returns the version of a dependency that a package asks for, without its operator.
    fn asked<'a>(packages: &'a [Package], package: &str, dependency: &str) -> &'a str {
        let package = packages.iter().find(|other| other.name == package).unwrap();
        let dependencies = package.manifest["dependencies"].as_array().unwrap();
        let found = dependencies.iter().find(|uses| uses["name"] == dependency && uses["kind"].is_null()).unwrap();
        found["req"].as_str().unwrap().trim_start_matches(['^', '>', '='])
    }

    #[test]
    fn the_version_table_has_the_versions_of_the_manifests() {
        let page = std::fs::read_to_string(process::root().join("crates/shadowfit/README.md")).unwrap();
        let packages = published().unwrap();
        let minor = |version: &str| version.split('.').take(2).collect::<Vec<_>>().join(".");
        let start = format!("| {} |", minor(&packages[0].version));
        let row = page.lines().find(|line| line.starts_with(&start)).expect("a row of this version");
        let cells: Vec<&str> = row.trim_matches(['|', ' ']).split('|').map(str::trim).collect();
        for package in &packages {
            assert!(cells[1].contains(package.manifest["rust_version"].as_str().unwrap()), "{}: {row}", package.name);
        }
        let glam: Vec<&str> = asked(&packages, "shadowfit", "glam").split(", <").collect();
        assert_eq!(cells[2].split(" to ").next(), Some(glam[0]));
        assert_eq!(cells[3], asked(&packages, "shadowfit-wgpu", "wgpu"));
        assert_eq!(cells[4], asked(&packages, "shadowfit-egui", "egui"));
        assert_eq!(cells[5], minor(asked(&packages, "bevy-shadowfit", "bevy")));
    }

    #[test]
    fn eight_crates_are_published_with_licences_and_documentation() {
        let packages = published().unwrap();
        assert_eq!(packages.len(), 8);
        for Package { name, folder, manifest, .. } in packages {
            assert_eq!(manifest["documentation"], format!("https://docs.rs/{name}"), "{name}");
            assert!(manifest["description"].is_string() && manifest["readme"].is_string(), "{name}");
            let docs = json!({
                "all-features": true, "rustdoc-args": ["--generate-link-to-definition"], "targets": [],
            });
            assert_eq!(manifest["metadata"]["docs"]["rs"], docs, "{name}");
            for license in ["LICENSE-APACHE", "LICENSE-MIT"] {
                assert!(folder.join(license).exists(), "{name}: {license}");
            }
        }
    }
}
