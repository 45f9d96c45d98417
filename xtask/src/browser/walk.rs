//! What is tried on the page.

use super::devtools::Browser;
use super::{controls, walls};
use base64::Engine as _;
use serde_json::{Value, json};
use std::path::Path;

/// Tries something on a page, and says in a few words what it saw. With a folder, it leaves screenshots there.
pub type Walk = fn(&mut Browser, &Path, Option<&Path>) -> Result<String, String>;

const DESKTOP: [u32; 2] = [1280, 800];
const PHONE: [u32; 2] = [390, 844];

/// Name, size of the page, flags of the browser, and what to do.
pub fn all() -> [(&'static str, [u32; 2], &'static [&'static str], Walk); 9] {
    [
        ("mouse", DESKTOP, &[], mouse),
        ("controls", DESKTOP, &[], controls::controls),
        ("keyboard", DESKTOP, &[], keyboard),
        ("phone", PHONE, &[], phone),
        ("walls", DESKTOP, &[], walls::walls),
        ("course", DESKTOP, &[], walls::course),
        ("large", DESKTOP, &[], walls::large),
        ("paper", DESKTOP, &[], paper),
        (
            "no WebGL",
            DESKTOP,
            &["--disable-gpu", "--disable-3d-apis"],
            without_webgl,
        ),
    ]
}

/// The share of the canvas that is drawn on, a number that changes with any pixel, and the number of colours.
const PIXELS: &str = "(async () => {
    const frame = () => new Promise((next) => requestAnimationFrame(next));
    await frame(); await frame();
    const canvas = document.getElementById('canvas');
    const copy = Object.assign(document.createElement('canvas'), { width: canvas.width, height: canvas.height });
    const context = copy.getContext('2d');
    context.drawImage(canvas, 0, 0);
    const { data } = context.getImageData(0, 0, copy.width, copy.height);
    let [drawn, hash] = [0, 7];
    const colours = new Set();
    for (let k = 0; k < data.length; k += 4) {
        if (data[k + 3]) drawn++;
        hash = (Math.imul(hash, 31) + data[k] + 257 * data[k + 1] + 65537 * data[k + 2]) | 0;
        if (k % 32 === 0) colours.add((data[k] << 16) | (data[k + 1] << 8) | data[k + 2]);
    }
    return [drawn / (data.length / 4), hash, colours.size];
})()";

pub(super) fn pixels(browser: &mut Browser) -> Result<Value, String> {
    browser.value(PIXELS)
}

pub(super) fn camera(browser: &mut Browser) -> Result<Value, String> {
    browser.wait("!document.getElementById('canvas').dataset.flying")?;
    pixels(browser)?;
    browser.value("document.getElementById('canvas').dataset.camera")
}

/// The middle of an element, in the window.
pub(super) fn middle(browser: &mut Browser, selector: &str) -> Result<[f64; 2], String> {
    let quoted = json!(selector);
    let place = browser.value(&format!(
        "(() => {{ const e = document.querySelector({quoted}); e.scrollIntoView({{ block: 'nearest' }});
           const box = e.getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; }})()"
    ))?;
    match (place[0].as_f64(), place[1].as_f64()) {
        (Some(x), Some(y)) => Ok([x, y]),
        _ => Err(format!("{selector} has no place")),
    }
}

pub(super) fn click(browser: &mut Browser, selector: &str) -> Result<(), String> {
    let place = middle(browser, selector)?;
    browser.drag(&[place])
}

/// Sets a slider or a list as a person would.
pub(super) fn choose(browser: &mut Browser, selector: &str, value: &str) -> Result<(), String> {
    let (selector, value) = (json!(selector), json!(value));
    browser
        .value(&format!(
            "(() => {{ const e = document.querySelector({selector}); e.value = {value}; e.dispatchEvent(new Event('input', {{ bubbles: true }})); }})()"
        ))
        .map(drop)
}

pub(super) fn expect(good: bool, what: &str) -> Result<(), String> {
    if good { Ok(()) } else { Err(what.to_owned()) }
}

