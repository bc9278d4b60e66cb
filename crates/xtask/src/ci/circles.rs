//! Import cycles: files that use each other's items, so that none can be read without the others. Rooms are
//! counted in the same way: a room is a folder or a file directly below `src`, with all of its files. The
//! check fails if a number grows, and also if an accepted number is too high, so that both numbers only fall.
//!
//! The files of each crate are scanned as text, without tests. An import or a path is an edge from its file
//! to the file of the item. Re-exports are followed to the item, unless a module on the way has items of its
//! own. Items of parent modules' files create no edge.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use anyhow::{Result, ensure};

use crate::machine::Machine;
use crate::source::{is_part_of_word, texts, without_comments, without_tests};

/// Number of remaining circles of files. The goal is 0.
const ACCEPTED: usize = 0;

/// Number of remaining rooms in circles, in all crates. The goal is 0.
const ACCEPTED_ROOMS: usize = 0;

/// Longest chain of re-exports. A longer chain is a loop: a name of another crate, which resolves to itself.
const MAX_HOPS: usize = 8;

/// Keywords before the name of an item.
const ITEM_WORDS: [&str; 8] = ["fn", "struct", "enum", "trait", "const", "static", "type", "union"];

/// Names from the crate's root to a module or an item.
type Names<'a> = Vec<&'a str>;

/// The names in a module.
#[derive(Default)]
struct Module<'a> {
    file: &'a str,
    items: BTreeSet<&'a str>,
    /// Names that `use` imports, with their paths.
    imports: BTreeMap<&'a str, Names<'a>>,
    /// Modules that `use` imports with `*`.
    globs: Vec<Names<'a>>,
}

/// A position in the code that names an item.
struct Mention<'a> {
    file: &'a str,
    module: Names<'a>,
    path: Names<'a>,
    line: usize,
}

/// The modules of a crate, by their names from its root.
#[derive(Default)]
struct Modules<'a> {
    modules: BTreeMap<Names<'a>, Module<'a>>,
    mentions: Vec<Mention<'a>>,
}

/// A token and its line number.
type Token<'a> = (&'a str, usize);

/// The files that each file uses, with the first mention of each.
type Edges<'a> = BTreeMap<&'a str, BTreeMap<&'a str, &'a Mention<'a>>>;

/// Counts the circles of all crates.
pub(super) fn check(_: &Machine) -> Result<()> {
    let (mut files, mut rooms) = (Vec::new(), Vec::new());
    let mut list = String::new();
    for (name, codes) in &crates()? {
        let modules = Modules::of(codes);
        let edges = modules.edges();
        for circle in circles(&edges) {
            let _ = write!(list, "{name}:\n{}", described(&circle, &edges));
            files.push(circle.len());
        }
        let edges = edges_of_rooms(&edges);
        for circle in circles(&edges) {
            let _ = write!(list, "{name}, {} rooms:\n{}", circle.len(), described(&circle, &edges));
            rooms.push(circle.len());
        }
    }
    for (count, accepted, what) in
        [(files.len(), ACCEPTED, "circles of files"), (rooms.iter().sum(), ACCEPTED_ROOMS, "rooms in circles")]
    {
        ensure!(count <= accepted, "{count} {what}, where {accepted} are accepted:\n{list}");
        ensure!(count == accepted, "{count} {what} are left: lower the accepted number in {} to {count}", file!());
        println!("{count} {what} are left");
    }
    print!("{list}");
    Ok(())
}

/// Reads the files of each crate without comments and tests, by their names below the crate's source folder.
/// A folder with a `main.rs` is another crate.
fn crates() -> Result<BTreeMap<String, BTreeMap<String, String>>> {
    let mut crates: BTreeMap<String, BTreeMap<String, String>> = BTreeMap::new();
    let texts = texts("crates")?;
    for (name, text) in &texts {
        let Some((crate_name, file)) = name.split_once("/src/") else { continue };
        let program = file
            .split_once('/')
            .filter(|(folder, _)| texts.contains_key(&format!("{crate_name}/src/{folder}/main.rs")));
        let (crate_name, file) = match program {
            Some((folder, file)) => (format!("{crate_name}/src/{folder}"), file),
            None => (format!("{crate_name}/src"), file),
        };
        let code = without_tests(&without_comments(text));
        crates.entry(crate_name).or_default().insert(file.to_owned(), code);
    }
    Ok(crates)
}

