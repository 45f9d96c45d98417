//! The markup of the viewer: what the scripts bring to life.

use crate::html::{escape, measure};
use crate::scene::{Scene, SolidKind, Surface};
use std::fmt::Write as _;

/// How exact the viewer is, and what it lacks.
pub(crate) fn accuracy(step: f64, surface: Option<&Surface>, left_out: &[String]) -> String {
    let mut text = format!(
        " The viewer shows heights in steps of {} mm; report.json and dexels.csv have them in full.",
        escape(&measure(step))
    );
    if let Some(surface) = surface {
        let _ = write!(text, " The part is drawn by {} triangles", surface.triangles.len());
        if surface.whole > surface.triangles.len() {
            let farthest = measure(surface.farthest);
            let _ = write!(
                text,
                " of {}, from which the farthest corner is {farthest} mm",
                surface.whole
            );
        }
        text.push('.');
    }
    if !left_out.is_empty() {
        let _ = write!(text, " To stay small, it leaves out {}.", escape(&left_out.join("; ")));
    }
    text
}

/// The canvas with its controls.
pub(crate) fn markup(html: &mut String, scene: &Scene) {
    html.push_str(
        "<div class=\"viewer\" id=\"viewer\" hidden>\n<div class=\"tools\" role=\"toolbar\" aria-label=\"View\">\n",
    );
    html.push_str("<div class=\"group\" role=\"radiogroup\" aria-label=\"Colours\">\n");
    let ends = || scene.part.intervals.iter().flatten();
    let surface = scene.surface.as_ref();
    let on_surface = |known: fn(&Surface) -> bool| surface.is_some_and(known);
    let deviates = ends().any(|end| end.deviation.is_finite())
        || on_surface(|own| own.deviations.iter().any(|deviation| deviation.is_finite()));
    let cut = ends().any(|end| end.maker > 0) || on_surface(|own| own.makers.iter().any(|maker| *maker > 0));
    let modes = [
        ("deviation", "Deviation", deviates),
        ("tool", "Tool", cut),
        ("move", "Move", cut),
        ("plain", "Plain", true),
    ];
    for (mode, name, _) in modes.iter().filter(|(.., offered)| *offered) {
        let _ = writeln!(
            html,
            "<button type=\"button\" role=\"radio\" aria-checked=\"false\" data-mode=\"{mode}\">{name}</button>"
        );
    }
    html.push_str("</div>\n<div class=\"group\" aria-label=\"Show\">\n");
    let has = |kind| scene.solids.iter().any(|solid| solid.kind == kind);
    // The machine hides the part: it is there at first only if its bodies meet.
    let meets = scene
        .machine
        .as_ref()
        .is_some_and(|machine| !machine.contacts.is_empty());
    let switches = [
        ("part", "Part", true, true),
        ("mesh", "Mesh", true, false),
        ("target", "Target", has(SolidKind::Target), false),
        ("fixture", "Fixtures", has(SolidKind::Fixture), true),
        ("stock", "Stock", has(SolidKind::Stock), false),
        ("tool", "Cutter", scene.track.is_some(), true),
        ("path", "Path", scene.track.is_some(), false),
        ("machine", "Machine", scene.machine.is_some(), meets),
        ("still", "Base still", scene.machine.is_some(), false),
    ];
    for (what, name, _, on) in switches.iter().filter(|(_, _, offered, _)| *offered) {
        let _ = writeln!(
            html,
            "<button type=\"button\" aria-pressed=\"{on}\" data-show=\"{what}\">{name}</button>"
        );
    }
    html.push_str(
        "</div>\n<div class=\"group\">\n\
         <label class=\"select\">Section <select id=\"section\"><option value=\"\">off</option><option value=\"0\">X</option><option value=\"1\">Y</option><option value=\"2\">Z</option><option value=\"free\">turned</option></select></label>\n\
         <input type=\"range\" id=\"section-at\" min=\"0\" max=\"1000\" value=\"500\" aria-label=\"Place of the section\" hidden>\n\
         <button type=\"button\" id=\"section-flip\" aria-pressed=\"false\" hidden>Flip</button>\n\
         <button type=\"button\" id=\"measure\" aria-pressed=\"false\">Measure</button>\n\
         <label class=\"select\"><select id=\"measure-kind\" aria-label=\"What is measured\" hidden><option value=\"distance\">distance</option><option value=\"diameter\">diameter</option><option value=\"thickness\">thickness</option></select></label>\n\
         </div>\n<div class=\"group\">\n\
         <label class=\"select\"><select id=\"view\" aria-label=\"Seen from\"><option value=\"\">View</option><option value=\"corner\">corner</option><option value=\"front\">front</option><option value=\"back\">back</option><option value=\"left\">left</option><option value=\"right\">right</option><option value=\"above\">above</option><option value=\"below\">below</option></select></label>\n\
         <button type=\"button\" id=\"home\">Reset</button>\n\
         <button type=\"button\" id=\"save\">Save picture</button>\n\
         <button type=\"button\" id=\"full\" aria-pressed=\"false\">Full screen</button>\n\
         </div>\n</div>\n\
         <div class=\"canvas\"><canvas id=\"canvas\" tabindex=\"0\" role=\"application\" aria-label=\"The part in three dimensions: arrow keys turn it, with Shift they move it, plus and minus zoom, Home resets\" aria-describedby=\"keys\"></canvas>\n\
         <svg class=\"overlay\" id=\"overlay\"><g class=\"marks\" aria-hidden=\"true\"></g><g class=\"handles\" style=\"display:none\"><line/>\
         <circle id=\"section-move\" r=\"9\" tabindex=\"0\" role=\"button\" aria-label=\"Move the section: drag, or arrow keys\"/>\
         <circle id=\"section-turn\" r=\"8\" tabindex=\"0\" role=\"button\" aria-label=\"Turn the section: drag, or arrow keys\"/></g></svg>\n\
         <div class=\"legend\" id=\"legend\"></div>\n\
         <output class=\"probe\" id=\"probe\" hidden></output>\n\
         <p class=\"hover\" id=\"hover\" hidden></p>\n\
         <p class=\"loading\" id=\"loading\">Loading …</p></div>\n\
         <p class=\"keys\" id=\"keys\"><kbd>drag</kbd> turn <kbd>right drag</kbd> move <kbd>wheel</kbd> zoom <kbd>arrows</kbd> <kbd>+ −</kbd> <kbd>Home</kbd> <kbd>N P</kbd> findings <kbd>C</kbd> colours <kbd>S</kbd> section <kbd>M</kbd> measure <kbd>F</kbd> full screen</p>\n\
         </div>\n<p class=\"without\" id=\"without\" hidden>This browser offers no WebGL, so the part is shown as a picture.</p>\n",
    );
}

