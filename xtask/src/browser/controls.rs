//! What the buttons around the picture do: sides, switches, speed, the picture as a file.

use super::devtools::Browser;
use super::walk::{camera, choose, click, expect, pixels, quiet};
use serde_json::Value;
use std::path::Path;

const VIEWS: [&str; 7] = ["corner", "front", "back", "left", "right", "above", "below"];

/// Saves the picture, but hands over what would be saved: its name, and the first letters of its address.
const SAVED: &str = "(() => {
    const click = HTMLAnchorElement.prototype.click;
    let saved = null;
    HTMLAnchorElement.prototype.click = function () { saved = [this.download, this.href.slice(0, 22), this.href.length]; };
    document.getElementById('save').click();
    HTMLAnchorElement.prototype.click = click;
    return saved;
})()";

/// How far the slider is, three times, a moment apart.
const PLAYED: &str = "(async () => {
    const [slider, play] = ['moment', 'play'].map((id) => document.getElementById(id));
    play.click();
    const at = [];
    for (let k = 0; k < 3; k++) {
        await new Promise((next) => setTimeout(next, 150));
        at.push(Number(slider.value));
    }
    play.click();
    return at;
})()";

pub fn controls(browser: &mut Browser, report: &Path, _: Option<&Path>) -> Result<String, String> {
    browser.open(report)?;
    let first = camera(browser)?;
    let mut seen: Vec<Value> = Vec::new();
    for view in VIEWS {
        choose(browser, "#view", view)?;
        let now = pixels(browser)?[1].clone();
        expect(!seen.contains(&now), &format!("seen from {view}, nothing changes"))?;
        seen.push(now);
    }
    click(browser, "#home")?;
    expect(camera(browser)? == first, "Reset does not lead back")?;
    // The sides of triangles are drawn over the part, and without the part there is little left.
    let whole = pixels(browser)?;
    click(browser, "[data-show='mesh']")?;
    let sides = pixels(browser)?;
    expect(
        sides[1] != whole[1] && sides[0].as_f64() >= whole[0].as_f64(),
        "no sides of triangles are drawn",
    )?;
    click(browser, "[data-show='part']")?;
    let less = pixels(browser)?;
    expect(
        less[0].as_f64() < whole[0].as_f64().map(|share| 0.5 * share),
        &format!(
            "without the part, {} of the picture is drawn, and {} with it",
            less[0], whole[0]
        ),
    )?;
    for what in ["part", "mesh"] {
        click(browser, &format!("[data-show='{what}']"))?;
    }
    expect(pixels(browser)?[1] == whole[1], "the part does not come back")?;
    let saved = browser.value(SAVED)?;
    expect(
        saved[0] == "part.png" && saved[1] == "data:image/png;base64," && saved[2].as_u64() > Some(10_000),
        &format!("the picture is not saved: {saved}"),
    )?;
    // Forwards, faster, and backwards.
    let mut spans = Vec::new();
    for (speed, begin) in [("1", "0"), ("4", "0"), ("-1", "5000")] {
        choose(browser, "#speed", speed)?;
        choose(browser, "#moment", begin)?;
        let at = browser.value(PLAYED)?;
        let [first, last] = [&at[0], &at[2]].map(|at| at.as_f64().unwrap_or(f64::NAN));
        spans.push(last - first);
    }
    expect(
        spans[0] > 0.0 && spans[1] > 2.0 * spans[0] && spans[2] < 0.0,
        &format!("the program is played by {spans:?} of the slider"),
    )?;
    quiet(browser)?;
    Ok(format!("{} sides; played {spans:.0?}", VIEWS.len()))
}
