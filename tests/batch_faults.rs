//! Batches whose worker is not toile, inputs that are hard to find, and lists that are hard to read.

mod room;

use std::fs;
use std::path::Path;

use room::{COARSE, Room, SKIRT, skirt, text};
use serde_json::{Value, json};
use toile::batch::{BatchJob, Digests, JobKey};

/// Runs one job with a worker that is a shell script.
#[cfg(unix)]
mod scripts {
    use std::num::NonZeroUsize;
    use std::os::unix::fs::PermissionsExt;

    use toile::batch::{BatchError, BatchPlan, INDEX, Limits, Store, Summary, Worker, run};

    use super::*;

    fn batch(room: &Room, script: &str) -> Result<Summary, BatchError> {
        room.put("worker", &format!("#!/bin/sh\n{script}\n"));
        fs::set_permissions(room.path("worker"), fs::Permissions::from_mode(0o755)).expect("set");
        let job = BatchJob { id: "skirt".into(), garment: vec![room.path("skirt.yaml")], ..BatchJob::options() };
        let worker = Worker { program: vec![room.path("worker").into()], threads: NonZeroUsize::MIN };
        let plan = BatchPlan {
            worker,
            limits: Limits::default(),
            side_by_side: NonZeroUsize::MIN,
            retry: true,
            index: INDEX.to_owned(),
        };
        let store = Store::open(&room.path("store")).expect("a store");
        run(&[job], &store, &plan, &|| false, &mut |_| {})
    }

    #[test]
    fn a_worker_that_is_not_toile_stops_the_batch() {
        let room = Room::new();
        // Python's own ends, and those of a shell: neither says anything of the garment.
        for code in [0, 1, 2, 3, 127] {
            let error = batch(&room, &format!("echo 'ModuleNotFoundError: no toile' >&2\nexit {code}"));
            let error = error.expect_err("no toile").to_string();
            assert!(error.contains(&format!("exit code {code}")) && error.contains("no toile"), "{error}");
            assert!(error.contains("what is done is kept"), "{error}");
        }
        assert!(room.results("store").is_empty() && room.names("store/failed").is_empty());
    }

    #[test]
    fn a_result_has_its_files_and_a_worker_that_the_system_ends_is_no_note() {
        let room = Room::new();
        let error = |room: &Room| room.index("store")["skirt"]["error"].as_str().unwrap_or_default().to_owned();
        assert_eq!(batch(&room, "exit 80").expect("a failure").failed, 1);
        assert!(error(&room).contains("without garment.obj"), "{}", error(&room));
        let killed = "echo 'skirt.yaml: woman_92 is wide' >&2\nkill -KILL $$";
        assert_eq!(batch(&room, killed).expect("a failure").failed, 1);
        assert!(error(&room).contains("memory") && !error(&room).contains("wide"), "{}", error(&room));
        // One that is out of bounds is done, and the index has the code of `toile make`.
        let made = "for word; do case $word in --output=*) out=${word#--output=};; esac; done\n\
                    touch \"$out/garment.obj\" \"$out/report.json\"\nexit 81";
        let summary = batch(&room, made).expect("a result");
        assert_eq!((summary.done, summary.out_of_bounds), (1, 1));
        assert_eq!(room.index("store")["skirt"]["exit"], 1);
    }
}

#[test]
fn a_key_follows_what_a_garment_names_whatever_its_file_is_called() {
    let room = Room::new();
    let key = |name: &str| {
        JobKey::of(
            &BatchJob { id: "any".into(), garment: vec![room.path(name)], ..BatchJob::options() },
            &Digests::default(),
        )
    };
    let garments = [
        ("sheet.json", "{\"garment\": 1, \"body\": \"ball.obj\"}"),
        ("sheet.YAML", "garment: 1\nbody: ball.obj\n"),
        ("sheet", "garment: 1\nbody: ball.obj\n"),
        ("marked.yaml", "\u{feff}garment: 1\nbody: ball.obj\n"),
    ];
    room.put("ball.obj", "v 0 0 0\n");
    let before: Vec<JobKey> = garments
        .iter()
        .map(|(name, text)| {
            room.put(name, text);
            key(name)
        })
        .collect();
    room.put("ball.obj", "v 0 0 1\n");
    for ((name, _), before) in garments.iter().zip(before) {
        assert_ne!(key(name), before, "{name}");
    }
}

/// Runs a list in the room and gives its index.
fn made(room: &Room, jobs: &[Value], more: &[&str]) -> std::collections::BTreeMap<String, Value> {
    room.list("jobs.jsonl", jobs);
    let run = room.run(&[&["batch", "jobs.jsonl", "-o", "store"], more].concat());
    assert!(matches!(run.status.code(), Some(0 | 1 | 3)), "{}", text(&run.stderr));
    room.index("store")
}

fn folder(room: &Room, line: &Value) -> std::path::PathBuf {
    room.path("store").join(line["folder"].as_str().expect("a folder"))
}

