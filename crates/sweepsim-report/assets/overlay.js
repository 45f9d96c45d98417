// Marks over the picture: findings, measured points, and the directions of the axes.

function drawOverlay(viewer, markers, current, choose) {
  const { overlay, canvas, camera } = viewer;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  overlay.setAttribute("viewBox", `0 0 ${width} ${height}`);
  const marks = [];
  const mark = (name, attributes, text) => {
    const node = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
    if (text) node.textContent = text;
    marks.push(node);
    return node;
  };
  // Farther ones first, the chosen one last.
  const pins = markers.slice(0, 200).map((marker, n) => ({ marker, n, at: viewer.onCanvas(marker.place) }));
  const order = (pin) => (pin.n === current ? -Infinity : pin.at[2]);
  for (const { marker, n, at } of pins.filter((pin) => pin.at).sort((a, b) => order(b) - order(a))) {
    const colour = KINDS[marker.kind] ?? OTHER_KIND;
    const pin = mark("g", { class: n === current ? "pin current" : "pin", transform: `translate(${at[0].toFixed(1)} ${at[1].toFixed(1)})` });
    const inner = [
      ["circle", { r: 2.5, fill: colour }],
      ["path", { d: "M0 0L-4 -10A10 10 0 1 1 4 -10Z", fill: colour }],
      ["text", { y: -15.5 }, String(n + 1)],
    ];
    for (const [name, attributes, text] of inner) {
      mark(name, attributes, text);
      pin.append(marks.pop());
    }
    pin.addEventListener("click", () => choose(n));
  }
  drawMeasured(viewer, mark);
  // Axes in the corner.
  const [ox, oy] = [44, height - 44];
  const towards = camera.towards;
  const right = unit(cross([0, 0, 1], towards));
  const up = cross(towards, right);
  const axes = [["x", [1, 0, 0]], ["y", [0, 1, 0]], ["z", [0, 0, 1]]];
  axes.sort((a, b) => dot(a[1], towards) - dot(b[1], towards));
  for (const [name, axis] of axes) {
    const [x, y] = [ox + 28 * dot(axis, right), oy - 28 * dot(axis, up)];
    mark("line", { class: `axis ${name}`, x1: ox, y1: oy, x2: x, y2: y });
    mark("text", { class: `axis ${name}`, x: ox + 38 * dot(axis, right), y: oy - 38 * dot(axis, up) + 4 }, name.toUpperCase());
  }
  overlay.querySelector(".marks").replaceChildren(...marks);
  placeHandle(viewer);
}

/** The points, lines and the circle that were measured. */
function drawMeasured(viewer, mark) {
  const { points, lines, circle } = viewer.measured;
  const path = (places, attributes) => {
    const seen = places.map((p) => viewer.onCanvas(p));
    if (seen.every(Boolean)) mark("path", { ...attributes, d: `M${seen.map(([x, y]) => `${x.toFixed(1)} ${y.toFixed(1)}`).join("L")}` });
  };
  for (const line of lines) path(line, { class: "span" });
  if (circle) {
    const { centre, diameter, axis } = circle;
    const x = unit(cross(Math.abs(axis[2]) > 0.9 ? [1, 0, 0] : [0, 0, 1], axis));
    const y = cross(axis, x);
    const at = (k) => add(centre, scaled(add(scaled(x, Math.cos((k * Math.PI) / 32)), scaled(y, Math.sin((k * Math.PI) / 32))), diameter / 2));
    path(Array.from({ length: 65 }, (_, k) => at(k)), { class: "span" });
  }
  for (const at of points.map((p) => viewer.onCanvas(p)).filter(Boolean)) mark("circle", { class: "point", cx: at[0], cy: at[1], r: 4 });
}

/** Puts the handle of the section where it is seen. */
function placeHandle(viewer) {
  const { section, overlay } = viewer;
  const [a, b] = section.isOn ? [section.handle, section.tip].map((p) => viewer.onCanvas(p)) : [];
  const group = overlay.querySelector(".handles");
  group.style.display = a && b ? "" : "none";
  if (!a || !b) return;
  const put = (selector, values) => Object.entries(values).forEach(([name, value]) => group.querySelector(selector).setAttribute(name, value.toFixed(1)));
  put("line", { x1: a[0], y1: a[1], x2: b[0], y2: b[1] });
  put("#section-move", { cx: a[0], cy: a[1] });
  put("#section-turn", { cx: b[0], cy: b[1] });
}

/** Lets the handle of the section be held: its disc moves the plane, the tip of its arrow turns it. */
function holdHandle(viewer, changed) {
  const { section, canvas } = viewer;
  const held = (id, drag, key) => {
    const node = $(id);
    let before = null;
    node.addEventListener("pointerdown", (event) => {
      node.setPointerCapture(event.pointerId);
      before = [event.clientX, event.clientY];
      event.preventDefault();
    });
    node.addEventListener("pointermove", (event) => {
      if (!before) return;
      const box = canvas.getBoundingClientRect();
      drag(event.clientX - before[0], event.clientY - before[1], event.clientX - box.left, event.clientY - box.top);
      before = [event.clientX, event.clientY];
      changed();
    });
    for (const end of ["pointerup", "pointercancel"]) node.addEventListener(end, () => (before = null));
    node.addEventListener("keydown", (event) => {
      const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
      if (!way) return;
      key(...way);
      event.preventDefault();
      event.stopPropagation();
      changed();
    });
  };
  const step = (dx, dy) => (section.share = Math.min(Math.max(section.share + 0.01 * (dx + dy), 0), 1));
  const turn = (Math.PI * 5) / 180;
  held("section-move", (dx, dy) => section.drag(dx, dy), step);
  held("section-turn", (dx, dy, x, y) => section.turn(x, y), (dx, dy) => section.tilt(turn * dx, turn * dy));
}
