//! Counts of the elements of a drawing that are not read, for a note.

/// Something that is no line of a pattern.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum What {
    Image,
    Clone,
    Text,
    Hidden,
    Unsized,
    Other,
}

/// All kinds, in the order they are said in.
const KINDS: [What; 6] = [What::Image, What::Clone, What::Text, What::Unsized, What::Hidden, What::Other];

/// Elements that show something, but not by lines of their own.
const DRAWN_OTHERWISE: [&str; 3] = ["foreignObject", "video", "mesh"];

impl What {
    /// The kind of an element of this name that is left out. `taken`: whether it was found to be a line of the pattern.
    pub(super) fn of(name: &str, taken: bool) -> Option<Self> {
        match name {
            "image" => Some(Self::Image),
            "use" => (!taken).then_some(Self::Clone),
            "text" | "flowRoot" => Some(Self::Text),
            _ => DRAWN_OTHERWISE.contains(&name).then_some(Self::Other),
        }
    }

    fn words(self) -> [&'static str; 3] {
        match self {
            Self::Image => ["image", "images", "trace its outlines as paths to have them"],
            Self::Clone => [
                "clone or symbol ('use')",
                "clones or symbols ('use')",
                "unlink it (in Inkscape: Edit, Clone, Unlink Clone) to have its lines",
            ],
            Self::Text => [
                "text",
                "texts",
                "of words only titles, numbers, 'cut 2', 'cut 1 on fold' and the like on a piece are read",
            ],
            Self::Hidden => ["hidden element", "hidden elements", "show it to have its lines"],
            Self::Unsized => ["shape without a size", "shapes without a size", "give it lengths, or make a path of it"],
            Self::Other => {
                ["element that is no drawing", "elements that are no drawing", "make paths of what it shows"]
            }
        }
    }
}

/// How many there were of each kind, and the line of the first.
#[derive(Clone, Debug, Default)]
pub(super) struct LeftOutElements {
    counts: [(usize, u32); KINDS.len()],
}

impl LeftOutElements {
    pub(super) fn add(&mut self, what: What, line: u32) {
        for (kind, (count, first)) in KINDS.iter().zip(&mut self.counts) {
            if *kind == what {
                *count += 1;
                *first = if *count == 1 { line } else { (*first).min(line) };
            }
        }
    }

    /// One for each kind there is.
    pub(super) fn sentences(&self) -> Vec<String> {
        let rows = KINDS.iter().zip(self.counts).filter(|(_, (count, _))| *count > 0);
        rows.map(|(kind, (count, line))| {
            let [one, several, remedy] = kind.words();
            match count {
                1 => format!("left out: 1 {one} in line {line}; {remedy}"),
                _ => format!("left out: {count} {several}, the first in line {line}; {remedy}"),
            }
        })
        .collect()
    }
}
