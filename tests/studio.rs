//! The studio's doors, and its file: who is kept out, how much it takes, what an act does to the bytes of the file.

mod served;

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;
use std::thread;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use served::{PATIENCE, Served, answer};
use tempfile::TempDir;

const SKIRT: &str = include_str!("data/skirt.yaml");

/// A skirt in a folder with a file that is nobody's business.
fn room() -> (TempDir, PathBuf) {
    let room = tempfile::tempdir().expect("a temporary folder");
    fs::create_dir(room.path().join("garment")).expect("made");
    fs::write(room.path().join("secret.txt"), "secret").expect("written");
    fs::write(room.path().join("garment/secret.txt"), "secret").expect("written");
    let file = room.path().join("garment/skirt.yaml");
    fs::write(&file, SKIRT).expect("written");
    (room, file)
}

/// The skirt with a seam missing: no garment is made, so that the machine is quiet.
fn quiet() -> (TempDir, Served) {
    let (room, file) = room();
    let from = SKIRT.find("seams:").expect("seams");
    let to = SKIRT.find("free:").expect("free");
    fs::write(&file, format!("{}{}", &SKIRT[..from], &SKIRT[to..])).expect("written");
    let served = Served::start(&file, &["--spacing", "25"]);
    (room, served)
}

#[test]
fn strangers_are_kept_out() {
    let (_room, studio) = quiet();
    let before = studio.text();
    let (host, inside) = (studio.host.clone(), studio.inside.clone());
    let get = |path: &str, fields: &str| studio.raw(format!("GET {path} HTTP/1.1\r\n{fields}\r\n").as_bytes());
    let own = format!("Host: {host}\r\n");
    assert_eq!(get(&inside, &own).0, 200);
    // No token, another one, a part of it.
    for path in
        ["/", "/state.json", "/act", "//", &format!("/{}/", "0".repeat(64)), &inside[..20], &format!("/x{inside}")]
    {
        assert_eq!(get(path, &own).0, 403, "{path}");
    }
    // A name that was made to lead here, or none.
    let port = host.split(':').nth(1).expect("a port");
    for field in [
        "Host: evil.example\r\n".to_owned(),
        format!("Host: evil.example:{port}\r\n"),
        format!("Host: localhost:{port}\r\n"),
        "Host: 127.0.0.1\r\n".to_owned(),
        format!("{own}Host: evil.example\r\n"),
        String::new(),
    ] {
        assert_eq!(get(&inside, &field).0, 403, "{field}");
    }
    // Pages of others, which know the token from somewhere.
    for origin in ["http://evil.example", "null", "http://127.0.0.1:1", "https://127.0.0.1", ""] {
        assert_eq!(get(&format!("{inside}state.json"), &format!("{own}Origin: {origin}\r\n")).0, 403, "{origin}");
    }
    assert_eq!(get(&format!("{inside}state.json"), &format!("{own}Sec-Fetch-Site: cross-site\r\n")).0, 403);
    let act = json!({ "base": studio.state()["version"], "act": { "do": "body", "name": "man_100" } }).to_string();
    let whole = studio.message(&act);
    for (from, to) in [
        (format!("Origin: http://{host}\r\n"), String::new()),
        (format!("Origin: http://{host}"), "Origin: http://evil.example".to_owned()),
        (format!("Origin: http://{host}"), "Origin: null".to_owned()),
        (inside.clone(), "/".to_owned()),
    ] {
        assert_eq!(studio.raw(whole.replacen(&from, &to, 1).as_bytes()).0, 403, "{from}");
    }
    // As a form of another page would send it.
    for kind in ["text/plain", "application/x-www-form-urlencoded", "application/json; x=y"] {
        assert_eq!(studio.raw(whole.replace("application/json", kind).as_bytes()).0, 400, "{kind}");
    }
    assert_eq!(studio.text(), before, "nobody has changed the file");
    assert_eq!(studio.raw(whole.as_bytes()).0, 200, "the page has");
    assert_ne!(studio.text(), before);
}

