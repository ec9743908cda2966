//! Where a surface is cut: as asked, where it must be, and where it should be.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use super::super::error::PipelineError;
use super::darts::Source;
use super::parts::{Nodes, Part};
use super::report::{CutReport, CutWhy, DartReport};
use crate::flatten::{self, FlattenError, Flattened, disk_cuts, shortest_path, slit_from_rim};
use crate::geometry::{MM, Topology, rim_loops, sorted_pair};
use crate::io::obj_read::ObjFaces;

/// Where to cut besides groups and texture seams.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cuts {
    /// Along the shortest ways through these vertices, numbered from 1 as in the file.
    pub paths: Vec<Vec<u32>>,
    /// Whether to cut what these leave that is no disk into one.
    pub auto: bool,
}

/// Edges of nodes that are cut.
#[derive(Clone, Default)]
pub(super) struct Marks {
    pub(super) edges: HashSet<[u32; 2]>,
    /// The same as chains of the file's vertices, from 1.
    pub(super) chains: Vec<Vec<u32>>,
    /// A row for each of these.
    pub(super) made: Vec<CutReport>,
}

impl Marks {
    /// The cuts asked for by their vertices, `parts` being the surface without them.
    pub(super) fn asked(source: &Source<'_>, parts: &[Part]) -> Result<Self, PipelineError> {
        let Source { file, faces, nodes, space, options, .. } = *source;
        let mut out = Self::default();
        let mut of_file = HashSet::new();
        let refused = |path: &[u32], why: String| {
            let cut = path.iter().map(u32::to_string).collect::<Vec<_>>().join(",");
            PipelineError::Cut { file: file.to_owned(), cut, why }
        };
        let paths = &options.cuts.paths;
        for path in paths {
            let (way, part) = way(faces, nodes, parts, path).map_err(|why| refused(path, why))?;
            of_file.extend(way.windows(2).map(|w| sorted_pair([w[0], w[1]])));
            let step = |w: &[u32]| (faces.vertices[w[1] as usize] - faces.vertices[w[0] as usize]).norm();
            let length = way.windows(2).map(step).sum::<f64>() * space.metres * MM;
            out.record(part, CutWhy::Asked, way.iter().map(|v| v + 1).collect(), length);
        }
        out.edges = nodes.edges_on(&of_file);
        let rims = rim_edges(parts);
        match paths.iter().enumerate().find_map(|(k, path)| Some((path, out.opens_nothing(k, &rims)?))) {
            Some((path, why)) => Err(refused(path, why.to_owned())),
            None => Ok(out),
        }
    }

    /// Cuts what is no disk into one, `parts` being the surface with the cuts so far.
    pub(super) fn cut_open(&mut self, parts: &[Part]) {
        for part in parts {
            for chain in opening(part) {
                self.cut(part, &chain, CutWhy::Auto);
            }
        }
    }

    /// Why the cut `k` leaves the surface as it is, if it does.
    fn opens_nothing(&self, k: usize, rims: &HashSet<[u32; 2]>) -> Option<&'static str> {
        let chain = &self.chains[k];
        if chain.windows(2).all(|w| rims.contains(&sorted_pair([w[0], w[1]]))) {
            return Some("it runs along the rim, where the surface is open already");
        }
        let [a, b] = chain[..] else { return None };
        let other = |v: u32| self.chains.iter().enumerate().any(|(i, chain)| i != k && chain.contains(&v));
        let open = |v: u32| other(v) || rims.iter().any(|edge| edge.contains(&v));
        (!open(a) && !open(b)).then_some(
            "it is a single edge inside the surface, whose ends stay joined, so that nothing opens; name a vertex \
             further on",
        )
    }

    /// Cuts a part along a chain of its vertices.
    pub(super) fn cut(&mut self, part: &Part, chain: &[u32], why: CutWhy) {
        if chain.len() > 1 {
            let numbers = chain.iter().map(|&v| part.number(v)).collect();
            self.record(part.name.clone(), why, numbers, length(part, chain));
            let node = |v: u32| part.nodes[v as usize];
            self.edges.extend(chain.windows(2).map(|w| sorted_pair([node(w[0]), node(w[1])])));
        }
    }

    /// Notes a cut of `length` millimetres through these of the file's vertices, from 1.
    fn record(&mut self, piece: String, why: CutWhy, chain: Vec<u32>, length: f64) {
        if let [from, .., to] = chain[..] {
            self.made.push(CutReport { piece, why, from, to, length });
            self.chains.push(chain);
        }
    }
}

