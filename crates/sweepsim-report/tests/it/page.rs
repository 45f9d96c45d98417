//! The page as text: escaped, offline, the same each time.

use sweepsim_report::{
    Area, Bar, DexelLayer, Excerpt, Fact, Finding, Histogram, LayerEnd, Page, Picture, Plot, ProgramText, Scene, Table,
    ToolPart, Verdict,
};

/// Text that would leave every element, attribute and script if it were not escaped.
const EVIL: &str = "</script><script>alert(1)</script><!--\"'><img src=x onerror=alert(2)>&amp;</style></title>";

fn evil() -> Page {
    let text = || EVIL.to_owned();
    let mut page = Page::new(EVIL);
    page.lead = text();
    let mut verdict = Verdict::bad(EVIL);
    verdict.details = vec![text()];
    page.verdict = Some(verdict);
    page.findings = vec![Finding {
        title: text(),
        kind: text(),
        place: [f64::NAN, 1.0, 2.0],
        clock: Some(f64::INFINITY),
        facts: vec![(text(), text())],
        excerpt: Some(Excerpt {
            file: text(),
            first: 3,
            lines: vec![text(), text()],
            line: 4,
        }),
    }];
    page.proofs = page.findings.clone();
    page.facts = vec![Fact::new(EVIL, EVIL, EVIL)];
    page.plots = vec![Plot {
        name: text(),
        unit: text(),
        steps: vec![[0.0, f64::NAN, 1.0], [f64::INFINITY, 1.0, 2.0]],
    }];
    page.histogram = Some(Histogram {
        bars: vec![Bar {
            from: -1.0,
            to: 1.0,
            area: 2.0,
        }],
        limits: [0.1, 0.2],
        note: text(),
    });
    page.tables = vec![Table {
        title: text(),
        note: text(),
        columns: vec![text()],
        rows: vec![vec![text()]],
        numbers: vec![0],
        printed: true,
    }];
    page.notes = vec![text()];
    page.pictures = vec![Picture {
        caption: text(),
        png: vec![1, 2, 3],
    }];
    page.footer = text();
    let area = Area {
        min: [0.0; 2],
        max: [2.0; 2],
        cells: [2, 2],
    };
    let mut scene = Scene::new(DexelLayer::new(area, |_, _, line| {
        line.push([LayerEnd::at(0.0, [0.0, 0.0, -1.0]), LayerEnd::at(1.0, [0.0, 0.0, 1.0])]);
    }));
    scene.tools = vec![ToolPart {
        name: text(),
        ..ToolPart::default()
    }];
    scene.programs = vec![ProgramText {
        name: text(),
        text: text(),
    }];
    page.scene = Some(scene);
    page
}

/// What remains of a page without its own scripts and styles, which end at the first end tag like any others.
fn without_scripts(html: &str) -> String {
    let mut rest = html;
    let mut kept = String::new();
    for (open, close) in [
        ("<style>", "</style>"),
        ("<script", "</script>"),
        ("<script", "</script>"),
        ("<script", "</script>"),
        ("<script", "</script>"),
    ] {
        let (before, from) = rest.split_once(open).expect("the page has it");
        kept.push_str(before);
        rest = from.split_once(close).expect("it ends").1;
    }
    kept + rest
}

#[test]
fn no_text_leaves_its_element() {
    let html = evil().html();
    let words = without_scripts(&html);
    assert!(
        !words.contains("<script") && !words.contains("<img src=x") && !words.contains("<!--"),
        "{words}"
    );
    // The scripts are the page's own, whole: four, and nothing behind them.
    assert_eq!(html.matches("<script").count(), 4);
    assert!(html.trim_end().ends_with("</script>\n</body>\n</html>"));
    assert!(words.contains("&lt;/script&gt;&lt;script&gt;alert(1)"));
}

#[test]
fn nothing_is_asked_of_the_network() {
    let html = evil().html();
    let words = without_scripts(&html);
    for mark in ["http:", "https:", "//", "url(", "@import", "<link", "<iframe"] {
        let found = words
            .match_indices(mark)
            .filter(|(at, _)| !words[..*at].ends_with("data:image/png;base64,"));
        assert_eq!(found.count(), 0, "{mark}");
    }
    assert!(html.contains("Content-Security-Policy\" content=\"default-src 'none';"));
}

#[test]
fn the_same_page_gives_the_same_bytes() {
    assert_eq!(evil().html(), evil().html());
}

#[test]
fn the_verdict_comes_first() {
    let mut page = Page::new("job");
    page.verdict = Some(Verdict::bad("May not be run: 3 moves do harm."));
    page.tables = vec![Table {
        title: "Tools".to_owned(),
        ..Table::default()
    }];
    page.findings = vec![Finding {
        title: "Holder hits the workpiece".to_owned(),
        ..Finding::default()
    }];
    let html = page.html();
    let places = ["May not be run", "Holder hits", "<h2>Tools"].map(|text| html.find(text).expect("it is on the page"));
    assert!(places[0] < places[1] && places[1] < places[2]);
}

#[test]
fn an_empty_page_is_a_page() {
    let html = Page::new("").html();
    assert!(html.contains("<main>") && !html.contains("id=\"canvas\""));
}

/// The scripts number what is listed: findings first, then proofs, each with its colour.
#[test]
fn proofs_are_listed_after_findings() {
    let listed = |title: &str, kind: &str| Finding {
        title: title.to_owned(),
        kind: kind.to_owned(),
        ..Finding::default()
    };
    let mut page = Page::new("proofs");
    page.findings = vec![listed("one", "gouge")];
    page.proofs = vec![listed("two", "refuted"), listed("three", "open")];
    let html = page.html();
    let at = |text: &str| html.find(text).unwrap_or_else(|| panic!("no {text}"));
    assert!(at("<h2>Findings <span class=\"count\">1<") < at("<h2>Proofs <span class=\"count\">2<"));
    for (number, (title, kind)) in [("one", "gouge"), ("two", "refuted"), ("three", "open")]
        .into_iter()
        .enumerate()
    {
        let item = &html[at(&format!("<li class=\"finding k-{kind}\">"))..];
        assert!(item.find(title) < item.find("</li>"), "{title}");
        assert!(item.contains(&format!("data-finding=\"{number}\"")), "{title}");
    }
    page.findings.clear();
    assert!(!page.html().contains("<h2>Findings"));
}
