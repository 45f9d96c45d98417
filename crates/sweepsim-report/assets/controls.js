// The controls of the section, of measuring, and of what is under the pointer.

const $ = (id) => document.getElementById(id);
const all = (selector) => [...document.querySelectorAll(selector)];
const short = (x) => (Math.abs(x) < 5e-4 ? 0 : x).toFixed(3).replace("-", "−");

/** Where it is seen from, the picture as a file, and the whole screen. */
function pictureControls(viewer) {
  const { camera, canvas } = viewer;
  const seen = (view) => {
    camera.home(view);
    viewer.ask();
  };
  $("home").addEventListener("click", () => seen());
  const view = $("view");
  view.addEventListener("input", () => {
    if (view.value) seen(view.value);
    // It says what can be chosen, not where the viewer stands after turning.
    view.value = "";
  });
  $("save").addEventListener("click", () => {
    viewer.draw();
    Object.assign(document.createElement("a"), { href: canvas.toDataURL(), download: "part.png" }).click();
  });
  const full = $("full");
  full.hidden = !document.fullscreenEnabled;
  full.addEventListener("click", () => (document.fullscreenElement ? document.exitFullscreen() : $("viewer").requestFullscreen()));
  document.addEventListener("fullscreenchange", () => full.setAttribute("aria-pressed", String(document.fullscreenElement !== null)));
}

function sectionControls(viewer) {
  const { section } = viewer;
  const [select, slider, flip] = [$("section"), $("section-at"), $("section-flip")];
  const show = () => {
    slider.hidden = flip.hidden = !section.isOn;
    if (section.isOn) {
      slider.value = 1000 * section.share;
      slider.setAttribute("aria-valuetext", `${short(section.at)} mm along ${section.normal.map(short).join(", ")}`);
      const axis = section.normal.findIndex((c) => Math.abs(c) === 1);
      select.value = axis < 0 ? "free" : axis;
    }
    viewer.ask();
  };
  select.addEventListener("input", () => {
    const { towards } = viewer.camera;
    // What is nearer to the viewer goes away.
    if (select.value === "") section.off();
    else if (select.value === "free") section.across(add(towards, scaled(unit(cross([0, 0, 1], towards)), 0.8)));
    else section.across([0, 1, 2].map((k) => (k === Number(select.value) ? (towards[k] < 0 ? -1 : 1) : 0)));
    show();
  });
  slider.addEventListener("input", () => {
    section.share = slider.value / 1000;
    show();
  });
  flip.addEventListener("click", () => {
    section.flip();
    show();
  });
  holdHandle(viewer, show);
}

/** Measuring, clicks and hovering. */
function probeControls(viewer, lineOf) {
  const measuring = new Measuring(viewer);
  const [button, kinds, probe, hover] = [$("measure"), $("measure-kind"), $("probe"), $("hover")];
  const say = (text) => {
    probe.hidden = !text;
    probe.textContent = text;
  };
  /** What is known of a picked place, in words. */
  const words = (hit) => {
    const about = viewer.about(hit);
    if (!about) return [];
    const { maker, deviation } = about;
    const found = deviation == null ? [] : [`deviation ${deviation > 0 ? "+" : ""}${short(deviation)} mm`];
    if (maker === 0) found.push("stock");
    else if (maker) {
      const tool = viewer.meshes.tools[new Colours(viewer.head, "tool").toolOf(maker - 1)];
      found.push([lineOf(maker - 1), `move ${maker}`, tool?.name].filter(Boolean).join(" "));
    }
    return found;
  };
  const start = (on) => {
    button.setAttribute("aria-pressed", String(on));
    kinds.hidden = !on;
    say(measuring.start(on ? kinds.value : null));
    viewer.ask();
  };
  button.addEventListener("click", () => start(!measuring.kind));
  kinds.addEventListener("input", () => start(true));
  viewer.onclick = (x, y) => {
    const hit = viewer.pick(x, y);
    if (!hit) return measuring.kind || say("");
    if (measuring.kind) say(measuring.take(hit));
    else {
      viewer.measured = { points: [hit.place], lines: [], circle: null };
      say([hit.place.map(short).join(", "), ...words(hit)].join(" · "));
    }
    viewer.ask();
  };
  // At most one pick a picture.
  let waiting = null;
  viewer.onhover = (x, y) => {
    if (x === undefined) {
      waiting = null;
      hover.hidden = true;
      return;
    }
    if (!waiting)
      requestAnimationFrame(() => {
        if (!waiting) return;
        const [px, py] = waiting;
        waiting = null;
        const hit = viewer.pick(px, py);
        const found = hit ? words(hit) : [];
        hover.hidden = !found.length;
        hover.textContent = found.join(" · ");
        const room = viewer.canvas.clientWidth - hover.offsetWidth - 4;
        Object.assign(hover.style, { left: `${Math.max(Math.min(px + 14, room), 4)}px`, top: `${Math.max(py - 34, 4)}px` });
      });
    waiting = [x, y];
  };
}
