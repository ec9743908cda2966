//! Where a surface is cut: as asked, where it must be, and where it should be.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use super::super::error::PipelineError;
use super::darts::LayingInput;
use super::parts::SurfacePart;
use super::report::{CutWhy, DartReport, HalvingReport};
use super::sheet::CutFaces;
use crate::flatten::line::{SurfacePoint, Web, straightened};
use crate::flatten::{self, FlattenError, Flattened, Solid, disk_cuts, shortest_path, slit_from_rim};
use crate::geometry::{MM, Topology, rim_loops, sorted_pair};

/// Where to cut besides groups and texture seams.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cuts {
    /// Along straight lines through these vertices, numbered from 1 as in the file.
    pub paths: Vec<Vec<u32>>,
    /// Along the lines that are drawn in these files, in the unit and the axes of the surface: OBJ files with `l`
    /// elements, or lists of points.
    pub files: Vec<PathBuf>,
    /// Whether to cut along all sharp edges, where neighbouring faces turn by more than 50°.
    pub sharp: bool,
    /// Whether to cut what these leave that is no disk into one.
    pub auto: bool,
}

/// Cuts a surface as asked for, `parts` being the surface without cuts.
pub(super) fn cut_as_asked(
    source: &LayingInput<'_>,
    sheet: &mut CutFaces,
    mut parts: Vec<SurfacePart>,
) -> Result<(), PipelineError> {
    let paths = &source.options.cuts.paths;
    let count = sheet.faces.vertices.len();
    let before = sheet.made.len();
    for path in paths {
        let asked = AskedCut { stops: path, count };
        asked.check(sheet).map_err(|why| refused(source, path, why))?;
        let (mut chain, mut begun) = (Vec::new(), None);
        for leg in path.windows(2) {
            let (part, line) = asked.leg(sheet, &parts, [leg[0], leg[1]]).map_err(|why| refused(source, path, why))?;
            begun.get_or_insert_with(|| parts[part].name.clone());
            let way = sheet.split(&parts[part], &line);
            chain.extend(way.into_iter().skip(usize::from(!chain.is_empty())));
            if line.iter().any(|spot| !matches!(spot, SurfacePoint::Vertex(_))) {
                parts = sheet.parts();
            }
        }
        sheet.plan(begun.unwrap_or_default(), chain);
    }
    sheet.cut_planned(CutWhy::Asked);
    let rims = rim_edges(&parts);
    let of_path = |k: usize| opens_nothing(&sheet.chains[before..], k, &rims);
    match paths.iter().enumerate().find_map(|(k, path)| Some((path, of_path(k)?))) {
        Some((path, why)) => Err(refused(source, path, why.to_owned())),
        None => Ok(()),
    }
}

fn refused(source: &LayingInput<'_>, path: &[u32], why: String) -> PipelineError {
    let cut = path.iter().map(u32::to_string).collect::<Vec<_>>().join(",");
    PipelineError::Cut { file: source.file.to_owned(), cut, why }
}

/// Why the cut `k` leaves the surface as it is, if it does.
fn opens_nothing(chains: &[Vec<u32>], k: usize, rims: &HashSet<[u32; 2]>) -> Option<&'static str> {
    let chain = &chains[k];
    if chain.windows(2).all(|w| rims.contains(&sorted_pair([w[0], w[1]]))) {
        return Some("it runs along the rim, where the surface is open already");
    }
    let [a, b] = chain[..] else { return None };
    let other = |v: u32| chains.iter().enumerate().any(|(i, chain)| i != k && chain.contains(&v));
    let open = |v: u32| other(v) || rims.iter().any(|edge| edge.contains(&v));
    (!open(a) && !open(b)).then_some(
        "it is a single edge inside the surface, whose ends stay joined, so that nothing opens; name a vertex \
         further on",
    )
}

/// A cut that is asked for by vertices, numbered from 1.
struct AskedCut<'a> {
    stops: &'a [u32],
    /// How many vertices the file has.
    count: usize,
}

