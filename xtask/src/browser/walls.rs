//! What the page tells of a part whose faults are known: a slot whose walls are 0.2 mm off on a stretch, and a hole.

use super::devtools::Browser;
use super::walk::{camera, choose, click, expect, middle, pixels, quiet, save};
use serde_json::json;
use std::path::Path;

/// The slot is 6 mm wide and 5 mm deep; line 7 moves it by 0.2 mm. The hole is 8 mm wide and as deep.
pub const PROGRAM: &str = "G21 G90 G17\nT1 M6\nS8000 M3\nG0 X-30 Y0 Z5\nG0 Z-5\nG1 X-6 F400\nG1 Y0.2\nG1 X6\nG1 Y0\nG1 X30\nG0 Z5\n\
                           T2 M6\nG0 X0 Y9\nG1 Z-5 F200\nG1 X2\nG3 I-2\nG1 X0\nG0 Z5\nM30\n";

pub const JOB: &str = "Job(
    name: \"walls\",
    grid: Grid(min: (-20, -15), max: (20, 15), cells: (80, 60)),
    stock: Block(min: (-20, -15, -10), max: (20, 15, 0)),
    tools: { 1: Flat(radius: 3, length: 20), 2: Flat(radius: 2, length: 20) },
    paths: [Path(file: \"walls.nc\")],
    target: Mesh(\"walls.stl\"),
    limits: Limits(gouge: 0.05, excess: 0.05),
)
";

/// The target: a block with a straight slot, without the hole; as STL.
pub fn target() -> String {
    const PROFILE: [[f64; 2]; 8] = [
        [-15.0, -10.0],
        [15.0, -10.0],
        [15.0, 0.0],
        [3.0, 0.0],
        [3.0, -5.0],
        [-3.0, -5.0],
        [-3.0, 0.0],
        [-15.0, 0.0],
    ];
    const ENDS: [[usize; 3]; 6] = [[0, 6, 7], [0, 5, 6], [0, 4, 5], [0, 1, 4], [1, 2, 4], [2, 3, 4]];
    let at = |x: f64, k: usize| [x, PROFILE[k % 8][0], PROFILE[k % 8][1]];
    let mut text = String::from("solid walls\n");
    let mut facet = |corners: [[f64; 3]; 3]| {
        text.push_str("facet normal 0 0 0\nouter loop\n");
        for [x, y, z] in corners {
            text.push_str(&format!("vertex {x} {y} {z}\n"));
        }
        text.push_str("endloop\nendfacet\n");
    };
    for [a, b, c] in ENDS {
        facet([at(20.0, a), at(20.0, b), at(20.0, c)]);
        facet([at(-20.0, a), at(-20.0, c), at(-20.0, b)]);
    }
    for k in 0..8 {
        let [a, b, c, d] = [at(-20.0, k), at(20.0, k), at(20.0, k + 1), at(-20.0, k + 1)];
        facet([a, d, c]);
        facet([a, c, b]);
    }
    text + "endsolid walls\n"
}

/// Where a point of the world is in the window, as the camera's own numbers say.
fn in_window(browser: &mut Browser, p: [f64; 3]) -> Result<[f64; 2], String> {
    let seen = browser.value(
        "(() => { const c = document.getElementById('canvas'); c.scrollIntoView({ block: 'nearest' }); const b = c.getBoundingClientRect();
           return [b.x, b.y, b.width, b.height, ...c.dataset.camera.split(' ').map(Number)]; })()",
    )?;
    let n = |k: usize| seen[k].as_f64().unwrap_or(f64::NAN);
    let (width, height, distance) = (n(2), n(3), n(7));
    let ([sa, ca], [se, ce]) = ([n(8).sin(), n(8).cos()], [n(9).sin(), n(9).cos()]);
    // The camera looks at its centre from this direction; z is upwards.
    let (back, right, up) = ([ce * ca, ce * sa, se], [-sa, ca, 0.0], [-se * ca, -se * sa, ce]);
    let off = [0, 1, 2].map(|k| p[k] - n(4 + k));
    let dot = |a: [f64; 3]| (0..3).map(|k| a[k] * off[k]).sum::<f64>();
    let aspect = width / height;
    let half = 14.0_f64.to_radians().tan();
    let [wide, tall] = if aspect < 1.0 {
        [half, half / aspect]
    } else {
        [half * aspect, half]
    };
    let far = distance - dot(back);
    let [u, v] = [dot(right) / (far * wide), dot(up) / (far * tall)];
    Ok([n(0) + 0.5 * width * (1.0 + u), n(1) + 0.5 * height * (1.0 - v)])
}

