//! The structure of the workspace: which crate may use which, and no circles between the files of a crate.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use syn::visit::{self, Visit};
use syn::{Attribute, Item, ItemMod, ItemUse, Macro, UseTree, VisRestricted};

/// Crates from the ground up: each may use those before it.
const FLOORS: [&str; 14] = [
    "switchback-model",
    "switchback-table",
    "switchback-noise",
    "switchback-identify",
    "switchback-diagnose",
    "switchback-fmu",
    "switchback-io",
    "switchback-host",
    "switchback-study",
    "switchback-versions",
    "switchback-lab",
    "switchback-report",
    "switchback-python",
    "switchback",
];

/// Most source lines of a crate, tests apart.
const MOST_LINES: usize = 14_000;

/// Crates above that, which only may shrink.
const LARGE: [(&str, usize); 3] = [("diagnose", 23_500), ("identify", 15_500), ("lab", 17_200)];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the workspace")
}

#[test]
fn a_crate_uses_only_crates_below_it() {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--format-version", "1", "--offline"])
        .current_dir(root())
        .output()
        .expect("cargo runs");
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("cargo prints JSON");
    let floor = |name: &str| FLOORS.iter().position(|known| *known == name);
    let mut upwards = Vec::new();
    for package in metadata["packages"].as_array().expect("packages") {
        let name = package["name"].as_str().expect("a name");
        let Some(own) = floor(name) else { continue };
        for dependency in package["dependencies"].as_array().expect("dependencies") {
            let used = dependency["name"].as_str().expect("a name");
            if dependency["kind"].is_null() && floor(used).is_some_and(|used| used >= own) {
                upwards.push(format!("{name} → {used}"));
            }
        }
    }
    assert!(upwards.is_empty(), "{upwards:?}");
}

/// The file of a crate that names its modules: of a library, or of the program.
fn root_file(source: &Path) -> PathBuf {
    let library = source.join("lib.rs");
    if library.exists() { library } else { source.join("main.rs") }
}

/// The files of a crate as modules: by its path within the crate, what a module defines, what it takes from where, and what it names.
#[derive(Default)]
struct Modules(BTreeMap<Vec<String>, Module>);

#[derive(Default)]
struct Module {
    defined: BTreeSet<String>,
    /// Names in scope by `use`, with the paths that they stand for.
    imported: BTreeMap<String, Vec<String>>,
    /// Modules taken in by `use path::*`.
    globs: Vec<Vec<String>>,
    /// Every path of the module's code from the root of the crate; what begins with no keyword is looked up in the module.
    named: BTreeSet<Vec<String>>,
}

impl Modules {
    fn of(source: &Path) -> Self {
        let mut modules = Self::default();
        modules.read(&root_file(source), source, Vec::new());
        modules
    }

    fn read(&mut self, file: &Path, folder: &Path, path: Vec<String>) {
        let Ok(text) = fs::read_to_string(file) else { return };
        let parsed = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        let mut reader = Reader { path: path.clone(), module: Module::default(), children: Vec::new() };
        reader.visit_file(&parsed);
        self.0.insert(path.clone(), reader.module);
        for child in reader.children {
            let mut path = path.clone();
            path.push(child.clone());
            let inside = folder.join(&child);
            let file = folder.join(format!("{child}.rs"));
            let file = if file.is_file() { file } else { inside.join("mod.rs") };
            self.read(&file, &inside, path);
        }
    }

    /// The module that defines what a path names, as far as it is one of this crate.
    fn home(&self, path: &[String], depth: usize) -> Option<Vec<String>> {
        let module = (0..=path.len()).rev().map(|k| path[..k].to_vec()).find(|k| self.0.contains_key(k))?;
        // A module's bare name takes nothing from it, but may name what the parent defines or takes in under the same name.
        let module = if module.len() == path.len() { path.split_last()?.1.to_vec() } else { module };
        let (name, rest) = path[module.len()..].split_first()?;
        let found = self.0.get(&module)?;
        if found.defined.contains(name) {
            return Some(module);
        }
        let depth = depth.checked_sub(1)?;
        let target = found.imported.get(name).filter(|target| target[..] != path[..]);
        if let Some(target) = target {
            return self.home(&[&target[..], rest].concat(), depth);
        }
        found
            .globs
            .iter()
            .find_map(|glob| self.home(&[&glob[..], std::slice::from_ref(name), rest].concat(), depth))
    }