impl AskedCut<'_> {
    fn check(&self, sheet: &CutFaces) -> Result<(), String> {
        let (stops, count) = (self.stops, self.count);
        if stops.len() < 2 {
            return Err("a cut goes through two vertices or more".into());
        }
        if let Some(wrong) = stops.iter().find(|v| **v == 0 || **v as usize > count) {
            return Err(format!("there is no vertex {wrong}; the file has 1 to {count}"));
        }
        let place = |v: u32| sheet.same[v as usize - 1];
        let still = stops.windows(2).find(|leg| place(leg[0]) == place(leg[1]));
        still.map_or(Ok(()), |leg| {
            let (a, b) = (leg[0], leg[1]);
            let said = "from a vertex to itself there is nothing to cut";
            Err(if a == b {
                format!("vertex {a} follows itself, and {said}; leave one {a} out or name another")
            } else {
                format!("vertices {a} and {b} are welded to one, and {said}; leave one out or name another")
            })
        })
    }

    /// The part in which two stops lie, and the straight line between them.
    fn leg(
        &self,
        sheet: &CutFaces,
        parts: &[SurfacePart],
        leg: [u32; 2],
    ) -> Result<(usize, Vec<SurfacePoint>), String> {
        let local = |part: &SurfacePart, v: u32| {
            let place = sheet.same[v as usize - 1];
            part.vertices.iter().position(|&w| w == place).map(|k| k as u32)
        };
        let both = |part: &SurfacePart| Some([local(part, leg[0])?, local(part, leg[1])?]);
        let shared = parts.iter().enumerate().find_map(|(k, part)| Some((k, both(part)?)));
        let Some((k, [from, to])) = shared else {
            return Err(format!("vertices {} and {} do not lie in one part of the surface", leg[0], leg[1]));
        };
        // In one part, so there is a way.
        let chain = shortest_path(&parts[k].surface, &Solid::new(), from, to).unwrap_or_default();
        Ok((k, straight(&parts[k], &chain)))
    }
}

/// The straight line along a chain of a part's vertices. A surface with one side is cut along the chain.
pub(super) fn straight(part: &SurfacePart, chain: &[u32]) -> Vec<SurfacePoint> {
    if part.turned.is_none() {
        return chain.iter().map(|&v| SurfacePoint::Vertex(v)).collect();
    }
    straightened(&part.surface, &Web::new(&part.surface), chain)
}

/// Cuts along all sharp edges, as a block or a box is sewn.
pub(super) fn cut_sharp(sheet: &mut CutFaces) {
    /// Cosine of 50°.
    const SHARP: f64 = 0.642_787_6;
    let parts = sheet.parts();
    for part in &parts {
        let normal = |t: u32| part.surface.double_normal(t as usize).normalize();
        let is_sharp = |t: u32, u: u32| normal(t).dot(&normal(u)) < SHARP;
        let topology = Topology::new(&part.surface.triangles);
        let edges = topology.edges.iter().filter_map(|edge| match edge.triangles {
            [Some(t), Some(u)] if is_sharp(t, u) => Some(edge.ends),
            _ => None,
        });
        for chain in chains(&edges.collect::<Vec<_>>()) {
            sheet.plan(part.name.clone(), chain.into_iter().map(|v| part.vertices[v as usize]).collect());
        }
    }
    sheet.cut_planned(CutWhy::Asked);
}

/// Cuts open what is no disk, one line after the other, the part `number` only where it is given.
pub(super) fn cut_open(sheet: &mut CutFaces, number: Option<usize>) {
    /// A surface with more holes and handles is cut in other ways.
    const MOST: usize = 1000;
    let parts = sheet.parts().len();
    for k in number.map_or(0..parts, |k| k..k + 1) {
        for _ in 0..MOST {
            // A cut that opens a part leaves it whole, so that all parts keep their numbers.
            let Some(part) = sheet.parts().into_iter().nth(k) else { break };
            let Some(line) = next_opening(&part) else { break };
            sheet.cut(&part, &line, CutWhy::Auto);
        }
    }
}

