//! Sizes of a garment drawn over one another: a nest for each piece.

use super::{Paper, PieceWords};
use crate::geometry::Vec2;

/// Chords of sewing lines, of which labels keep clear, are as near to them as this, metres.
const COARSE: f64 = 1e-4;

/// A size in a nest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PaperSize {
    /// As the file calls it.
    pub name: String,
    /// Its place among the sizes, from 0: each has its own dashes.
    pub number: usize,
}

/// A layer of a drawing: its papers are shown and hidden together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PaperLayer {
    /// The material of its papers.
    pub material: String,
    /// The size of its papers; `None` of papers in one size, and of the labels of nests.
    pub size: Option<String>,
}

impl PaperLayer {
    /// The layer that a paper is in.
    pub fn of(paper: &Paper) -> Self {
        Self { material: paper.fabric.clone(), size: paper.size.as_ref().map(|size| size.name.clone()) }
    }

    /// `shell`, or `shell, size 40`.
    pub fn words(&self) -> String {
        let size = self.size.as_ref().map_or_else(String::new, |size| format!(", size {size}"));
        format!("{}{size}", self.material)
    }
}

/// The layers of papers, each once, in the order of the papers.
pub fn layers(papers: &[Paper]) -> Vec<PaperLayer> {
    let mut all: Vec<PaperLayer> = Vec::new();
    for layer in papers.iter().map(PaperLayer::of) {
        if !all.contains(&layer) {
            all.push(layer);
        }
    }
    all
}

/// The papers of several sizes of a garment as nests: the sizes of each piece where they are drawn, over one another,
/// each with its name at its cut line, and before them a paper that has nothing but the label. Pieces are told by
/// their names.
pub fn nested(sizes: Vec<(String, Vec<Paper>)>) -> Vec<Paper> {
    let mut names: Vec<String> = Vec::new();
    for paper in sizes.iter().flat_map(|(_, papers)| papers) {
        if !names.contains(&paper.name) {
            names.push(paper.name.clone());
        }
    }
    let of = |(nest, name): (usize, &String)| {
        let own = sizes.iter().enumerate().filter_map(|(number, (size, papers))| {
            let paper = papers.iter().find(|paper| paper.name == *name)?;
            Some((PaperSize { name: size.clone(), number }, paper))
        });
        one_nest(nest, &own.collect::<Vec<_>>())
    };
    names.iter().enumerate().flat_map(of).collect()
}

/// A cut line with its first point again at its end.
fn closed(line: &[Vec2]) -> Vec<Vec2> {
    line.iter().chain(line.first()).copied().collect()
}

fn one_nest(nest: usize, sizes: &[(PaperSize, &Paper)]) -> Vec<Paper> {
    let Some((_, first)) = sizes.first() else { return Vec::new() };
    let area = |paper: &Paper| {
        let [low, high] = paper.bounds();
        (high - low).product()
    };
    let mut rising: Vec<&Paper> = sizes.iter().map(|(_, paper)| *paper).collect();
    rising.sort_by(|a, b| area(a).total_cmp(&area(b)));
    let cut = |papers: &[&Paper]| -> Vec<Vec<Vec2>> {
        let lines = |paper: &&Paper| {
            let sewn = paper.sew.iter().map(|line| line.path.sampled(COARSE)).collect::<Vec<_>>();
            paper.cut.iter().map(|line| closed(line)).chain(sewn).collect::<Vec<_>>()
        };
        papers.iter().flat_map(lines).collect()
    };
    let label = Paper {
        cut: Vec::new(),
        fold: None,
        sew: Vec::new(),
        notches: Vec::new(),
        marks: Vec::new(),
        drills: Vec::new(),
        narrowed: Vec::new(),
        words: PieceWords { seams: Vec::new(), ..first.words.clone() },
        nest: Some(nest),
        others: cut(&rising),
        ..(*first).clone()
    };
    let one = |(size, paper): &(PaperSize, &Paper)| {
        let rest: Vec<&Paper> = sizes.iter().filter(|(own, _)| own != size).map(|(_, paper)| *paper).collect();
        let words = PieceWords { tag: Some(size.name.clone()), ..PieceWords::default() };
        let others = cut(&rest);
        Paper { nest: Some(nest), size: Some(size.clone()), words, others, ..(*paper).clone() }.lettered_clear_of(&[])
    };
    std::iter::once(label.lettered_clear_of(&[])).chain(sizes.iter().map(one)).collect()
}
