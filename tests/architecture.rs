//! `docs/ARCHITECTURE.md` against the files: it names every module, and no file that is not there.
//!
//! A *section* begins with the name of what it is about in backticks, as a heading (``### `shadowfit` ``) or in bold at
//! the start of a paragraph (``**`shadowfit`**``), and goes on to the next section or heading. Each crate has one by
//! its name. The examples have one called `examples`, and those that are folders may have one of their own, such as
//! `examples/report`.
//!
//! Names of files stand in backticks too. Within its section, a module is named by
//!
//! - its path below `src` (or below `examples`), such as `import/mesh.rs`,
//! - the end of that path, such as `mesh.rs`, if no other module of the section ends so,
//! - a folder that it is in, with a slash at its end, such as `import/`. That is for folders whose files are much alike
//!   and need no words one by one.
//!
//! `foo/mod.rs` is what the folder `foo/` is about, and has to be named like any other module. The root of a crate or
//! example (`lib.rs`, `main.rs`) is what its section is about, and needs no mention in it.

use std::collections::BTreeMap;

use crate::support::{files_below, workspace};

/// Where the doc's files are, below the workspace.
const FOLDERS: [&str; 4] = ["crates", "docs", "examples", "tests"];

/// How the names of modules end.
const MODULE: &str = ".rs";

/// How the names of files end that the doc can name; others, such as pictures, may be what a program writes.
const KINDS: [&str; 2] = [MODULE, ".wgsl"];

/// The lines of each section by its name.
type Sections = BTreeMap<String, String>;

/// Modules that one section has to name.
struct Unit {
    /// Name of the section.
    title: String,
    /// Paths that the section's mentions are relative to, with slashes.
    modules: Vec<String>,
}

fn document() -> String {
    let file = workspace().join("docs/ARCHITECTURE.md");
    std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}

/// Every file of [`FOLDERS`], relative to the workspace, with slashes.
fn all_files() -> Vec<String> {
    let below = |folder: &&str| files_below(&workspace().join(folder));
    let relative = |file: std::path::PathBuf| {
        let relative = file.strip_prefix(workspace()).expect("a file of the workspace");
        relative.components().map(|part| part.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/")
    };
    FOLDERS.iter().flat_map(below).map(relative).collect()
}

/// What each section has to name: a unit for each crate, and one for each example that has a section of its own.
fn units(files: &[String], sections: &Sections) -> Vec<Unit> {
    let mut modules: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for file in files.iter().filter(|file| file.ends_with(MODULE)) {
        if let Some((name, path)) = file.strip_prefix("crates/").and_then(|file| file.split_once("/src/")) {
            modules.entry(name.to_owned()).or_default().push(path.to_owned());
        } else if let Some(path) = file.strip_prefix("examples/") {
            let own = path.split_once('/').map(|(folder, path)| (format!("examples/{folder}"), path));
            let own = own.filter(|(title, _)| sections.contains_key(title));
            let (title, path) = own.unwrap_or_else(|| ("examples".to_owned(), path));
            modules.entry(title).or_default().push(path.to_owned());
        }
    }
    modules.into_iter().map(|(title, modules)| Unit { title, modules }).collect()
}

/// The sections of a document. Blocks of code belong to none.
fn sections(text: &str) -> Sections {
    let mut sections = Sections::new();
    let (mut current, mut is_code) = (None, false);
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            is_code = !is_code;
        } else if !is_code {
            match title(line) {
                Some(title) => current = Some(title.to_owned()),
                None if line.starts_with('#') => current = None,
                None => {}
            }
            if let Some(current) = &current {
                let body: &mut String = sections.entry(current.clone()).or_default();
                body.push_str(line);
                body.push('\n');
            }
        }
    }
    sections
}

/// The name of the section that begins with a line.
fn title(line: &str) -> Option<&str> {
    let heading = line.strip_prefix('#').map(|rest| rest.trim_start_matches('#').trim_start());
    let (name, rest) = heading.or(line.strip_prefix("**"))?.strip_prefix('`')?.split_once('`')?;
    (heading.is_some() || rest.starts_with("**")).then_some(name)
}

/// What stands in backticks, lines joined.
fn mentions(text: &str) -> Vec<String> {
    text.split('`').skip(1).step_by(2).map(|mention| mention.replace('\n', " ")).collect()
}

/// The files that a mention names: those in a folder, the one with that path, or those whose paths end so.
fn named<'a>(mention: &str, files: &'a [String]) -> Vec<&'a String> {
    let ends = |file: &str| file == mention || file.ends_with(&format!("/{mention}"));
    if mention.ends_with('/') {
        files.iter().filter(|file| format!("/{file}").contains(&format!("/{mention}"))).collect()
    } else if let Some(exact) = files.iter().find(|file| *file == mention) {
        vec![exact]
    } else {
        files.iter().filter(|file| ends(file)).collect()
    }
}