/// The line that opens a part next: of the ways along which it must be cut the shortest that is closed, or begins or
/// ends at the rim; where there is none the shortest two that make a closed one.
fn next_opening(part: &SurfacePart) -> Option<Vec<SurfacePoint>> {
    let ways = opening(part);
    let rim: HashSet<u32> = rim_loops(&part.surface.triangles).into_iter().flatten().collect();
    let is_slit = |way: &[u32]| ways.len() == 1 && way.len() > 2;
    let opens = |way: &[u32]| {
        let (first, last) = (way.first(), way.last());
        first == last || is_slit(way) || [first, last].into_iter().flatten().any(|v| rim.contains(v))
    };
    let closed = ways.iter().filter(|way| opens(way)).cloned().chain(rings(&ways));
    let way = closed.min_by(|a, b| length(part, a).total_cmp(&length(part, b)))?;
    let line = straight_inside(part, &way);
    // A slit along one edge opens nothing: both of its ends stay closed.
    let is_shut = line.len() < 3 && is_slit(&way);
    Some(if is_shut { along(&way) } else { line })
}

/// The line along a chain of a part's vertices.
fn along(chain: &[u32]) -> Vec<SurfacePoint> {
    chain.iter().map(|&v| SurfacePoint::Vertex(v)).collect()
}

/// The closed ways that two ways between the same ends make.
fn rings(ways: &[Vec<u32>]) -> Vec<Vec<u32>> {
    let mut rings = Vec::new();
    for (k, own) in ways.iter().enumerate() {
        for other in &ways[k + 1..] {
            let mut back = other.clone();
            if own.last() != back.first() {
                back.reverse();
            }
            if own.first() != own.last() && own.last() == back.first() && own.first() == back.last() {
                rings.push(own.iter().chain(&back[1..]).copied().collect());
            }
        }
    }
    rings
}

/// The straight line along a chain of a part's vertices, or the chain itself where that line would touch the rim, and
/// so part the surface.
pub(super) fn straight_inside(part: &SurfacePart, chain: &[u32]) -> Vec<SurfacePoint> {
    let line = straight(part, chain);
    let rim: HashSet<u32> = rim_loops(&part.surface.triangles).into_iter().flatten().collect();
    let on_rim = |spot: &SurfacePoint| matches!(spot, SurfacePoint::Vertex(v) if rim.contains(v));
    let is_clear = line.len() < 3 || !line[1..line.len() - 1].iter().any(on_rim);
    if is_clear { line } else { along(chain) }
}

/// The ways along which a part must be cut to become a disk; none for a disk.
pub(super) fn opening(part: &SurfacePart) -> Vec<Vec<u32>> {
    chains(&disk_cuts(&part.surface, &part.diagonals))
}

/// The way from a part's rim to its far end.
pub(super) fn slit(part: &SurfacePart) -> Vec<u32> {
    slit_from_rim(&part.surface, &part.diagonals)
}

/// The rims of all parts as edges of the file's vertices by their numbers, smaller first.
fn rim_edges(parts: &[SurfacePart]) -> HashSet<[u32; 2]> {
    let of_part = |part: &SurfacePart| {
        let topology = Topology::new(&part.surface.triangles);
        topology.rim_edges().map(|e| sorted_pair(e.ends.map(|v| part.number(v)))).collect::<Vec<_>>()
    };
    parts.iter().flat_map(of_part).collect()
}

