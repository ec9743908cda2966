//! Patterns for cutting as PDF: pages to be joined, or one page; the only user of pdf-writer.
//!
//! Every material, and every size of it, is a layer (optional content) that readers switch on and off. Lengths are
//! true: one millimetre is 72/25.4 points, no scaling. Lettering is in Helvetica, which every reader has; letters of
//! other scripts are drawn as strokes in fonts of the file's own, and can be searched.

mod cover;
mod draw;
mod letters;
mod pages;

use pdf_writer::writers::Catalog;
use pdf_writer::{Finish as _, Name, Pdf, Rect, Ref, TextStr};

pub use pages::{booklet, one_page, tiled};

use draw::PageContent;

use crate::cutting::{Paper, PaperLayer};

/// Points per metre.
const POINTS: f64 = 72.0 / 0.0254;
/// Longest side of a page, points: readers refuse more (14400 units, ISO 32000-1 annex C).
const LONGEST_SIDE: f64 = 14400.0;

/// A format of paper, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Page {
    /// Across.
    pub width: f64,
    /// Down.
    pub height: f64,
    /// Its name.
    pub name: &'static str,
}

impl Page {
    /// ISO 216.
    pub const A4: Self = Self { width: 0.210, height: 0.297, name: "A4" };
    /// ANSI A.
    pub const LETTER: Self = Self { width: 0.2159, height: 0.2794, name: "Letter" };
}

/// Why a pattern could not be put on pages.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PdfError {
    /// A page longer than any reader shows.
    #[error(
        "the page would be {width:.0} × {height:.0} mm and PDF knows none over 5080 mm; \
         give another --width, or print on joined pages with --page a4"
    )]
    TooLarge {
        /// Millimetres.
        width: f64,
        /// Millimetres.
        height: f64,
    },
    /// More pages than anybody joins.
    #[error("the pattern would take {pages} pages, and at most {most} are written; check the file's units")]
    TooMany {
        /// Pages needed.
        pages: usize,
        /// The limit.
        most: usize,
    },
}

/// The letters of what is written on papers, and of `more`, that no font of the PDF has, each once; they are printed as
/// `?`.
pub fn unprintable(papers: &[Paper], more: &[String]) -> Vec<char> {
    let texts =
        papers.iter().flat_map(|paper| paper.texts.iter().map(|t| t.text.as_str()).chain([paper.name.as_str()]));
    let mut missing: Vec<char> = texts.chain(more.iter().map(String::as_str)).flat_map(letters::unprintable).collect();
    missing.sort_unstable();
    missing.dedup();
    missing
}

/// Pages of one size as a PDF file, with the `layers` that their content is marked with. The same pages give the
/// same bytes.
fn document(title: &str, [width, height]: [f64; 2], pages: Vec<PageContent>, layers: &[PaperLayer]) -> Vec<u8> {
    let mut pdf = Pdf::new();
    let (catalog, tree, font, info) = (Ref::new(1), Ref::new(2), Ref::new(3), Ref::new(4));
    let id = |k: usize, of: usize| Ref::new((5 + 2 * k + of) as i32);
    let layer = |k: usize| id(pages.len(), k);
    let shown: Vec<Ref> = (0..layers.len()).map(layer).collect();
    with_layers(pdf.catalog(catalog).pages(tree), &shown);
    for (layer, id) in layers.iter().zip(&shown) {
        let mut group = pdf.indirect(*id).dict();
        group.pair(Name(b"Type"), Name(b"OCG"));
        group.pair(Name(b"Name"), TextStr(&layer.words()));
    }
    pdf.pages(tree).kids((0..pages.len()).map(|k| id(k, 0))).count(pages.len() as i32);
    let letters = pages.iter().flat_map(|page| page.letters.iter().copied()).collect();
    let mut next = id(pages.len(), layers.len());
    let mut fonts = letters::write_fonts(&mut pdf, &letters, &mut next);
    fonts.push((letters::HELVETICA.to_owned(), font));
    for (k, PageContent { content, .. }) in pages.into_iter().enumerate() {
        let mut page = pdf.page(id(k, 0));
        page.media_box(Rect::new(0.0, 0.0, (width * POINTS) as f32, (height * POINTS) as f32));
        page.parent(tree).contents(id(k, 1));
        let mut resources = page.resources();
        let mut named = resources.fonts();
        for (name, font) in &fonts {
            named.pair(Name(name.as_bytes()), *font);
        }
        named.finish();
        let mut properties = resources.insert(Name(b"Properties")).dict();
        for (k, id) in shown.iter().enumerate() {
            properties.pair(Name(draw::layer_name(k).as_bytes()), *id);
        }
        properties.finish();
        resources.finish();
        page.finish();
        pdf.stream(id(k, 1), &content.finish());
    }
    pdf.type1_font(font).base_font(Name(b"Helvetica")).encoding_predefined(Name(b"WinAnsiEncoding"));
    pdf.document_info(info).title(TextStr(title)).producer(TextStr(concat!("toile ", env!("CARGO_PKG_VERSION"))));
    pdf.finish()
}

/// Lists layers, all of them shown, in the document's catalogue (ISO 32000-1, 8.11.4).
fn with_layers(catalog: &mut Catalog, layers: &[Ref]) {
    let mut properties = catalog.insert(Name(b"OCProperties")).dict();
    properties.insert(Name(b"OCGs")).array().items(layers.iter().copied());
    properties.insert(Name(b"D")).dict().insert(Name(b"Order")).array().items(layers.iter().copied());
}