/// What hovering over a point of the world says.
fn hovered(browser: &mut Browser, p: [f64; 3]) -> Result<String, String> {
    let place = in_window(browser, p)?;
    browser.hover(place)?;
    pixels(browser)?;
    let text = browser
        .value("(() => { const h = document.getElementById('hover'); return h.hidden ? '' : h.innerText; })()")?;
    Ok(text.as_str().unwrap_or_default().to_owned())
}

/// What is said after points of the world were picked.
fn picked(browser: &mut Browser, points: &[[f64; 3]]) -> Result<String, String> {
    for p in points {
        let place = in_window(browser, *p)?;
        browser.drag(&[place])?;
        pixels(browser)?;
    }
    let text = browser.value("document.getElementById('probe').innerText")?;
    Ok(text.as_str().unwrap_or_default().to_owned())
}

/// The first number of a text.
fn number(text: &str) -> f64 {
    let rest = text.trim_start_matches(|c: char| !c.is_ascii_digit() && c != '−' && c != '+');
    let rest = rest.replace('−', "-");
    let end = rest
        .find(|c: char| !c.is_ascii_digit() && !".-+".contains(c))
        .unwrap_or(rest.len());
    rest[..end].parse().unwrap_or(f64::NAN)
}

fn is_near(text: &str, value: f64, most: f64) -> bool {
    (number(text) - value).abs() <= most
}

/// Hovering tells deviation, line and tool on both walls; diameters, thicknesses and a section are right.
pub fn walls(browser: &mut Browser, report: &Path, docs: Option<&Path>) -> Result<String, String> {
    let report = &report.with_file_name("walls").join("report.html");
    browser.open(report)?;
    pixels(browser)?;
    let triangles = browser.value("Number(document.getElementById('canvas').dataset.triangles)")?;
    expect(
        triangles.as_f64() > Some(1000.0),
        &format!("the surface has {triangles} triangles"),
    )?;
    expect(
        browser.value("document.getElementById('canvas').dataset.quads")? == "0",
        "lines are drawn beside the surface",
    )?;
    // The far wall: too much is removed there by line 8, and nothing beside it.
    let gouge = hovered(browser, [4.5, 3.2, -1.0])?;
    let told = |text: &str, value: f64, words: &[&str]| {
        let all =
            text.starts_with("deviation") && is_near(text, value, 0.002) && words.iter().all(|own| text.contains(own));
        expect(all, &format!("hovering says {text:?}, not {value} by {words:?}"))
    };
    told(&gouge, -0.2, &["walls.nc:8", "T1"])?;
    let good = hovered(browser, [14.0, 3.0, -1.0])?;
    told(&good, 0.0, &["walls.nc:10", "T1"])?;
    // From the other side: the near wall, where material is left. A turn by half a circle is a drag of 393 pixels.
    let [x, y] = middle(browser, "#canvas")?;
    let steps: Vec<[f64; 2]> = (0..=10).map(|n| [x - 190.0 + 39.3 * f64::from(n), y]).collect();
    browser.drag(&steps)?;
    pixels(browser)?;
    // Between the marks of what is wrong there, which are in front.
    let excess = hovered(browser, [0.0, -2.8, -1.0])?;
    told(&excess, 0.2, &["walls.nc", "T1"])?;
    click(browser, "#home")?;
    pixels(browser)?;
    // The hole by three points of its wall at different heights; the floor of the slot to the bottom.
    click(browser, "#measure")?;
    choose(browser, "#measure-kind", "diameter")?;
    let at = |degrees: f64, z: f64| {
        [
            4.0 * degrees.to_radians().cos(),
            9.0 + 4.0 * degrees.to_radians().sin(),
            z,
        ]
    };
    let diameter = picked(browser, &[at(80.0, -0.7), at(120.0, -1.3), at(160.0, -0.9)])?;
    expect(
        diameter.starts_with('⌀') && is_near(&diameter, 8.0, 0.06),
        &format!("the hole measures {diameter}"),
    )?;
    choose(browser, "#measure-kind", "thickness")?;
    let thickness = picked(browser, &[[18.5, 1.5, -5.0]])?;
    expect(
        is_near(&thickness, 5.0, 0.001) && thickness.contains("thick"),
        &format!("the floor measures {thickness}"),
    )?;
    choose(browser, "#measure-kind", "distance")?;
    let distance = picked(browser, &[[-19.0, -14.0, 0.0], [19.0, -14.0, 0.0]])?;
    expect(is_near(&distance, 38.0, 0.2), &format!("the block measures {distance}"))?;
    click(browser, "#measure")?;
    section(browser, docs)?;
    quiet(browser)?;
    Ok(format!(
        "{triangles} triangles; {gouge}; {excess}; {diameter}; {thickness}"
    ))
}