/// Edges as chains that end where one or more than two of them meet.
fn chains(edges: &[[u32; 2]]) -> Vec<Vec<u32>> {
    let mut at: HashMap<u32, Vec<u32>> = HashMap::new();
    for &[a, b] in edges {
        at.entry(a).or_default().push(b);
        at.entry(b).or_default().push(a);
    }
    let mut left: HashSet<[u32; 2]> = edges.iter().copied().collect();
    let mut starts: Vec<u32> = at.keys().copied().filter(|v| at[v].len() != 2).collect();
    starts.sort_unstable();
    // Closed chains begin anywhere.
    starts.extend(edges.iter().map(|e| e[0]));
    let mut chains = Vec::new();
    for start in starts {
        for &first in &at[&start] {
            let mut chain = vec![start];
            let mut next = Some(first);
            while let Some(v) = next.filter(|&v| left.remove(&sorted_pair([chain[chain.len() - 1], v]))) {
                chain.push(v);
                let open = |w: &&u32| left.contains(&sorted_pair([v, **w]));
                next = if at[&v].len() == 2 { at[&v].iter().find(open).copied() } else { None };
            }
            if chain.len() > 1 {
                chains.push(chain);
            }
        }
    }
    chains
}

/// A part's error in the file's numbers, with where to cut if that is the remedy.
pub(super) fn advise(file: &Path, part: &SurfacePart, error: FlattenError) -> PipelineError {
    let curable = matches!(error, FlattenError::Closed | FlattenError::Handles(_) | FlattenError::OneSided(_));
    let source = FlattenError::Piece { piece: part.name.clone(), source: Box::new(part.blame(error)) };
    let ways = if curable { opening(part) } else { Vec::new() };
    if ways.is_empty() {
        return PipelineError::Surface { file: file.to_owned(), source };
    }
    let named: Vec<String> = ways.iter().map(|way| described(part, way)).collect();
    let advice = format!("--cut auto would cut {}; --cut A,B,… cuts along a way of your own", named.join(" and "));
    PipelineError::NoDisk { file: file.to_owned(), source, advice }
}

fn described(part: &SurfacePart, way: &[u32]) -> String {
    let ends = [way[0], way[way.len() - 1]].map(|v| part.number(v));
    format!("from vertex {} to vertex {} ({:.1} mm)", ends[0], ends[1], length(part, way))
}

/// Millimetres.
fn length(part: &SurfacePart, way: &[u32]) -> f64 {
    let at = |v: u32| part.surface.vertices[v as usize];
    way.windows(2).map(|w| (at(w[1]) - at(w[0])).norm()).sum::<f64>() * MM
}

/// Where a dart would relieve a part; empty where none can be told. It starts on no other cut: the sides of a cut are
/// the same vertices of the file, and its end is between two that are.
pub(super) fn dart(part: &SurfacePart, flat: &Flattened) -> Vec<u32> {
    let mut count: HashMap<u32, usize> = HashMap::new();
    part.vertices.iter().for_each(|&v| *count.entry(v).or_default() += 1);
    let is_cut = |v: u32| count[&part.vertices[v as usize]] > 1;
    let mut on_cut: HashSet<u32> = (0..part.vertices.len() as u32).filter(|&v| is_cut(v)).collect();
    for rim in rim_loops(&part.surface.triangles) {
        for k in 0..rim.len() {
            let [a, b, c] = [0, 1, 2].map(|step| rim[(k + step) % rim.len()]);
            if part.vertices[a as usize] == part.vertices[c as usize] {
                on_cut.insert(b);
            }
        }
    }
    flatten::dart(&part.surface, &flat.log_scale, &part.diagonals, |v| !on_cut.contains(&v))
}

/// The way along which a part is best cut in two; empty where there is none.
pub(super) fn halving(part: &SurfacePart) -> Vec<u32> {
    flatten::halving(&part.surface, &part.diagonals)
}

/// The same as it is reported.
pub(super) fn proposed_halving(part: &SurfacePart) -> Option<HalvingReport> {
    let way = halving(part);
    let [from, .., to] = *way else { return None };
    Some(HalvingReport { from: part.number(from), to: part.number(to), length: length(part, &way) })
}

/// A dart as it is reported.
pub(super) fn proposal(part: &SurfacePart, dart: &[u32]) -> Option<DartReport> {
    let [rim, .., tip] = *dart else { return None };
    Some(DartReport { rim: part.number(rim), tip: part.number(tip), length: length(part, dart) })
}
