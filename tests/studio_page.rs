//! The studio in a real browser: a drawing of FreeSewing becomes a sewn garment by clicks alone.
//!
//! Skipped, saying so, where no Chromium is installed.

mod browser;
mod served;

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use browser::Browser;
use served::{PATIENCE, Served};
use toile::io::garment::read_file_only;
use toile::pattern::GarmentFile;

/// Waits until a script in the page gives true.
#[track_caller]
fn until(browser: &mut Browser, script: &str) {
    let begin = Instant::now();
    while browser.value(script) != true {
        if begin.elapsed() > PATIENCE {
            let said = browser.value("document.querySelector('main').innerText.slice(0, 3000)");
            panic!("{script}: {said}\n{:?}", browser.errors);
        }
        std::thread::sleep(Duration::from_millis(40));
    }
}

/// Clicks in the middle of an element, or of an edge's line.
#[track_caller]
fn click(browser: &mut Browser, element: &str, shift: bool) {
    until(browser, &format!("!!({element}) && !({element}).disabled"));
    let place = format!(
        "(() => {{ const all = {element}; const it = all.querySelector('path.hit') || all;
        it.scrollIntoView({{ block: 'center', behavior: 'instant' }});
        if (it.tagName === 'path' && it.classList.contains('hit')) {{
            const at = it.getPointAtLength(0.31 * it.getTotalLength()).matrixTransform(it.getScreenCTM());
            return {{ x: at.x, y: at.y }};
        }}
        const box = it.getBoundingClientRect();
        return {{ x: box.left + box.width / 2, y: box.top + box.height / 2 }}; }})()"
    );
    let at = browser.value(&place);
    let (x, y) = (at["x"].as_f64().expect("x"), at["y"].as_f64().expect("y"));
    browser.click(x, y, shift);
}

fn by_id(id: &str) -> String {
    format!("document.getElementById({})", serde_json::json!(id))
}

/// Does something that changes the file, and waits until the page shows it.
#[track_caller]
fn acting(browser: &mut Browser, act: impl FnOnce(&mut Browser)) {
    let version = browser.value("document.documentElement.dataset.state");
    act(browser);
    until(
        browser,
        &format!(
            "document.documentElement.dataset.state !== {version} || !!document.getElementById('said').textContent"
        ),
    );
    let said = browser.value("document.getElementById('said').textContent");
    assert_eq!(said, "", "refused");
}

#[track_caller]
fn act(browser: &mut Browser, id: &str) {
    acting(browser, |browser| click(browser, &by_id(id), false));
}

fn opened(studio: &Served) -> Option<Browser> {
    let Some(mut browser) = Browser::start() else {
        eprintln!("skipped: no Chromium is installed");
        return None;
    };
    browser.open(&studio.address);
    until(&mut browser, "Number(document.documentElement.dataset.state) > 0");
    Some(browser)
}

fn read(file: &Path) -> GarmentFile {
    read_file_only("garment", &fs::read_to_string(file).expect("a file")).expect("a garment file")
}

/// A garment file with its seams and free edges in the order of their names.
fn in_order(mut file: GarmentFile) -> GarmentFile {
    file.seams.sort_by(|a, b| a.name.value.cmp(&b.name.value));
    file.free.sort_by(|a, b| a.value.cmp(&b.value));
    file
}

/// The skirt of the drawing, finished in an editor.
const BY_HAND: &str = "\
garment: 1
name: freesewing_skirt
body: woman_92
pieces:
  front:
    cut: fold d
    place: hip front
    grain: [[50, 280], [50, 80]]
    outline: {start: 0 0, a: L 200 0, b: 'C 220 80, 270 200, 290 300', c: L 0 300, d: L 0 0}
  back:
    cut: fold d
    drawn: R
    place: hip back
    grain: [[50, 280], [50, 80]]
    outline: {start: 0 0, a: L 200 0, b: 'C 220 80, 270 200, 290 300', c: L 0 300, d: L 0 0}
  band:
    place: waist
    grain: [[50, 35], [50, 5]]
    outline: {start: 0 0, a: L 800 0, b: L 800 40, c: L 0 40, d: L 0 0}
seams:
  band: {sew: band.b, to: band.d}
  front_back: {sew: front.b, to: back.b}
  band_front_back: {sew: band.c, to: [front.a, back.a]}
free: [front.c, back.c, band.a]
";

/// Imports the drawing of a skirt in a folder of its own.
fn imported() -> (tempfile::TempDir, std::path::PathBuf) {
    let room = tempfile::tempdir().expect("a temporary folder");
    let drawing = room.path().join("freesewing_skirt.svg");
    fs::write(&drawing, include_str!("data/freesewing_skirt.svg")).expect("written");
    let file = room.path().join("skirt.yaml");
    let mut import = Command::new(env!("CARGO_BIN_EXE_toile"));
    let run = import.args(["import", "svg"]).arg(&drawing).arg("-o").arg(&file).output().expect("started");
    assert!(file.is_file(), "{}", String::from_utf8_lossy(&run.stderr));
    (room, file)
}

