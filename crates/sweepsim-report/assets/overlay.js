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
  const points = viewer.measured.map((p) => viewer.onCanvas(p)).filter(Boolean);
  if (points.length === 2) mark("line", { class: "span", x1: points[0][0], y1: points[0][1], x2: points[1][0], y2: points[1][1] });
  for (const [x, y] of points) mark("circle", { class: "point", cx: x, cy: y, r: 4 });
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
  overlay.replaceChildren(...marks);
}