#[test]
fn no_file_is_served() {
    let (_room, studio) = quiet();
    for path in [
        "secret.txt",
        "../secret.txt",
        "../garment/secret.txt",
        "skirt.yaml",
        "%2e%2e/secret.txt",
        "..%2fsecret.txt",
        "..\\secret.txt",
        "../../../../../../etc/passwd",
        "/etc/passwd",
        "state.json/../../secret.txt",
        "./state.json",
        "state.json/",
        "STATE.JSON",
        "state.json%00",
    ] {
        let (status, body) = studio.get(&format!("{}{path}", studio.inside));
        assert!(status == 404 && !body.contains("secret"), "{path}: {status} {body}");
    }
    let absolute =
        format!("GET http://{}{}state.json HTTP/1.1\r\nHost: {}\r\n\r\n", studio.host, studio.inside, studio.host);
    assert_eq!(studio.raw(absolute.as_bytes()).0, 403);
    for method in ["PUT", "DELETE", "OPTIONS", "HEAD", "CONNECT", "TRACE"] {
        let request = format!("{method} {}state.json HTTP/1.1\r\nHost: {}\r\n\r\n", studio.inside, studio.host);
        assert_eq!(studio.raw(request.as_bytes()).0, 405, "{method}");
    }
    // Acts name nothing outside the file either.
    for act in [
        json!({ "do": "body", "name": "../secret.txt" }),
        json!({ "do": "fabric", "name": "shell", "cloth": "/etc/passwd" }),
        json!({ "do": "length", "path": ["body"], "value": "12" }),
        json!({ "do": "write", "text": "x" }),
        json!({ "do": "place", "piece": "front", "words": ["hip", "front\nfree: []"] }),
        json!({ "do": "name", "edge": "front.hem", "name": "a: {b: c}" }),
    ] {
        let before = studio.text();
        assert_eq!(studio.act(&act).0, 400, "{act}");
        assert_eq!(studio.text(), before);
    }
}

