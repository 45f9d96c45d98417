//! Links between the pages of the documentation: to files, and to the headings in them.

use std::collections::BTreeSet;
use std::path::Path;

use super::{assert_none, files, text};

/// The name of a heading in links, as GitHub makes it.
fn anchor(heading: &str) -> String {
    let kept = |c: &char| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_');
    let lower = heading.trim().to_lowercase();
    lower
        .chars()
        .filter(kept)
        .map(|c| if c == ' ' { '-' } else { c })
        .collect()
}

/// What links to a page may name.
fn anchors(page: &Path) -> BTreeSet<String> {
    let text = text(page);
    let headings = text.lines().filter(|line| line.starts_with('#'));
    headings.map(|line| anchor(line.trim_start_matches('#'))).collect()
}

#[test]
fn links_between_pages_lead_somewhere() {
    let mut broken = Vec::new();
    let (mut links, mut named) = (0, 0);
    for page in files(&["."], "md") {
        for link in text(&page).split("](").skip(1) {
            let link = link.split(')').next().unwrap_or_default();
            if link.is_empty() || link.contains("://") || link.contains(char::is_whitespace) {
                continue;
            }
            links += 1;
            let (file, name) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() {
                page.clone()
            } else {
                page.with_file_name(file)
            };
            named += usize::from(!name.is_empty());
            if !target.exists() || !name.is_empty() && !anchors(&target).contains(name) {
                broken.push(format!("{}: {link}", page.display()));
            }
        }
    }
    assert!(
        links > 100 && named > 50,
        "only {links} links seen, {named} of them to headings"
    );
    assert_none(&broken, "a link to nothing");
}

#[test]
fn headings_are_named() {
    assert_eq!(anchor(" Arcs, and chords: `G2` (1-D)"), "arcs-and-chords-g2-1-d");
}
