//! A page of tables and figures without a script: several results side by side, a study.

use std::path::Path;

use asperity_io::output::{WriteError, write_all};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use crate::figure::Figure;
use crate::page::{STYLE, escaped};

/// The page as it grows.
pub struct Sheet {
    title: String,
    body: String,
}

/// Pixels of a page for a point of a figure, where there is room: two panels side by side fill it.
const LARGE: f64 = 2.2;

/// What the pages of results do not need.
const TABLES: &str = "\
    .wide { overflow-x: auto; } table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
    th, td { text-align: left; padding: 4px 14px 4px 0; border-bottom: 1px solid var(--rule); white-space: nowrap; }
    th { color: var(--soft); font-weight: 500; } td:first-child { color: var(--soft); }
    img { max-width: 100%; height: auto; background: #fff; border-radius: 4px; }
    /* On a phone each row is a block, and each cell a line with the head of its column. */
    @media (max-width: 560px) {
      tr:first-child { display: none; } table, tbody, tr, td { display: block; }
      tr { padding: 8px 0; border-bottom: 1px solid var(--rule); }
      td { border: 0; padding: 1px 0; white-space: normal; overflow-wrap: anywhere; }
      td:first-child { font-weight: 600; color: var(--ink); }
      td[data-head]:not([data-head=\"\"]) { display: grid; grid-template-columns: 9em 1fr; gap: 10px; }
      td[data-head]::before { content: attr(data-head); color: var(--soft); font-weight: 400; }
    }";

/// The dark colours of the pages of results, where the system is dark: this page has no script that chooses.
fn dark() -> String {
    let (_, after) = STYLE.split_once(":root[data-theme=\"dark\"]").unwrap_or_default();
    let (colours, _) = after.split_once('}').unwrap_or_default();
    format!("@media (prefers-color-scheme: dark) {{ :root{colours}}} }}")
}

impl Sheet {
    /// A page with this title.
    pub fn new(title: impl Into<String>) -> Sheet {
        Sheet { title: title.into(), body: String::new() }
    }

    /// The same page with a table more, the first of whose rows is its head.
    pub fn table(mut self, heading: &str, rows: &[Vec<String>]) -> Sheet {
        self.body += &format!("<h2>{}</h2>\n<div class=\"wide\"><table>\n", escaped(heading));
        for (n, row) in rows.iter().enumerate() {
            let cell = |(column, cell): (usize, &String)| match (n, rows[0].get(column)) {
                (0, _) => format!("<th>{}</th>", escaped(cell)),
                (_, head) => {
                    let head = escaped(head.map_or("", String::as_str));
                    format!("<td data-head=\"{head}\">{}</td>", escaped(cell))
                }
            };
            let cells: String = row.iter().enumerate().map(cell).collect();
            self.body += &format!("<tr>{cells}</tr>\n");
        }
        self.body += "</table></div>\n";
        self
    }

    /// The same page with a figure more, whose panels stand below one another on a phone.
    pub fn figure(mut self, heading: &str, figure: &Figure) -> Sheet {
        let data =
            |figure: &Figure| format!("data:image/svg+xml;base64,{}", STANDARD.encode(figure.to_svg()));
        let narrow = match figure.panels.len() {
            0 | 1 => String::new(),
            _ => {
                let column = data(&figure.clone().columns(1));
                format!("<source media=\"(max-width: 560px)\" srcset=\"{column}\">")
            }
        };
        let (heading, picture) = (escaped(heading), data(figure));
        let width = (LARGE * figure.paper()[0]).round();
        self.body += &format!(
            "<h2>{heading}</h2>\n<p><picture>{narrow}<img style=\"width: {width}px\" alt=\"{heading}\" src=\"{picture}\"></picture></p>\n"
        );
        self
    }

    /// The same page with a sentence more.
    pub fn note(mut self, text: &str) -> Sheet {
        self.body += &format!("<p class=\"note\">{}</p>\n", escaped(text));
        self
    }

    /// The page as HTML.
    pub fn html(&self) -> String {
        let title = escaped(&self.title);
        format!(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta name=\"generator\" content=\"asperity\">\n<title>{title}</title>\n<style>\n{STYLE}\n{}\n{TABLES}\n</style>\n\
             </head>\n<body>\n<header><h1>{title}</h1></header>\n<main>\n{}</main>\n</body>\n</html>\n",
            dark(),
            self.body
        )
    }

    /// Writes the page. It appears whole or not at all.
    ///
    /// # Errors
    /// [`WriteError`]: `Exists` if there is a file already and `force` is not given.
    pub fn write(&self, path: &Path, force: bool) -> Result<(), WriteError> {
        write_all(path, force, self.html().as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_cannot_become_markup() {
        let page = Sheet::new("<b>").table("<i>", &[vec!["<script>".into()]]).note("&").html();
        for markup in ["<b>", "<i>", "<script>"] {
            assert!(!page.contains(markup), "{markup}");
        }
        assert!(page.contains("<th>&lt;script&gt;</th>") && page.contains("<p class=\"note\">&amp;</p>"));
    }

    #[test]
    fn a_narrow_page_shows_the_head_of_its_column_beside_each_cell_and_a_dark_one_the_dark_colours() {
        let rows = [["", "load = 1 N"], ["Contact area", "2 mm²"]].map(|row| row.map(String::from).to_vec());
        let page = Sheet::new("two").table("Answers", &rows).html();
        assert!(page.contains("<td data-head=\"load = 1 N\">2 mm²</td>"), "{page}");
        let (_, dark) = page.split_once("(prefers-color-scheme: dark) { :root {").unwrap();
        assert!(dark.trim_start().starts_with("--paper: #14181c"), "{dark}");
    }
}