#[test]
fn a_drawing_becomes_a_sewn_garment_by_clicks_alone() {
    let (_room, file) = imported();
    let before = fs::read_to_string(&file).expect("a file");
    let studio = Served::start(&file, &["--spacing", "25"]);
    let Some(mut browser) = opened(&studio) else { return };
    let browser = &mut browser;
    act(browser, "body woman_92");
    // A seam that is suggested.
    acting(browser, |browser| click(browser, "document.querySelector('[data-offer=front_back]')", false));
    // Two edges, and a chain.
    click(browser, &by_id("edge band.b"), false);
    click(browser, &by_id("edge band.d"), false);
    act(browser, "sew");
    click(browser, &by_id("edge band.c"), false);
    click(browser, &by_id("edge front.a"), false);
    click(browser, &by_id("edge back.a"), true);
    act(browser, "sew");
    // Places on the body.
    for (piece, cover, area) in [("front", "front", "hip"), ("back", "back", "hip"), ("band", "all round", "waist")] {
        click(browser, &by_id(&format!("piece {piece}")), false);
        click(browser, &by_id(&format!("cover {cover}")), false);
        act(browser, &format!("area {area}"));
    }
    let by_hand = in_order(read_file_only("by hand", BY_HAND).expect("a garment"));
    assert_eq!(in_order(read(&file)), by_hand, "{}", studio.text());
    let after = studio.text();
    for remark in before.lines().filter(|line| line.trim_start().starts_with('#')) {
        assert!(after.contains(remark), "{remark} is lost");
    }
    let begin = Instant::now();
    until(browser, "document.documentElement.dataset.sound === 'true'");
    until(browser, "Number(document.documentElement.dataset.garment) > 0");
    println!("a garment is seen {} ms after the last click", begin.elapsed().as_millis());
    until(browser, "Number(document.documentElement.dataset.report) > 0");
    println!("all of it after {} ms", begin.elapsed().as_millis());
    assert_eq!(browser.value("toile.cloth.pieces.length"), 3);
    assert!(browser.value("toile.body.count").as_u64() > Some(1000), "it is worn");
    assert!(
        browser.value("document.getElementById('tables').textContent").as_str().is_some_and(|t| t.contains("Girths"))
    );
    everything_is_undone(browser, &file, &before, &after);
    assert_eq!(browser.errors, Vec::<String>::new());
    let host = format!("\"http://{}/", studio.host);
    let foreign = browser.requests.iter().find(|asked| !asked.starts_with(&host) && !asked.starts_with("\"data:"));
    assert_eq!(foreign, None);
}

/// Back to the imported file, and on again, to the byte.
fn everything_is_undone(browser: &mut Browser, file: &Path, before: &str, after: &str) {
    for _ in 0..7 {
        act(browser, "undo");
    }
    assert_eq!(fs::read_to_string(file).expect("a file"), before);
    assert_eq!(browser.value("document.getElementById('undo').disabled"), true);
    for _ in 0..7 {
        act(browser, "redo");
    }
    assert_eq!(fs::read_to_string(file).expect("a file"), after);
}

#[test]
fn names_and_lengths_are_typed_and_keys_do_what_clicks_do() {
    let (_room, file) = imported();
    let studio = Served::start(&file, &["--spacing", "25"]);
    let Some(mut browser) = opened(&studio) else { return };
    let browser = &mut browser;
    click(browser, &by_id("edge band.a"), false);
    click(browser, &by_id("edge-name"), false);
    browser.type_text("upper");
    act(browser, "name");
    assert!(studio.text().contains("upper: L 800 0"), "{}", studio.text());
    // By keys: an edge, another one, and the button.
    let focus = |browser: &mut Browser, id: &str| {
        browser.value(&format!("{}.focus()", by_id(id)));
    };
    for edge in ["edge front.b", "edge back.b"] {
        focus(browser, edge);
        browser.key("Enter");
        let focused = browser.value("document.activeElement.id");
        assert_eq!(focused, edge, "the focus stays");
        assert_eq!(browser.value("document.activeElement.getAttribute('aria-pressed')"), "true");
    }
    act(browser, "sew");
    assert_eq!(read(&file).seams.len(), 1);
    click(browser, &by_id("ease front_back"), false);
    browser.type_text("5");
    acting(browser, |browser| browser.key("Tab"));
    act(browser, "unpick front_back");
    assert_eq!(read(&file).seams.len(), 0);
    assert_eq!(browser.errors, Vec::<String>::new());
}

