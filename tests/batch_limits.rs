//! Batches whose disk is full, and jobs that are too large or never end.

#![cfg(target_os = "linux")]

mod room;

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{BufWriter, Write as _};
use std::process::Command;

use room::{COARSE, ENDLESS, Room, skirt, skirts, text};
use serde_json::json;

/// Jobs of the batch that fills its disk.
const JOBS: usize = 6;
/// A disk that has room for three results of 1.5 MiB or so, and one that has room for all.
const SMALL: &str = "5m";
const LARGE: &str = "100m";
/// Exit code with which a system says that it lets nobody but root mount a disk.
const NO_DISK: i32 = 99;

/// Runs the batch on a small disk in memory, then on the same disk when it has grown, and copies the store out of it.
/// Says how each run ended and how many results it left.
const SCRIPT: &str = r#"
mkdir disk && mount -t tmpfs -o size="$2" none disk || exit 99
for size in "$2" "$3"; do
    mount -o remount,size="$size" disk || exit 99
    "$1" batch jobs.jsonl -o disk/store -j 2 --quiet
    exit=$?
    failed=$(ls disk/store/failed 2>/dev/null | wc -l)
    echo "exit $exit results $(ls disk/store | grep -cE '^[0-9a-f]{32}$') failed $failed"
    for folder in $(ls disk/store | grep -E '^[0-9a-f]{32}$'); do
        [ -s "disk/store/$folder/job.json" ] && [ -s "disk/store/$folder/garment.obj" ] || echo "half $folder"
    done
done
cp -r disk/store store
"#;

#[test]
fn a_full_disk_stops_the_batch_and_it_goes_on_when_there_is_room() {
    let room = Room::new();
    room.list("jobs.jsonl", &skirts(JOBS));
    // A namespace of its own lets also others than root mount a disk, where the system has them.
    let run = Command::new("unshare")
        .args(["--user", "--map-root-user", "--mount", "sh", "-c", SCRIPT, "sh"])
        .args([env!("CARGO_BIN_EXE_toile"), SMALL, LARGE])
        .current_dir(room.0.path())
        .output();
    let ran = run.ok().filter(|run| run.status.code() != Some(NO_DISK) && text(&run.stdout).contains("exit"));
    let Some(run) = ran else {
        eprintln!("SKIPPED: this system lets nobody but root make a small disk");
        return;
    };
    let (said, complained) = (text(&run.stdout), text(&run.stderr));
    let lines: Vec<&str> = said.lines().collect();
    let full: Vec<&str> = lines[0].split(' ').collect();
    assert_eq!([full[1], full[5]], ["4", "0"], "{said}{complained}");
    assert!((1..JOBS).contains(&full[3].parse().expect("a number")), "{said}");
    assert!(complained.contains("cannot write the store"), "{complained}");
    assert_eq!(lines[1..], [format!("exit 0 results {JOBS} failed 0")], "{said}{complained}");

    assert_eq!(room.run(&["batch", "jobs.jsonl", "-o", "plain", "--quiet"]).status.code(), Some(0));
    let folders = |store: &str| {
        let index = room.index(store);
        index.iter().map(|(id, line)| (id.clone(), line["folder"].clone())).collect::<Vec<_>>()
    };
    assert_eq!(folders("store"), folders("plain"));
    assert_eq!(room.names("store/.work"), ["lock"]);
}

/// A closed ball of so many triangles round it and along it.
fn ball(around: usize, along: usize, file: &File) -> std::io::Result<()> {
    let mut out = BufWriter::new(file);
    let mut points = String::new();
    let row = |r: usize, k: usize| 2 + (r - 1) * around + k % around;
    out.write_all(b"v 0 50 0\n")?;
    for r in 1..along {
        let (sin, cos) = (std::f64::consts::PI * r as f64 / along as f64).sin_cos();
        points.clear();
        for k in 0..around {
            let turn = std::f64::consts::TAU * k as f64 / around as f64;
            let _ =
                writeln!(points, "v {:.6} {:.6} {:.6}", 50.0 * sin * turn.cos(), 50.0 * cos, -50.0 * sin * turn.sin());
        }
        out.write_all(points.as_bytes())?;
    }
    out.write_all(b"v 0 -50 0\n")?;
    let last = 2 + (along - 1) * around;
    for k in 0..around {
        writeln!(out, "f 1 {} {}", row(1, k), row(1, k + 1))?;
        for r in 1..along - 1 {
            let [a, b, c, d] = [row(r, k), row(r + 1, k), row(r, k + 1), row(r + 1, k + 1)];
            writeln!(out, "f {a} {b} {c}\nf {c} {b} {d}")?;
        }
        writeln!(out, "f {} {last} {}", row(along - 1, k), row(along - 1, k + 1))?;
    }
    out.flush()
}

#[test]
fn what_is_too_large_or_never_ends_fails_alone() {
    let room = Room::new();
    // A garment file of a gigabyte, of which the disk keeps nothing.
    let file = File::create(room.path("gigabyte.yaml")).expect("made");
    file.set_len(1 << 30).expect("a long file");
    // 2236 × 1119 quadrilaterals are five million triangles.
    ball(2236, 1119, &File::create(room.path("body.obj")).expect("made")).expect("written");
    let mut jobs = vec![
        json!({"id": "gigabyte", "garment": "gigabyte.yaml"}),
        json!({"id": "body", "garment": "skirt.yaml", "body": "body.obj", "spacing": COARSE}),
        skirt("first", COARSE),
        skirt("second", COARSE + 1.0),
    ];
    // The endless garment has a run of its own: how much memory it holds after some seconds depends on the machine.
    for limits in [["--memory", "900M"], ["--time", "20"]] {
        room.list("jobs.jsonl", &jobs);
        let run = room.run(&[&["batch", "jobs.jsonl", "-o", "store", "-j", "2"], &limits[..]].concat());
        assert_eq!(run.status.code(), Some(3), "{}", text(&run.stderr));
        jobs.push(skirt("hangs", ENDLESS));
    }
    let index = room.index("store");
    for (id, exit, why) in [
        ("gigabyte", json!(2), "1073741824 bytes"),
        ("body", json!(null), "900 MiB, the memory limit"),
        ("hangs", json!(null), "20 s, the time limit"),
    ] {
        let line = &index[id];
        assert_eq!((&line["state"], &line["exit"]), (&json!("failed"), &exit), "{line}");
        assert!(line["error"].as_str().is_some_and(|error| error.contains(why)), "{line}");
    }
    for id in ["first", "second"] {
        assert_eq!(index[id]["state"], "done", "{}", index[id]);
    }
    assert_eq!(fs::read_dir(room.path("store/failed")).expect("failures").count(), 3);
}
