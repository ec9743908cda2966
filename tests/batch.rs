//! Batches: nothing lost, nothing twice, no half folder, and failures of their own.

mod room;

use std::collections::HashMap;
use std::fs;
use std::path::Path;
use std::process::{Child, Command};
use std::time::{Duration, Instant};

use room::{COARSE, ENDLESS, Room, SKIRT, skirt, skirts, text};
use serde_json::{Value, json};
use toile::batch::{BatchJob, Digests, JobKey};

/// A garment that cannot be sewn.
const NARROW_TUBE: &str = include_str!("data/narrow_tube.yaml");

#[test]
fn every_job_is_made_once_and_every_failure_kept_with_its_reason() {
    let room = Room::new();
    room.put("narrow_tube.yaml", NARROW_TUBE);
    room.put("broken.yaml", "garment: 1\npieces: {front: {outlin: 3}}\n");
    let narrow = json!({"id": "narrow", "garment": "narrow_tube.yaml", "spacing": 30});
    room.list(
        "jobs.jsonl",
        &[
            skirt("a", COARSE),
            skirt("same as a", COARSE),
            narrow,
            json!({"garment": "broken.yaml"}),
            json!({"id": "missing", "garment": "missing.yaml"}),
            json!({"id": "fabric", "garment": "skirt.yaml", "fabric": "denin"}),
            skirt("endless", ENDLESS),
            json!({"id": "denim", "garment": "skirt.yaml", "spacing": COARSE, "fabric": "denim"}),
        ],
    );
    let args = ["batch", "jobs.jsonl", "-o", "store", "--time", "20", "-j", "2"];
    let first = room.run(&args);
    assert_eq!(first.status.code(), Some(3), "{}", text(&first.stderr));
    assert!(text(&first.stdout).starts_with("8 jobs: 3 done"), "{}", text(&first.stdout));
    let index = room.index("store");
    assert_eq!(index.len(), 8);
    let said = |id: &str, key: &str| index[id][key].clone();
    for (id, exit, why) in [
        ("narrow", json!(3), ""),
        ("broken-4", json!(2), "broken.yaml:2:"),
        ("missing", json!(2), "missing.yaml"),
        ("fabric", json!(2), "denim"),
        ("endless", json!(null), "20 s, the time limit"),
    ] {
        assert_eq!((said(id, "state"), said(id, "exit")), (json!("failed"), exit), "{id}");
        let error = said(id, "error").as_str().expect("a reason").to_owned();
        assert!(error.contains(why) && !error.contains(".work"), "{id}: {error}");
        let folder = room.path("store").join(said(id, "folder").as_str().expect("a folder"));
        assert!(folder.starts_with(room.path("store/failed")) && folder.join("job.json").is_file());
        assert_eq!(folder.join("input/skirt.yaml").is_file(), ["fabric", "endless"].contains(&id));
    }
    assert_eq!(said("a", "folder"), said("same as a", "folder"));
    assert_eq!(room.results("store").len(), 2);
    assert_eq!(room.names("store/failed").len(), 5);

    // The same bytes as of `make`.
    let made = room.run(&["make", "skirt.yaml", "--spacing", "60", "-o", "plain", "--threads", "2"]);
    let done = said("a", "folder").as_str().expect("a folder").to_owned();
    assert_eq!(said("a", "exit"), json!(made.status.code()));
    let obj = |folder: &str| fs::read(room.path(folder).join("garment.obj")).expect("a garment");
    assert_eq!(obj("plain"), obj(&format!("store/{done}")));

    // Nothing is made anew, but for failures that are to be.
    let bytes = fs::read(room.path("store/index.jsonl")).expect("an index");
    let again = room.run(&args);
    assert!(text(&again.stdout).contains("8 were known before"), "{}", text(&again.stdout));
    assert_eq!(fs::read(room.path("store/index.jsonl")).expect("an index"), bytes);
    // A record that a power cut has damaged is no record.
    room.put(&format!("store/{done}/job.json"), "{");
    let mended = room.run(&args);
    assert!(text(&mended.stdout).contains("6 were known before"), "{}", text(&mended.stdout));
    assert_eq!(obj("plain"), obj(&format!("store/{done}")));
    room.put("missing.yaml", SKIRT);
    let retried = room.run(&["batch", "jobs.jsonl", "-o", "store", "--time", "0.5", "--retry"]);
    assert!(text(&retried.stdout).contains("3 were known before"), "{}", text(&retried.stdout));
    assert!(room.index("store")["endless"]["error"].as_str().is_some_and(|e| e.contains("0.5 s")));
    assert_eq!(room.names("store/.work"), ["lock"]);
}

