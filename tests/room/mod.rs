//! A folder with garments, lists and stores, for tests of batches.

#![allow(dead_code, reason = "every test that has a room uses a part of this")]

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::process::{Child, Command, Output, Stdio};

use serde_json::{Value, json};
use tempfile::TempDir;

/// A skirt of two pieces that sews in a fraction of a second at this spacing (mm).
pub(crate) const SKIRT: &str = include_str!("../data/skirt.yaml");
pub(crate) const COARSE: f64 = 60.0;
/// A spacing (mm) at which the skirt takes minutes.
pub(crate) const ENDLESS: f64 = 1.5;

/// A folder with garments, lists and stores.
pub(crate) struct Room(pub(crate) TempDir);

impl Room {
    pub(crate) fn new() -> Self {
        let room = Self(tempfile::tempdir().expect("a temporary folder"));
        room.put("skirt.yaml", SKIRT);
        room
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn put(&self, name: &str, text: &str) {
        fs::create_dir_all(self.path(name).parent().expect("a folder")).expect("made");
        fs::write(self.path(name), text).expect("written");
    }

    pub(crate) fn list(&self, name: &str, jobs: &[Value]) {
        self.put(name, &jobs.iter().map(|job| format!("{job}\n")).collect::<String>());
    }

    pub(crate) fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_toile"));
        command.args(args).current_dir(self.0.path()).stdin(Stdio::null());
        command
    }

    pub(crate) fn run(&self, args: &[&str]) -> Output {
        self.command(args).output().expect("started")
    }

    pub(crate) fn start(&self, args: &[&str]) -> Child {
        self.command(args).stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("started")
    }

    /// Lines of a store's index by their ids.
    pub(crate) fn index(&self, store: &str) -> BTreeMap<String, Value> {
        let text = fs::read_to_string(self.path(store).join("index.jsonl")).expect("an index");
        let lines: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
        let by_id: BTreeMap<String, Value> =
            lines.iter().map(|line| (line["id"].as_str().expect("an id").to_owned(), line.clone())).collect();
        assert_eq!(by_id.len(), lines.len(), "an id twice: {text}");
        by_id
    }

    /// Names in a folder, sorted; none if there is no such folder.
    pub(crate) fn names(&self, folder: &str) -> Vec<String> {
        let Ok(entries) = fs::read_dir(self.path(folder)) else { return Vec::new() };
        let mut names: Vec<String> = entries.filter_map(|e| e.ok()?.file_name().into_string().ok()).collect();
        names.sort();
        names
    }

    /// Folders of results in a store.
    pub(crate) fn results(&self, store: &str) -> Vec<String> {
        self.names(store).into_iter().filter(|name| name.len() == 32).collect()
    }
}

pub(crate) fn skirt(id: &str, spacing: f64) -> Value {
    json!({"id": id, "garment": "skirt.yaml", "spacing": spacing})
}

/// Skirts that are all different.
pub(crate) fn skirts(count: usize) -> Vec<Value> {
    (0..count).map(|k| skirt(&format!("skirt {k}"), COARSE + k as f64)).collect()
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}