#[test]
fn inputs_that_are_missing_have_a_failure_each() {
    let room = Room::new();
    let missing = |id: &str| json!({"id": id, "garment": format!("{id}/skirt.yaml")});
    let index = made(&room, &[missing("a"), missing("b")], &[]);
    assert_ne!(index["a"]["folder"], index["b"]["folder"]);
    for id in ["a", "b"] {
        let error = index[id]["error"].as_str().expect("a reason");
        assert!(error.contains(Path::new(id).join("skirt.yaml").to_str().expect("UTF-8")), "{error}");
    }
}

#[test]
fn a_failure_keeps_all_of_its_input_as_it_lay() {
    let room = Room::new();
    let named = SKIRT.replace("cotton_poplin", "../cloth.yaml");
    assert_ne!(named, SKIRT);
    room.put("a/skirt.yaml", &named);
    room.put("b/skirt.yaml", SKIRT);
    room.put("cloth.yaml", "weight: 100 g/m2\nbend: 0.05 gf.cm2/cm\n");
    room.put("job.json", "{\"garment\": 1, \"pieces\": 3}");
    room.put("log.txt", "garment: 1\npieces: 3\n");
    let worn = json!({"id": "worn", "garment": ["a/skirt.yaml", "b/skirt.yaml"], "fabric": "denim"});
    let hidden = ["job.json", "log.txt"].map(|name| json!({"id": name, "garment": name}));
    let index = made(&room, &[&[worn][..], &hidden].concat(), &[]);
    for (id, inputs) in [
        ("worn", &["a/skirt.yaml", "b/skirt.yaml", "cloth.yaml"][..]),
        ("job.json", &["job.json"]),
        ("log.txt", &["log.txt"]),
    ] {
        let folder = folder(&room, &index[id]);
        for input in inputs {
            assert_eq!(
                fs::read(folder.join("input").join(input)).expect("kept"),
                fs::read(room.path(input)).expect("there"),
                "{id}: {input}"
            );
        }
        let record = fs::read(folder.join("job.json")).expect("a record");
        let record: Value = serde_json::from_slice(&record).expect("JSON");
        assert_eq!((&record["state"], &record["exit"]), (&json!("failed"), &json!(2)), "{id}");
        let garment = &record["job"]["garment"];
        let first = garment.get(0).unwrap_or(garment).as_str().expect("a path");
        assert!(Path::new(first).is_absolute() && Path::new(first).is_file(), "{first}");
        assert_eq!(record["inputs"].as_array().map(Vec::len), Some(inputs.len()), "{record}");
        assert!(fs::read_to_string(folder.join("log.txt")).expect("a log").contains("error"), "{id}");
    }
    // The copies are a garment: it fails as the one that they are of.
    let copy = folder(&room, &index["worn"]).join("input/a/skirt.yaml");
    let checked = room.run(&["check", copy.to_str().expect("UTF-8")]);
    assert_eq!(checked.status.code(), Some(0), "{}", text(&checked.stderr));
}

#[test]
fn a_folder_has_its_garments_and_says_what_is_left_out() {
    let room = Room::new();
    room.put("all/skirt.yaml", SKIRT);
    room.put("all/broken.yaml", "garment: 1\npieces: [\n");
    room.put("all/ranges.yaml", "measures: {bust: {from: 90, to: 95}}\n");
    room.put("all/cloth.yml", "weight: 100 g/m2\n");
    room.put("all/.skirt.yaml", SKIRT);
    room.put("all/._skirt.yaml", "\u{1}\u{2}");
    let run = room.run(&["batch", "all", "-o", "store", "--spacing", "60"]);
    let said = text(&run.stderr);
    assert!(said.contains("ranges.yaml") && said.contains("cloth.yml") && !said.contains(".skirt.yaml"), "{said}");
    assert_eq!(room.index("store").keys().collect::<Vec<_>>(), ["broken", "skirt"]);
    let draw = |count: &str| {
        let bodies = ["--bodies", "woman_92,woman_92", "--fabrics", "denim,denim", "--sizes", "none,none"];
        let run = room.run(&[&["sample", "skirt.yaml", "-n", count, "-o", "s.jsonl"], &bodies[..]].concat());
        (run.status.code(), text(&run.stderr))
    };
    assert_eq!(draw("1").0, Some(0));
    let (code, said) = draw("2");
    assert!(code == Some(2) && said.contains("only 1: 1 garments × 1 bodies × 1 fabrics"), "{said}");
}

#[test]
fn ranges_are_told_by_the_name_of_their_file() {
    let room = Room::new();
    let draw = |ranges: &str, count: &str| {
        room.put("ranges.yaml", ranges);
        let args = ["sample", "skirt.yaml", "-n", count, "-o", "s.jsonl", "--vary", "ranges.yaml"];
        let run = room.run(&[&args[..], &["--bodies", "woman_92", "--fabrics", "denim"]].concat());
        (run.status.code(), text(&run.stderr))
    };
    let (code, said) = draw("alter: [{lengthen: front, at: 150, by: {from: 1, to: 40000}}, {pivot: 1}]\n", "2");
    assert!(code == Some(2) && said.contains("ranges.yaml: with the least numbers"), "{said}");
    let (code, said) = draw("# nothing yet\n", "2");
    assert!(code == Some(2) && said.contains("ranges.yaml") && said.contains("a file of ranges"), "{said}");
    let (code, said) = draw("alter: [{lengthen: front, at: 150, by: {from: 1, to: 40}}]\n", "1000000000000");
    assert!(code == Some(2) && said.contains("a list has 1000000 at most"), "{said}");
}