#[test]
fn killed_twenty_times_a_batch_ends_as_a_plain_one() {
    const JOBS: usize = 10;
    let room = Room::new();
    let mut jobs = skirts(JOBS);
    jobs.push(json!({"id": "missing", "garment": "missing.yaml"}));
    room.list("jobs.jsonl", &jobs);
    let args = ["batch", "jobs.jsonl", "-o", "store", "-j", "2", "--quiet"];
    // Times that no rhythm of the batch keeps in step with, ms.
    let times = (0u64..20).map(|k| 20 + k * 7919 % 331);
    let mut seen = 0;
    for time in times {
        let mut batch = room.start(&args);
        std::thread::sleep(Duration::from_millis(time));
        batch.kill().expect("killed");
        batch.wait().expect("ended");
        let results = room.results("store");
        for name in &results {
            let folder = room.path("store").join(name);
            let files = ["garment.obj", "sewn.obj", "pattern.svg", "report.json", "garment.png", "job.json"];
            assert!(files.iter().all(|file| folder.join(file).is_file()), "half a folder: {name}");
        }
        assert!(results.len() >= seen, "a result was lost");
        seen = results.len();
    }
    assert_eq!(room.run(&args).status.code(), Some(3));
    let plain = room.run(&["batch", "jobs.jsonl", "-o", "plain", "-j", "1", "--quiet"]);
    assert_eq!(plain.status.code(), Some(3));
    let (ours, theirs) = (room.index("store"), room.index("plain"));
    assert_eq!(ours.len(), JOBS + 1);
    for (id, line) in &ours {
        for key in ["state", "exit", "folder", "error"] {
            assert_eq!(line[key], theirs[id][key], "{id}");
        }
    }
    assert_eq!(room.results("store"), room.results("plain"));
    for name in room.results("store") {
        let obj = |store: &str| fs::read(room.path(store).join(&name).join("garment.obj")).expect("a garment");
        assert_eq!(obj("store"), obj("plain"));
    }
    assert_eq!(room.names("store/.work"), ["lock"]);
}

/// Ids of the processes that have this folder in their arguments.
#[cfg(target_os = "linux")]
fn workers_of(folder: &Path) -> Vec<String> {
    let name = folder.to_string_lossy().into_owned();
    let is_worker = |pid: &String| {
        fs::read(format!("/proc/{pid}/cmdline")).is_ok_and(|line| {
            let line = text(&line);
            line.contains(&name) && line.contains("--worker")
        })
    };
    let entries = fs::read_dir("/proc").expect("/proc");
    entries.filter_map(|e| e.ok()?.file_name().into_string().ok()).filter(is_worker).collect()
}