/// No errors, and no requests but for the page and what it holds itself.
pub(super) fn quiet(browser: &mut Browser) -> Result<(), String> {
    expect(
        browser.said.is_empty(),
        &format!("the page complains: {}", browser.said.join("; ")),
    )?;
    let outside = |url: &&String| !url.starts_with("file://") && !url.starts_with("data:");
    let asked: Vec<&String> = browser.asked.iter().filter(outside).collect();
    expect(asked.is_empty(), &format!("the page asks for {asked:?}"))?;
    let files = browser.asked.iter().filter(|url| url.starts_with("file://")).count();
    expect(files == 1, "the page asks for other files")
}

pub(super) fn save(browser: &mut Browser, docs: Option<&Path>, name: &str) -> Result<(), String> {
    let Some(docs) = docs else { return Ok(()) };
    let picture = browser.screenshot()?;
    let bytes = base64::engine::general_purpose::STANDARD
        .decode(picture.as_str().unwrap_or_default())
        .map_err(|error| error.to_string())?;
    let file = docs.join(name);
    std::fs::write(&file, bytes).map_err(|error| format!("{}: {error}", file.display()))
}

fn mouse(browser: &mut Browser, report: &Path, docs: Option<&Path>) -> Result<String, String> {
    let begin = std::time::Instant::now();
    browser.open(report)?;
    let first = pixels(browser)?;
    let loaded = begin.elapsed().as_secs_f64();
    expect(
        browser.value("document.documentElement.dataset.viewer")? == "ready",
        "there is no viewer",
    )?;
    expect(
        first[0].as_f64() > Some(0.1) && first[2].as_f64() > Some(50.0),
        &format!("the picture is empty: {first}"),
    )?;
    expect(
        browser.value("document.getElementById('verdict').innerText.includes('May not be run: 7 moves do harm')")?
            == true,
        "the verdict is missing",
    )?;
    // A finding turns the view, and shows its line.
    let before = camera(browser)?;
    let at_end = browser.value("document.getElementById('canvas').dataset.moment")?;
    click(browser, "[data-finding='6']")?;
    let after = camera(browser)?;
    expect(before != after, "a finding does not move the camera")?;
    expect(
        browser.value("document.querySelector('.finding.open mark').innerText.includes('Y-8')")? == true,
        "a finding does not show its line",
    )?;
    let moment = browser.value("document.getElementById('canvas').dataset.moment")?;
    expect(moment != at_end, "a finding does not go to its time")?;
    save(browser, docs, "report.png")?;
    // The slider changes the workpiece.
    let triangles = |browser: &mut Browser| browser.value("document.getElementById('canvas').dataset.triangles");
    let mut seen = Vec::new();
    for value in ["0", "3000", "5000", "10000"] {
        choose(browser, "#moment", value)?;
        let now = pixels(browser)?[1].clone();
        seen.push((triangles(browser)?, now));
    }
    let all_differ = |list: &[Value]| (1..list.len()).all(|n| !list[..n].contains(&list[n]));
    let (counts, hashes): (Vec<Value>, Vec<Value>) = seen.into_iter().unzip();
    expect(
        all_differ(&counts) && all_differ(&hashes),
        &format!("the slider does not change the workpiece: {counts:?}"),
    )?;
    // Colours, switches and sections each change the picture.
    click(browser, "#home")?;
    let mut looks = vec![pixels(browser)?[1].clone()];
    for mode in ["tool", "move", "plain"] {
        click(browser, &format!("[data-mode='{mode}']"))?;
        looks.push(pixels(browser)?[1].clone());
    }
    for what in ["target", "stock", "path", "fixture"] {
        click(browser, &format!("[data-show='{what}']"))?;
        looks.push(pixels(browser)?[1].clone());
    }
    for (axis, at) in [("0", "500"), ("1", "500"), ("2", "800"), ("2", "300")] {
        choose(browser, "#section", axis)?;
        choose(browser, "#section-at", at)?;
        looks.push(pixels(browser)?[1].clone());
    }
    click(browser, "#section-flip")?;
    looks.push(pixels(browser)?[1].clone());
    choose(browser, "#section", "")?;
    expect(all_differ(&looks), "a colour, a switch or a section does nothing")?;
    // Measuring between two points.
    click(browser, "#measure")?;
    let [x, y] = middle(browser, "#canvas")?;
    for place in [[x - 60.0, y + 20.0], [x + 40.0, y + 30.0]] {
        browser.drag(&[place])?;
        pixels(browser)?;
    }
    let measured = browser.value("document.getElementById('probe').innerText")?;
    expect(
        measured.as_str().is_some_and(|text| text.contains(" mm")),
        &format!("nothing is measured: {measured}"),
    )?;
    // Turning.
    let before = camera(browser)?;
    browser.drag(&[[x, y], [x + 40.0, y + 10.0], [x + 80.0, y + 25.0]])?;
    expect(camera(browser)? != before, "dragging does not turn the part")?;
    quiet(browser)?;
    Ok(format!(
        "loaded in {loaded:.1} s; measured {}",
        measured.as_str().unwrap_or_default()
    ))
}

