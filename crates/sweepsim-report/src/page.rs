//! The page as a whole.

use crate::axes::{self, AxisPlot};
use crate::encode::{Embedded, embed};
use crate::findings::{self, Finding};
use crate::html::{escape, json};
use crate::plots::{self, Histogram, Plot};
use crate::scene::{Scene, Surface};
use crate::tables::{self, Fact, Table};
use crate::viewer;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use std::fmt::Write as _;

const STYLES: [&str; 4] = [
    include_str!("../assets/page.css"),
    include_str!("../assets/viewer.css"),
    include_str!("../assets/axes.css"),
    include_str!("../assets/print.css"),
];

/// The scripts share one function: each uses what those before it declare.
const SCRIPTS: [&str; 17] = [
    include_str!("../assets/data.js"),
    include_str!("../assets/vectors.js"),
    include_str!("../assets/layers.js"),
    include_str!("../assets/surface.js"),
    include_str!("../assets/sharp.js"),
    include_str!("../assets/rays.js"),
    include_str!("../assets/solids.js"),
    include_str!("../assets/machine.js"),
    include_str!("../assets/colours.js"),
    include_str!("../assets/gpu.js"),
    include_str!("../assets/camera.js"),
    include_str!("../assets/section.js"),
    include_str!("../assets/measure.js"),
    include_str!("../assets/viewer.js"),
    include_str!("../assets/overlay.js"),
    include_str!("../assets/controls.js"),
    include_str!("../assets/page.js"),
];

/// What an answer is worth: each has its own colour and sign.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum VerdictState {
    /// Nothing is wrong with what was looked at.
    Good,
    /// Nothing was found, but not everything was looked at.
    #[default]
    Partial,
    /// Something is wrong, or not decided.
    Bad,
}

/// Whether the program may be run, in words.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Verdict {
    /// What the answer is.
    pub state: VerdictState,
    /// The answer: one sentence.
    pub headline: String,
    /// What was found, in a few words each.
    pub details: Vec<String>,
}

impl Verdict {
    fn new(state: VerdictState, headline: impl Into<String>) -> Self {
        Self {
            state,
            headline: headline.into(),
            details: Vec::new(),
        }
    }

    /// Nothing is wrong.
    #[must_use]
    pub fn good(headline: impl Into<String>) -> Self {
        Self::new(VerdictState::Good, headline)
    }

    /// Nothing was found, but not everything was looked at.
    #[must_use]
    pub fn partial(headline: impl Into<String>) -> Self {
        Self::new(VerdictState::Partial, headline)
    }

    /// The program may not be run, or that is not decided.
    #[must_use]
    pub fn bad(headline: impl Into<String>) -> Self {
        Self::new(VerdictState::Bad, headline)
    }
}

/// A picture, shown on paper and where there is no WebGL.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// What it shows.
    pub caption: String,
    /// A PNG file.
    pub png: Vec<u8>,
}

/// A report.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Page {
    /// The name of the job.
    pub title: String,
    /// What was computed, in one line.
    pub lead: String,
    /// The answer, if there was a question.
    pub verdict: Option<Verdict>,
    /// What was found, in the program's order.
    pub findings: Vec<Finding>,
    /// What is proven everywhere, refuted or open: each with the place where its extreme is, or a place that is open.
    pub proofs: Vec<Finding>,
    /// The most important figures.
    pub facts: Vec<Fact>,
    /// Quantities along the program.
    pub plots: Vec<Plot>,
    /// The travel of the machine's axes along the program.
    pub axes: Vec<AxisPlot>,
    /// Deviations from the target.
    pub histogram: Option<Histogram>,
    /// Tables, in order.
    pub tables: Vec<Table>,
    /// What else should be known.
    pub notes: Vec<String>,
    /// Pictures.
    pub pictures: Vec<Picture>,
    /// What the viewer shows.
    pub scene: Option<Scene>,
    /// The last line.
    pub footer: String,
    /// The most bytes of the page: 15 MB, unless set. Words, pictures, tools and solids are never left out.
    pub most_bytes: usize,
}