#[cfg(target_os = "linux")]
fn until(what: &str, true_at_last: impl Fn() -> bool) {
    let begin = Instant::now();
    while !true_at_last() {
        assert!(begin.elapsed() < Duration::from_secs(20), "{what}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
#[cfg(target_os = "linux")]
fn workers_end_with_their_batch_and_ctrl_c_leaves_nothing_behind() {
    let room = Room::new();
    room.list("jobs.jsonl", &[skirt("quick", COARSE), skirt("b", ENDLESS), skirt("c", ENDLESS + 0.1)]);
    let store = room.path("store");
    let args = ["batch", "jobs.jsonl", "-o", store.to_str().expect("UTF-8"), "-j", "3"];
    for signal in ["-KILL", "-INT"] {
        let mut batch = room.start(&args);
        until("the workers start and the quick job ends", || {
            workers_of(&store).len() == 2 && room.results("store").len() == 1
        });
        let kill = Command::new("kill").args([signal, &batch.id().to_string()]).status();
        assert!(kill.expect("a kill command").success());
        let status = batch.wait().expect("ended");
        until("the workers end", || workers_of(&store).is_empty());
        if signal == "-INT" {
            assert_eq!(status.code(), Some(130));
            assert_eq!(room.names("store/.work"), ["lock"]);
        }
        assert_eq!(room.index("store").keys().collect::<Vec<_>>(), ["quick"]);
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_job_that_takes_too_much_memory_fails_alone() {
    let room = Room::new();
    room.list("jobs.jsonl", &[skirt("quick", COARSE), skirt("large", ENDLESS)]);
    let run = room.run(&["batch", "jobs.jsonl", "-o", "store", "--memory", "350M", "--time", "2m"]);
    assert_eq!(run.status.code(), Some(3), "{}", text(&run.stderr));
    let index = room.index("store");
    assert_eq!(index["quick"]["state"], "done", "{index:?}");
    let error = index["large"]["error"].as_str().expect("a reason");
    assert!(error.contains("350 MiB, the memory limit"), "{error}");
}

#[test]
fn parts_work_into_one_store_at_the_same_time() {
    let room = Room::new();
    room.list("jobs.jsonl", &skirts(6));
    let part = |k: usize| room.start(&["batch", "jobs.jsonl", "-o", "store", "-j", "1", "--part", &format!("{k}/3")]);
    let running: Vec<Child> = (1..=3).map(part).collect();
    for mut batch in running {
        assert!(matches!(batch.wait().expect("ended").code(), Some(0 | 1)));
    }
    assert_eq!(fs::read_to_string(room.path("store/index.2-of-3.jsonl")).expect("an index").lines().count(), 2);
    let whole = room.run(&["batch", "jobs.jsonl", "-o", "store"]);
    assert!(text(&whole.stdout).contains("6 were known before"), "{}", text(&whole.stdout));
    assert_eq!(room.results("store").len(), 6);
    assert_eq!(room.index("store").len(), 6);
}

#[test]
fn a_folder_is_a_list_and_a_wrong_list_makes_nothing() {
    let room = Room::new();
    fs::create_dir(room.path("garments")).expect("made");
    fs::copy(room.path("skirt.yaml"), room.path("garments/short skirt.yaml")).expect("copied");
    let made = room.run(&["batch", "garments", "-o", "store", "--spacing", "60", "--json"]);
    let summary: Value = serde_json::from_slice(&made.stdout).expect("JSON");
    assert_eq!((&summary["jobs"], &summary["done"]), (&json!(1), &json!(1)), "{}", text(&made.stderr));
    assert_eq!(room.index("store").keys().collect::<Vec<_>>(), ["short skirt"]);

    room.put(
        "wrong.jsonl",
        "{\"garment\": \"skirt.yaml\", \"id\": \"a\"}\n\n{\"garmnt\": 1}\n{\"garment\": \"b.yaml\", \"id\": \"a\"}\n[",
    );
    let wrong = room.run(&["batch", "wrong.jsonl", "-o", "other"]);
    assert_eq!(wrong.status.code(), Some(2));
    let said = text(&wrong.stderr);
    assert!(said.contains("wrong.jsonl:3: error: unknown field `garmnt`"), "{said}");
    assert!(said.contains("wrong.jsonl:4: error: the id 'a' is that of line 1"), "{said}");
    assert!(said.contains("wrong.jsonl:5: error: "), "{said}");
    assert!(!room.path("other").exists());
}

#[test]
fn samples_are_drawn_reproducibly_and_without_repetition() {
    let room = Room::new();
    fs::create_dir(room.path("lists")).expect("made");
    room.put("cloth.yaml", "weight: 100 g/m2\n");
    let draw = |list: &str, more: &[&str]| {
        let args = [&["sample", "skirt.yaml", "--seed", "5", "-o", list, "--spacing", "60"], more].concat();
        let output = room.run(&args);
        (output.status.code(), text(&output.stderr), fs::read_to_string(room.path(list)).unwrap_or_default())
    };
    let (code, said, list) = draw("lists/a.jsonl", &["-n", "40"]);
    assert_eq!(code, Some(0), "{said}");
    assert_eq!(list, draw("lists/b.jsonl", &["-n", "40"]).2);
    let jobs: Vec<Value> = list.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    let mut drawn: HashMap<String, usize> = HashMap::new();
    for job in &jobs {
        assert_eq!((&job["garment"], &job["spacing"]), (&json!("../skirt.yaml"), &json!(60.0)));
        *drawn.entry(format!("{} {}", job["body"], job["fabric"])).or_default() += 1;
    }
    assert!(drawn.len() == 40 && drawn.values().all(|n| *n == 1));
    let (code, said, _) = draw("lists/c.jsonl", &["-n", "3", "--bodies", "woman_92", "--fabrics", "denim,cloth.yaml"]);
    assert!(code == Some(2) && said.contains("only 2: 1 garments × 1 bodies × 2 fabrics"), "{said}");
    let (_, _, list) = draw("lists/c.jsonl", &["-n", "2", "--bodies", "woman_92", "--fabrics", "denim,cloth.yaml"]);
    assert!(list.contains("\"fabric\":\"../cloth.yaml\""), "{list}");
    let (code, said, _) = draw("lists/d.jsonl", &["-n", "2", "--fabrics", "denin"]);
    assert!(code == Some(2) && said.contains("did you mean 'denim'"), "{said}");
}

#[test]
fn samples_draw_measures_alterations_and_sizes_and_the_batch_makes_them() {
    let room = Room::new();
    room.put("sized.yaml", &format!("{SKIRT}sizes: {{long: [{{lengthen: front, at: 200, by: 30}}]}}\n"));
    room.put(
        "ranges.yaml",
        "measures: {waist: {from: 98 %, to: 102 %}, height: {from: 1640, to: 1700}}\n\
         alter:\n  - {lengthen: front, at: 150, by: {from: 1, to: 40}}\n",
    );
    let draw = |list: &str, count: &str, more: &[&str]| {
        let args = ["sample", "sized.yaml", "-n", count, "--seed", "3", "-o", list, "--spacing", "60"];
        let output = room.run(&[&args[..], &["--bodies", "woman_92", "--fabrics", "denim"], more].concat());
        (output.status.code(), text(&output.stderr), fs::read_to_string(room.path(list)).unwrap_or_default())
    };
    let (code, said, list) = draw("jobs.jsonl", "5", &["--vary", "ranges.yaml"]);
    assert_eq!(code, Some(0), "{said}");
    let jobs: Vec<Value> = list.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    let within = |value: &Value, low: f64, high: f64| value.as_f64().is_some_and(|v| (low..=high).contains(&v));
    for job in &jobs {
        assert!(within(&job["measures"]["height"], 1640.0, 1700.0), "{job}");
        assert!(within(&job["alter"][0]["by"], 1.0, 40.0), "{job}");
    }
    // Both variants of the garment come before either comes again.
    for pair in jobs[..4].chunks(2) {
        assert_eq!(pair.iter().filter(|job| job["size"] == "long").count(), 1, "{list}");
    }
    // The first jobs of a longer list are those of a shorter one.
    assert!(list.starts_with(&draw("few.jsonl", "3", &["--vary", "ranges.yaml"]).2));
    let (code, said, _) = draw("d.jsonl", "5", &["--sizes", "none,short"]);
    assert!(code == Some(2) && said.contains("has no size 'short'; its sizes: long"), "{said}");
    room.put("wrong.yaml", "alter: [{lengthen: frnt, at: 150, by: {from: 1, to: 40}}]\n");
    let (code, said, _) = draw("d.jsonl", "5", &["--vary", "wrong.yaml"]);
    assert!(code == Some(2) && said.contains("did you mean 'front'?"), "{said}");
    room.put("wrong.yaml", "measures: {waist: {from: 98 %, to: 300 %}}\n");
    let (code, said, _) = draw("d.jsonl", "5", &["--vary", "wrong.yaml"]);
    assert!(code == Some(2) && said.contains("'waist'"), "{said}");

    // What a job says, `make` makes.
    let made = room.run(&["batch", "few.jsonl", "-o", "store"]);
    assert!(matches!(made.status.code(), Some(0 | 1)), "{}", text(&made.stderr));
    let job = jobs.iter().take(3).find(|job| job["size"] == "long").expect("a long one");
    let (measures, alter) = (job["measures"].to_string(), job["alter"].to_string());
    let args = ["make", "sized.yaml", "--size", "long", "--spacing", "60", "--fabric", "denim", "--body", "woman_92"];
    room.run(&[&args[..], &["--measures", &*measures, "--alter", &*alter, "-o", "plain"]].concat());
    let folder = room.index("store")[job["id"].as_str().expect("an id")]["folder"].clone();
    let obj = |folder: &str| fs::read(room.path(folder).join("garment.obj")).expect("a garment");
    assert_eq!(obj("plain"), obj(&format!("store/{}", folder.as_str().expect("a folder"))));
}

/// The key of `skirt.yaml` in this folder.
fn key(folder: &Path, options: BatchJob) -> JobKey {
    JobKey::of(&BatchJob { id: "any".into(), garment: vec![folder.join("skirt.yaml")], ..options }, &Digests::default())
}

#[test]
fn a_key_follows_the_content_and_all_that_is_named_and_nothing_else() {
    let (one, two) = (Room::new(), Room::new());
    for room in [&one, &two] {
        room.put("skirt.yaml", "fabrics: {shell: {base: cloth.yaml}}\n");
        room.put("cloth.yaml", "tensile: curve.csv\n");
        room.put("curve.csv", "0 0\n");
    }
    let (one, two) = (one.0.path(), two.0.path());
    let same = key(one, BatchJob::options());
    assert_eq!(same, key(two, BatchJob::options()));
    assert_eq!(same.to_string().len(), 32);
    assert_ne!(same, key(one, BatchJob { spacing: Some(25.0), ..BatchJob::options() }));
    let cloth = |folder: &Path| BatchJob {
        fabric: Some(folder.join("cloth.yaml").display().to_string()),
        ..BatchJob::options()
    };
    assert_eq!(key(one, cloth(one)), key(two, cloth(two)));
    fs::write(two.join("curve.csv"), "0 0\n1 1\n").expect("written");
    assert_ne!(same, key(two, BatchJob::options()));
    assert_ne!(key(one, cloth(one)), key(one, cloth(two)));
    fs::remove_file(two.join("skirt.yaml")).expect("removed");
    assert_ne!(same, key(two, BatchJob::options()));
}

/// An index that was written again after this many seconds differed in its last digit from the one before.
#[test]
fn a_number_is_read_back_as_it_was_written() {
    let seconds = 1.971_962_737_000_000_1;
    let text = serde_json::to_string(&seconds).expect("written");
    assert_eq!(serde_json::from_str::<f64>(&text).expect("read").to_bits(), f64::to_bits(seconds));
}