fn keyboard(browser: &mut Browser, report: &Path, _: Option<&Path>) -> Result<String, String> {
    browser.open(report)?;
    // All controls can be reached, and it shows where one is.
    let mut reached = Vec::new();
    for _ in 0..60 {
        browser.key("Tab")?;
        let now = browser.value(
            "(() => { const e = document.activeElement; const s = getComputedStyle(e);
               return [e.id || e.dataset.mode || e.dataset.show || e.dataset.finding || e.className || e.tagName, s.outlineStyle !== 'none' && s.outlineWidth !== '0px']; })()",
        )?;
        if now[0] == "BODY" {
            break;
        }
        expect(now[1] == true, &format!("the focus on {} cannot be seen", now[0]))?;
        reached.extend(now[0].as_str().map(str::to_owned));
    }
    for name in [
        "0",
        "deviation",
        "target",
        "section",
        "measure",
        "canvas",
        "play",
        "moment",
    ] {
        expect(
            reached.iter().any(|own| own == name),
            &format!("Tab does not reach {name}: {reached:?}"),
        )?;
    }
    browser.value("document.getElementById('canvas').focus()")?;
    let mut seen = vec![camera(browser)?];
    for key in ["ArrowLeft", "ArrowUp", "+", "n", "n", "Home"] {
        browser.key(key)?;
        seen.push(camera(browser)?);
    }
    expect(seen[6] == seen[0], "Home does not come back")?;
    seen.pop();
    expect(
        (1..seen.len()).all(|n| !seen[..n].contains(&seen[n])),
        &format!("a key does nothing: {seen:?}"),
    )?;
    expect(
        browser.value("document.querySelectorAll('.finding')[1].classList.contains('open')")? == true,
        "N is not the next finding",
    )?;
    quiet(browser)?;
    Ok(format!("{} stops of Tab", reached.len()))
}

fn phone(browser: &mut Browser, report: &Path, docs: Option<&Path>) -> Result<String, String> {
    browser.open(report)?;
    pixels(browser)?;
    let wide = browser.value("[document.documentElement.scrollWidth, innerWidth]")?;
    expect(
        wide[0] == wide[1],
        &format!("the page is {} wide on {}", wide[0], wide[1]),
    )?;
    save(browser, docs, "report-phone.png")?;
    pinch(browser)?;
    browser.call(
        "Emulation.setEmulatedMedia",
        json!({"features": [{"name": "prefers-color-scheme", "value": "dark"}]}),
    )?;
    pixels(browser)?;
    save(browser, docs, "report-phone-dark.png")?;
    let ground = browser.value("getComputedStyle(document.body).backgroundColor")?;
    expect(ground == "rgb(17, 22, 28)", &format!("the page stays light: {ground}"))?;
    quiet(browser)?;
    Ok(format!("{} wide", wide[0]))
}