/// How fast the program is played: in parts of the usual speed, or as a machine runs if its times are known.
fn speeds(unit: &str) -> String {
    let real = if unit == "s" {
        "<option value=\"real\">real time</option>"
    } else {
        ""
    };
    format!(
        "<label class=\"select\"><select id=\"speed\" aria-label=\"Speed\"><option value=\"0.25\">¼ ×</option>\
         <option value=\"1\" selected>1 ×</option><option value=\"4\">4 ×</option>{real}\
         <option value=\"-1\">backwards</option></select></label>\n"
    )
}

/// The slider along the program.
pub(crate) fn timeline(html: &mut String, scene: Option<&Scene>) {
    let unit = scene
        .and_then(|scene| scene.track.as_ref())
        .map_or("", |track| track.unit.as_str());
    let _ = write!(
        html,
        "<div class=\"course\" id=\"course\" data-unit=\"{}\" hidden>\n\
         <button type=\"button\" id=\"play\" aria-label=\"Play the program\">▶</button>\n\
         <input type=\"range\" id=\"moment\" min=\"0\" max=\"10000\" value=\"10000\" step=\"1\" aria-label=\"Time in the program\">\n\
         <output id=\"clock\"></output>\n{}<code id=\"now\"></code></div>\n",
        escape(unit),
        speeds(unit)
    );
}
