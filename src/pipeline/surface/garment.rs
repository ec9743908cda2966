//! The flat pieces as a garment file, to be exported, altered and sewn.

use super::super::error::PipelineError;
use super::FlatSurface;
use super::darts::LaidPart;
use super::edges::PartRimEdge;
use super::form::ClosedForm;
use crate::geometry::{Cubic, MM, Vec2, smooth_curves};
use crate::input::LengthUnit;
use crate::io::garment::write;
use crate::io::result_names::FORM_OBJ;
use crate::pattern::{GarmentFile, Located, NotchFile, OutlineFile, PieceFile, Quantity, SeamFile, Spot, Value};

/// The fabric of a garment that was drawn as a surface, until its maker names another.
const FABRIC: &str = "cotton_poplin";
/// Decimals of a millimetre in the file.
const DECIMALS: f64 = 1e4;
/// Half the length of the grain line, mm.
const GRAIN: f64 = 50.0;
/// Distance that a smooth edge keeps from every vertex, mm: what a person can cut.
const SMOOTH: f64 = 0.1;

fn at_no_place<T>(value: T) -> Located<T> {
    Located::new(value, Spot::default())
}

fn rounded(x: f64) -> f64 {
    (x * DECIMALS).round() / DECIMALS
}

impl FlatSurface {
    /// The pieces as a garment: their rims as named edges, seams along everything that was cut, a notch in the middle
    /// of every one, the grain upright, every piece placed where it is of; on the `form`, if [`FORM_OBJ`] is written.
    ///
    /// # Errors
    /// When it cannot be written.
    pub(super) fn garment(&self, form: Option<&ClosedForm>) -> Result<String, PipelineError> {
        write(&self.garment_file(false, form)).map_err(PipelineError::Encode)
    }

    /// As [`Self::garment`], before it is written. With `smooth` the named edges are few smooth curves, and those
    /// without a name, the legs of darts, are straight.
    pub(in crate::pipeline) fn garment_file(&self, smooth: bool, form: Option<&ClosedForm>) -> GarmentFile {
        let names = self.piece_names();
        let inward = form.is_some_and(|form| form.inward);
        let piece = |k: usize| {
            let place = Some(at_no_place(self.place_of(k, inward)));
            PieceFile { place, ..self.piece_file(k, &names[k], smooth) }
        };
        let pieces: Vec<PieceFile> = (0..self.laid.len()).map(piece).collect();
        let (seams, free) = self.seams(&names);
        GarmentFile {
            version: at_no_place(1),
            name: Some(at_no_place(self.report.surface.clone())),
            about: Vec::new(),
            units: None,
            body: form.map(|_| at_no_place(FORM_OBJ.to_owned())),
            body_measures: Vec::new(),
            body_units: form.map(|_| at_no_place(LengthUnit::Millimetre)),
            allowance: None,
            fabrics: vec![(at_no_place("shell".to_owned()), at_no_place(Value::Text(FABRIC.to_owned())))],
            pieces,
            seams,
            closures: Vec::new(),
            free,
            tests: Vec::new(),
            alter: Vec::new(),
            sizes: Vec::new(),
        }
    }

    /// Names the edges by the vertices of the file that they run through; those without a name keep their numbers.
    pub(in crate::pipeline) fn name_edges(&mut self, name: &dyn Fn(&[u32]) -> Option<String>) {
        for (laid, edges) in self.laid.iter().zip(&mut self.edges) {
            let mut taken: Vec<String> = Vec::new();
            for edge in edges {
                let vertices: Vec<u32> = edge.vertices.iter().map(|&v| laid.part.vertices[v as usize]).collect();
                let Some(given) = name(&vertices) else { continue };
                let word: String =
                    given.chars().map(|c| if c.is_alphanumeric() || c == '-' { c } else { '_' }).collect();
                let stem =
                    if word.parse::<f64>().is_ok() || word.chars().count() < 2 { format!("line_{word}") } else { word };
                let again = (2..).map(|n| format!("{stem}_{n}"));
                let free = std::iter::once(stem.clone()).chain(again).find(|name| !taken.contains(name));
                taken.extend(free.clone());
                edge.title = free;
            }
        }
    }

    /// How many darts each piece has.
    pub(in crate::pipeline) fn darts(&self) -> Vec<usize> {
        self.laid.iter().map(|laid| laid.darts).collect()
    }