/// Two fingers that part come nearer without turning the part; one finger turns it.
fn pinch(browser: &mut Browser) -> Result<(), String> {
    browser.call(
        "Emulation.setTouchEmulationEnabled",
        json!({"enabled": true, "maxTouchPoints": 5}),
    )?;
    let [x, y] = middle(browser, "#canvas")?;
    let seen = |browser: &mut Browser| -> Result<Vec<f64>, String> {
        let words = camera(browser)?;
        let numbers = words.as_str().unwrap_or_default().split(' ').map(str::parse);
        numbers
            .collect::<Result<_, _>>()
            .map_err(|_| format!("the camera is {words}"))
    };
    let before = seen(browser)?;
    let steps: Vec<Vec<[f64; 2]>> = (0..=6)
        .map(|n| 40.0 + 10.0 * f64::from(n))
        .map(|far| vec![[x - far, y], [x + far, y]])
        .collect();
    browser.touch(&steps)?;
    let near = seen(browser)?;
    // 80 pixels become 200: two fifths of the distance.
    expect(
        (near[3] / before[3] - 0.4).abs() < 0.02 && near[4..] == before[4..],
        &format!("parting fingers take the camera from {before:?} to {near:?}"),
    )?;
    browser.touch(&[vec![[x, y]], vec![[x + 30.0, y]], vec![[x + 60.0, y]]])?;
    let turned = seen(browser)?;
    expect(
        turned[3] == near[3] && turned[4] != near[4],
        &format!("a finger takes the camera from {near:?} to {turned:?}"),
    )
}

/// What comes out of a printer: set-up before findings, the picture as on the screen, nothing beside the page.
fn paper(browser: &mut Browser, report: &Path, _: Option<&Path>) -> Result<String, String> {
    browser.open(report)?;
    pixels(browser)?;
    let pdf = browser.call(
        "Page.printToPDF",
        json!({"paperWidth": 8.27, "paperHeight": 11.69, "preferCSSPageSize": true}),
    )?;
    let size = pdf["data"].as_str().map_or(0, str::len);
    expect(size > 50_000, &format!("the printed pages have {size} bytes"))?;
    // The same by the rules for paper, in the width of its type area.
    browser.value("dispatchEvent(new Event('beforeprint'))")?;
    browser.call("Emulation.setEmulatedMedia", json!({"media": "print"}))?;
    browser.resize([688, 1000])?;
    let seen = browser.value(
        "(async () => {
            const picture = document.getElementById('print-picture');
            await picture.decode();
            const top = (e) => e.getBoundingClientRect().top;
            const setup = [...document.querySelectorAll('.card h2')].find((h) => h.innerText.startsWith('Set-up'));
            const shown = [...document.querySelectorAll('.finding-body')].filter((e) => e.getBoundingClientRect().height > 10);
            const lines = [...document.querySelectorAll('.finding .code .line')].filter((e) => e.getBoundingClientRect().height > 0);
            return [document.documentElement.scrollWidth <= innerWidth, picture.naturalWidth, picture.getBoundingClientRect().width,
                top(picture) < top(setup) && top(setup) < top(document.querySelector('.finding')),
                shown.length === document.querySelectorAll('.finding').length, lines.length / shown.length,
                document.getElementById('canvas').getBoundingClientRect().width];
        })()",
    )?;
    let good = seen[0] == true
        && seen[1].as_f64() > Some(300.0)
        && seen[2].as_f64() > Some(300.0)
        && seen[3] == true
        && seen[4] == true
        && seen[5].as_f64() <= Some(3.0)
        && seen[6] == 0;
    expect(good, &format!("the sheet is not as it should be: {seen}"))?;
    quiet(browser)?;
    Ok(format!("{size} bytes of PDF in base64"))
}

fn without_webgl(browser: &mut Browser, report: &Path, _: Option<&Path>) -> Result<String, String> {
    browser.open(report)?;
    expect(
        browser.value("document.documentElement.dataset.viewer")? == "none",
        "there is a viewer without WebGL",
    )?;
    let shown = browser.value(
        "(() => { const i = document.querySelector('#pictures img'); const box = i.getBoundingClientRect(); return [i.naturalWidth, box.width, box.height]; })()",
    )?;
    expect(
        (0..3).all(|k| shown[k].as_f64() > Some(100.0)),
        &format!("the picture does not show: {shown}"),
    )?;
    expect(
        browser.value("document.querySelectorAll('table').length >= 3")? == true,
        "tables are missing",
    )?;
    click(browser, "[data-finding='2']")?;
    expect(
        browser.value("document.querySelector('.finding.open mark').innerText.includes('X50 Y30')")? == true,
        "findings do not open",
    )?;
    quiet(browser)?;
    Ok(format!("a picture of {} pixels, and all tables", shown[0]))
}
