//! The plots of the study.

use super::{Bridge, Row, Study};
use crate::plot::{Axis, Panel, Series, figure};
use crate::workspace;
use std::fs;

/// Writes `docs/pictures/accuracy-*.svg`.
pub fn store(studies: &[Study]) -> Result<(), String> {
    let steps = panels(studies, "spacing of the placed tools, mm", |_, row| row.spacing, false);
    write(
        "accuracy-spacing",
        &figure(
            &steps,
            2,
            "Error against the spacing of the placed tools, of the four examples",
        ),
    )?;
    let times = panels(
        studies,
        "time / time of the exact simulation",
        |study, row| row.seconds / study.seconds,
        true,
    );
    write(
        "accuracy-time",
        &figure(
            &times,
            2,
            "Error against time in units of the exact simulation's, of the four examples",
        ),
    )
}

fn panels(studies: &[Study], label: &str, x: fn(&Study, &Row) -> f64, exact: bool) -> Vec<Panel> {
    let axis = |label: &str, range| Axis {
        label: label.into(),
        logarithmic: true,
        range,
    };
    let panel = |study: &Study| {
        let curve = |bridge: Bridge, name: &str, measure: fn(&Row) -> f64, colour: usize, dashed: bool| Series {
            name: format!("{}, {name}", bridge.name()),
            colour,
            dashed,
            joined: true,
            points: study.of(bridge).map(|row| [x(study, row), measure(row)]).collect(),
        };
        let mut series = Vec::new();
        for (bridge, colour) in [(Bridge::Union, 0), (Bridge::Hulls, 1)] {
            if study.of(bridge).next().is_some() {
                series.push(curve(bridge, "largest", |row| row.errors.max, colour, false));
                series.push(curve(bridge, "RMS", |row| row.errors.rms, colour, true));
            }
        }
        if exact {
            series.push(Series {
                name: "sweepsim, its tolerance".into(),
                colour: 2,
                dashed: false,
                joined: true,
                points: vec![[1.0, 1e-6]],
            });
        }
        Panel {
            title: study.title.into(),
            axes: [axis(label, None), axis("error, mm", Some([1e-7, 1.0]))],
            series,
        }
    };
    studies.iter().map(panel).collect()
}

fn write(name: &str, svg: &str) -> Result<(), String> {
    let file = workspace::root().join("docs/pictures").join(name).with_extension("svg");
    fs::write(&file, svg).map_err(|error| format!("{}: {error}", file.display()))
}