/// The modules of a unit that its section does not name.
fn unnamed<'a>(unit: &'a Unit, section: &str) -> Vec<&'a String> {
    let mentions = mentions(section);
    let is_root = |module: &str| unit.title != "examples" && ["lib.rs", "main.rs"].contains(&module);
    let is_named = |module: &String| {
        mentions.iter().any(|mention| {
            let named = named(mention, &unit.modules);
            named.contains(&module) && (mention.ends_with('/') || named.len() == 1)
        })
    };
    unit.modules.iter().filter(|module| !is_root(module) && !is_named(module)).collect()
}

/// Whether a mention is meant as the name of a file or folder, and not as code or what a program writes.
fn is_file_name(mention: &str) -> bool {
    let is_of_a_kind = KINDS.iter().any(|kind| mention.ends_with(kind)) || mention.ends_with('/');
    let is_path = FOLDERS.iter().any(|folder| mention.starts_with(&format!("{folder}/")));
    !mention.contains(char::is_whitespace) && (is_of_a_kind || is_path)
}

/// Whether a mention names a file or folder that is there; a star stands for any part of a name.
fn exists(mention: &str, files: &[String]) -> bool {
    if let Some((start, end)) = mention.split_once('*') {
        let (start, end) = (format!("/{start}"), end.to_owned());
        return files.iter().map(|file| format!("/{file}")).any(|file| {
            let after = file.find(&start).map(|at| &file[at + start.len()..]);
            after.is_some_and(|after| after.ends_with(&end))
        });
    }
    let as_folder = format!("{}/", mention.trim_end_matches('/'));
    !named(mention, files).is_empty() || !named(&as_folder, files).is_empty()
}

#[test]
fn architecture_names_every_module_in_the_section_of_its_crate() {
    let sections = sections(&document());
    let units = units(&all_files(), &sections);
    let modules: usize = units.iter().map(|unit| unit.modules.len()).sum();
    assert!(modules > 0 && units.iter().any(|unit| unit.title == "shadowfit"), "no modules were found");
    let mut missing = Vec::new();
    for unit in &units {
        match sections.get(&unit.title) {
            Some(section) => missing.extend(unnamed(unit, section).iter().map(|m| format!("{}: {m}", unit.title))),
            None => missing.push(format!("{}: a section of its own", unit.title)),
        }
    }
    assert!(missing.is_empty(), "docs/ARCHITECTURE.md does not name\n{}", missing.join("\n"));
}

#[test]
fn every_file_that_architecture_names_exists() {
    let (text, files) = (document(), all_files());
    // Code blocks have lines of backticks, whose content is no mention.
    let prose: String = text.split("```").step_by(2).collect();
    let mentioned: Vec<String> = mentions(&prose).into_iter().filter(|mention| is_file_name(mention)).collect();
    assert!(!mentioned.is_empty(), "docs/ARCHITECTURE.md names no file");
    let missing: Vec<&String> = mentioned.iter().filter(|mention| !exists(mention, &files)).collect();
    assert!(missing.is_empty(), "docs/ARCHITECTURE.md names what is not there: {missing:?}");
}

#[test]
fn a_module_is_named_by_its_path_its_unique_end_or_its_folder_in_its_own_section() {
    let text = "# Title\n**`one`** has `top.rs`, `part/twice.rs` and\n`alike/`.\n```\n`lost.rs`\n```\n`twice.rs`\n\
                ### `two`\n`lost.rs`\n## End\n`lost.rs`\n";
    let modules = ["lib.rs", "top.rs", "part/mod.rs", "part/twice.rs", "other/twice.rs", "alike/a.rs", "lost.rs"];
    let unit = Unit { title: "one".to_owned(), modules: modules.map(str::to_owned).to_vec() };
    let sections = sections(text);
    assert_eq!(sections.keys().collect::<Vec<_>>(), ["one", "two"]);
    assert_eq!(unnamed(&unit, &sections["one"]), ["part/mod.rs", "other/twice.rs", "lost.rs"]);
}

#[test]
fn names_of_files_are_found_anywhere_in_the_workspace_and_code_is_no_name() {
    let files = ["crates/one/src/part/mod.rs", "crates/one/src/shaders/compare_less.wgsl"].map(str::to_owned);
    for there in ["mod.rs", "part/", "part/mod.rs", "crates/one/src/part", "compare_*.wgsl", "shaders/compare_*.wgsl"] {
        assert!(is_file_name(there) && exists(there, &files), "{there}");
    }
    for gone in ["lost.rs", "lost/", "od.rs", "crates/two", "filter_*.wgsl"] {
        assert!(is_file_name(gone) && !exists(gone, &files), "{gone}");
    }
    for code in ["cargo xtask ci", "shadowfit::fit", "report.md", "Vec<f32>"] {
        assert!(!is_file_name(code), "{code}");
    }
}
