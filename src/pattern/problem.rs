//! Everything that can be wrong with a garment file. Lengths in messages are millimetres.

use super::GIRTHS;
use crate::input::did_you_mean;

/// Kinds of mistakes, with the data of their messages.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "every field is a word or a number of the message above it")]
pub enum Problem {
    // The text.
    #[error("cannot read the file: {0}")]
    Unreadable(String),
    #[error("it is a directory, not a garment file")]
    Directory,
    #[error("the file has {bytes} bytes or more; a garment file has at most {limit}")]
    TooLarge { bytes: u64, limit: u64 },
    #[error("the file is not UTF-8 text (byte {0} is no part of a character)")]
    NotText(usize),
    #[error("the file is empty")]
    Empty,
    #[error("not YAML: {0}")]
    Syntax(String),
    #[error("a second document starts here; a garment file holds one")]
    SecondDocument,
    #[error("nested deeper than {0} levels")]
    TooDeep(usize),
    #[error("the file unfolds to more than {0} values; its aliases repeat too much")]
    TooManyValues(usize),
    #[error("an alias stands inside the value it names")]
    EndlessAlias,
    #[error("a key must be a word, not a list or a mapping")]
    KeyNotText,
    #[error("a key has more than {0} characters; names are shorter")]
    KeyTooLong(usize),
    #[error("duplicate key '{key}' at line {line} (first at line {first})")]
    DuplicateKey { key: String, line: usize, first: usize },