/// Returns the rooms that each room uses. The crate's root is not a room.
fn edges_of_rooms<'a>(edges: &Edges<'a>) -> Edges<'a> {
    let mut rooms = Edges::new();
    for (from, named) in edges {
        for (to, mention) in named {
            let (from, to) = (room(from), room(to));
            if from != to && ![from, to].iter().any(|room| ["lib", "main"].contains(room)) {
                rooms.entry(from).or_default().entry(to).or_insert(mention);
            }
        }
    }
    rooms
}

/// Returns the room of a file.
fn room(file: &str) -> &str {
    file.split_once('/').map_or_else(|| file.trim_end_matches(".rs"), |(folder, _)| folder)
}

impl<'a> Modules<'a> {
    /// Reads the modules that the crate's root declares, recursively.
    fn of(codes: &'a BTreeMap<String, String>) -> Self {
        let mut crate_modules = Self::default();
        let mut declared: Vec<(String, Names)> = ["lib.rs", "main.rs"].map(|root| (root.to_owned(), Vec::new())).into();
        while let Some((name, module)) = declared.pop() {
            if let Some((file, code)) = codes.get_key_value(&name) {
                declared.extend(crate_modules.read(file, code, module).into_iter().flat_map(|child| {
                    let path = child.join("/");
                    [(format!("{path}.rs"), child.clone()), (format!("{path}/mod.rs"), child)]
                }));
            }
        }
        crate_modules
    }

    /// Reads a file, which is the module `module`. Returns the modules that it declares.
    fn read(&mut self, file: &'a str, code: &'a str, module: Names<'a>) -> Vec<Names<'a>> {
        let tokens = tokens(code);
        let mut declared = Vec::new();
        // Modules around the token, each with the depth of braces within it.
        let mut around = vec![(module.clone(), 0)];
        let mut depth = 0;
        self.modules.entry(module).or_default().file = file;
        let mut at = 0;
        while at < tokens.len() {
            let before = if at == 0 { "" } else { tokens[at - 1].0 };
            let (token, line) = tokens[at];
            let [after, after_next] = [1, 2].map(|n| tokens.get(at + n).map_or("", |token| token.0));
            let inner = around[around.len() - 1].0.clone();
            at += 1;
            match token {
                "{" => depth += 1,
                "}" => {
                    depth -= 1;
                    around.retain(|(_, within)| *within <= depth);
                }
                "mod" if after_next == ";" => declared.push([&inner[..], &[after]].concat()),
                "mod" if after_next == "{" => {
                    let module = [&inner[..], &[after]].concat();
                    self.modules.entry(module.clone()).or_default().file = file;
                    around.push((module, depth + 1));
                }
                "use" if after != "<" => {
                    let end = at + tokens[at..].iter().position(|token| token.0 == ";").unwrap_or(0);
                    self.read_imports(&inner, &tokens[at..=end]);
                    at = end;
                }
                "macro_rules" => {
                    self.modules.entry(inner).or_default().items.insert(after_next);
                }
                _ if ITEM_WORDS.contains(&token) && after.starts_with(is_part_of_word) => {
                    self.modules.entry(inner).or_default().items.insert(after);
                }
                // A path in the code, but not the path of `pub(in path)`.
                _ if after == "::" && token.starts_with(is_part_of_word) && !["::", ".", "in"].contains(&before) => {
                    let names = path_at(&tokens[at - 1..]);
                    at += 2 * (names.len() - 1);
                    self.mentions.push(Mention { file, path: from_root(&inner, &names), module: inner, line });
                }
                _ => {}
            }
        }
        declared
    }

    /// Reads the imports of a `use`. `tokens` are the tokens after the keyword, up to its semicolon.
    fn read_imports(&mut self, module: &Names<'a>, tokens: &[Token<'a>]) {
        let mut prefixes: Vec<Names> = vec![Vec::new()];
        let (mut names, mut alias): (Names, Option<&str>) = (Vec::new(), None);
        for (index, &(token, line)) in tokens.iter().enumerate() {
            match token {
                "::" | "as" => {}
                "{" => prefixes.push(names.clone()),
                "," | "}" | ";" => {
                    if prefixes.last().is_some_and(|prefix| names.len() > prefix.len()) {
                        self.import(module, &names, alias.take(), line);
                    }
                    if token == "}" {
                        prefixes.pop();
                    }
                    names = prefixes.last().cloned().unwrap_or_default();
                }
                _ if index > 0 && tokens[index - 1].0 == "as" => alias = Some(token),
                _ => names.push(token),
            }
        }
    }

