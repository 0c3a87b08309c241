//! The separation that the product rests on: the truth depends on nothing that samples light, does I/O or runs threads.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use toml::{Table, Value};

const MANIFEST: &str = env!("CARGO_MANIFEST_DIR");

/// What the truth may depend on, directly.
const ALLOWED: [&str; 2] = ["libm", "serde"];

/// All that these pull in; what `serde_derive` needs runs in the compiler only.
const ALLOWED_CLOSURE: [&str; 8] = [
    "libm",
    "proc-macro2",
    "quote",
    "serde",
    "serde_core",
    "serde_derive",
    "syn",
    "unicode-ident",
];

fn toml_file(name: &str) -> Table {
    let text = fs::read_to_string(Path::new(MANIFEST).join(name)).expect("a file");
    text.parse().expect("TOML")
}

/// Names of a manifest's dependencies in a table of that name, for any target as well.
fn dependencies(manifest: &Table, kind: &str) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    let mut add = |table: Option<&Value>| {
        let table = table.and_then(|t| t.get(kind)).and_then(Value::as_table);
        names.extend(table.into_iter().flatten().map(|(name, _)| name.clone()));
    };
    add(Some(&Value::Table(manifest.clone())));
    if let Some(targets) = manifest.get("target").and_then(Value::as_table) {
        targets.values().for_each(|t| add(Some(t)));
    }
    names
}

/// Every package that the lock file reaches from the given ones.
fn locked_closure(lock: &Table, roots: &BTreeSet<String>) -> BTreeSet<String> {
    let packages = lock["package"].as_array().expect("packages");
    let mut open: Vec<String> = roots.iter().cloned().collect();
    let mut seen = BTreeSet::new();
    while let Some(name) = open.pop() {
        if !seen.insert(name.clone()) {
            continue;
        }
        let found = packages
            .iter()
            .filter(|p| p["name"].as_str() == Some(&name));
        for list in found.filter_map(|p| p.get("dependencies")) {
            let list = list.as_array().expect("dependencies");
            // An entry is `name` or `name version`.
            let names = list.iter().filter_map(|d| d.as_str()?.split(' ').next());
            open.extend(names.map(str::to_owned));
        }
    }
    seen
}

fn set(names: &[&str]) -> BTreeSet<String> {
    names.iter().map(|&n| n.to_owned()).collect()
}

#[test]
fn the_truth_depends_on_libm_and_serde_only() {
    let manifest = toml_file("analytic/Cargo.toml");
    let direct = dependencies(&manifest, "dependencies");
    assert_eq!(direct, set(&ALLOWED));
    assert!(dependencies(&manifest, "build-dependencies").is_empty());
    assert!(!Path::new(MANIFEST).join("analytic/build.rs").exists());
    let lock = toml_file("Cargo.lock");
    let closure = locked_closure(&lock, &direct);
    let extra: Vec<_> = closure
        .difference(&set(&ALLOWED_CLOSURE))
        .cloned()
        .collect();
    assert!(extra.is_empty(), "analytic pulls in {extra:?}");
    // The check has teeth: the root crate does depend on what is forbidden here.
    let root = dependencies(&toml_file("Cargo.toml"), "dependencies");
    let root = locked_closure(&lock, &root);
    assert!(root.contains("rayon") && root.contains("nephroid-analytic"));
}

fn sources(directory: &Path, into: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(directory).expect("a directory") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            sources(&path, into);
        } else if path.extension().is_some_and(|e| e == "rs") {
            into.push(path);
        }
    }
}

/// What is in the code of a file: comments and the text of tests aside.
fn code(text: &str) -> String {
    text.split("#[cfg(test)]")
        .next()
        .unwrap_or_default()
        .lines()
        .map(|line| line.split("//").next().unwrap_or_default())
        .collect::<Vec<_>>()
        .join("\n")
}

/// Words that mean input, output, threads, clocks or chance.
const FORBIDDEN: [&str; 18] = [
    "std::fs",
    "std::io",
    "std::net",
    "std::env",
    "std::process",
    "std::thread",
    "std::time",
    "println!",
    "print!",
    "eprintln!",
    "eprint!",
    "dbg!",
    "rayon",
    "rand::",
    "getrandom",
    "RandomState",
    "include_str!",
    "include_bytes!",
];

#[test]
fn the_truth_does_no_input_or_output() {
    let mut files = vec![];
    sources(&Path::new(MANIFEST).join("analytic/src"), &mut files);
    assert!(files.len() > 10, "{files:?}");
    for file in files {
        let text = code(&fs::read_to_string(&file).expect("a source"));
        for word in FORBIDDEN {
            assert!(!text.contains(word), "{} uses {word}", file.display());
        }
        // `use std::{fs, …}` would hide the path: the standard library is named in full, or as core.
        assert!(!text.contains("use std::{"), "{}", file.display());
    }
    assert!(code("fn f() { std::fs::read(\"x\"); } // fine").contains("std::fs"));
    assert!(!code("// std::fs in a comment\n#[cfg(test)]\nprintln!()").contains("std::fs"));
}

#[test]
fn integrators_do_not_know_the_closed_forms() {
    let integrators = Path::new(MANIFEST).join("src/integrators");
    let mut files = vec![];
    sources(&integrators, &mut files);
    for file in files {
        let text = code(&fs::read_to_string(&file).expect("a source"));
        for word in [
            "nephroid_analytic::kinds",
            "nephroid_analytic::optics",
            "crate::evaluate",
        ] {
            assert!(!text.contains(word), "{} uses {word}", file.display());
        }
    }
}
