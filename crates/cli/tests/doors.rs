//! Where bytes come in and go out: one place opens what is read, one what is written, one keeps processes, and each format of text has one place
//! that knows what must be escaped in it.

use proc_macro2::TokenStream;
use std::fs;
use std::path::{Path, PathBuf};
use syn::visit::{self, Visit};
use syn::{Attribute, Item, Macro, UseTree};

/// Sources that may do what no other may, with what they do it for.
const DOORS: [(&str, &str); 7] = [
    ("crates/table/src/door.rs", "files and folders that are read"),
    ("crates/table/src/stream.rs", "streams, the standard input among them"),
    (
        "crates/io/src/output/",
        "files, folders and words that are written; the script that `launch --submit` runs",
    ),
    ("crates/host/src/", "processes of FMUs, their pipes and folders"),
    (
        "crates/fmu/src/exports.rs",
        "the library inside an exported FMU, which reads its own resources in another program",
    ),
    ("crates/cli/src/main.rs", "the command line"),
    ("crates/io/src/provenance.rs", "the command line, as it is written down"),
];

/// Paths that open, read, write or begin something: a path that ends in one of these, one that holds it, is refused outside of the doors.
const OPENING: [&str; 16] = [
    "fs::*",
    "File::open",
    "File::create",
    "File::create_new",
    "File::options",
    "OpenOptions::*",
    "process::Command",
    "Command::new",
    "env::var",
    "env::var_os",
    "env::vars",
    "env::args",
    "env::args_os",
    "env::current_exe",
    "io::stdin",
    "net::*",
];

/// Paths of the standard streams that words go to.
const STREAMS: [&str; 2] = ["io::stdout", "io::stderr"];

const PRINTING: [&str; 5] = ["print", "println", "eprint", "eprintln", "dbg"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the workspace")
}

/// Sources of the crates, by their paths in the workspace, without tests.
fn sources() -> Vec<(String, String)> {
    fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if path.is_dir() {
                if name != "tests" {
                    collect(&path, found);
                }
            } else if name.ends_with(".rs") && name != "tests.rs" && !name.ends_with("_tests.rs") {
                found.push(path);
            }
        }
    }
    let mut found = Vec::new();
    for entry in fs::read_dir(root().join("crates")).expect("crates") {
        collect(&entry.expect("an entry").path().join("src"), &mut found);
    }
    found.sort();
    let named = |path: PathBuf| {
        let name = path.strip_prefix(root()).expect("within the workspace").display().to_string();
        (name, fs::read_to_string(&path).expect("a source"))
    };
    found.into_iter().map(named).collect()
}

/// All paths that the code of a source names, and the macros that it calls.
#[derive(Default)]
struct Named(Vec<String>);

impl Named {
    fn of(text: &str) -> Self {
        let mut named = Self::default();
        named.visit_file(&syn::parse_file(text).expect("Rust"));
        named
    }

    fn import(&mut self, tree: &UseTree, before: &str) {
        match tree {
            UseTree::Path(path) => self.import(&path.tree, &format!("{before}{}::", path.ident)),
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.import(tree, before)),
            UseTree::Name(name) if name.ident == "self" => {
                self.0.push(before.trim_end_matches(':').to_owned())
            }
            UseTree::Name(name) => self.0.push(format!("{before}{}", name.ident)),
            UseTree::Rename(name) => self.0.push(format!("{before}{}", name.ident)),
            UseTree::Glob(_) => self.0.push(format!("{before}*")),
        }
    }

    /// Paths in the arguments of a macro, where the syntax is the macro's own.
    fn tokens(&mut self, tokens: TokenStream) {
        let text: String = tokens.to_string().split_whitespace().collect();
        let letters = |c: char| !(c.is_alphanumeric() || c == '_' || c == ':');
        self.0.extend(text.split(letters).filter(|word| word.contains("::")).map(str::to_owned));
    }
}

fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|a| {
        a.path().is_ident("cfg") && a.meta.require_list().is_ok_and(|l| l.tokens.to_string() == "test")
    })
}