/// A section is moved and turned by its handles, and its face can be picked.
fn section(browser: &mut Browser, docs: Option<&Path>) -> Result<(), String> {
    choose(browser, "#section", "0")?;
    choose(browser, "#section-at", "500")?;
    pixels(browser)?;
    // The face of the section at x = 0 is at 0 all over.
    let text = picked(browser, &[[0.0, -9.0, -5.0]])?;
    let [x, y] = [number(&text), number(text.split_once(',').map_or("", |(_, rest)| rest))];
    expect(
        x.abs() < 2e-3 && (y + 9.0).abs() < 0.3,
        &format!("the face of the section is at {text}"),
    )?;
    let handle = |browser: &mut Browser, id: &str| middle(browser, id);
    let state = |browser: &mut Browser| {
        browser.value("[document.getElementById('section').value, document.getElementById('section-at').getAttribute('aria-valuetext'), document.getElementById('section-at').value]")
    };
    let before = state(browser)?;
    let [a, b] = [handle(browser, "#section-move")?, handle(browser, "#section-turn")?];
    let along = [b[0] - a[0], b[1] - a[1]];
    let moved = |share: f64| [a[0] + share * along[0], a[1] + share * along[1]];
    browser.drag(&[a, moved(0.2), moved(0.4)])?;
    pixels(browser)?;
    let after = state(browser)?;
    expect(
        after[0] == before[0] && after[1] != before[1] && after[2] != before[2],
        &format!("the handle takes the section from {before} to {after}"),
    )?;
    let b = handle(browser, "#section-turn")?;
    browser.drag(&[b, [b[0] + 20.0, b[1] - 25.0], [b[0] + 40.0, b[1] - 50.0]])?;
    pixels(browser)?;
    let turned = state(browser)?;
    expect(
        turned[0] == "free" && turned[1] != after[1],
        &format!("the arrow turns the section to {turned}"),
    )?;
    save(browser, docs, "report-section.png")?;
    // By keys.
    browser.value("document.getElementById('section-turn').focus()")?;
    browser.key("ArrowLeft")?;
    pixels(browser)?;
    expect(state(browser)? != turned, "arrow keys do not turn the section")?;
    // A finger moves it.
    browser.call(
        "Emulation.setTouchEmulationEnabled",
        json!({"enabled": true, "maxTouchPoints": 5}),
    )?;
    let before = state(browser)?;
    let [a, b] = [handle(browser, "#section-move")?, handle(browser, "#section-turn")?];
    browser.touch(&[vec![a], vec![[a[0] + 0.2 * (b[0] - a[0]), a[1] + 0.2 * (b[1] - a[1])]]])?;
    pixels(browser)?;
    expect(state(browser)? != before, "a finger does not move the section")?;
    browser.call("Emulation.setTouchEmulationEnabled", json!({"enabled": false}))?;
    choose(browser, "#section", "")
}