    fn import(&mut self, module: &Names<'a>, names: &[&'a str], alias: Option<&'a str>, line: usize) {
        let mut path = from_root(module, names);
        let importing = self.modules.entry(module.clone()).or_default();
        if path.pop_if(|last| *last == "*").is_some() {
            importing.globs.push(path);
        } else if let Some(name) = alias.or(path.last().copied()) {
            importing.imports.insert(name, path.clone());
            let file = importing.file;
            self.mentions.push(Mention { file, module: module.clone(), path, line });
        }
    }

    /// Returns the file of the item that a mention names, or `None` for modules and other crates. Follows
    /// re-exports through modules without their own items, and through the modules around the mention.
    fn file_of(&self, mention: &Mention<'a>) -> Option<&'a str> {
        let mut path = mention.path.clone();
        for _ in 0..MAX_HOPS {
            let known = (0..=path.len()).rev().find(|&length| self.modules.contains_key(&path[..length]))?;
            let (names, module) = (&path[..known], &self.modules[&path[..known]]);
            let name = *path.get(known)?;
            let from_glob = |glob: &Names<'a>| {
                let has_it = |module: &Module| module.items.contains(name) || module.imports.contains_key(name);
                self.modules.get(glob).is_some_and(has_it).then(|| [&glob[..], &[name]].concat())
            };
            let import = module.imports.get(name).cloned().or_else(|| module.globs.iter().find_map(from_glob));
            let is_followed = module.items.is_empty() || mention.module.starts_with(names);
            match import {
                Some(import) if is_followed => path = [&import[..], &path[known + 1..]].concat(),
                _ => return Some(module.file),
            }
        }
        None
    }

    fn edges(&self) -> Edges<'_> {
        let mut edges = Edges::new();
        for mention in &self.mentions {
            let Some(named) = self.file_of(mention) else { continue };
            let mut around = (0..=mention.module.len()).map(|length| self.modules[&mention.module[..length]].file);
            if !around.any(|file| file == named) {
                let file = self.modules[&mention.module].file;
                edges.entry(file).or_default().entry(named).or_insert(mention);
            }
        }
        edges
    }
}

/// Returns the words, double colons and other characters of a text, each with its line number.
fn tokens(code: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    for (index, mut rest) in code.lines().enumerate() {
        while let Some(next) = rest.chars().next() {
            let word = rest.len() - rest.trim_start_matches(is_part_of_word).len();
            let length = if rest.starts_with("::") { 2 } else { word.max(next.len_utf8()) };
            if !next.is_whitespace() {
                tokens.push((&rest[..length], index + 1));
            }
            rest = &rest[length..];
        }
    }
    tokens
}

/// Returns the names of the path that begins with the first token.
fn path_at<'a>(tokens: &[Token<'a>]) -> Names<'a> {
    let pairs = tokens[1..].chunks_exact(2);
    let further = pairs.take_while(|pair| pair[0].0 == "::" && pair[1].0.starts_with(is_part_of_word));
    tokens.iter().take(1).chain(further.map(|pair| &pair[1])).map(|token| token.0).collect()
}

/// Resolves a path in a module to names from the crate's root.
fn from_root<'a>(module: &[&'a str], path: &[&'a str]) -> Names<'a> {
    let mut names = module.to_vec();
    for name in path {
        match *name {
            "crate" => names.clear(),
            "self" => {}
            "super" => drop(names.pop()),
            name => names.push(name),
        }
    }
    names
}

/// Returns the sets of files that reach each other.
fn circles<'a>(edges: &Edges<'a>) -> Vec<BTreeSet<&'a str>> {
    let reached: BTreeMap<&str, BTreeSet<&str>> = edges.keys().map(|file| (*file, reached_from(file, edges))).collect();
    let mut circles: Vec<BTreeSet<&str>> = Vec::new();
    for (file, others) in &reached {
        if others.contains(file) && !circles.iter().any(|circle| circle.contains(file)) {
            let leads_back = |other: &&str| reached.get(other).is_some_and(|back| back.contains(file));
            circles.push(others.iter().copied().filter(leads_back).collect());
        }
    }
    circles
}

fn reached_from<'a>(file: &'a str, edges: &Edges<'a>) -> BTreeSet<&'a str> {
    let mut reached = BTreeSet::new();
    let mut open = vec![file];
    while let Some(file) = open.pop() {
        let named = edges.get(file).into_iter().flat_map(|named| named.keys().copied());
        open.extend(named.filter(|named| reached.insert(*named)));
    }
    reached
}

