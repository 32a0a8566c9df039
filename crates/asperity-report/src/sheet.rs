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

/// What the pages of results do not need.
const TABLES: &str = ".wide { overflow-x: auto; } table { border-collapse: collapse; font-variant-numeric: tabular-nums; }\
    th, td { text-align: left; padding: 4px 14px 4px 0; border-bottom: 1px solid var(--rule); white-space: nowrap; }\
    th { color: var(--soft); font-weight: 500; } img { max-width: 100%; height: auto; background: #fff; }";

impl Sheet {
    /// A page with this title.
    pub fn new(title: impl Into<String>) -> Sheet {
        Sheet { title: title.into(), body: String::new() }
    }

    /// The same page with a table more, the first of whose rows is its head.
    pub fn table(mut self, heading: &str, rows: &[Vec<String>]) -> Sheet {
        self.body += &format!("<h2>{}</h2>\n<div class=\"wide\"><table>\n", escaped(heading));
        for (n, row) in rows.iter().enumerate() {
            let tag = if n == 0 { "th" } else { "td" };
            let cells: String = row.iter().map(|cell| format!("<{tag}>{}</{tag}>", escaped(cell))).collect();
            self.body += &format!("<tr>{cells}</tr>\n");
        }
        self.body += "</table></div>\n";
        self
    }

    /// The same page with a figure more.
    pub fn figure(mut self, heading: &str, figure: &Figure) -> Sheet {
        let data =
            |figure: &Figure| format!("data:image/svg+xml;base64,{}", STANDARD.encode(figure.to_svg()));
        // On a phone the panels stand one below the other.
        let narrow = match figure.panels.len() {
            0 | 1 => String::new(),
            _ => {
                let column = data(&figure.clone().columns(1));
                format!("<source media=\"(max-width: 640px)\" srcset=\"{column}\">")
            }
        };
        let (heading, picture) = (escaped(heading), data(figure));
        self.body += &format!(
            "<h2>{heading}</h2>\n<p><picture>{narrow}<img alt=\"{heading}\" src=\"{picture}\"></picture></p>\n"
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
             <meta name=\"generator\" content=\"asperity\">\n<title>{title}</title>\n<style>\n{STYLE}\n{TABLES}\n</style>\n\
             </head>\n<body>\n<header><h1>{title}</h1></header>\n<main>\n{}</main>\n</body>\n</html>\n",
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
}
