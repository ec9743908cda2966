//! The house keeps its shape: modules use only what they may, files of a folder use one another one way, each foreign
//! crate lives in one place, no file lies about that no module declares, and lines are of one width.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Modules in building order, each with those it may use. The ground floor first, the edge last.
const FLOORS: [(&str, &[&str]); 26] = [
    ("geometry", &[]),
    ("input", &[]),
    ("parallel", &[]),
    ("linear", &["geometry", "parallel"]),
    ("fabric", &["input"]),
    ("pattern", &["geometry", "input", "fabric"]),
    ("alter", &["geometry", "input", "pattern"]),
    ("mannequin", &["geometry", "input"]),
    ("contact", &["geometry", "parallel"]),
    ("mesh", &["geometry", "pattern"]),
    ("dynamics", &["geometry", "parallel", "linear", "fabric", "pattern", "contact", "mesh"]),
    ("sew", &["geometry", "parallel", "linear", "fabric", "pattern", "mannequin", "contact", "mesh", "dynamics"]),
    ("drape", &["geometry", "parallel", "linear", "fabric", "pattern", "contact", "mesh", "dynamics", "sew"]),
    ("specimen", &["geometry", "fabric", "pattern", "contact", "mesh", "dynamics", "sew"]),
    ("flatten", &["geometry", "linear", "pattern", "mesh"]),
    ("verify", &["geometry", "mannequin", "mesh"]),
    ("report", &["geometry", "pattern", "mannequin", "mesh", "verify"]),
    ("picture", &["geometry", "mesh", "verify"]),
    ("cutting", &["geometry", "input", "parallel", "pattern"]),
    ("digitize", &["geometry", "fabric", "pattern"]),
    ("io", &["geometry", "input", "pattern", "alter", "mannequin", "mesh", "verify", "cutting", "digitize"]),
    (
        "pipeline",
        &[
            "geometry",
            "input",
            "fabric",
            "pattern",
            "mannequin",
            "contact",
            "mesh",
            "dynamics",
            "sew",
            "drape",
            "flatten",
            "verify",
            "report",
            "picture",
            "io",
        ],
    ),
    ("fitting", &["geometry", "pattern", "mannequin", "report", "io", "pipeline"]),
    ("batch", &["input", "fabric", "mannequin", "io"]),
    (
        "studio",
        &["geometry", "input", "fabric", "pattern", "mannequin", "flatten", "report", "digitize", "io", "pipeline"],
    ),
    (
        "cli",
        &[
            "geometry",
            "input",
            "fabric",
            "pattern",
            "mannequin",
            "specimen",
            "flatten",
            "report",
            "picture",
            "cutting",
            "digitize",
            "io",
            "pipeline",
            "fitting",
            "batch",
            "studio",
        ],
    ),
];

/// Crates and the paths below `src` that may name them.
const CRATES: [(&str, &[&str]); 30] = [
    ("parry3d_f64", &["contact/"]),
    ("robust", &["geometry/"]),
    ("faer", &["linear/"]),
    ("foldhash", &["dynamics/friction.rs"]),
    ("spade", &["mesh/"]),
    ("unifont", &["geometry/letters.rs"]),
    ("kurbo", &["geometry/"]),
    ("i_overlay", &["cutting/clean.rs"]),
    ("roxmltree", &["io/svg_read/"]),
    ("pdf_writer", &["io/pdf_write/"]),
    ("encoding_rs", &["io/encoding.rs"]),
    ("svgtypes", &["geometry/"]),
    ("svg", &["io/svg_write/"]),
    ("obj", &["io/obj_read.rs"]),
    // Written in `picture`; what users hand in is read where it is measured.
    ("gif", &["picture/turntable.rs", "picture/mod.rs"]),
    ("png", &["picture/", "fabric/measure/photo.rs"]),
    ("epaint_default_fonts", &["picture/font.rs"]),
    ("ttf_parser", &["picture/font.rs"]),
    ("zune_jpeg", &["fabric/measure/photo.rs"]),
    ("zune_core", &["fabric/measure/photo.rs"]),
    ("saphyr_parser", &["io/garment/"]),
    // Texts are parsed in `input`; small formats are read where they are defined.
    ("serde_yaml", &["input/yaml.rs", "io/garment/", "fabric/"]),
    ("tempfile", &["io/files/"]),
    ("ctrlc", &["io/files/"]),
    ("sha2", &["batch/key.rs"]),
    ("nix", &["batch/process.rs"]),
    ("httparse", &["studio/http.rs"]),
    ("getrandom", &["studio/door.rs"]),
    ("clap", &["cli/"]),
    ("indicatif", &["cli/"]),
];