    /// Names of the pieces that a garment file takes, each once.
    fn piece_names(&self) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for laid in &self.laid {
            let kept = |c: char| if c.is_alphanumeric() || c == '-' { c } else { '_' };
            let word: String = laid.part.name.trim().chars().map(kept).collect();
            let usable = word.starts_with(char::is_alphabetic) && word.chars().count() > 1;
            let stem = if usable { word } else { format!("piece_{word}") };
            let again = (2..).map(|n| format!("{stem}_{n}"));
            let free = std::iter::once(stem.clone()).chain(again).find(|name| !names.contains(name));
            names.extend(free);
        }
        names
    }

    /// The rim round a piece, which is its outline; the others are holes.
    fn outline_of(&self, piece: usize) -> usize {
        let rims = 1 + self.edges[piece].iter().map(|edge| edge.ring).max().unwrap_or(0);
        let area = |ring: usize| {
            let places: Vec<Vec2> = self.edges[piece]
                .iter()
                .filter(|e| e.ring == ring)
                .flat_map(|e| e.vertices[1..].iter().map(|&v| self.place(piece, v)))
                .collect();
            (0..places.len()).map(|k| places[k].perp(&places[(k + 1) % places.len()])).sum::<f64>().abs()
        };
        (0..rims).max_by(|&a, &b| area(a).total_cmp(&area(b)).then(b.cmp(&a))).unwrap_or(0)
    }

    /// Where a vertex of a piece lies as it is cut, mm.
    pub(super) fn place(&self, piece: usize, v: u32) -> Vec2 {
        self.ease.cut(self.laid[piece].flat.positions[v as usize]) * MM
    }

    fn piece_file(&self, k: usize, name: &str, smooth: bool) -> PieceFile {
        let outline = self.outline_of(k);
        let own: Vec<&PartRimEdge> = self.edges[k].iter().filter(|e| e.ring == outline).collect();
        let point = |v: u32| {
            let p = self.place(k, v);
            [rounded(p.x), rounded(p.y)]
        };
        let path = |vertices: &[u32]| {
            let line = |&v: &u32| {
                let [x, y] = point(v);
                format!("L {x} {y}")
            };
            vertices.iter().map(line).collect::<Vec<_>>().join(" ")
        };
        let drawn = |e: &PartRimEdge| match (smooth, &e.title) {
            (false, _) => path(&e.vertices[1..]),
            (true, Some(_)) => self.curves(k, e),
            // Near the tip the legs of a dart are nearer to each other than either is to its straight line.
            (true, None) => path(&e.vertices[e.vertices.len() - 1..]),
        };
        let edges = own.iter().map(|e| (at_no_place(edge_name(e)), at_no_place(drawn(e))));
        let start = own.first().map_or([0.0; 2], |e| point(e.vertices[0]));
        let rings = self.edges[k].iter().filter(|e| e.ring != outline).fold(Vec::new(), |mut rings: Vec<_>, edge| {
            match rings.last_mut() {
                Some((ring, vertices)) if *ring == edge.ring => {
                    let more: &mut Vec<u32> = vertices;
                    more.extend(&edge.vertices[1..]);
                }
                _ => rings.push((edge.ring, edge.vertices[1..].to_vec())),
            }
            rings
        });
        let hole = |(n, (_, vertices)): (usize, (usize, Vec<u32>))| {
            let closed = format!("{} Z", path(&vertices).replacen('L', "M", 1));
            (at_no_place(hole_name(n)), at_no_place(closed))
        };
        let middle = self.grain_middle(k);
        PieceFile {
            outline: Some(OutlineFile { start: at_no_place(start), edges: edges.collect() }),
            grain: Some(at_no_place([
                [middle[0], rounded(middle[1] + GRAIN)],
                [middle[0], rounded(middle[1] - GRAIN)],
            ])),
            notches: own.iter().filter_map(|edge| self.notch_file(k, edge)).collect(),
            holes: rings.into_iter().enumerate().map(hole).collect(),
            ..PieceFile::named(at_no_place(name.to_owned()))
        }
    }

    /// An edge as few smooth curves through its vertices.
    fn curves(&self, k: usize, edge: &PartRimEdge) -> String {
        let points: Vec<Vec2> = edge.vertices.iter().map(|&v| self.place(k, v)).collect();
        let straight =
            |c: &Cubic| distance_to_chord(c[1], [c[0], c[3]]).max(distance_to_chord(c[2], [c[0], c[3]])) < SMOOTH;
        let at = |p: Vec2| format!("{} {}", rounded(p.x), rounded(p.y));
        let step = |c: Cubic| {
            if straight(&c) { format!("L {}", at(c[3])) } else { format!("C {} {} {}", at(c[1]), at(c[2]), at(c[3])) }
        };
        smooth_curves(&points, SMOOTH).into_iter().map(step).collect::<Vec<_>>().join(" ")
    }

    /// The middle of the box round a piece, mm.
    fn grain_middle(&self, k: usize) -> [f64; 2] {
        let LaidPart { flat, .. } = &self.laid[k];
        let (low, high) = flat
            .positions
            .iter()
            .fold((Vec2::repeat(f64::INFINITY), Vec2::repeat(f64::NEG_INFINITY)), |(low, high), p| {
                (low.inf(&self.ease.cut(*p)), high.sup(&self.ease.cut(*p)))
            });
        let middle = (low + high) * (0.5 * MM);
        [rounded(middle.x), rounded(middle.y)]
    }

    /// The notch of an edge that is sewn, at the vertex that it shares with its partner.
    fn notch_file(&self, k: usize, edge: &PartRimEdge) -> Option<(Located<String>, Vec<Located<NotchFile>>)> {
        let index = self.edges[k].iter().position(|e| std::ptr::eq(e, edge))?;
        edge.partner.filter(|_| edge.vertices.len() > 2)?;
        let middle = edge.middle([k, index]);
        let way = edge.vertices[..=middle].windows(2).map(|w| (self.place(k, w[1]) - self.place(k, w[0])).norm());
        let at = Quantity { number: rounded(way.sum()), unit: None };
        Some((at_no_place(edge_name(edge)), vec![at_no_place(NotchFile { at, double: false })]))
    }

    /// By how much the second of two sewn edges is longer as they are cut: ease draws edges of different directions
    /// differently.
    fn excess(&self, [p, e]: [usize; 2], [q, f]: [usize; 2]) -> Option<Located<Quantity>> {
        /// Less is no ease, mm.
        const NONE: f64 = 0.05;
        let length = |p: usize, e: usize| self.report.pieces[p].edges[e].length_cut;
        let excess = length(q, f) - length(p, e);
        (excess.abs() > NONE).then(|| at_no_place(Quantity { number: rounded(excess), unit: None }))
    }

    /// The seams between outlines, each once, and all other edges.
    fn seams(&self, names: &[String]) -> (Vec<SeamFile>, Vec<Located<String>>) {
        let outlines: Vec<usize> = (0..self.laid.len()).map(|k| self.outline_of(k)).collect();
        let (mut seams, mut free) = (Vec::new(), Vec::new());
        for (p, edges) in self.edges.iter().enumerate() {
            let mut holes: Vec<usize> = Vec::new();
            for (e, edge) in edges.iter().enumerate() {
                let full =
                    |piece: usize, edge: &PartRimEdge| at_no_place(format!("{}.{}", names[piece], edge_name(edge)));
                let sewn = edge.partner.filter(|[q, f]| self.edges[*q][*f].ring == outlines[*q]);
                if edge.ring != outlines[p] {
                    if !holes.contains(&edge.ring) {
                        free.push(at_no_place(format!("{}.{}", names[p], hole_name(holes.len()))));
                        holes.push(edge.ring);
                    }
                    continue;
                }
                match sewn {
                    None => free.push(full(p, edge)),
                    Some([q, f]) if [p, e] < [q, f] => {
                        let name = at_no_place(format!("seam{}", seams.len() + 1));
                        let (own, other) = (vec![full(p, edge)], vec![full(q, &self.edges[q][f])]);
                        seams.push(SeamFile { ease: self.excess([p, e], [q, f]), ..SeamFile::new(name, own, other) });
                    }
                    Some(_) => {}
                }
            }
        }
        (seams, free)
    }
}

/// A name of an edge that a garment file takes: a number alone is none.
fn edge_name(edge: &PartRimEdge) -> String {
    if let Some(title) = &edge.title {
        return title.clone();
    }
    format!("edge{}", edge.name.replace('.', "_"))
}

fn hole_name(k: usize) -> String {
    format!("hole{}", k + 1)
}

/// Distance of a point from the line through two others.
fn distance_to_chord(p: Vec2, [a, b]: [Vec2; 2]) -> f64 {
    let way = b - a;
    if way.norm() > 0.0 { way.perp(&(p - a)).abs() / way.norm() } else { (p - a).norm() }
}
