//! Facts and tables.

use crate::html::escape;
use std::fmt::Write as _;

/// A figure with its name, and an explanation in small print.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fact {
    /// The name.
    pub label: String,
    /// The figure with its unit.
    pub value: String,
    /// The small print.
    pub small: String,
}

impl Fact {
    /// A figure with its name.
    #[must_use]
    pub fn new(label: impl Into<String>, value: impl Into<String>, small: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            value: value.into(),
            small: small.into(),
        }
    }
}

/// A table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// The title.
    pub title: String,
    /// A sentence below the title, or nothing.
    pub note: String,
    /// The heads of the columns; if there are none, the first cell of each row is its head.
    pub columns: Vec<String>,
    /// The rows.
    pub rows: Vec<Vec<String>>,
    /// Which columns hold numbers, from 0: they are set flush right.
    pub numbers: Vec<usize>,
    /// Whether it belongs on a printed set-up sheet.
    pub printed: bool,
}

/// The most rows shown.
const ROWS: usize = 1000;

pub(crate) fn facts(html: &mut String, facts: &[Fact]) {
    if facts.is_empty() {
        return;
    }
    html.push_str("<dl class=\"facts\">\n");
    for fact in facts {
        let _ = writeln!(
            html,
            "<div><dt>{}</dt><dd>{}<small>{}</small></dd></div>",
            escape(&fact.label),
            escape(&fact.value),
            escape(&fact.small)
        );
    }
    html.push_str("</dl>\n");
}

pub(crate) fn table(html: &mut String, table: &Table) {
    let class = if table.printed { "card" } else { "card screen" };
    let _ = writeln!(html, "<section class=\"{class}\"><h2>{}</h2>", escape(&table.title));
    if !table.note.is_empty() {
        let _ = writeln!(html, "<p class=\"soft\">{}</p>", escape(&table.note));
    }
    html.push_str("<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"");
    html.push_str(&escape(&table.title));
    html.push_str("\"><table>\n");
    let number = |column: usize| {
        if table.numbers.contains(&column) {
            " class=\"n\""
        } else {
            ""
        }
    };
    if !table.columns.is_empty() {
        html.push_str("<thead><tr>");
        for (column, head) in table.columns.iter().enumerate() {
            let _ = write!(html, "<th scope=\"col\"{}>{}</th>", number(column), escape(head));
        }
        html.push_str("</tr></thead>\n");
    }
    html.push_str("<tbody>\n");
    for row in table.rows.iter().take(ROWS) {
        html.push_str("<tr>");
        for (column, cell) in row.iter().enumerate() {
            let tag = if column == 0 && table.columns.is_empty() {
                "th scope=\"row\""
            } else {
                "td"
            };
            let end = &tag[..2];
            let _ = write!(html, "<{tag}{}>{}</{end}>", number(column), escape(cell));
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</tbody></table></div>\n");
    if table.rows.len() > ROWS {
        let _ = writeln!(
            html,
            "<p class=\"soft\">… and {} more rows.</p>",
            table.rows.len() - ROWS
        );
    }
    html.push_str("</section>\n");
}