/// Files and folders that use one another in a circle, each with the folder that they are in. They are still to be
/// untangled: none may be added, and one that is out of its circle is struck out.
const CIRCLES: [(&str, &[&str]); 10] = [
    ("alter", &["even", "reshape"]),
    ("digitize", &["darts", "edges", "file", "folds", "materials", "notches", "suggest"]),
    ("fabric", &["library", "measure", "resolve", "sheet"]),
    ("flatten", &["relax", "zone"]),
    ("io", &["dxf_block", "dxf_library"]),
    ("io/garmentcode", &["drawing", "outward", "short", "spec"]),
    ("io/pdf_write", &["cover", "pages"]),
    ("pattern", &["chain", "dart", "draft", "line", "outline", "pleat", "seam"]),
    ("pipeline/surface", &["cuts", "darts", "edges", "even", "parts", "report", "sheet"]),
    (
        "sew/start",
        &[
            "balloon", "circles", "cloth", "cover", "crossing", "deal", "glue", "harmonic", "laps", "openings",
            "reach", "ribbon", "rings", "sides", "star", "unfold", "way_out", "zip",
        ],
    ),
];

#[test]
fn modules_use_only_what_stands_below_them() {
    let mut wrong = Vec::new();
    for (file, text) in sources() {
        let Some((own, allowed)) = FLOORS.iter().find(|(name, _)| file.starts_with(name)) else { continue };
        for used in mentions(&text, "crate") {
            let known = FLOORS.iter().any(|(name, _)| *name == used);
            if known && used != *own && !allowed.contains(&used.as_str()) {
                wrong.push(format!("{} uses crate::{used}", file.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_table_has_every_module_and_no_circle() {
    let floor = |name: &str| FLOORS.iter().position(|f| f.0 == name);
    for (k, (name, allowed)) in FLOORS.iter().enumerate() {
        for used in *allowed {
            assert!(floor(used).is_some_and(|u| u < k), "{name} may use {used}, which stands above it");
        }
    }
    for (file, _) in sources() {
        let mut parts = file.iter().filter_map(|p| p.to_str());
        let first = parts.next().unwrap_or_default();
        let at_home = ["lib.rs", "main.rs"].contains(&first) || floor(first).is_some();
        assert!(at_home, "{} belongs to no module of the table", file.display());
    }
}

/// A name counts as used where its path names the file, or where the folder's `mod.rs` has it from there. The folder's
/// `mod.rs` itself is left out: it stands for the folder and names all of its files.
#[test]
fn files_of_a_folder_use_one_another_one_way() {
    let files = sources();
    let mut wrong = Vec::new();
    for folder in folders(&files) {
        let listed = CIRCLES.iter().find(|(name, _)| folder == Path::new(name)).map_or(&[][..], |(_, names)| *names);
        let uses = uses_within(&folder, &files);
        let tangled: BTreeSet<&str> = uses.keys().map(String::as_str).filter(|n| reaches(n, n, &uses)).collect();
        let shown = folder.display();
        for name in tangled.iter().filter(|name| !listed.contains(name)) {
            let back: Vec<&String> = uses[*name].iter().filter(|used| reaches(used, name, &uses)).collect();
            wrong.push(format!("{shown}/{name} uses {back:?}, which use it"));
        }
        let loose = listed.iter().filter(|name| !tangled.contains(*name));
        wrong.extend(loose.map(|name| format!("{shown}/{name} is in no circle any more: strike it out of CIRCLES")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn foreign_crates_live_in_one_place() {
    let mut wrong = Vec::new();
    for (file, text) in sources() {
        for (name, homes) in CRATES {
            let at_home = homes.iter().any(|home| file.to_string_lossy().starts_with(home));
            if !at_home && names_crate(&text, name) {
                wrong.push(format!("{} names {name}, which belongs to {}", file.display(), homes.join(", ")));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_source_file_is_a_module_of_its_parent() {
    let files = sources();
    let stray: Vec<String> = files
        .iter()
        .filter(|(file, _)| !is_declared(file, &files))
        .map(|(file, _)| file.display().to_string())
        .collect();
    assert!(stray.is_empty(), "no module declares {}", stray.join(", "));
}

/// The formatter breaks no comment and no text in quotes.
#[test]
fn no_line_is_wider_than_the_formatter_makes_them() {
    let said = include_str!("../rustfmt.toml").lines().find_map(|line| line.strip_prefix("max_width = "));
    let width: usize = said.and_then(|number| number.parse().ok()).expect("rustfmt.toml says how wide lines are");
    let mut wide = Vec::new();
    for folder in ["src", "tests", "examples", "benches", "python/src"] {
        let files = rust_files(folder);
        assert!(!files.is_empty(), "{folder} was not found");
        for (file, text) in files {
            let lines = text.lines().zip(1..).filter(|(line, _)| line.chars().count() > width);
            wide.extend(lines.map(|(_, n)| format!("{folder}/{}:{n}", file.display())));
        }
    }
    assert!(wide.is_empty(), "more than {width} characters: {}", wide.join(", "));
}

/// The folders below `src` that are modules.
fn folders(files: &[(PathBuf, String)]) -> Vec<PathBuf> {
    let of_module = |(file, _): &(PathBuf, String)| file.ends_with("mod.rs").then(|| file.parent().map(Path::to_owned));
    files.iter().filter_map(of_module).flatten().collect()
}

/// Which files and folders directly in a folder use which others there, tests left out.
fn uses_within(folder: &Path, files: &[(PathBuf, String)]) -> BTreeMap<String, BTreeSet<String>> {
    let inside = |file: &Path| file.strip_prefix(folder).ok().map(modules).filter(|names| !names.is_empty());
    let inner: Vec<(Vec<String>, &str)> =
        files.iter().filter_map(|(file, text)| Some((inside(file)?, untested(text)))).collect();
    let head = files.iter().find(|(file, _)| *file == folder.join("mod.rs")).map_or("", |(_, text)| text);
    let mut uses: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for (names, _) in &inner {
        uses.entry(names[0].clone()).or_default();
    }
    let mut home: BTreeMap<String, String> = BTreeMap::new();
    for child in uses.keys() {
        home.extend(mentions(head, child).into_iter().map(|name| (name, child.clone())));
        home.insert(child.clone(), child.clone());
    }
    let whole = format!("crate::{}", modules(folder).join("::"));
    for (names, text) in inner {
        let above = vec!["super"; names.len()].join("::");
        let named = [mentions(text, &above), mentions(text, &whole)].concat();
        let used = named.iter().filter_map(|name| home.get(name)).filter(|child| **child != names[0]).cloned();
        uses.entry(names[0].clone()).or_default().extend(used);
    }
    uses
}

/// The modules that lead to a file or a folder.
fn modules(path: &Path) -> Vec<String> {
    let names = path.with_extension("");
    names.iter().filter_map(|name| name.to_str()).filter(|name| *name != "mod").map(str::to_owned).collect()
}

/// A file's text up to its tests.
fn untested(text: &str) -> &str {
    const TESTS: &str = "#[cfg(test)]\n";
    let is_module =
        |at: usize| text[at + TESTS.len()..].lines().next().is_some_and(|line| line.ends_with("mod tests {"));
    text.match_indices(TESTS).map(|(at, _)| at).find(|at| is_module(*at)).map_or(text, |at| &text[..at])
}

/// Whether a file uses another, itself or by way of others.
fn reaches(from: &str, to: &str, uses: &BTreeMap<String, BTreeSet<String>>) -> bool {
    let mut seen = BTreeSet::new();
    let mut open = vec![from];
    while let Some(next) = open.pop() {
        for used in uses.get(next).into_iter().flatten() {
            if used == to {
                return true;
            }
            if seen.insert(used.as_str()) {
                open.push(used);
            }
        }
    }
    false
}

/// Whether the file that stands for the folder of `file` declares it: the compiler passes over what nobody declares,
/// and so do the linter and every test.
fn is_declared(file: &Path, files: &[(PathBuf, String)]) -> bool {
    let named = |path: &Path| path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let folder = file.parent().unwrap_or(Path::new(""));
    let (parents, module) = match named(file).as_str() {
        "lib" | "main" if folder == Path::new("") => return true,
        "mod" => (heads(folder.parent().unwrap_or(Path::new(""))), named(folder)),
        own => (heads(folder), own.to_owned()),
    };
    let declares = |text: &str| {
        let declaration = format!("mod {module};");
        text.lines()
            .map(str::trim_end)
            .any(|line| line.ends_with(&declaration) && stands_alone(line, line.len() - declaration.len()))
    };
    files.iter().any(|(parent, text)| parents.contains(parent) && declares(text))
}

/// The files that can declare the modules of a folder.
fn heads(folder: &Path) -> Vec<PathBuf> {
    if folder == Path::new("") {
        return vec!["lib.rs".into(), "main.rs".into()];
    }
    vec![folder.join("mod.rs"), folder.with_extension("rs")]
}

/// Every Rust file below `src`, its path from there and its text without comments.
fn sources() -> Vec<(PathBuf, String)> {
    let bare = |(file, text): (PathBuf, String)| {
        let code: Vec<&str> = text.lines().map(|l| l.split("//").next().unwrap_or("")).collect();
        (file, code.join("\n"))
    };
    let files: Vec<_> = rust_files("src").into_iter().map(bare).collect();
    assert!(files.len() > 50, "the sources were not found");
    files
}

/// Every Rust file below a folder of the house, its path from there and its text.
fn rust_files(folder: &str) -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut files = Vec::new();
    let mut open = vec![root.clone()];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let text = fs::read_to_string(&path).expect("a text");
                files.push((path.strip_prefix(&root).expect("below the folder").to_owned(), text));
            }
        }
    }
    files
}

/// The words after `name::` wherever it stands as a whole word, also those of `name::{a, b::c}`.
fn mentions(text: &str, name: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (at, _) in text.match_indices(&format!("{name}::")) {
        if !stands_alone(text, at) || text[..at].ends_with("::") {
            continue;
        }
        let rest = &text[at + name.len() + 2..];
        if let Some(list) = rest.strip_prefix('{') {
            let inner = &list[..closing(list)];
            found.extend(top_level(inner).iter().map(|item| word(item.trim_start())));
        } else {
            found.push(word(rest));
        }
    }
    found
}

fn names_crate(text: &str, name: &str) -> bool {
    let path =
        text.match_indices(&format!("{name}::")).any(|(at, _)| stands_alone(text, at) && !text[..at].ends_with("::"));
    path || text.contains(&format!("use {name};"))
}

/// Whether a name that starts at `at` is not the tail of a longer one.
fn stands_alone(text: &str, at: usize) -> bool {
    !text[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_')
}

fn word(text: &str) -> String {
    text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
}

/// Where the brace that is open at the start closes.
fn closing(text: &str) -> usize {
    let mut depth = 1;
    for (at, c) in text.char_indices() {
        depth += match c {
            '{' => 1,
            '}' => -1,
            _ => 0,
        };
        if depth == 0 {
            return at;
        }
    }
    text.len()
}

/// The items of a list, commas inside braces not counting.
fn top_level(text: &str) -> Vec<&str> {
    let mut items = Vec::new();
    let (mut depth, mut begin) = (0, 0);
    for (at, c) in text.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                items.push(&text[begin..at]);
                begin = at + 1;
            }
            _ => {}
        }
    }
    items.push(&text[begin..]);
    items
}