impl<'ast> Visit<'ast> for Named {
    fn visit_item(&mut self, item: &'ast Item) {
        match item {
            Item::Mod(module) if is_test(&module.attrs) => {}
            Item::Use(item) => self.import(&item.tree, ""),
            item => visit::visit_item(self, item),
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let words: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        self.0.push(words.join("::"));
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, mac: &'ast Macro) {
        let name = mac.path.segments.last().map_or_else(String::new, |segment| segment.ident.to_string());
        self.0.push(format!("{name}!"));
        self.tokens(mac.tokens.clone());
    }
}

/// Whether a path is one of these, however it is begun: `fs::*` stands for all in `fs`, and for a `fs` that is taken in.
fn is_one_of(path: &str, list: &[&str]) -> bool {
    let is = |wanted: &&str| {
        let (module, any) = wanted.strip_suffix("::*").map_or((*wanted, false), |module| (module, true));
        let whole = path == module || path.ends_with(&format!("::{module}"));
        let begins = |path: &str| any && path.starts_with(&format!("{module}::"));
        // A module of ours may be called so, too.
        let is_ours =
            path.starts_with("crate::") || path.starts_with("super::") || path.starts_with("self::");
        let is_std = path.starts_with(&format!("std::{module}::"));
        !is_ours && (begins(path) || (any && is_std) || (whole && (!any || path.starts_with("std::"))))
    };
    list.iter().any(is)
}

fn is_door(source: &str) -> bool {
    DOORS.iter().any(|(door, _)| source == *door || (door.ends_with('/') && source.starts_with(door)))
}

/// What a source does that only doors may.
fn trespasses(source: &str, text: &str) -> Vec<String> {
    if is_door(source) {
        return Vec::new();
    }
    let named = Named::of(text);
    let is_printing = |path: &str| PRINTING.iter().any(|name| path == format!("{name}!"));
    let is_wrong =
        |path: &&String| is_one_of(path, &OPENING) || is_one_of(path, &STREAMS) || is_printing(path);
    named.0.iter().filter(is_wrong).map(|path| format!("{source}: {path}")).collect()
}

#[test]
fn only_the_doors_open_read_write_and_begin_anything() {
    let found: Vec<String> = sources().iter().flat_map(|(source, text)| trespasses(source, text)).collect();
    assert!(
        found.is_empty(),
        "take a function of switchback_io::input or ::output instead:\n{}",
        found.join("\n")
    );
    for (door, _) in DOORS {
        assert!(sources().iter().any(|(source, _)| source.starts_with(door)), "{door} is no source any more");
    }
}

#[test]
fn every_way_past_a_door_is_seen() {
    let seen = |code: &str| !trespasses("crates/cli/src/cmd/a.rs", code).is_empty();
    for code in [
        "fn f() { let _ = std::fs::read(\"a\"); }",
        "use std::fs; fn f() { let _ = fs::write(\"a\", \"b\"); }",
        "use std::fs::read_to_string as r; fn f() { let _ = r(\"a\"); }",
        "use std::fs::*;",
        "use std::{fs::{self, File}, io};",
        "fn f() { let _ = File::open(\"a\"); }",
        "fn f() { let _ = std::fs::OpenOptions::new(); }",
        "use std::process::Command;",
        "use std::process; fn f() { process::Command::new(\"a\"); }",
        "fn f() { println!(\"a\"); }",
        "fn f() { let _ = writeln!(std::io::stderr(), \"a\"); }",
        "use std::io; fn f() { let _ = io::stdin().lines(); }",
        "fn f() { assert!(std::env::var(\"HOME\").is_ok()); }",
        "fn f() { let _ = std::net::TcpStream::connect(\"a\"); }",
    ] {
        assert!(seen(code), "{code}");
    }
    for code in [
        "use switchback_io::input::read_text; fn f() { let _ = read_text(p); }",
        "#[cfg(test)] mod tests { use std::fs; fn f() { fs::read(\"a\"); println!(); } }",
        "fn f() -> std::process::ExitCode { std::process::exit(1) }",
        "// std::fs::read\nfn f() { let _ = \"std::fs::read\"; }",
    ] {
        assert!(!seen(code), "{code}");
    }
}

/// Markdown; SVG; the XML of an exported FMU, by a crate on its own; and tests that read figures.
const MARKUP: [&str; 4] = [
    "crates/io/src/output/text.rs",
    "crates/report/src/plots/canvas.rs",
    "crates/fmu/src/description.rs",
    "crates/report/src/plots/inspect.rs",
];

/// Marks of a home-made escape, or of a way around one, with the sources that may have them.
const ESCAPES: [(&str, &[&str]); 7] = [
    ("PreEscaped", &["crates/report/src/pages/layout.rs", "crates/report/src/pages/sheet.rs"]),
    ("Escaper", &["crates/report/src/pages/drawing.rs"]),
    ("SVGBackend", &["crates/report/src/plots/canvas.rs"]),
    ("&lt;", &MARKUP),
    ("&amp;", &MARKUP),
    ("'\\\\''", &["crates/table/src/shell.rs"]),
    ("\\u{1b}", &[]),
];

#[test]
fn each_format_of_text_is_escaped_in_one_place() {
    let mut found = Vec::new();
    for (source, text) in sources() {
        let end = text.find("#[cfg(test)]\nmod tests {").unwrap_or(text.len());
        let code = text[..end].lines().filter(|line| !line.trim_start().starts_with("//"));
        let code = code.collect::<Vec<_>>().join("\n");
        let marks =
            ESCAPES.iter().filter(|(mark, places)| code.contains(mark) && !places.contains(&source.as_str()));
        found.extend(marks.map(|(mark, _)| format!("{source}: {mark}")));
    }
    assert!(found.is_empty(), "escape where the others do:\n{}", found.join("\n"));
}