/// Returns the first position of each import within a circle, one per line.
fn described(circle: &BTreeSet<&str>, edges: &Edges) -> String {
    let mut lines = String::new();
    for named in circle.iter().filter_map(|name| edges.get(name)) {
        for (other, Mention { file, path, line, .. }) in named.iter().filter(|(other, _)| circle.contains(*other)) {
            let name = path.last().copied().unwrap_or_default();
            let _ = writeln!(lines, "    {file}:{line} names {name} of {other}");
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the circles of a crate, given by the names and texts of its files.
    fn circles_of(files: &[(&str, &str)]) -> Vec<Vec<String>> {
        let codes = files.iter().map(|(name, text)| ((*name).to_owned(), without_tests(text))).collect();
        let modules = Modules::of(&codes);
        let owned = |circle: BTreeSet<&str>| circle.into_iter().map(str::to_owned).collect();
        circles(&modules.edges()).into_iter().map(owned).collect()
    }

    #[test]
    fn files_that_import_each_other_are_a_circle() {
        let lib = ("lib.rs", "mod a;\nmod b;\nmod c;\nmod d;");
        let (a, c) = (("a.rs", "use crate::b::{self, B, inner::{X, Y}};"), ("c.rs", "fn c() { crate::a::f(); }"));
        let others = [
            ("use super::c::c;", 1),
            ("use super::{c as _, d};", 0),
            ("fn f() { super::c::c() }", 1),
            ("use crate::c as e; fn f() { e::c() }", 1),
            ("use crate::c::c as e;", 1),
            ("#[cfg(test)]\nmod tests { use super::super::c::c; }", 0),
        ];
        for (b, count) in others {
            let circles = circles_of(&[lib, a, ("b.rs", b), c, ("d.rs", "use crate::a::f;")]);
            assert_eq!(circles, vec![vec!["a.rs", "b.rs", "c.rs"]; count], "{b}");
        }
    }

    #[test]
    fn rooms_that_name_each_other_are_a_circle_though_no_file_is_in_one() {
        let lib = ("lib.rs", "mod a;\nmod b;");
        let (a, b) = (("a/mod.rs", "mod x;\nmod y;"), ("b/mod.rs", "mod x;\nmod y;"));
        let x_of_a = ("a/x.rs", "use crate::b::x::X;");
        let files = [lib, a, b, x_of_a, ("a/y.rs", "pub struct Y;"), ("b/x.rs", "pub struct X;")];
        for (y_of_b, rooms) in [("use crate::a::y::Y;", &["a", "b"][..]), ("use super::x::X;", &[])] {
            let last = ("b/y.rs", y_of_b);
            let files = files.iter().chain([&last]);
            let codes = files.map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect();
            let modules = Modules::of(&codes);
            let edges = modules.edges();
            assert!(circles(&edges).is_empty());
            let found: Vec<&str> = circles(&edges_of_rooms(&edges)).into_iter().flatten().collect();
            assert_eq!(found, rooms, "{y_of_b}");
        }
    }

    #[test]
    fn re_exports_lead_to_the_file_of_the_item() {
        let lib = ("lib.rs", "mod a;\nmod b { pub mod c; mod d; pub use d::D; }\npub use a::A;\npub struct Root;");
        let (a, d) = (("a.rs", "use crate::b::D;"), ("b/d.rs", "use crate::A;"));
        assert_eq!(circles_of(&[lib, a, ("b/c.rs", "use crate::Root;"), d]), [["a.rs", "b/d.rs"]]);
        assert!(circles_of(&[lib, a, ("b/c.rs", "use crate::A;"), ("b/d.rs", "")]).is_empty());
    }

    #[test]
    fn a_module_with_items_of_its_own_counts_as_the_file() {
        let lib = ("lib.rs", "mod a;\nmod b;");
        let (a, leaf) =
            (("a.rs", "use crate::b::LEAF;\npub const A: u8 = 0;"), ("b/leaf.rs", "pub const LEAF: u8 = 0;"));
        let facade = "mod leaf;\nmod user;\npub use leaf::LEAF;";
        let user = ("b/user.rs", "use crate::a::A;\npub fn user() {}");
        assert!(circles_of(&[lib, a, leaf, user, ("b/mod.rs", facade)]).is_empty());
        let with_code = format!("{facade}\nfn f() {{ user::user() }}");
        assert_eq!(circles_of(&[lib, a, leaf, user, ("b/mod.rs", &with_code)]), [["a.rs", "b/mod.rs", "b/user.rs"]]);
    }

    #[test]
    fn a_file_may_name_items_of_the_files_above_it() {
        let above = ("a.rs", "mod b;\nuse b::B;\npub struct A;");
        assert!(circles_of(&[("main.rs", "mod a;"), above, ("a/b.rs", "use super::A;")]).is_empty());
    }
}
