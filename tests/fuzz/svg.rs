//! SVG.

use toile::digitize::garment_file;
use toile::io::garment::{read_file_only, write};
use toile::io::svg_read::read_svg_text;

const SEEDS: [&str; 2] = [include_str!("../data/inkscape.svg"), include_str!("../data/freesewing.svg")];

#[test]
fn a_damaged_svg_is_read_or_refused() {
    super::shake(&SEEDS, |text| {
        if let Ok(traced) = read_svg_text(text) {
            let yaml = write(&garment_file("damaged", &traced).file).expect("YAML");
            read_file_only("damaged.yaml", &yaml).unwrap_or_else(|e| panic!("{e}\n{yaml}\n{text}"));
        }
    });
}
