//! The studio's page: the report's own parts made live, and what edits the file.

use std::sync::LazyLock;

use crate::report::page_parts;

/// The studio's own scripts, in the order in which they are joined after those of the report.
const SCRIPTS: [&str; 9] = [
    include_str!("page/talk.js"),
    include_str!("page/board.js"),
    include_str!("page/chosen.js"),
    include_str!("page/mannequin.js"),
    include_str!("page/colors.js"),
    include_str!("page/alter.js"),
    include_str!("page/wearer.js"),
    include_str!("page/panel.js"),
    include_str!("page/studio.js"),
];
const FRAME: &str = include_str!("page/studio.html");
const STYLE: &str = include_str!("page/studio.css");

static HTML: LazyLock<String> = LazyLock::new(|| FRAME.replace("{{views}}", page_parts().views));
static CSS: LazyLock<String> = LazyLock::new(|| [page_parts().style, STYLE].join("\n"));
static SCRIPT: LazyLock<String> =
    LazyLock::new(|| format!("\"use strict\";\n(() => {{\n{}\n{}\n}})();\n", page_parts().scripts, SCRIPTS.join("\n")));

/// The page. It holds no data: names come later and are set as text.
pub(super) fn html() -> &'static str {
    &HTML
}

/// Its styles.
pub(super) fn css() -> &'static str {
    &CSS
}

/// Its script.
pub(super) fn script() -> &'static str {
    &SCRIPT
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_markup_but_the_page_itself() {
        assert!(!html().contains("{{") && html().contains("id=\"space\"") && html().contains("id=\"board\""));
        for word in ["innerHTML", "outerHTML", "insertAdjacentHTML", "document.write", "eval(", "http://", "https://"] {
            let said = script().replace("http://www.w3.org/2000/svg", "");
            assert!(!said.contains(word) && !html().contains(word), "{word}");
        }
        // The policy allows neither scripts nor styles in the page.
        for word in ["<script>", "<style", "style=\"", "onclick"] {
            assert!(!html().contains(word), "{word}");
        }
    }
}