impl Page {
    /// A page without anything but its title.
    #[must_use]
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            most_bytes: 15_000_000,
            ..Self::default()
        }
    }

    /// The page as an HTML file: UTF-8, without any reference to another file or to the network.
    #[must_use]
    pub fn html(&self) -> String {
        let mut head = String::from(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:\">\n\
             <meta name=\"color-scheme\" content=\"light dark\">\n",
        );
        let _ = write!(head, "<title>{} — sweepsim</title>\n<style>\n", escape(&self.title));
        for style in STYLES {
            head.push_str(style);
        }
        head.push_str("</style>\n</head>\n<body>\n");
        let before = self.before_viewer();
        let mut after = self.after_viewer();
        let mut script = String::from("<script>\n(() => {\n\"use strict\";\n");
        for source in SCRIPTS {
            script.push_str(source);
        }
        script.push_str("})();\n</script>\n</body>\n</html>\n");
        let marks = json(&findings::markers(&self.findings, &self.proofs));
        let words = head.len() + before.len() + after.len() + script.len() + marks.len();
        // The markup of the viewer and the description of the arrays are small beside this.
        const SPARE: usize = 100_000;
        let most = self.most_bytes.saturating_sub(words + SPARE);
        let embedded = self.scene.as_ref().map(|scene| embed(scene, most));

        let mut html = head;
        html.reserve(
            before.len() + after.len() + script.len() + embedded.as_ref().map_or(0, |e| e.bytes.len() * 4 / 3),
        );
        html.push_str(&before);
        self.viewer(&mut html, embedded.as_ref());
        html.push_str("</div>\n");
        if let Some(embedded) = &embedded {
            let accuracy = viewer::accuracy(embedded.step, self.surface(embedded), &embedded.left_out);
            after = after.replacen(ACCURACY, &accuracy, 1);
        }
        html.push_str(&after.replacen(ACCURACY, "", 1));
        if let Some(embedded) = &embedded {
            let _ = writeln!(
                html,
                "<script type=\"application/json\" id=\"head\">{}</script>",
                json(&embedded.head)
            );
            let _ = writeln!(
                html,
                "<script type=\"application/json\" id=\"markers\">{marks}</script>"
            );
            html.push_str("<script type=\"text/plain\" id=\"arrays\">");
            STANDARD.encode_string(&embedded.bytes, &mut html);
            html.push_str("</script>\n");
        }
        html.push_str(&script);
        html
    }

    /// The surface of the part, if it is embedded.
    fn surface(&self, embedded: &Embedded) -> Option<&Surface> {
        let surface = self.scene.as_ref().and_then(|scene| scene.surface.as_ref());
        surface.filter(|_| embedded.has_surface)
    }

    /// Verdict and findings.
    fn before_viewer(&self) -> String {
        let mut html = String::from("<header class=\"top\">\n");
        let _ = writeln!(
            html,
            "<div class=\"title\"><h1>{}</h1><p>{}</p></div>",
            escape(&self.title),
            escape(&self.lead)
        );
        if let Some(verdict) = &self.verdict {
            let (class, sign) = match verdict.state {
                VerdictState::Good => ("good", "✓"),
                VerdictState::Partial => ("partial", "!"),
                VerdictState::Bad => ("bad", "✕"),
            };
            let _ = write!(
                html,
                "<div class=\"verdict {class}\" id=\"verdict\"><span class=\"sign\" aria-hidden=\"true\">{sign}</span><div><p class=\"headline\">{}</p>",
                escape(&verdict.headline)
            );
            if !verdict.details.is_empty() {
                let details: Vec<String> = verdict.details.iter().map(|detail| escape(detail)).collect();
                let _ = write!(html, "<p>{}</p>", details.join(" · "));
            }
            html.push_str("</div></div>\n");
        }
        html.push_str("</header>\n<main>\n");
        let class = if self.findings.is_empty() && self.proofs.is_empty() {
            "stage"
        } else {
            "stage with-findings"
        };
        let _ = writeln!(html, "<div class=\"{class}\">");
        if !(self.findings.is_empty() && self.proofs.is_empty()) {
            html.push_str("<section class=\"list\" aria-label=\"Findings and proofs\">");
            findings::lists(&mut html, &self.findings, &self.proofs);
            html.push_str("</section>\n");
        }
        html
    }

    fn viewer(&self, html: &mut String, embedded: Option<&Embedded>) {
        html.push_str("<section class=\"show\" aria-label=\"The part\">\n");
        if let Some(scene) = self.scene.as_ref().filter(|_| embedded.is_some()) {
            viewer::markup(html, scene);
        }
        if !self.pictures.is_empty() {
            html.push_str("<div class=\"pictures\" id=\"pictures\">\n");
            for picture in &self.pictures {
                let _ = write!(
                    html,
                    "<figure><img alt=\"{}\" src=\"data:image/png;base64,",
                    escape(&picture.caption)
                );
                STANDARD.encode_string(&picture.png, html);
                let _ = writeln!(
                    html,
                    "\"><figcaption>{}</figcaption></figure>",
                    escape(&picture.caption)
                );
            }
            html.push_str("</div>\n");
        }
        if let Some(track) = self.scene.as_ref().and_then(|scene| scene.track.as_ref()) {
            let end = track.points.last().map_or(0.0, |point| point.clock);
            viewer::timeline(html, self.scene.as_ref());
            if !self.plots.is_empty() || !self.axes.is_empty() {
                html.push_str("<div class=\"plots\" id=\"plots\">\n");
                plots::plots(html, &self.plots, end);
                axes::axes(html, &self.axes, end);
                html.push_str("</div>\n");
            }
        }
        html.push_str("</section>\n");
    }

    /// Figures, tables and notes.
    fn after_viewer(&self) -> String {
        let mut html = String::new();
        tables::facts(&mut html, &self.facts);
        html.push_str("<div class=\"cards\">\n");
        if let Some(histogram) = &self.histogram {
            plots::histogram(&mut html, histogram);
        }
        for table in &self.tables {
            tables::table(&mut html, table);
        }
        if !self.notes.is_empty() {
            html.push_str("<section class=\"card\"><h2>Notes</h2>\n<ul>\n");
            for note in &self.notes {
                let _ = writeln!(html, "<li>{}</li>", escape(note));
            }
            html.push_str("</ul></section>\n");
        }
        html.push_str("</div>\n</main>\n<footer>");
        html.push_str(&escape(&self.footer));
        html.push_str(ACCURACY);
        html.push_str("</footer>\n");
        html
    }
}

/// Where the accuracy of the viewer's data goes; no text of the page holds this character.
const ACCURACY: &str = "\u{0}";