#[test]
fn a_save_shows_its_problems_and_names_are_text() {
    let (_room, file) = imported();
    let studio = Served::start(&file, &["--spacing", "25"]);
    let Some(mut browser) = opened(&studio) else { return };
    let browser = &mut browser;
    let evil = "<img src=x onerror=\"document.title='owned'\"><script>document.title='owned'</script>";
    let text = studio.text();
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let name = lines.iter().position(|line| line.starts_with("name:")).expect("a name");
    lines[name] = format!("name: {}", serde_json::json!(evil));
    lines.push(format!("closures: [{{kind: button, on: {}}}]", serde_json::json!(evil)));
    let begin = Instant::now();
    fs::write(&file, lines.join("\n")).expect("saved");
    until(browser, "document.getElementById('problems').textContent.includes('onerror')");
    println!("problems are seen {} ms after a save", begin.elapsed().as_millis());
    let said = browser.value("document.getElementById('problems').textContent");
    assert!(said.as_str().is_some_and(|said| said.contains(&format!("line {}:", lines.len()))), "{said}");
    assert_eq!(browser.value("document.querySelectorAll('main img, main script').length"), 0);
    assert_eq!(browser.value("document.getElementById('title').textContent"), evil);
    assert_ne!(browser.value("document.title"), "owned");
    assert_eq!(browser.errors, Vec::<String>::new());
}

/// Chooses a value of a list, as a click on it does.
fn choose(browser: &mut Browser, id: &str, value: &str) {
    let list = by_id(id);
    until(browser, &format!("!!{list}"));
    browser.value(&format!(
        "(() => {{ const list = {list}; list.value = {}; list.dispatchEvent(new Event('change')); }})()",
        serde_json::json!(value)
    ));
}

#[test]
fn a_maker_alters_measures_and_chooses_a_size_without_an_editor() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let file = room.path().join("skirt.yaml");
    let text = format!("{}sizes: {{S: []}}   # one more\n", include_str!("data/skirt.yaml"));
    fs::write(&file, &text).expect("written");
    let studio = Served::start(&file, &["--spacing", "25"]);
    let Some(mut browser) = opened(&studio) else { return };
    let browser = &mut browser;
    // A seam is taken in: the one of the edge that is clicked.
    click(browser, &by_id("edge front.left"), false);
    choose(browser, "alter kind", "let_out");
    assert_eq!(browser.value(&format!("{}.value", by_id("alter seam"))), "right");
    choose(browser, "alter where", "3");
    act(browser, "alter");
    assert!(studio.text().contains("alter:\n  - {let_out: right, at: {100 %: 10 mm}}"), "{}", studio.text());
    // Both pieces are made longer, at the height of the click.
    choose(browser, "alter kind", "lengthen");
    click(browser, &by_id("piece front"), false);
    click(browser, &by_id("alter piece back"), false);
    until(browser, "document.querySelectorAll('#board .slash').length === 2");
    act(browser, "alter");
    let lengthened = read(&file).alter.pop().expect("an alteration").value;
    assert!(format!("{lengthened:?}").contains("back"), "{lengthened:?}");
    // One alone does not fit the other any more: said, and nothing is written.
    let before = studio.text();
    click(browser, &by_id("alter"), false);
    until(browser, "document.getElementById('said').textContent.includes('cannot be done')");
    assert_eq!(studio.text(), before);
    act(browser, "unalter 1");
    assert_eq!(read(&file).alter.len(), 1);
    choose(browser, "measure-name", "waist");
    click(browser, &by_id("measure-value"), false);
    browser.type_text("76 cm");
    acting(browser, |browser| browser.key("Tab"));
    assert!(studio.text().contains("body: {like: woman_92, waist: 76 cm}"), "{}", studio.text());
    acting(browser, |browser| choose(browser, "size", "S"));
    assert!(studio.text().contains("# one more"));
    // A colour of the page alone.
    until(browser, "Number(document.documentElement.dataset.garment) > 0");
    let paint = "(() => { const field = document.getElementById('color shell'); field.value = '#c02020'; \
                 field.dispatchEvent(new Event('input')); \
                 return Array.from(toile.colorsOf(toile.maps[0], toile.cloth).slice(0, 3)); })()";
    assert_eq!(browser.value(paint), serde_json::json!([192, 32, 32]));
    for _ in 0..4 {
        act(browser, "undo");
    }
    assert_eq!(studio.text(), text);
    // The browser itself tells of the act that was refused, and of nothing else.
    let [refused] = &browser.errors[..] else { panic!("{:?}", browser.errors) };
    assert!(refused.contains("400") && refused.contains("/act"), "{refused}");
}