#[test]
fn lists_of_any_editor_and_stores_of_any_name_will_do() {
    let room = Room::new();
    let long = "l".repeat(210);
    room.put(&format!("{long}.yaml"), "garment: 1\npieces: 3\n");
    let lines = [skirt("a", COARSE).to_string(), json!({"garment": format!("{long}.yaml")}).to_string()];
    room.put("jobs.jsonl", &format!("\u{feff}{}\r\n{}\r\n", lines[0], lines[1]));
    let run = room.run(&["batch", "jobs.jsonl", "--output=-s"]);
    assert_eq!(run.status.code(), Some(3), "{}", text(&run.stderr));
    let index = room.index("-s");
    assert_eq!(index["a"]["state"], "done", "{}", index["a"]);
    let named = &index[&format!("{long}-2")];
    assert!(named["error"].as_str().is_some_and(|error| error.contains("pieces")), "{named}");

    room.put("jobs.jsonl", "[\"a\", \"skirt.yaml\"]\n");
    let wrong = room.run(&["batch", "jobs.jsonl", "-o", "other"]);
    assert_eq!(wrong.status.code(), Some(2));
    assert!(text(&wrong.stderr).contains("jobs.jsonl:1: error: a job is an object"), "{}", text(&wrong.stderr));
}

#[test]
#[cfg(target_os = "linux")]
fn a_memory_limit_in_which_nothing_can_begin_is_named() {
    let room = Room::new();
    for limit in ["10M", "30M", "100M"] {
        let index = made(&room, &[skirt(limit, COARSE)], &["--memory", limit, "--retry"]);
        let error = index[limit]["error"].as_str().unwrap_or("no error");
        let said = format!("more than {} MiB, the memory limit", limit.trim_end_matches('M'));
        assert!(error.contains(&said) || index[limit]["state"] == "done", "{limit}: {error}");
    }
    let index = made(&room, &[skirt("least", COARSE)], &["--memory", "10M", "--retry"]);
    assert_eq!(index["least"]["state"], "failed");
}

/// The first block of a language after a heading of docs/batch.md.
fn block(heading: &str, language: &str) -> String {
    let docs = include_str!("../docs/batch.md");
    let part = docs.split(&format!("## {heading}\n")).nth(1).expect("the part");
    let block = part.split(&format!("```{language}\n")).nth(1).expect("a block");
    block.split("```").next().unwrap_or_default().to_owned()
}

/// Ends of a script with `toile` on its path.
#[cfg(unix)]
fn ended(room: &Room, script: &str) -> Option<i32> {
    let program = Path::new(env!("CARGO_BIN_EXE_toile")).parent().expect("a folder");
    let path = std::env::var("PATH").unwrap_or_default();
    let mut command = std::process::Command::new("bash");
    command.args(["-euo", "pipefail", "-c", script]).current_dir(room.0.path());
    command.env("PATH", format!("{}:{path}", program.display())).env("SLURM_ARRAY_TASK_ID", "1");
    command.output().expect("bash").status.code()
}

/// With failures the scripts of the docs are well, and with a store that cannot be written they are not.
#[test]
#[cfg(unix)]
fn the_scripts_of_the_docs_tell_failures_from_a_batch_that_cannot_go_on() {
    let slurm = block("Slurm", "sh").replace("/shared/", "").replace("--memory 4G ", "");
    let rules = block("Snakemake", "python");
    let parts: Vec<String> = rules.split("shell:").skip(1).map(shell_line).collect();
    assert_eq!(parts.len(), 2);
    let room = Room::new();
    room.list("jobs.jsonl", &[json!({"id": "missing", "garment": "missing.yaml"})]);
    // Slurm runs its script without the options that Snakemake gives its lines.
    let scripts = [&[format!("set +e\n{slurm}")][..], &parts].concat();
    for script in &scripts {
        assert_eq!(ended(&room, script), Some(0), "{script}");
        room.put("jobs.jsonl", "{}\n");
        assert_eq!(ended(&room, script), Some(1), "{script}");
        room.list("jobs.jsonl", &[json!({"id": "missing", "garment": "missing.yaml"})]);
        fs::remove_dir_all(room.path("store")).expect("removed");
        room.put("store", "a file is no folder");
        assert_eq!(ended(&room, script), Some(1), "{script}");
        fs::remove_file(room.path("store")).expect("removed");
    }
}

/// The line that Snakemake makes of the texts after `shell:`.
fn shell_line(rule: &str) -> String {
    let rule = rule.split("\nrule").next().unwrap_or_default();
    let line: String = rule.replace("str(PARTS)", "\"1\"").split('"').skip(1).step_by(2).collect();
    line.replace("{input}", "jobs.jsonl").replace("{input[0]}", "jobs.jsonl").replace("{wildcards.k}", "1")
}