    /// Which modules each module takes something from.
    fn arrows(&self) -> BTreeMap<Vec<String>, BTreeSet<Vec<String>>> {
        let taken = |(path, module): (&Vec<String>, &Module)| {
            let named = module.named.iter().filter_map(|name| self.home(name, 8));
            (path.clone(), named.filter(|home| home != path).collect())
        };
        self.0.iter().map(taken).collect()
    }
}

/// Reads a module's syntax.
struct Reader {
    path: Vec<String>,
    module: Module,
    children: Vec<String>,
}

impl Reader {
    /// A path of the code from the root of the crate.
    fn looked_up(&self, path: &[String]) -> Option<Vec<String>> {
        match path.first()?.as_str() {
            "crate" | "self" | "super" => self.absolute(path),
            _ => Some([&self.path[..], path].concat()),
        }
    }

    /// A path from the root of the crate, where it begins there.
    fn absolute(&self, path: &[String]) -> Option<Vec<String>> {
        let (first, rest) = path.split_first()?;
        let base = match first.as_str() {
            "crate" => Vec::new(),
            "self" => self.path.clone(),
            "super" => {
                let ups = 1 + rest.iter().take_while(|word| *word == "super").count();
                let base = self.path[..self.path.len().checked_sub(ups)?].to_vec();
                return Some([base, rest[ups - 1..].to_vec()].concat());
            }
            name if self.children.iter().any(|child| child == name) => {
                return Some([self.path.clone(), path.to_vec()].concat());
            }
            _ => return None,
        };
        Some([base, rest.to_vec()].concat())
    }

    fn import(&mut self, tree: &UseTree, before: &[String]) {
        let with = |name: String| [before.to_vec(), vec![name]].concat();
        match tree {
            UseTree::Path(path) => self.import(&path.tree, &with(path.ident.to_string())),
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.import(tree, before)),
            UseTree::Glob(_) => {
                if let Some(path) = self.absolute(before) {
                    self.module.globs.push(path.clone());
                }
            }
            UseTree::Name(name) => {
                let name = name.ident.to_string();
                let (name, path) = match name.as_str() {
                    "self" => (before.last().cloned().unwrap_or_default(), before.to_vec()),
                    _ => (name.clone(), with(name)),
                };
                self.take(name, &path);
            }
            UseTree::Rename(rename) => self.take(rename.rename.to_string(), &with(rename.ident.to_string())),
        }
    }

    fn take(&mut self, name: String, path: &[String]) {
        if let Some(path) = self.absolute(path) {
            self.module.named.insert(path.clone());
            self.module.imported.insert(name, path);
        }
    }
}

fn is_for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg")
            && attribute.meta.require_list().is_ok_and(|list| list.tokens.to_string() == "test")
    })
}

impl<'ast> Visit<'ast> for Reader {
    fn visit_file(&mut self, file: &'ast syn::File) {
        for item in &file.items {
            if let Item::Mod(child) = item
                && child.content.is_none()
                && !is_for_tests(&child.attrs)
            {
                self.children.push(child.ident.to_string());
            }
        }
        visit::visit_file(self, file);
    }

    fn visit_item(&mut self, item: &'ast Item) {
        let defined = match item {
            Item::Struct(item) => Some(&item.ident),
            Item::Enum(item) => Some(&item.ident),
            Item::Trait(item) => Some(&item.ident),
            Item::Type(item) => Some(&item.ident),
            Item::Const(item) => Some(&item.ident),
            Item::Static(item) => Some(&item.ident),
            Item::Fn(item) => Some(&item.sig.ident),
            Item::Macro(item) => item.ident.as_ref(),
            _ => None,
        };
        self.module.defined.extend(defined.map(ToString::to_string));
        visit::visit_item(self, item);
    }

    fn visit_item_mod(&mut self, item: &'ast ItemMod) {
        if !is_for_tests(&item.attrs) {
            visit::visit_item_mod(self, item);
        }
    }

    fn visit_vis_restricted(&mut self, _: &'ast VisRestricted) {
        // Whom an item is for is nothing that it takes.
    }

    fn visit_macro(&mut self, item: &'ast Macro) {
        // What stands within a macro is no syntax yet, so its paths are read from its words.
        let text = item.tokens.to_string().replace(" :: ", "::").replace(":: ", "::");
        let is_word = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == ':';
        for path in text.split(|letter| !is_word(letter)).filter(|path| path.contains("::")) {
            let words: Vec<String> = path.split("::").map(str::to_owned).collect();
            self.module.named.extend(self.looked_up(&words));
        }
        visit::visit_macro(self, item);
    }

    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        // A re-export is no use of its own: whoever names it leads to where it is defined.
        if matches!(item.vis, syn::Visibility::Inherited) {
            self.import(&item.tree, &[]);
        } else {
            let named = self.module.named.clone();
            self.import(&item.tree, &[]);
            self.module.named = named;
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let words: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        self.module.named.extend(self.looked_up(&words));
        visit::visit_path(self, path);
    }
}

