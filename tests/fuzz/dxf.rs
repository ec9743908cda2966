//! DXF.

use toile::cutting::{Options, papers};
use toile::digitize::garment_file;
use toile::io::dxf_read::read_dxf_text;
use toile::io::dxf_write::cutting_dxf;
use toile::io::garment::{read_file_only, read_text, write};
use toile::pattern::drawings;

/// A piece on the fold, with a notch, a dart and a hole.
const GARMENT: &str = "
garment: 1
pieces:
  front:
    cut: fold center
    grain: [[60, 250], [60, 60]]
    outline: {start: 0 20, neck: C 40 20 60 0 80 -20, side: L 140 300, hem: L 0 300, center: L 0 20}
    notches: {side: [100 double]}
    darts: [{edge: hem, at: 60, intake: 12, length: 80}]
    holes: {slit: M 20 120 L 20 130 L 60 130 L 60 120 Z}
free: ['*.*']
";

#[test]
fn a_damaged_dxf_is_read_or_refused() {
    let loaded = read_text("garment", "garment.yaml", GARMENT).expect("a garment");
    let seed = cutting_dxf("seed", &papers(&drawings(&loaded.file, &loaded.garment), &Options::default()));
    super::shake(&[&seed], |text| {
        if let Ok(traced) = read_dxf_text(text, None) {
            let yaml = write(&garment_file("damaged", &traced).file).expect("YAML");
            read_file_only("damaged.yaml", &yaml).unwrap_or_else(|e| panic!("{e}\n{yaml}\n{text}"));
        }
    });
}