    // The findings themselves.
    #[error("… and {count} more {what}{}", if *count == 1 { "" } else { "s" })]
    More { count: usize, what: &'static str },

    // Its values.
    #[error("{what} must be {expected}, not {found}")]
    WrongType { what: String, expected: &'static str, found: String },
    #[error("unknown key '{key}' in {what}")]
    UnknownKey { key: String, what: String, nearest: Option<String>, known: String },
    #[error("{what} needs '{key}'")]
    MissingKey { what: String, key: &'static str },
    #[error("'{one}' and '{other}' exclude each other")]
    Exclusive { one: &'static str, other: &'static str },
    #[error("a test of 'flatten' or 'drape' says how far: it needs 'area', 'boundary' or both")]
    NoFigure,
    #[error("unknown unit '{0}'; use mm, cm or in")]
    UnknownUnit(String),
    #[error("garment file version {0} is not known; this program reads version 1")]
    Version(u32),
    #[error("unknown {what} '{found}'; use {known}")]
    UnknownWord { what: &'static str, found: String, known: &'static str },
    #[error("{what} must be {expected}, not {found}")]
    OutOfRange { what: String, expected: &'static str, found: String },
    #[error("an allowance of {width} mm is wider than {widest:.0} mm, the widest there is; is it in another unit?")]
    AllowanceWide { width: f64, widest: f64 },
    #[error("'{0}' names the shape first; an allowance begins with its width: '{1}'")]
    ShapeFirst(String, String),
    #[error("the name '{0}' cannot be used: names have letters, digits, _ and -, and are not L, R, mirror or a number")]
    BadName(String),

    // Names.
    #[error("piece '{name}' not found{}", did_you_mean(.nearest.as_deref()))]
    UnknownPiece { name: String, nearest: Option<String>, known: String },
    #[error("edge '{name}' not found; {known}")]
    UnknownEdge { name: String, nearest: Option<String>, known: String },
    #[error("seam '{name}' not found{}", did_you_mean(.nearest.as_deref()))]
    UnknownSeam { name: String, nearest: Option<String>, known: String },
    #[error("no closure '{name}' with points to measure{}", did_you_mean(.nearest.as_deref()))]
    UnknownClosure { name: String, nearest: Option<String>, known: String },
    #[error("the body has no girth '{name}'{}", did_you_mean(.nearest.as_deref()))]
    UnknownGirth { name: String, nearest: Option<String> },
    #[error("fabric '{name}' not found{}", did_you_mean(.nearest.as_deref()))]
    UnknownFabric { name: String, nearest: Option<String>, known: String },
    #[error("'{0}' names no edge; write piece.edge, piece.L.edge or piece.edge@20%..80%")]
    BadReference(String),
    #[error("'{0}' says more than one side; write L or R once, after the piece or after the edge")]
    TwoSides(String),
    #[error("'{reference}' is not cut; there is {known}")]
    NotCut { reference: String, known: String },
    #[error("'{0}' matches no edge")]
    MatchesNothing(String),
    #[error("'like' goes round in a circle: {0}")]
    LikeCircle(String),
    #[error("the file has no pieces")]
    NoPieces,

    // Places.
    #[error("place of '{piece}': '{word}' means nothing{}", did_you_mean(.nearest.as_deref()))]
    PlaceWord { piece: String, word: String, nearest: Option<String>, known: Box<str> },
    #[error("place of '{piece}': '{place}' says two sides; a piece has one")]
    PlaceBoth { piece: String, place: String },
    #[error("place of '{piece}': '{place}' names no body part")]
    PlaceNowhere { piece: String, place: String, known: Box<str> },

    // Alterations.
    #[error("dart '{name}' not found; {known}")]
    UnknownDart { name: String, nearest: Option<String>, known: String },
    #[error("size '{name}' not found{}", did_you_mean(.nearest.as_deref()))]
    UnknownSize { name: String, nearest: Option<String>, known: String },
    #[error("'{0}' is altered edge by edge: write piece.edge, without a side or a range")]
    AlterPart(String),
    #[error("'{0}' names no point of an edge; write piece.edge@50 % or piece.edge@120 mm")]
    AlterPoint(String),
    #[error("{edge} is {length:.1} mm long; {at:.1} mm is not on it")]
    AlterOff { edge: String, at: f64, length: f64 },
    #[error("'{what}' of two pieces, '{one}' and '{other}'; it stays within one")]
    AlterTwoPieces { what: &'static str, one: String, other: String },
    #[error("{what} must be {expected}, not {found:.2} mm")]
    AlterAmount { what: String, expected: String, found: f64 },
    #[error("piece '{piece}' cannot be altered: {reason}")]
    AlterShape { piece: String, reason: String },
    #[error("with this alteration the outline of '{piece}' crosses itself near {near}, between {edges}")]
    AlterCrosses { piece: String, near: String, edges: String },
    #[error("seam '{seam}' sews more than one edge to one; take in its edges one by one (take_in: piece.edge)")]
    AlterSeam { seam: String },
    #[error("'{piece}.{edge}' lies on the fold: {reason}")]
    AlterFold { piece: String, edge: String, reason: String },

    #[error("'{name}' is the name of something else already")]
    AlterTaken { name: String },

    // Wants.
    #[error("'{want}' cannot be wanted: {why}")]
    NoSuchWant { want: String, why: String },
    #[error("the ranges of knob '{0}' pass zero at different places; make each a multiple of the others")]
    KnobRanges(String),
    #[error("the file wants nothing; write ease, pressure, hem, sleeve, leg or strain")]
    NoWants,

    // The mesh, in its own words.
    #[error("{0}")]
    Mesh(String),
    #[error(
        "'{piece}' is {} mm wide, narrower than the mesh size of {} mm: it is meshed finer, with one row of cells \
         across and springs of {} mm along",
        hundredths(*.width), hundredths(*.spacing), hundredths(*.along)
    )]
    Narrow { piece: String, width: f64, spacing: f64, along: f64 },
    // What the garment is made of, and for whom, in the words of those who know.
    #[error("{0}")]
    Fabric(String),
    #[error("{0}")]
    Body(String),

    // Outlines.
    #[error("piece '{0}' has no outline")]
    NoOutline(String),
    #[error("edge '{piece}.{edge}': {reason}")]
    BadPath { piece: String, edge: String, reason: String },
    #[error("outline of '{piece}' does not close: last point {last} is {gap:.1} mm from start {start}")]
    NotClosed { piece: String, last: String, start: String, gap: f64 },
    #[error("outline of '{piece}' crosses itself near {near}, between {edges}")]
    Crosses { piece: String, near: String, edges: String },
    #[error(
        "outline of '{0}' encloses no area: it runs back along itself, or crosses itself, and its loops cancel out"
    )]
    NoArea(String),
    #[error("outline of '{0}' runs counter-clockwise; reversed it")]
    CounterClockwise(String),
    #[error("all outlines run counter-clockwise; reversed them. Was this drawn with y up? Here y points down")]
    DrawnUpwards,
    #[error("edge name '{edge}' used twice in '{piece}'")]
    EdgeTwice { piece: String, edge: String },
    #[error("hole '{hole}' lies outside piece '{piece}'")]
    HoleOutside { piece: String, hole: String },
    #[error("hole '{hole}' of '{piece}' encloses less than 1 mm2; draw a slit as a line, or leave it out")]
    HoleNoArea { piece: String, hole: String },
    #[error(
        "holes '{hole}' and '{other}' of '{piece}' lie one in the other; draw what lies in a hole as its own piece"
    )]
    HoleInHole { piece: String, hole: String, other: String },
    #[error("line '{line}' leaves piece '{piece}' near {near}")]
    LineOff { piece: String, line: String, near: String },
    #[error("line '{line}' of '{piece}' is only {length} mm long; draw it at least {least} mm long or leave it out")]
    LineShort { piece: String, line: String, length: f64, least: f64 },
    #[error("fold '{line}' of '{piece}' lies on edge '{edge}', beyond which there is no cloth to fold")]
    FoldOnEdge { piece: String, line: String, edge: String },
    #[error("line '{line}' of '{piece}' {contradiction}")]
    LineKind { piece: String, line: String, contradiction: String },
    #[error("place of '{piece}': {at} is more than {most} m from the body's feet; positions are in the file's units")]
    PlaceFar { piece: String, at: String, most: f64 },
    #[error("point {at} of the {kind} lies off piece '{piece}'")]
    PointOff { kind: String, piece: String, at: String },
    #[error("the {kind} has {on} points that are to meet {met}")]
    PointsUnlike { kind: String, on: usize, met: usize },
    #[error("grain of '{0}' has zero length")]
    ZeroGrain(String),
    #[error("piece '{0}' has no grain; taken as running down the drawing")]
    NoGrain(String),
    #[error("notch at {at:.1} mm lies off {edge}, which is {length:.1} mm long")]
    NotchOff { edge: String, at: f64, length: f64 },
    #[error("fold edge '{0}' is curved; only straight edges can be folded")]
    CurvedFold(String),
    #[error("fold edge '{0}' has darts or pleats; draw it without")]
    ShapedFold(String),
    #[error("piece '{0}' crosses its fold edge")]
    BeyondFold(String),
    #[error("cut: pair piece '{0}' has no L/R seams; use cut: 2")]
    PairUnsewn(String),
    #[error("piece '{0}' is sewn to nothing; it will fall where the body does not hold it")]
    PieceUnsewn(String),
    #[error("'{pattern}' matches only {edge}, which lies on the fold: the cloth goes on there, neither sewn nor free")]
    FreeOnFold { pattern: String, edge: String },
    #[error(
        "the largest piece, '{piece}', is {piece_mm:.0} mm long, and the body {body_m:.2} m high: is the drawing in \
         another unit than {unit}?"
    )]
    Size { piece: String, piece_mm: f64, body_m: f64, unit: &'static str, small: bool },
    #[error("{0}")]
    Place(String),
    #[error("piece '{piece}' starts inside the body, up to {depth_mm:.0} mm deep")]
    StartsInside { piece: String, depth_mm: f64 },

    // Darts and pleats.
    #[error("a dart on an edge needs 'length' or 'tip'")]
    DartWithoutLength,
    #[error(
        "dart at {edge}@{at:.0}: its mouth reaches from {from:.1} to {to:.1} mm but the edge is {length:.1} mm long"
    )]
    DartMouth { edge: String, at: f64, from: f64, to: f64, length: f64 },
    #[error("dart at {edge}@{at:.0}: legs differ {one:.1} / {other:.1} mm")]
    DartLegs { edge: String, at: f64, one: f64, other: f64 },
    #[error("dart tip {tip} lies outside piece '{piece}'")]
    DartTip { piece: String, tip: String },
    #[error("darts overlap on {0}")]
    DartsOverlap(String),
    #[error("pleats on '{edge}' take {take:.0} mm but the edge has {length:.0} mm")]
    PleatsTooLong { edge: String, take: f64, length: f64 },
    #[error("pleat at {at:.0} mm on '{edge}' reaches {by:.1} mm over {over}")]
    PleatsOverlap { edge: String, at: f64, by: f64, over: String },
    #[error("edge '{0}' has both darts and pleats; split it in two")]
    DartsAndPleats(String),
    #[error("'toward: {toward}' is not next to '{edge}', whose neighbours are {known}")]
    Toward { toward: String, edge: String, known: String },
    #[error("pleats on '{0}' are stitched down their whole depth at the edge only; 'sewn' is kept, not simulated")]
    PleatSewn(String),

    // Seams.
    #[error("range {0} runs backwards")]
    BackwardsRange(String),
    #[error("{user} uses {reference} but the edge is {length:.1} mm long")]
    RangeBeyond { user: String, reference: String, length: f64 },
    #[error("range of {0} is empty: the cloth there is taken up by a dart or pleat")]
    RangeEmpty(String),
    #[error("seam '{seam}': {reference} lies on the fold, where the cloth goes on; there is nothing to sew")]
    OnFold { seam: String, reference: String },
    #[error("seam '{seam}': {reference} is on both sides of the garment; write {choice}")]
    WhichSide { seam: String, reference: String, choice: String },
    #[error("seam '{seam}': {reference} is cut {count} times; say which, {choice}")]
    WhichCopy { seam: String, reference: String, choice: String, count: usize },
    #[error("seam '{seam}': piece '{piece}' has no mirror; 'to: mirror' needs cut: pair or fold")]
    NoMirror { seam: String, piece: String },
    #[error(
        "seam '{seam}': {sides}, {} mm apart; {advice} (tolerance {})",
        beyond(*apart, *tolerance), rounded(*tolerance)
    )]
    LengthsApart { seam: String, sides: String, apart: f64, advice: String, tolerance: f64 },
    #[error(
        "seam '{seam}': ease {ease:.0} mm is {percent:.0} % of {length:.0} mm; more than 8 % gathers, say {advice}"
    )]
    EaseTooLarge { seam: String, ease: f64, percent: f64, length: f64, advice: String },
    #[error("gather: {ratio} would stretch the cloth by {percent:.0} %; did you swap sew and to?")]
    GatherBelowOne { ratio: f64, percent: f64 },
    #[error("stretch: {ratio} would gather the cloth; did you swap sew and to?")]
    StretchBelowOne { ratio: f64 },
    #[error("{edge} is sewn twice on {from:.0}..{to:.0} mm: in '{first}' and in '{second}'")]
    SewnTwice { edge: String, from: f64, to: f64, first: String, second: String },
    #[error("edges neither sewn nor free: {0}")]
    NeitherSewnNorFree(String),
    #[error("{edge} is listed free but sewn in '{seam}'")]
    FreeButSewn { edge: String, seam: String },
    #[error("chain in '{seam}' is not continuous: {end}, {start}")]
    ChainBroken { seam: String, end: String, start: String, doubt: ChainDoubt },
    #[error("seam '{seam}' is twisted: its ends meet {ends}")]
    Twisted { seam: String, ends: String, turned: Option<String>, same: bool },
    #[error("'{piece}' lies on '{on}' (face: same), but both are on layer {layer}: it starts outside '{on}'")]
    OneLayer { piece: String, on: String, layer: i32 },
    #[error("seam '{seam}' sets '{tube}' in upside down: its own seam comes to the top of the opening")]
    UpsideDown { seam: String, tube: String },
    #[error("seam '{seam}' joins the {side} side of '{piece}' to the {side} side of '{to}', each seen from outside")]
    SameSide { seam: String, piece: String, to: String, side: &'static str },
    /// `settling` says which words of `place` settle it.
    #[error("{openings}; it is put on the first way")]
    WornInTwoWays { openings: String, settling: String },
    #[error("'{one}' and '{other}' start in one place, and nothing leads them apart")]
    OnePlace { one: String, other: String, copies: bool },
    #[error("sewing closes the surface into a non-orientable band at '{0}'")]
    NonOrientable(String),
    #[error("garment has {found} openings, expected {expected}: {rims}")]
    Openings { found: usize, expected: usize, rims: String },
    #[error("seam '{seam}' has no end at '{from}'; its ends are at {known}")]
    OpenFrom { seam: String, from: String, known: String },
    #[error("seam '{seam}' is opened twice from its {end}; write one opening there, as long as it is open in all")]
    OpenTwice { seam: String, end: &'static str },
    #[error("seam '{seam}' is {length:.1} mm long but opens {open:.1} mm in all")]
    OpenTooLong { seam: String, length: f64, open: f64 },
    #[error("notch {notch} of {edge} has no partner on {other}")]
    NotchAlone { notch: usize, edge: String, other: String },
    #[error(
        "seam '{seam}': the notches at {one} and {other}, both from where the seam begins, are {apart:.0} mm apart"
    )]
    NotchesApart { seam: String, one: String, other: String, apart: f64 },
    #[error(
        "seam '{seam}': of the notches at {one} and {other}, both from where the seam begins, one is single and one \
         double"
    )]
    NotchesUnlike { seam: String, one: String, other: String },
    #[error("seam order: '{seam}' is sewn before '{later}' that makes it a ring; order kept, stage them to change")]
    SeamOrder { seam: String, later: String },
}