/// Modules that reach themselves.
fn circles(arrows: &BTreeMap<Vec<String>, BTreeSet<Vec<String>>>) -> Vec<String> {
    let reached = |from: &Vec<String>| {
        let mut seen = BTreeSet::new();
        let mut open: Vec<&Vec<String>> = arrows.get(from).into_iter().flatten().collect();
        while let Some(next) = open.pop() {
            if seen.insert(next) {
                open.extend(arrows.get(next).into_iter().flatten());
            }
        }
        seen
    };
    let within = |path: &&Vec<String>| reached(path).contains(path);
    arrows.keys().filter(within).map(|path| path.join("::")).collect()
}

#[test]
fn no_files_of_a_crate_use_each_other_in_circles() {
    let mut found = BTreeMap::new();
    for name in [
        "model", "table", "noise", "identify", "diagnose", "fmu", "io", "host", "study", "versions", "lab",
        "report", "cli", "python",
    ] {
        let modules = Modules::of(&root().join("crates").join(name).join("src"));
        assert!(!modules.0.is_empty(), "{name}");
        let circles = circles(&modules.arrows());
        if !circles.is_empty() {
            found.insert(name, circles);
        }
    }
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn a_circle_through_a_re_export_is_found() {
    let module = |defined: &[&str], named: &[&str], imported: &[(&str, &str)]| {
        let split = |path: &str| path.split("::").map(str::to_owned).collect::<Vec<_>>();
        Module {
            defined: defined.iter().map(|name| (*name).to_owned()).collect(),
            imported: imported.iter().map(|(name, path)| ((*name).to_owned(), split(path))).collect(),
            globs: Vec::new(),
            named: named.iter().map(|path| split(path)).collect(),
        }
    };
    let mut modules = Modules::default();
    modules.0.insert(Vec::new(), module(&[], &[], &[("A", "a::A"), ("B", "b::B")]));
    modules.0.insert(vec!["a".to_owned()], module(&["A"], &["B"], &[]));
    modules.0.insert(vec!["b".to_owned()], module(&["B"], &[], &[]));
    assert!(circles(&modules.arrows()).is_empty());
    modules.0.insert(vec!["b".to_owned()], module(&["B"], &["a::A"], &[]));
    assert_eq!(circles(&modules.arrows()), ["a", "b"]);
    let read = |path: &str, text: &str| {
        let path = vec![path.to_owned()];
        let mut reader = Reader { path, module: Module::default(), children: Vec::new() };
        reader.visit_file(&syn::parse_str(text).expect("Rust"));
        reader.module
    };
    modules.0.insert(vec!["a".to_owned()], read("a", "pub(super) struct A;"));
    modules.0.insert(vec!["b".to_owned()], read("b", "use super::a; pub struct B(a::A); pub struct C;"));
    assert!(circles(&modules.arrows()).is_empty());
    modules.0.insert(vec!["a".to_owned()], read("a", "use super::b; pub struct A; fn f() { g!(b::C); }"));
    assert_eq!(circles(&modules.arrows()), ["a", "b"]);
}

#[test]
fn a_crate_has_one_sentence_of_purpose_and_no_more_lines_than_one_can_know() {
    for entry in fs::read_dir(root().join("crates")).expect("crates") {
        let crate_folder = entry.expect("an entry").path();
        let text = fs::read_to_string(root_file(&crate_folder.join("src"))).expect("a crate");
        let first = text.lines().next().unwrap_or_default();
        assert!(first.starts_with("//! ") && first.ends_with('.'), "{}: {first}", crate_folder.display());
        let lines = source_lines(&crate_folder.join("src"));
        let large = LARGE.iter().find(|(name, _)| crate_folder.ends_with(name));
        let most = large.map_or(MOST_LINES, |(_, most)| *most);
        assert!(lines <= most, "{}: {lines} lines", crate_folder.display());
    }
}

/// Lines of Rust below a folder, without modules of tests.
fn source_lines(folder: &Path) -> usize {
    let mut lines = 0;
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() {
            lines += if name == "tests" { 0 } else { source_lines(&path) };
        } else if name.ends_with(".rs") && name != "tests.rs" && !name.ends_with("_tests.rs") {
            let text = fs::read_to_string(&path).expect("a source");
            let end = text.find("#[cfg(test)]\nmod tests {").unwrap_or(text.len());
            lines += text[..end].lines().count();
        }
    }
    lines
}