/// During the program: walls are where they belong, also those that the next moment takes away, and deviations are
/// known.
pub fn course(browser: &mut Browser, report: &Path, _: Option<&Path>) -> Result<String, String> {
    let report = &report.with_file_name("walls").join("report.html");
    browser.open(report)?;
    pixels(browser)?;
    choose(browser, "#moment", "3500")?;
    pixels(browser)?;
    let drawn = browser.value(
        "[document.getElementById('canvas').dataset.triangles, document.getElementById('canvas').dataset.quads]",
    )?;
    let triangles = drawn[0].as_str().and_then(|n| n.parse::<u32>().ok());
    expect(
        triangles > Some(1000) && drawn[1] == "0",
        &format!("triangles and quads of the workpiece: {drawn}"),
    )?;
    // Without the tool, from the slot's open side: the wall at its end is as round as the tool of 6 mm.
    click(browser, "[data-show='tool']")?;
    choose(browser, "#view", "left")?;
    camera(browser)?;
    click(browser, "#measure")?;
    choose(browser, "#measure-kind", "diameter")?;
    let end = picked(browser, &[[12.0, -2.1, -1.2], [12.0, 0.4, -2.9], [12.0, 2.3, -2.2]])?;
    expect(
        end.starts_with('⌀') && is_near(&end, 6.0, 0.02),
        &format!("the end of the slot measures {end}"),
    )?;
    click(browser, "#measure")?;
    click(browser, "#home")?;
    camera(browser)?;
    // Between two lines.
    let wall = picked(browser, &[[4.5, 3.2, -1.0]])?;
    let y = wall.split_once(',').map_or("", |(_, rest)| rest);
    expect(is_near(y, 3.2, 0.005), &format!("the wall at y = 3.2 is at {wall}"))?;
    // From above.
    let [x, y] = middle(browser, "#canvas")?;
    browser.drag(&[[x, y], [x, y + 45.0], [x, y + 90.0]])?;
    pixels(browser)?;
    // The slot has come in from x = −20; at its end the stock is 5 mm higher than the target's floor.
    let done = hovered(browser, [-16.0, 1.0, -5.0])?;
    expect(
        done.starts_with("deviation") && is_near(&done, 0.0, 0.002),
        &format!("the floor that is done says {done:?}"),
    )?;
    let left = hovered(browser, [17.0, 0.0, 0.0])?;
    // The nearest surface of the target is one of the walls beside it.
    expect(
        left.starts_with("deviation") && is_near(&left, 3.0, 0.3),
        &format!("the stock above the slot says {left:?}"),
    )?;
    quiet(browser)?;
    // Without dexels along three axes, by lines.
    browser.open(&report.with_file_name("lines").join("report.html"))?;
    pixels(browser)?;
    choose(browser, "#moment", "3500")?;
    pixels(browser)?;
    let quads = browser.value("Number(document.getElementById('canvas').dataset.quads)")?;
    expect(
        quads.as_f64() > Some(100.0),
        &format!("the stock is drawn by {quads} quads of lines"),
    )?;
    let stock = hovered(browser, [17.0, -10.0, 0.0])?;
    expect(
        stock.starts_with("deviation") && is_near(&stock, 0.0, 0.002),
        &format!("the stock that stays says {stock:?}"),
    )?;
    quiet_twice(browser)?;
    Ok(format!("{end}; {done}; {left}; {quads} quads of lines"))
}

/// 300,000 triangles, and three million made into as many: how long each takes to open, and to turn.
pub fn large(browser: &mut Browser, report: &Path, _: Option<&Path>) -> Result<String, String> {
    let mut words = Vec::new();
    for (name, whole) in [("300k.html", None), ("3M.html", Some(3_001_250))] {
        browser.open(&report.with_file_name(name))?;
        pixels(browser)?;
        let opened = browser.value("Number(document.documentElement.dataset.opened)")?;
        let triangles = browser.value("Number(document.getElementById('canvas').dataset.triangles)")?;
        let count = triangles.as_f64().unwrap_or_default();
        expect(
            (50_000.0..=300_000.0).contains(&count),
            &format!("{name} has {triangles} triangles"),
        )?;
        let said = browser.value("document.querySelector('footer').innerText")?;
        let said = said.as_str().unwrap_or_default();
        if let Some(whole) = whole {
            expect(
                said.contains(&format!(" of {whole}, from which the farthest corner is 0.")),
                &format!("{name} says {said:?}"),
            )?;
        }
        let hover = hovered(browser, [100.0, 100.0, 35.0])?;
        expect(
            hover.starts_with("deviation"),
            &format!("hovering over {name} says {hover:?}"),
        )?;
        // Turning draws fewer triangles if pictures take long; at rest all of them.
        let [x, y] = middle(browser, "#canvas")?;
        let begin = std::time::Instant::now();
        for n in 0..6_u32 {
            let x = x + 5.0 * f64::from(n);
            browser.drag(&[[x, y], [x + 5.0, y]])?;
            pixels(browser)?;
        }
        let each = begin.elapsed().as_secs_f64() / 6.0;
        browser.wait(&format!(
            "document.getElementById('canvas').dataset.drawn === '{count}'"
        ))?;
        words.push(format!(
            "{count} triangles open in {opened} ms, turn in {each:.2} s a picture without a GPU"
        ));
    }
    quiet_twice(browser)?;
    Ok(words.join("; "))
}

/// Two pages were opened.
fn quiet_twice(browser: &mut Browser) -> Result<(), String> {
    expect(
        browser.said.is_empty(),
        &format!("the page complains: {}", browser.said.join("; ")),
    )
}