#[test]
fn huge_and_broken_messages_are_refused() {
    let (_room, studio) = quiet();
    let head = |fields: &str| {
        format!(
            "POST {}act HTTP/1.1\r\nHost: {}\r\nOrigin: http://{}\r\nContent-Type: application/json\r\n{fields}\r\n",
            studio.inside, studio.host, studio.host
        )
    };
    assert_eq!(studio.raw(head("Content-Length: 10000000000\r\n").as_bytes()).0, 413);
    assert_eq!(studio.raw(head("Content-Length: 99999999999999999999999\r\n").as_bytes()).0, 413);
    assert_eq!(studio.raw(head("Transfer-Encoding: chunked\r\n").as_bytes()).0, 400);
    assert_eq!(studio.raw(head("Content-Length: 2\r\nContent-Length: 3\r\n").as_bytes()).0, 400);
    assert_eq!(studio.raw(head("Content-Length: -1\r\n").as_bytes()).0, 400);
    // 64 KiB are read and found to be no act. A byte more is not read.
    let body = |length: usize| format!("{}{}", head(&format!("Content-Length: {length}\r\n")), "[".repeat(length));
    assert_eq!(studio.raw(body(64 << 10).as_bytes()).0, 400);
    assert_eq!(studio.raw(body((64 << 10) + 1).as_bytes()).0, 413);
    let long = head(&format!("X: {}\r\n", "x".repeat(1 << 20)));
    assert!([431, 0].contains(&studio.raw(long.as_bytes()).0), "a head of a megabyte");
    let many = head(&"X: y\r\n".repeat(200));
    assert_eq!(studio.raw(many.as_bytes()).0, 431);
    let path = format!("GET /{} HTTP/1.1\r\n\r\n", "a/".repeat(1 << 19));
    assert!([431, 0].contains(&studio.raw(path.as_bytes()).0), "a path of a megabyte");
    assert_eq!(studio.raw(b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n").0, 400);
    // Deep nesting takes no stack.
    let deep = format!("{{\"base\": 1, \"act\": {}", "{\"do\":".repeat(9000));
    assert_eq!(studio.raw(studio.message(&deep).as_bytes()).0, 400);
    assert_eq!(studio.get(&studio.inside).0, 200, "it goes on");
}

/// Memory in use, KiB, where the system tells.
fn memory(studio: &Served) -> Option<u64> {
    let text = fs::read_to_string(format!("/proc/{}/status", studio.child.id())).ok()?;
    let line = text.lines().find(|line| line.starts_with("VmRSS"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

#[test]
fn a_flood_of_messages_is_bounded() {
    let (_room, studio) = quiet();
    let before = (studio.text(), memory(&studio));
    let act = json!({ "base": 0, "act": { "do": "undo" } }).to_string();
    let message = studio.message(&act);
    let (mut refused, mut heard) = (0, 0);
    let begin = Instant::now();
    for _ in 0..4000 {
        match studio.raw(message.as_bytes()).0 {
            429 | 503 => refused += 1,
            // A state that is long gone.
            409 => heard += 1,
            other => assert_eq!(other, 0),
        }
    }
    let seconds = begin.elapsed().as_secs_f64();
    println!("{heard} of 4000 messages were heard, {refused} refused, in {seconds:.1} s");
    // 200 at once and 50 a second.
    assert!(f64::from(heard) <= 201.0 + 50.0 * seconds, "{heard} in {seconds} s");
    thread::sleep(Duration::from_secs(1));
    assert_eq!(studio.get(&studio.inside).0, 200, "it goes on");
    assert_eq!(studio.text(), before.0);
    if let (Some(before), Some(after)) = (before.1, memory(&studio)) {
        println!("memory {before} KiB before, {after} KiB after");
        assert!(after < before + (64 << 10), "{before} KiB, {after} KiB");
    }
}

#[test]
fn idle_connections_are_bounded_and_end() {
    let (_room, studio) = quiet();
    let mut idle: Vec<_> = (0..300).map(|_| studio.connect()).collect();
    let begin = Instant::now();
    idle.iter_mut().for_each(|stream| drop(stream.write_all(b"GET / HTTP/1.1\r\n")));
    // Those that come too many are told so at once, the others are left after five seconds.
    let answers: Vec<u16> = idle.iter_mut().map(|stream| answer(stream).0).collect();
    let busy = answers.iter().filter(|status| **status == 503).count();
    assert!(answers.iter().all(|status| [0, 503].contains(status)), "{answers:?}");
    assert!(busy >= 100, "{busy} of 300 were turned away");
    assert!(begin.elapsed() < Duration::from_secs(25), "{:?}", begin.elapsed());
    assert_eq!(studio.get(&studio.inside).0, 200, "it goes on");
    // Pages that listen are few, too.
    let listen = format!("GET {}events HTTP/1.1\r\nHost: {}\r\n\r\n", studio.inside, studio.host);
    let mut streams: Vec<_> = (0..20).map(|_| studio.connect()).collect();
    let statuses: Vec<String> = streams
        .iter_mut()
        .map(|stream| {
            stream.write_all(listen.as_bytes()).expect("sent");
            let mut line = String::new();
            let _ = BufReader::new(stream).read_line(&mut line);
            line
        })
        .collect();
    let heard = statuses.iter().filter(|line| line.contains("200")).count();
    assert_eq!(heard, 8, "{statuses:?}");
}

#[test]
fn answers_keep_other_pages_away() {
    let (_room, studio) = quiet();
    let mut stream = studio.connect();
    write!(stream, "GET {} HTTP/1.1\r\nHost: {}\r\n\r\n", studio.inside, studio.host).expect("sent");
    let mut text = String::new();
    let mut reader = BufReader::new(stream);
    while reader.read_line(&mut text).is_ok_and(|read| read > 2) {}
    for field in [
        "X-Frame-Options: DENY",
        "X-Content-Type-Options: nosniff",
        "Referrer-Policy: no-referrer",
        "Cache-Control: no-store",
        "Cross-Origin-Resource-Policy: same-origin",
        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'",
        "frame-ancestors 'none'",
    ] {
        assert!(text.contains(field), "{field}: {text}");
    }
    assert!(!text.to_lowercase().contains("access-control-allow"), "{text}");
    let token = studio.inside.trim_matches('/');
    assert!(token.len() == 64 && token.bytes().all(|b| b.is_ascii_hexdigit()), "{token}");
    assert!(studio.host.starts_with("127.0.0.1:"));
}

/// The piece of the skirt's front loses its hem's name, as a slip in an editor does.
#[test]
fn a_save_is_seen_with_its_problems() {
    let (_room, file) = room();
    let studio = Served::start(&file, &["--spacing", "25"]);
    studio.waited(|state| state["sound"] == true);
    let broken = SKIRT.replace("front.right", "front.rigt");
    assert_ne!(broken, SKIRT, "the skirt has such a seam");
    fs::write(&file, &broken).expect("saved");
    let (state, after) = studio.waited(|state| state["sound"] == false);
    println!("a save was seen after {} ms", after.as_millis());
    let problem = &state["problems"][0];
    let line = broken.lines().position(|line| line.contains("front.rigt")).expect("a line") + 1;
    assert_eq!(problem["line"], line, "{problem}");
    assert!(problem["message"].as_str().is_some_and(|said| said.contains("rigt")), "{problem}");
    assert!(problem["pieces"].as_array().is_some_and(|names| names.iter().any(|n| n == "front")), "{problem}");
    // An editor that writes a new file and renames it.
    let beside = file.with_extension("tmp");
    fs::write(&beside, SKIRT).expect("written");
    fs::rename(&beside, &file).expect("renamed");
    studio.waited(|state| state["sound"] == true);
    fs::remove_file(&file).expect("removed");
    let (state, _) = studio.waited(|state| state["sound"] == false);
    assert!(!state["pieces"].as_array().expect("pieces").is_empty(), "what was there is still shown: {state}");
    assert_eq!(studio.act(&json!({ "do": "body", "name": "man_100" })).0, 400);
}

#[test]
fn the_garment_comes_coarse_first_and_a_newer_save_takes_over() {
    let (_room, file) = room();
    let studio = Served::start(&file, &["--spacing", "12"]);
    let mut stream = studio.connect();
    stream.set_read_timeout(Some(PATIENCE)).expect("set");
    write!(stream, "GET {}events HTTP/1.1\r\nHost: {}\r\n\r\n", studio.inside, studio.host).expect("sent");
    let mut lines = BufReader::new(stream).lines();
    let mut next = |wanted: &dyn Fn(&Value) -> bool| loop {
        let line = lines.next().expect("a line").expect("text");
        let news: Option<Value> = line.strip_prefix("data: ").map(|text| serde_json::from_str(text).expect("JSON"));
        if let Some(news) = news.filter(|news| wanted(news)) {
            break news;
        }
    };
    let first = next(&|news| news["garment"].as_u64() > Some(0));
    assert_eq!(studio.part("about.json")["done"], false);
    assert_eq!(first["report"], 0);
    // Saved again while it is being made: the spacing of what comes next is that of the new make.
    let begin = Instant::now();
    fs::write(&file, SKIRT.replace("name:", "note: saved again\nname:")).expect("saved");
    let state = first["state"].as_u64();
    let seen = next(&|news| news["state"].as_u64() > state && news["making"] == true);
    let coarse = next(&|news| news["garment"].as_u64() > seen["garment"].as_u64());
    println!("coarse garment {} ms after a save", begin.elapsed().as_millis());
    assert!(coarse["failed"].is_null(), "{coarse}");
    let done = next(&|news| news["report"].as_u64() > Some(0) && news["report"] == news["garment"]);
    println!("all of it {} ms after a save", begin.elapsed().as_millis());
    assert!(done["garment"].as_u64() > coarse["garment"].as_u64());
    assert_eq!(studio.part("about.json")["done"], true);
    assert!(studio.part("report.json")["pieces"].as_array().is_some_and(|pieces| pieces.len() == 2));
}

#[test]
fn acts_change_the_file_and_are_undone_to_the_byte() {
    let (_room, file) = room();
    let with = SKIRT.replace("seams:", "# The seams, in order.\r\nseams:");
    fs::write(&file, &with).expect("written");
    let studio = Served::start(&file, &["--spacing", "25"]);
    let act = |act: Value| studio.act(&act);
    assert_eq!(act(json!({ "do": "undo" })).0, 400, "nothing was done yet");
    assert_eq!(act(json!({ "do": "body", "name": "man_100" })).0, 200);
    let dressed = studio.text();
    assert!(dressed.contains("body: man_100") && dressed.contains("# The seams, in order.\r\n"), "{dressed}");
    assert_eq!(act(json!({ "do": "unpick", "seam": "left" })).0, 200);
    let unpicked = studio.text();
    assert_eq!(act(json!({ "do": "undo" })).0, 200);
    assert_eq!(studio.text(), dressed);
    assert_eq!(act(json!({ "do": "undo" })).0, 200);
    assert_eq!(studio.text(), with);
    assert_eq!(act(json!({ "do": "redo" })).0, 200);
    assert_eq!(act(json!({ "do": "redo" })).0, 200);
    assert_eq!(studio.text(), unpicked);
    // A save elsewhere is never undone.
    fs::write(&file, format!("{unpicked}# mine\n")).expect("saved");
    studio.waited(|state| state["undo"].is_null());
    // The file is still being checked for a while, in which no act is done.
    let undone = (0..100).map(|_| act(json!({ "do": "undo" })).0).find(|status| {
        thread::sleep(Duration::from_millis(50));
        *status != 409
    });
    assert_eq!(undone, Some(400));
    assert_eq!(studio.text(), format!("{unpicked}# mine\n"));
    // An act meant for an older state is refused.
    let old = json!({ "base": 1, "act": { "do": "body", "name": "woman_92" } }).to_string();
    assert_eq!(studio.raw(studio.message(&old).as_bytes()).0, 409);
    // And so is one while the file on disk is another than the page shows.
    let version = studio.state()["version"].clone();
    fs::write(&file, SKIRT).expect("saved");
    let act = json!({ "base": version, "act": { "do": "body", "name": "man_100" } }).to_string();
    assert_eq!(studio.raw(studio.message(&act).as_bytes()).0, 409);
    assert_eq!(studio.text(), SKIRT);
}

/// A skirt with two sizes.
const SIZES: &str = "sizes:   # in the shop
  S: []
  L: [{let_out: left, at: {0: 10, 100 %: 10}}, {let_out: right, at: {0: 10, 100 %: 10}}]
";

/// Waits until a garment is done, and gives its report.
fn made(studio: &Served, since: &Value) -> Value {
    let begin = Instant::now();
    loop {
        let report = studio.get(&format!("{}report.json", studio.inside)).1;
        if let Some(report) = serde_json::from_str(&report).ok().filter(|report: &Value| report != since) {
            return report;
        }
        assert!(begin.elapsed() < PATIENCE, "no garment");
        thread::sleep(Duration::from_millis(100));
    }
}

/// Length of the hem of a report's garment, mm.
fn hem(report: &Value) -> f64 {
    let worn = report["worn"].as_array().expect("openings");
    let hem = worn.iter().find(|opening| opening["opening"].as_str().is_some_and(|name| name.contains("hem")));
    hem.and_then(|hem| hem["length"].as_f64()).expect("a hem")
}

#[test]
fn sizes_and_alterations_are_chosen_and_the_garment_follows() {
    let (_room, file) = room();
    let text = format!("{SKIRT}{SIZES}");
    fs::write(&file, &text).expect("written");
    let studio = Served::start(&file, &["--spacing", "25", "--size", "L"]);
    assert_eq!((&studio.state()["size"], &studio.state()["sizes"]), (&json!("L"), &json!(["S", "L"])));
    let large = made(&studio, &Value::Null);
    assert_eq!(studio.act(&json!({ "do": "size", "name": "XL" })).0, 400);
    assert_eq!(studio.act(&json!({ "do": "size", "name": null })).0, 200);
    let drawn = made(&studio, &large);
    // Two seams, two edges each, 10 mm each.
    assert!((hem(&large) - hem(&drawn) - 40.0).abs() < 4.0, "{} {}", hem(&large), hem(&drawn));
    assert_eq!(studio.text(), text, "a size belongs to the page");
    let take_in = json!({ "take_in": "left", "at": { "100 %": "15 mm" } }).to_string();
    assert_eq!(studio.act(&json!({ "do": "alter", "alteration": take_in })).0, 200);
    let altered = studio.text();
    assert!(altered.contains("# in the shop") && altered.contains("alter:\n  - {take_in: left, at: {100 %: 15 mm}}"));
    assert_eq!(studio.state()["alterations"], json!(["take in left, 15 mm at 100 %"]));
    let taken_in = made(&studio, &drawn);
    assert!((hem(&drawn) - hem(&taken_in) - 30.0).abs() < 4.0, "{} {}", hem(&drawn), hem(&taken_in));
    // It has gone on from the one before; sewn from nothing it comes out the same.
    assert!(large["from"].is_null() && taken_in["from"]["anew"] == false, "{}", taken_in["from"]);
    assert_eq!(studio.act(&json!({ "do": "anew" })).0, 200);
    let anew = made(&studio, &taken_in);
    assert!(anew["from"].is_null() && (hem(&anew) - hem(&taken_in)).abs() < 2.0, "{}", anew["from"]);
    // Put on in another way it must not hang where it did.
    assert_eq!(studio.act(&json!({ "do": "place", "piece": "back", "words": ["waist", "back"] })).0, 200);
    assert!(made(&studio, &anew)["from"].is_null());
    assert_eq!(studio.act(&json!({ "do": "undo" })).0, 200);
    let (status, why) = studio.act(&json!({ "do": "alter", "alteration": "{lengthen: front, at: 150, by: 20}" }));
    assert!(status == 400 && why.contains("left"), "a seam no longer matches: {why}");
    assert_eq!(studio.act(&json!({ "do": "undo" })).0, 200);
    assert_eq!(studio.text(), text);
}
