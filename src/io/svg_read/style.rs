//! CSS properties of an element: its own `style`, the rules of the drawing's `<style>`, or its attribute.

use roxmltree::{Document, Node};

/// The rules of a drawing's style sheets. Of selectors those that name an element, its class or its id are known.
pub(super) struct Styles {
    rules: Vec<StyleRule>,
}

struct StyleRule {
    selector: String,
    declarations: String,
}

impl Styles {
    pub(super) fn of(document: &Document) -> Self {
        let sheets = document.descendants().filter(|n| n.tag_name().name() == "style");
        let words = sheets.flat_map(|n| n.children()).filter_map(|n| n.text());
        Self { rules: words.flat_map(|sheet| rules(&without_comments(sheet))).collect() }
    }

    /// The value of a property; what is said of one element counts before what is said of many, and of rules the last
    /// among the most exact.
    pub(super) fn property<'a>(&'a self, node: Node<'a, '_>, key: &str) -> Option<&'a str> {
        let own = node.attribute("style").and_then(|style| declared(style, key));
        let ruled = || {
            let rules = self.rules.iter().filter_map(|r| Some((exactness(&r.selector, node)?, r)));
            let saying = rules.filter_map(|(exact, r)| Some((exact, declared(&r.declarations, key)?)));
            saying.max_by_key(|(exact, _)| *exact).map(|(_, value)| value)
        };
        own.or_else(ruled).or_else(|| node.attribute(key))
    }

    /// The value of a property that passes on to what an element holds.
    fn inherited<'a>(&'a self, node: Node<'a, '_>, key: &str) -> Option<&'a str> {
        node.ancestors().find_map(|n| self.property(n, key))
    }

    /// Whether an element is filled, and no pen runs along it.
    pub(super) fn only_fills(&self, node: Node) -> bool {
        let paints = |key: &str| self.inherited(node, key).filter(|value| !["none", "transparent"].contains(value));
        paints("fill").is_some() && paints("stroke").is_none()
    }

    /// The height of the letters of a text, user units; 0 where it is not told as a length.
    pub(super) fn letters(&self, node: Node) -> f64 {
        let told = self.inherited(node, "font-size").unwrap_or_default();
        let number = told.trim_end_matches(|c: char| c.is_alphabetic());
        number.trim().parse::<f64>().ok().filter(|x| x.is_finite() && *x > 0.0).unwrap_or(0.0)
    }

    pub(super) fn hides(&self, node: Node) -> bool {
        self.property(node, "display") == Some("none") || self.property(node, "visibility") == Some("hidden")
    }
}

fn without_comments(sheet: &str) -> String {
    let mut parts = sheet.split("/*");
    let first = parts.next().unwrap_or_default().to_owned();
    first + &parts.filter_map(|part| part.split_once("*/")).map(|(_, rest)| rest).collect::<String>()
}

/// `.a, .b { … }` as a rule for each selector.
fn rules(sheet: &str) -> Vec<StyleRule> {
    let blocks = sheet.split('}').filter_map(|block| block.split_once('{'));
    let of_block = |(selectors, declarations): (&str, &str)| {
        let rule = |s: &str| StyleRule { selector: s.trim().to_owned(), declarations: declarations.to_owned() };
        selectors.split(',').map(rule).collect::<Vec<StyleRule>>()
    };
    blocks.flat_map(of_block).collect()
}

/// The last value that declarations give a property.
fn declared<'a>(declarations: &'a str, key: &str) -> Option<&'a str> {
    let mut pairs = declarations.rsplit(';').filter_map(|d| d.split_once(':'));
    let (_, value) = pairs.find(|(name, _)| name.trim() == key)?;
    Some(value.trim().trim_end_matches("!important").trim_end())
}

/// How exactly a selector means this element, if it does: its name, its class or its id.
fn exactness(selector: &str, node: Node) -> Option<u8> {
    if let Some(id) = selector.strip_prefix('#') {
        return (node.attribute("id") == Some(id)).then_some(2);
    }
    let (name, class) = selector.split_once('.').map_or((selector, None), |(name, class)| (name, Some(class)));
    let has = |class: &str| node.attribute("class").is_some_and(|own| own.split_whitespace().any(|w| w == class));
    let means = !selector.is_empty() && (name.is_empty() || name == node.tag_name().name()) && class.is_none_or(has);
    means.then_some(u8::from(class.is_some()))
}