/// The ways along which a part must be cut to become a disk; none for a disk.
pub(super) fn opening(part: &Part) -> Vec<Vec<u32>> {
    chains(&disk_cuts(&part.surface, &part.diagonals))
}

/// The way from a part's rim to its far end.
pub(super) fn slit(part: &Part) -> Vec<u32> {
    slit_from_rim(&part.surface, &part.diagonals)
}

/// The shortest way through vertices numbered from 1, as the file's vertices from 0, and the part in which it begins.
fn way(faces: &ObjFaces, nodes: &Nodes, parts: &[Part], stops: &[u32]) -> Result<(Vec<u32>, String), String> {
    if stops.len() < 2 {
        return Err("a cut goes through two vertices or more".into());
    }
    let count = faces.vertices.len();
    if let Some(wrong) = stops.iter().find(|v| **v == 0 || **v as usize > count) {
        return Err(format!("there is no vertex {wrong}; the file has 1 to {count}"));
    }
    let place = |v: u32| nodes.stand_in(v - 1);
    if let Some(leg) = stops.windows(2).find(|leg| place(leg[0]) == place(leg[1])) {
        let (a, b) = (leg[0], leg[1]);
        let said = "from a vertex to itself there is nothing to cut";
        return Err(if a == b {
            format!("vertex {a} follows itself, and {said}; leave one {a} out or name another")
        } else {
            format!("vertices {a} and {b} are welded to one, and {said}; leave one out or name another")
        });
    }
    let mut way = vec![place(stops[0])];
    let mut begun = None;
    for leg in stops.windows(2) {
        let local = |part: &Part, v: u32| part.vertices.iter().position(|&w| w == place(v)).map(|k| k as u32);
        let shared = parts.iter().find_map(|part| Some((part, local(part, leg[0])?, local(part, leg[1])?)));
        let Some((part, from, to)) = shared else {
            return Err(format!("vertices {} and {} do not lie in one part of the surface", leg[0], leg[1]));
        };
        begun.get_or_insert_with(|| part.name.clone());
        // In one part, so there is a way.
        let path = shortest_path(&part.surface, &part.diagonals, from, to).unwrap_or_default();
        way.extend(path.iter().skip(1).map(|&v| part.vertices[v as usize]));
    }
    Ok((way, begun.unwrap_or_default()))
}

/// The rims of all parts as edges of the file's vertices, from 1, smaller first.
fn rim_edges(parts: &[Part]) -> HashSet<[u32; 2]> {
    let of_part = |part: &Part| {
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
pub(super) fn advise(file: &Path, part: &Part, error: FlattenError) -> PipelineError {
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

fn described(part: &Part, way: &[u32]) -> String {
    let ends = [way[0], way[way.len() - 1]].map(|v| part.number(v));
    format!("from vertex {} to vertex {} ({:.1} mm)", ends[0], ends[1], length(part, way))
}

/// Millimetres.
fn length(part: &Part, way: &[u32]) -> f64 {
    let at = |v: u32| part.surface.vertices[v as usize];
    way.windows(2).map(|w| (at(w[1]) - at(w[0])).norm()).sum::<f64>() * MM
}

/// Where a dart would relieve a part; empty where none can be told. It starts on no other cut: the sides of a cut are
/// the same vertices of the file, and its end is between two that are.
pub(super) fn dart(part: &Part, flat: &Flattened) -> Vec<u32> {
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

/// A dart as it is reported.
pub(super) fn proposal(part: &Part, dart: &[u32]) -> Option<DartReport> {
    let [rim, .., tip] = *dart else { return None };
    Some(DartReport { rim: part.number(rim), tip: part.number(tip), length: length(part, dart) })
}
