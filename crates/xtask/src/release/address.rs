//! The repository's address. The workspace's manifest states it. Other files repeat it: the manifests of
//! `bevy-shadowfit` and of the npm package, and the pictures of READMEs, which registries show without the repository.

use std::collections::BTreeSet;
use std::fs;

use anyhow::{Context, Result, ensure};

use super::{git, read};
use crate::process;

/// The owner's name until a person decides on it. Names of accounts have no underscores, so it is nobody's.
pub(crate) const PLACEHOLDER: &str = "_OWNER_";
/// Name of the repository, and folder of its page.
const REPOSITORY: &str = "/shadowfit";
/// Text before and after the owner in the address of the repository, and after the owner in the address of its page.
const HOST: &str = "https://github.com/";
const PAGES: &str = ".github.io";
/// Endings of the files that may contain an address.
const ENDINGS: [&str; 4] = [".md", ".toml", ".json", ".yml"];

/// Returns the owner that the workspace's manifest names.
pub(crate) fn owner() -> Result<String> {
    let manifest = read("Cargo.toml")?;
    let owner = manifest.lines().filter(|line| line.starts_with("repository")).flat_map(owners).next();
    owner.map(str::to_owned).context("Cargo.toml has no repository")
}

/// Checks that all addresses name the same owner.
///
/// # Errors
/// If an address names another owner than the workspace's manifest.
pub(crate) fn check() -> Result<()> {
    let owner = owner()?;
    for (file, text) in files()? {
        let others: Vec<&str> = owners(&text).into_iter().filter(|&other| other != owner).collect();
        ensure!(others.is_empty(), "{file} names the owner {others:?}, but Cargo.toml names {owner}");
    }
    Ok(())
}

/// Writes another owner into all addresses.
///
/// # Errors
/// If no account can have this name, or a file cannot be written.
pub(crate) fn set_owner(new: &str) -> Result<()> {
    ensure!(new == PLACEHOLDER || is_name(new), "\"{new}\" is no name of a GitHub account");
    let old = owner()?;
    for (file, text) in files()? {
        let replaced = with_owner(&text, &old, new);
        if replaced != text {
            fs::write(process::root().join(&file), replaced).with_context(|| format!("cannot write {file}"))?;
            println!("{file} is written");
        }
    }
    check()
}

/// Returns whether an account can have this name.
fn is_name(name: &str) -> bool {
    let is_word = |word: &str| !word.is_empty() && word.chars().all(|letter| letter.is_ascii_alphanumeric());
    name.len() < 40 && name.split('-').all(is_word)
}

/// Returns the files that may contain an address, with their text.
fn files() -> Result<Vec<(String, String)>> {
    let tracked = git(&["ls-files"])?;
    let files = tracked.lines().filter(|file| ENDINGS.iter().any(|ending| file.ends_with(ending)));
    files.map(|file| Ok((file.to_owned(), read(file)?))).collect()
}

/// Returns the owners in all addresses of this repository or its page.
fn owners(text: &str) -> BTreeSet<&str> {
    let of_code = text.split(HOST).skip(1).filter_map(|rest| {
        let (owner, rest) = rest.split_once('/')?;
        rest.starts_with(&REPOSITORY[1..]).then_some(owner)
    });
    let page = [PAGES, REPOSITORY].concat();
    let of_page = text.match_indices(&page).filter_map(|(at, _)| text[..at].rsplit('/').next());
    of_code.chain(of_page).collect()
}

/// Returns a text with another owner in all addresses of this repository and its page.
fn with_owner(text: &str, old: &str, new: &str) -> String {
    let code = |owner: &str| [HOST, owner, REPOSITORY].concat();
    let page = |owner: &str| ["//", owner, PAGES, REPOSITORY].concat();
    text.replace(&code(old), &code(new)).replace(&page(old), &page(new))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::release::{NPM, packages};

    const TEXT: &str = "git+https://github.com/_OWNER_/shadowfit.git, https://github.com/gfx-rs/wgpu \
                        (https://_OWNER_.github.io/shadowfit/)";

    #[test]
    fn only_addresses_of_this_repository_have_an_owner_of_ours() {
        assert_eq!(owners(TEXT), BTreeSet::from([PLACEHOLDER]));
        let replaced = with_owner(TEXT, PLACEHOLDER, "a-b");
        assert_eq!(owners(&replaced), BTreeSet::from(["a-b"]));
        assert!(replaced.contains("com/a-b/shadowfit.git") && replaced.contains("//a-b.github.io/shadowfit/"));
        assert_eq!(with_owner(&replaced, "a-b", PLACEHOLDER), TEXT);
    }

    #[test]
    fn names_are_words_with_hyphens() {
        assert!(is_name("a") && is_name("a-b2"));
        assert!(!["", "-a", "a--b", "a/b", PLACEHOLDER].into_iter().any(is_name));
    }

    #[test]
    fn all_addresses_agree_with_the_workspace() {
        check().unwrap();
        let repository = [HOST, &owner().unwrap(), REPOSITORY].concat();
        let page = format!("https://{}{PAGES}{REPOSITORY}/", owner().unwrap());
        for package in packages::published().unwrap() {
            assert_eq!(package.manifest["repository"], repository, "{}", package.name);
            assert_eq!(package.manifest["homepage"], page, "{}", package.name);
        }
        let npm: serde_json::Value = serde_json::from_str(&read(NPM).unwrap()).unwrap();
        assert_eq!(
            (&npm["repository"]["url"], &npm["homepage"]),
            (&format!("git+{repository}.git").into(), &page.into())
        );
    }

    #[test]
    fn registries_can_show_every_picture_of_a_published_readme() {
        let main = [HOST, &owner().unwrap(), REPOSITORY, "/raw/main/"].concat();
        let root = process::root();
        let mut pages: Vec<_> = packages::published().unwrap().into_iter().map(|package| package.folder).collect();
        pages.push(root.join(NPM).parent().unwrap().to_owned());
        for page in pages.into_iter().map(|folder| folder.join("README.md")) {
            let text = fs::read_to_string(&page).unwrap();
            for picture in text.split("![").skip(1).filter_map(|rest| rest.split_once("](")?.1.split(')').next()) {
                let file = picture.strip_prefix(&main);
                assert!(file.is_some_and(|file| root.join(file).exists()), "{}: {picture}", page.display());
            }
        }
    }
}
