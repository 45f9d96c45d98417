// The page: buttons, sliders, keys and the list of findings.

/** A time of the program in words. */
function clockWords(clock, unitName) {
  if (unitName !== "s") return `${Math.round(clock).toLocaleString("en")} ${unitName}`;
  const whole = Math.floor(clock);
  const [h, m, s] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60, whole % 60];
  const two = (n) => String(n).padStart(2, "0");
  return h ? `${h}:${two(m)}:${two(s)}` : `${m}:${two(s)}`;
}

/** The list without a viewer: one finding open at a time. */
function openFinding(number) {
  all(".finding").forEach((item, n) => {
    const isOpen = n === number;
    item.classList.toggle("open", isOpen);
    item.querySelector(".finding-body").hidden = !isOpen;
    item.querySelector("button").setAttribute("aria-expanded", String(isOpen));
  });
}

/** Without WebGL: pictures and tables. */
function withoutViewer(why) {
  document.documentElement.dataset.viewer = "none";
  if ($("viewer")) $("viewer").hidden = true;
  if ($("without")) $("without").hidden = false;
  if ($("pictures")) $("pictures").classList.add("instead");
  console.info(`No viewer: ${why}`);
}

function withViewer(viewer, markers) {
  const { canvas, head, track } = viewer;
  const programs = head.programs.length ? new TextDecoder().decode(head.data.programs).split("\0").map((text) => text.split(/\r?\n/)) : [];

  // Colours.
  const modes = all("[data-mode]").filter((button) => button.closest("#viewer"));
  const chooseMode = (mode) => {
    for (const button of modes) {
      button.setAttribute("aria-checked", String(button.dataset.mode === mode));
      button.tabIndex = button.dataset.mode === mode ? 0 : -1;
    }
    viewer.colour(mode);
    const { title, rows } = new Colours(head, mode).legend(viewer.meshes.tools);
    const legend = $("legend");
    legend.replaceChildren();
    legend.hidden = !rows.length;
    const element = (tag, text, more = {}) => Object.assign(document.createElement(tag), { textContent: text, ...more });
    legend.append(element("h3", title));
    for (const [colour, words] of rows) {
      const row = element("p", "", { className: colour ? "" : "head" });
      if (colour) {
        const patch = element("i", "");
        patch.style.background = `rgb(${colour.join()})`;
        row.append(patch);
      }
      row.append(element("span", words));
      legend.append(row);
    }
  };
  modes.forEach((button, n) => {
    button.addEventListener("click", () => chooseMode(button.dataset.mode));
    button.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
      if (!step) return;
      const next = modes[(n + step + modes.length) % modes.length];
      next.focus();
      chooseMode(next.dataset.mode);
      event.preventDefault();
    });
  });

  // Switches.
  for (const button of all("[data-show]")) {
    button.addEventListener("click", () => {
      const on = button.getAttribute("aria-pressed") !== "true";
      button.setAttribute("aria-pressed", String(on));
      viewer.shown[button.dataset.show] = on;
      viewer.ask();
    });
  }
  pictureControls(viewer);

  sectionControls(viewer);
  const lineOf = (move) => {
    const line = track?.lines[move];
    return line ? `${head.programs[track.files[move]] ?? "line"}:${line}` : "";
  };
  probeControls(viewer, lineOf);

  // The course of the program.
  const slider = $("moment");
  const setClock = (clock, fromSlider) => {
    if (!track) return;
    viewer.seek(clock);
    if (!fromSlider) slider.value = track.end > 0 ? (clock / track.end) * 10000 : 10000;
    const words = clockWords(clock, track.unit);
    $("clock").textContent = words;
    const { move } = track.at(clock);
    const text = programs[track.files[move]]?.[track.lines[move] - 1] ?? "";
    const setup = head.setups[viewer.setup];
    $("now").textContent = [setup && `set-up ${setup[1]}`, lineOf(move), text.trim()].filter(Boolean).join("  ");
    slider.setAttribute("aria-valuetext", `${words} ${$("now").textContent}`);
    for (const cursor of all(".cursor")) {
      const x = track.end > 0 ? (1000 * clock) / track.end : 1000;
      cursor.setAttribute("x1", x);
      cursor.setAttribute("x2", x);
    }
  };
  if (track) {
    $("course").hidden = false;
    slider.addEventListener("input", () => {
      stop();
      setClock((slider.value / 10000) * track.end, true);
    });
    for (const svg of all(".plot svg")) {
      const follow = (event) => {
        const box = svg.getBoundingClientRect();
        stop();
        setClock(Math.min(Math.max((event.clientX - box.left) / box.width, 0), 1) * track.end);
      };
      svg.addEventListener("pointerdown", follow);
      svg.addEventListener("pointermove", (event) => event.buttons && follow(event));
    }
    $("play").addEventListener("click", () => (playing ? stop() : play()));
  }
  let playing = 0;
  const stop = () => {
    if (playing) cancelAnimationFrame(playing);
    playing = 0;
    $("play").textContent = "▶";
    $("play").setAttribute("aria-label", "Play the program");
  };
  const play = () => {
    const speed = $("speed");
    const [first, last] = speed.value < 0 ? [track.end, 0] : [0, track.end];
    let clock = viewer.clock === last ? first : viewer.clock;
    let before = performance.now();
    $("play").textContent = "❚❚";
    $("play").setAttribute("aria-label", "Pause");
    const next = (now) => {
      // The whole program in twenty seconds, or a second of it in each.
      const share = speed.value === "real" ? 1e-3 : (speed.value * track.end) / 20000;
      clock = Math.min(Math.max(clock + (now - before) * share, 0), track.end);
      before = now;
      setClock(clock);
      playing = requestAnimationFrame(next);
      if (clock === (share < 0 ? 0 : track.end)) stop();
    };
    playing = requestAnimationFrame(next);
  };

  // Findings.
  let current = -1;
  const choose = (number, scroll) => {
    const same = number === current;
    current = same && !scroll ? -1 : number;
    openFinding(current);
    if (current < 0) return;
    const marker = markers[number];
    const { camera } = viewer;
    if (marker.clock != null) setClock(marker.clock);
    canvas.dataset.flying = "1";
    // Bodies of the machine are larger than the part.
    const far = marker.kind === "machine" ? 2.5 * camera.beyond : Math.min(camera.distance, 2.2 * camera.reach);
    camera.fly(viewer.held(marker.place), far, Math.max(camera.elevation, 0.45));
    viewer.ask();
    if (scroll) all(".finding")[number].scrollIntoView({ block: "nearest" });
  };
  all("[data-finding]").forEach((button, number) => button.addEventListener("click", () => choose(number)));
  viewer.ondraw = () => drawOverlay(viewer, markers, current, (number) => choose(number, true));

  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches("input[type=text], textarea, select")) return;
    const key = event.key.toLowerCase();
    if ((key === "n" || key === "p") && markers.length) {
      choose((current + (key === "n" ? 1 : markers.length - 1 + (current < 0))) % markers.length, true);
    } else if (key === "c") {
      const now = modes.findIndex((button) => button.getAttribute("aria-checked") === "true");
      chooseMode(modes[(now + 1) % modes.length].dataset.mode);
    } else if (key === "s") {
      const select = $("section");
      select.selectedIndex = (select.selectedIndex + 1) % select.options.length;
      select.dispatchEvent(new Event("input"));
    } else if (key === "m") $("measure").click();
    else if (key === "f") $("full").click();
  });

  // On paper: the picture as it is on the screen.
  addEventListener("beforeprint", () => {
    viewer.draw();
    const picture = $("print-picture") ?? Object.assign(new Image(), { id: "print-picture", alt: "The part" });
    picture.src = canvas.toDataURL();
    $("viewer").after(picture);
  });

  chooseMode(modes[0].dataset.mode);
  setClock(track?.end ?? 0);
}

async function begin() {
  if (all(".finding").length) {
    all("[data-finding]").forEach((button, n) => button.addEventListener("click", () => document.documentElement.dataset.viewer === "none" && openFinding(n)));
    openFinding(-1);
  }
  if (!$("head")) return;
  try {
    if (!document.createElement("canvas").getContext("webgl2")) throw new Error("no WebGL2");
    const head = await readEmbedded();
    $("viewer").hidden = false;
    const viewer = new Viewer(head, $("canvas"), $("overlay"));
    withViewer(viewer, JSON.parse($("markers").textContent));
    // For tests: how long it took.
    document.documentElement.dataset.opened = Math.round(performance.now());
    document.documentElement.dataset.viewer = "ready";
    $("loading").remove();
  } catch (error) {
    withoutViewer(error.message);
  }
}

begin();