/// Guess at the fault of edges that do not follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChainDoubt {
    /// Their order.
    Order,
    /// Or which half a piece is drawn as.
    Drawn,
    /// Or which edge a piece is folded at.
    Fold,
}

/// A number with as many digits as tell that it is more than a limit.
fn beyond(number: f64, limit: f64) -> String {
    let shown = |digits: &usize| {
        let text = format!("{number:.digits$}");
        text.parse::<f64>().is_ok_and(|n| n > rounded(limit)).then_some(text)
    };
    (1..=6).find_map(|digits| shown(&digits)).unwrap_or_else(|| number.to_string())
}

/// To a micrometre.
fn rounded(mm: f64) -> f64 {
    (mm * 1e3).round() / 1e3
}

/// The tenth at or below `x`. A number that is a tenth within rounding stays one.
fn tenth_below(x: f64) -> f64 {
    let tenths = 10.0 * x;
    let nearest = tenths.round();
    (if (tenths - nearest).abs() < 1e-6 { nearest } else { tenths.floor() }) / 10.0
}

/// To two decimals.
fn hundredths(x: f64) -> f64 {
    (100.0 * x).round() / 100.0
}

impl Problem {
    /// Advice, if the message itself has none.
    pub fn hint(&self) -> Option<String> {
        let hint = match self {
            Self::UnknownKey { nearest: Some(n), .. } => format!("did you mean '{n}'?"),
            Self::UnknownKey { known, .. } => format!("known keys: {known}"),
            Self::UnknownPiece { known, .. } => format!("the pieces are: {known}"),
            Self::PlaceWord { known, .. } | Self::PlaceNowhere { known, .. } => format!("use {known}"),
            Self::Narrow { width, .. } => {
                format!("--spacing {} puts three springs across it", tenth_below(width / 3.0))
            }
            Self::PlaceBoth { .. } => "leave one of the two out".to_owned(),
            Self::UnknownSeam { known, .. } => format!("the seams are: {known}"),
            Self::UnknownClosure { known, .. } if known.is_empty() => {
                "a closure can be measured that says 'piece' (or 'edge' or 'on'), 'at' and 'meets'".to_owned()
            }
            Self::UnknownClosure { known, .. } => {
                format!("the kinds of closures with points are: {known}; or write all")
            }
            Self::UnknownGirth { .. } => {
                format!("the girths are: {}; those of limbs also with 'left' or 'right' before them", GIRTHS.join(", "))
            }
            Self::UnknownFabric { known, .. } => {
                format!("the fabrics are: {known}; any other, a shipped one too, is named under 'fabrics' first")
            }
            Self::UnknownEdge { nearest: Some(n), .. } | Self::UnknownDart { nearest: Some(n), .. } => {
                format!("did you mean '{n}'?")
            }
            Self::UnknownSize { known, .. } => format!("the sizes are: {known}"),
            Self::AlterCrosses { .. } => "make the amount smaller, or spread it over more of the edge".to_owned(),
            Self::NeitherSewnNorFree(_) => "sew them in a seam or list them under 'free'".to_owned(),
            Self::FreeOnFold { .. } => "leave it out of 'free', or fold another edge".to_owned(),
            Self::Size { unit: "mm", small: true, .. } => {
                "bare numbers are millimetres; write 'units: cm' or 'units: in' if they are meant so".to_owned()
            }
            Self::Size { .. } => "write the unit the numbers are meant in, 'units: mm', 'cm' or 'in'".to_owned(),
            Self::StartsInside { .. } => {
                "move its 'at' out of the body: x to the wearer's left, y up from the floor, z forward; with 'turn' a \
                 piece lies as it says"
                    .to_owned()
            }
            Self::NotClosed { .. } => "the last edge must end at 'start'".to_owned(),
            Self::LineOff { .. } | Self::PointOff { .. } => {
                "positions are those of the drawing, in the file's units".to_owned()
            }
            Self::FoldOnEdge { .. } => {
                "draw the fold within the piece, and the outline where the cloth that is turned over ends".to_owned()
            }
            Self::PointsUnlike { .. } => "give 'meets_at' as many points as 'at'".to_owned(),
            Self::MatchesNothing(_) => "write piece.edge, such as front.hem, or *.hem for every hem".to_owned(),
            Self::WrongType { what, .. } if what == "a garment file" => {
                "it starts with 'garment: 1'; a surface (OBJ) goes to --body, or to 'toile flatten'".to_owned()
            }
            Self::Syntax(why) if why.contains("unknown anchor") => {
                "a word that begins with * stands in quotation marks: \"*.hem\"".to_owned()
            }
            Self::Syntax(why) if why.split_whitespace().any(|word| word == "tab" || word == "tabs") => {
                "YAML indents with spaces; write spaces for the tab".to_owned()
            }
            Self::Empty => "a garment file starts with 'garment: 1'".to_owned(),
            Self::CounterClockwise(_) => "distances along its edges are measured the clockwise way".to_owned(),
            Self::OneLayer { piece, layer, .. } => format!(
                "give '{piece}' layer: {} if it is worn inside, as a facing, or layer: {} if outside",
                layer - 1,
                layer + 1
            ),
            Self::UpsideDown { tube, .. } => format!(
                "unless that seam is to run there, '{tube}' is drawn for the other arm: write 'drawn: R' into it (or \
                 take that out again), or swap its front and its back"
            ),
            Self::SameSide { to, .. } => format!(
                "pieces side by side meet right to left: if '{to}' shows the wearer's other half, write 'drawn: R' \
                 into it (or take that out where it is wrong); or one of the two is drawn upside down"
            ),
            Self::WornInTwoWays { settling, .. } => settling.clone(),
            Self::OnePlace { copies: true, other, .. } => {
                format!("draw '{other}' as a piece of its own (like: ...) with another place or layer, or cut one only")
            }
            Self::OnePlace { other, .. } => format!(
                "give '{other}' another place, or another layer (1 if it is worn over the other, -1 if under it), or \
                 leave one of them out"
            ),
            Self::DrawnUpwards => {
                "give every y the other sign if it was, or the garment hangs upside down; if it was not, distances \
                 along edges are measured the clockwise way"
                    .to_owned()
            }
            Self::NoGrain(_) => "give it as grain: [[x, y], [x, y]], tail to head".to_owned(),
            Self::DartLegs { .. } => "give 'length' instead of 'tip' and both legs are equal".to_owned(),
            Self::WhichCopy { count: 2, .. } => "a left and a right one are 'cut: pair'".to_owned(),
            Self::BackwardsRange(_) => {
                "the smaller number comes first, along the edge; which way a seam runs follows from its 'face'"
                    .to_owned()
            }
            Self::ChainBroken { doubt, .. } => {
                let order = "name the edges in the order they are sewn, end to end";
                match doubt {
                    ChainDoubt::Order => order.to_owned(),
                    ChainDoubt::Drawn => {
                        format!("{order}; if they are, a half drawn for the wearer's right needs 'drawn: R'")
                    }
                    ChainDoubt::Fold => {
                        format!("{order}; the halves of a piece meet at the edge that its 'cut: fold' names")
                    }
                }
            }
            Self::Twisted { turned: None, .. } => {
                "leave face: same out: halves are sewn to each other with the right sides out".to_owned()
            }
            Self::Twisted { turned: Some(turned), same: false, .. } => format!(
                "with the right sides out its two lists run opposite ways round their pieces, and these run the same \
                 way; turn one round, to: [{turned}], or say face: same if one piece is laid on the other"
            ),
            Self::Twisted { turned: Some(turned), same: true, .. } => format!(
                "with face: same its two lists run the same way round their pieces, and these run opposite ways; turn \
                 one round, to: [{turned}], or leave face: same out if the right sides are out"
            ),
            Self::NonOrientable(_) => {
                "walked round through its seams, the right side of the cloth comes out inside: one of them says 'face: \
                 same' and should not, or should; without it the right sides are out"
                    .to_owned()
            }
            Self::OpenTooLong { .. } => {
                "leave more of it sewn, give it a 'closure', or list its edges under 'free' instead".to_owned()
            }
            Self::NotchesApart { .. } => {
                "a notch is measured from the start of its edge as it is drawn, and the two sides of a seam often run \
                 opposite ways; one that marks something else can be a line of the 'kind' place"
                    .to_owned()
            }
            Self::More { .. } => "mend those above, then check again".to_owned(),
            Self::TooManyValues(_) => "write the pieces with 'like' instead".to_owned(),
            _ => return None,
        };
        Some(hint)
    }
}
