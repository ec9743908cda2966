//! What a figure shows: a table, the bars it must meet, and pictures.

use std::error::Error;
use std::fmt;
use std::path::Path;

use toile::geometry::{TriMesh, Vec3};
use toile::io::files::write_all;
use toile::picture::{Specimen, draw_sheet};
use toile::report::aligned;

/// A figure of the paper, computed.
#[derive(Default)]
pub(crate) struct Figure {
    /// The first row is the head.
    pub(crate) table: Vec<Vec<String>>,
    pub(crate) bars: Vec<Bar>,
    /// What is worth saying besides.
    pub(crate) notes: Vec<String>,
    pub(crate) pictures: Vec<Picture>,
}

/// One sheet of shapes.
#[derive(Default)]
pub(crate) struct Picture {
    /// Its file's name, without folder and ending.
    pub(crate) file: &'static str,
    pub(crate) title: &'static str,
    pub(crate) subtitle: &'static str,
    /// Names and shapes, z up.
    pub(crate) shapes: Vec<(String, TriMesh)>,
    /// Lines drawn on each, as lists of vertices.
    pub(crate) lines: Vec<Vec<u32>>,
    /// A thing below every one of them, z up; may be empty.
    pub(crate) body: TriMesh,
}

/// A number that a figure must reach.
pub(crate) struct Bar {
    what: String,
    value: f64,
    bound: Bound,
}

enum Bound {
    AtMost(f64),
    AtLeast(f64),
}

impl Bar {
    pub(crate) fn at_most(bound: f64, what: impl Into<String>, value: f64) -> Self {
        Self { what: what.into(), value, bound: Bound::AtMost(bound) }
    }

    pub(crate) fn at_least(bound: f64, what: impl Into<String>, value: f64) -> Self {
        Self { what: what.into(), value, bound: Bound::AtLeast(bound) }
    }

    pub(crate) fn is_met(&self) -> bool {
        match self.bound {
            Bound::AtMost(bound) => self.value <= bound,
            Bound::AtLeast(bound) => self.value >= bound,
        }
    }
}

impl fmt::Display for Bar {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (word, bound) = match self.bound {
            Bound::AtMost(bound) => ("at most", bound),
            Bound::AtLeast(bound) => ("at least", bound),
        };
        let verdict = if self.is_met() { "met" } else { "MISSED" };
        write!(f, "{verdict}: {} {:.3}, {word} {bound}", self.what, self.value)
    }
}

impl Figure {
    pub(crate) fn with_head(head: &[&str]) -> Self {
        Self { table: vec![head.iter().map(|&h| h.to_owned()).collect()], ..Self::default() }
    }

    /// Prints the table and the bars, and draws the pictures into `out/experiments`.
    pub(crate) fn show(&self) -> Result<(), Box<dyn Error>> {
        print!("{}", aligned(&self.table));
        println!();
        self.notes.iter().for_each(|note| println!("{note}"));
        self.bars.iter().for_each(|bar| println!("{bar}"));
        self.pictures.iter().try_for_each(Picture::draw)
    }
}

impl Picture {
    fn draw(&self) -> Result<(), Box<dyn Error>> {
        let low = self.shapes.iter().flat_map(|s| &s.1.vertices).map(|v| v.z).fold(f64::INFINITY, f64::min);
        let stand = |(_, mesh): &(String, TriMesh)| {
            let middle = mesh.vertices.iter().sum::<Vec3>() / mesh.vertices.len() as f64;
            [mesh, &self.body].map(|m| y_up(m, Vec3::new(middle.x, middle.y, low)))
        };
        let stood: Vec<[TriMesh; 2]> = self.shapes.iter().map(stand).collect();
        let drawn = |mesh: &TriMesh| -> Vec<Vec<Vec3>> {
            self.lines.iter().map(|l| l.iter().map(|&v| mesh.vertices[v as usize]).collect()).collect()
        };
        let lines: Vec<Vec<Vec<Vec3>>> = stood.iter().map(|[cloth, _]| drawn(cloth)).collect();
        let specimens: Vec<Specimen> = (0..stood.len())
            .map(|k| {
                let [cloth, body] = &stood[k];
                Specimen { name: &self.shapes[k].0, cloth, lines: &lines[k], body }
            })
            .collect();
        let file = Path::new("out/experiments").join(format!("{}.png", self.file));
        write_all(&[(file, draw_sheet(self.title, self.subtitle, &specimens)?)], &[])?;
        Ok(())
    }
}

/// A mesh with y upwards instead of z, and `origin` at 0.
fn y_up(mesh: &TriMesh, origin: Vec3) -> TriMesh {
    let turn = |v: &Vec3| Vec3::new(v.x - origin.x, v.z - origin.z, origin.y - v.y);
    TriMesh { vertices: mesh.vertices.iter().map(turn).collect(), triangles: mesh.triangles.clone() }
}

/// A row of a table: a name, then numbers with this many digits behind the point.
pub(crate) fn row(name: &str, numbers: &[(f64, usize)]) -> Vec<String> {
    let numbers = numbers.iter().map(|&(value, digits)| format!("{value:.digits$}"));
    std::iter::once(name.to_owned()).chain(numbers).collect()
}
