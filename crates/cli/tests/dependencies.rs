//! What the program depends on is what `deny.toml` allows: licences, sources, and no library in two versions.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

/// `deny.toml`, as far as it is checked here.
struct Rules {
    licences: BTreeSet<String>,
    registries: BTreeSet<String>,
    in_several_versions: BTreeSet<String>,
}

impl Rules {
    fn parse(text: &str) -> Self {
        let file: toml::Table = text.parse().expect("deny.toml is TOML");
        let list = |table: &str, key: &str| file[table][key].as_array().expect("a list").clone();
        let texts = |values: Vec<toml::Value>| -> BTreeSet<String> {
            values.iter().map(|value| value.as_str().expect("a text").to_owned()).collect()
        };
        let skipped = list("bans", "skip").iter().map(|entry| entry["name"].clone()).collect();
        Self {
            licences: texts(list("licenses", "allow")),
            registries: texts(list("sources", "allow-registry")),
            in_several_versions: texts(skipped),
        }
    }

    /// All that is not as it should be.
    fn violations(&self, packages: &[Value]) -> Vec<String> {
        let text = |package: &Value, key: &str| package[key].as_str().unwrap_or_default().to_owned();
        let mut wrong = Vec::new();
        let mut versions: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for package in packages {
            let (name, version) = (text(package, "name"), text(package, "version"));
            let licence = text(package, "license");
            if !self.permits(&licence) {
                wrong.push(format!(
                    "{name} {version} is licensed `{licence}`, which deny.toml does not allow"
                ));
            }
            // Packages of this repository have no source.
            let source = text(package, "source");
            let registry = source.strip_prefix("registry+").unwrap_or(&source);
            if !(package["source"].is_null() || self.registries.contains(registry)) {
                wrong.push(format!("{name} {version} comes from `{source}`"));
            }
            versions.entry(name).or_default().insert(version);
        }
        for (name, versions) in versions {
            if (versions.len() > 1) != self.in_several_versions.contains(&name) {
                wrong.push(format!("{name} is here as {versions:?}: bans.skip in deny.toml says otherwise"));
            }
        }
        wrong
    }

    fn permits(&self, licence: &str) -> bool {
        // Old manifests write a slash for OR.
        let expression = spdx::Expression::parse_mode(licence, spdx::ParseMode::LAX);
        expression.is_ok_and(|expression| expression.evaluate(|one| self.licences.contains(&one.to_string())))
    }
}

fn rules() -> Rules {
    Rules::parse(&std::fs::read_to_string(root().join("deny.toml")).expect("deny.toml"))
}

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

/// Every package that is built here, for tests too, with all features.
fn packages() -> Vec<Value> {
    let host = Command::new("rustc").arg("-vV").output().expect("rustc");
    let host = String::from_utf8(host.stdout).expect("UTF-8");
    let host = host.lines().find_map(|line| line.strip_prefix("host: ")).expect("a host");
    let arguments = ["metadata", "--format-version", "1", "--locked", "--offline", "--all-features"];
    let output = Command::new(env!("CARGO"))
        .args(arguments)
        .args(["--filter-platform", host])
        .current_dir(root())
        .output()
        .expect("cargo");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    metadata["packages"].as_array().expect("packages").clone()
}

#[test]
fn what_is_depended_on_is_allowed() {
    let packages = packages();
    assert!(packages.len() > 100, "{} packages", packages.len());
    let wrong = rules().violations(&packages);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Libraries with the features that a build of some packages gives them.
fn features(of: &[&str]) -> BTreeSet<String> {
    let edges = ["--edges", "normal,build,dev", "--prefix", "none", "--format", "{p}|{f}"];
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--locked", "--offline"])
        .args(edges)
        .args(of)
        .current_dir(root())
        .output()
        .expect("cargo");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    let lines = text.lines().filter(|line| !line.starts_with("switchback-python"));
    lines.map(|line| line.replace(" (*)", "").replace(" (proc-macro)", "")).collect()
}

#[test]
fn the_wheel_is_built_from_the_libraries_of_the_workspace() {
    let program = "switchback/matlab,switchback/mcap,switchback/mdf,switchback/parquet";
    let workspace = features(&["--workspace", "--features", program]);
    let wheel = features(&["--package", "switchback-python", "--features", "matlab,mcap,mdf,parquet"]);
    assert!(wheel.len() > 100, "{} libraries", wheel.len());
    let others: Vec<&String> = wheel.difference(&workspace).collect();
    assert!(others.is_empty(), "crates/python/Cargo.toml has not all features of {others:#?}");
}

#[test]
fn what_is_not_allowed_is_reported() {
    let crates_io = "registry+https://github.com/rust-lang/crates.io-index";
    let package = |name: &str, version: &str, licence: &str, source: &str| serde_json::json!({ "name": name, "version": version, "license": licence, "source": source });
    let reported = |package: Value| rules().violations(&[package]).join("\n");
    assert_eq!(reported(package("a", "1.0.0", "GPL-3.0-only OR MIT", crates_io)), "");
    assert_eq!(reported(package("a", "1.0.0", "Unlicense/MIT", crates_io)), "");
    assert!(reported(package("a", "1.0.0", "GPL-3.0-only", crates_io)).contains("`GPL-3.0-only`"));
    assert!(reported(package("a", "1.0.0", "MIT AND GPL-3.0-only", crates_io)).contains("not allow"));
    assert!(reported(package("a", "1.0.0", "", crates_io)).contains("``"));
    assert!(reported(package("a", "1.0.0", "MIT", "git+https://example.org/a")).contains("comes from `git+"));
    let twice = [package("a", "1.0.0", "MIT", crates_io), package("a", "2.0.0", "MIT", crates_io)];
    assert!(rules().violations(&twice).join("\n").contains("a is here as {\"1.0.0\", \"2.0.0\"}"));
    // A line of bans.skip that is no longer needed goes.
    assert!(reported(package("glam", "1.0.0", "MIT", crates_io)).contains("glam"));
}
