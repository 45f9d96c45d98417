// The scene: what is drawn, how it is coloured, and what is under the pointer.

class Viewer {
  constructor(head, canvas, overlay) {
    this.head = head;
    this.canvas = canvas;
    this.overlay = overlay;
    this.gpu = new Gpu(canvas);
    const { gl } = this.gpu;
    this.frame = framed(head.frame);
    this.final = finalLayer(head);
    this.course = head.course ? new Course(head) : null;
    this.track = head.track ? new Track(head) : null;
    this.meshes = readMeshes(head);
    this.shapes = { part: new Shape(gl), path: new Shape(gl), rapid: new Shape(gl) };
    for (const [name, triangles] of Object.entries(this.meshes.solids)) this.addShape(name, triangles);
    this.tools = this.meshes.tools.map((tool) => [tool.cutter, tool.bodies].map((part) => {
      const shape = new Shape(gl);
      shape.plain(part.places, part.normals);
      return shape;
    }));
    this.machine = head.machine ? new Machine(head) : null;
    this.bodies = this.meshes.bodies.map(({ link, triangles }) => {
      const shape = new Shape(gl);
      shape.plain(triangles.places, triangles.normals);
      return { link, shape };
    });
    const meets = this.machine?.contacts.length > 0;
    this.shown = { target: false, fixture: true, stock: false, tool: true, path: false, machine: meets, still: false };
    this.clock = this.track?.end ?? 0;
    this.section = null;
    this.measured = [];
    this.marked = null;
    if (this.track) this.drawPath();
    const [low, high] = this.extent();
    this.camera = new Camera(low, high, canvas.clientWidth / canvas.clientHeight || 1);
    if (this.machine) this.camera.beyond = this.machine.reach(this.meshes.bodies, this.camera.centre);
    this.rebuilt = -1;
    this.mode = "plain";
    const asked = () => this.ask();
    steer(canvas, this.camera, asked, (x, y) => this.onclick?.(x, y));
    new ResizeObserver(asked).observe(canvas);
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
  }

  addShape(name, triangles) {
    this.shapes[name] = new Shape(this.gpu.gl);
    this.shapes[name].plain(triangles.places, triangles.normals);
  }

  drawPath() {
    const { track } = this;
    const lines = [[], []];
    for (let n = 1; n < track.count; n++) {
      if (!track.begins(n)) lines[track.isRapid(n) ? 1 : 0].push(...track.tip(n - 1), ...track.tip(n));
    }
    const { LINES } = this.gpu.gl;
    this.shapes.path.plain(lines[0], null, LINES);
    this.shapes.rapid.plain(lines[1], null, LINES);
  }

  /** The corners of a box that holds part, stock and target. */
  extent() {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    const take = (p) => p.forEach((c, k) => ([low[k], high[k]] = [Math.min(low[k], c), Math.max(high[k], c)]));
    const layer = this.course?.start ?? this.final;
    let [bottom, top] = [65535, 0];
    for (let k = 0; k < layer.lower.length; k++) [bottom, top] = [Math.min(bottom, layer.lower[k]), Math.max(top, layer.upper[k])];
    if (bottom <= top)
      for (let i = 0; i < 8; i++) {
        const x = layer.min[0] + (i & 1 ? layer.nx * layer.spacing[0] : 0);
        const y = layer.min[1] + (i & 2 ? layer.ny * layer.spacing[1] : 0);
        take(transformed(this.frame, [x, y, layer.height(i & 4 ? top : bottom)]).slice(0, 3));
      }
    const { places } = this.meshes.solids.target;
    for (let k = 0; k < places.length; k += 3) take([places[k], places[k + 1], places[k + 2]]);
    return low[0] <= high[0] ? [low, high] : [[-1, -1, -1], [1, 1, 1]];
  }

  /** Colours by `deviation`, `tool`, `move` or `plain`. */
  colour(mode) {
    this.mode = mode;
    this.rebuilt = -1;
    this.ask();
  }

  /** Goes to a time of the program. */
  seek(clock) {
    this.clock = clock;
    this.ask();
  }

  /** The number of moments that have passed, or −1 at the end. */
  get moment() {
    if (!this.course || this.clock >= this.track.end) return -1;
    return this.course.momentAt(this.clock);
  }

  /** The number of the set-up at this time. */
  get setup() {
    if (!this.track) return 0;
    const { move } = this.track.at(this.clock);
    const number = this.head.setups.findIndex(([end]) => move < end);
    return Math.max(number, 0);
  }

  rebuild() {
    const { moment } = this;
    if (this.rebuilt === `${moment} ${this.mode}`) return;
    this.rebuilt = `${moment} ${this.mode}`;
    let layer = this.final;
    if (moment >= 0) {
      this.course.seek(moment);
      layer = this.course.layer(this.final);
    }
    const colours = new Colours(this.head, this.mode);
    colours.clocks = this.course?.clocks ?? [];
    const colour = colours.of(layer, this.track);
    layer.look = (end) => colour(end).reduce((all, c) => all * 256 + c, 0);
    const begin = performance.now();
    const quads = surfaceOf(layer);
    this.layer = layer;
    this.shapes.part.quads(quads);
    this.shapes.part.colours(quads, colour);
    const milliseconds = Math.round(performance.now() - begin);
    Object.assign(this.canvas.dataset, { quads: quads.count, moment, mode: this.mode, milliseconds });
  }

  ask() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame((now) => {
      this.asked = false;
      if (this.camera.step(now)) this.ask();
      // For tests: whether the picture is still moving.
      if (this.camera.flight) this.canvas.dataset.flying = "1";
      else delete this.canvas.dataset.flying;
      this.draw();
    });
  }

  /** The plane beyond which all is cut away. */
  plane() {
    if (!this.section) return null;
    const { axis, share, flipped } = this.section;
    const normal = [0, 0, 0];
    normal[axis] = flipped ? -1 : 1;
    const at = this.camera.low[axis] + (this.camera.high[axis] - this.camera.low[axis]) * share;
    return [normal, normal[axis] * at, at];
  }

  draw(pass = 0) {
    const { canvas, gpu, shapes, shown, camera } = this;
    if (!canvas.clientWidth) return;
    if (pass === 0) this.rebuild();
    const ratio = Math.min(devicePixelRatio || 1, 2);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((c) => Math.round(c * ratio));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    const view = product(camera.matrix(width / height), this.hold);
    this.view = view;
    gpu.begin(width, height, view, transformed(inverted(this.hold), camera.eye).slice(0, 3), this.plane(), pass);
    gpu.draw(shapes.part, { model: this.frame });
    if (shown.fixture) {
      gpu.draw(shapes.fixture, { colour: FIXTURE });
      const own = shapes[`fixture ${this.setup}`];
      if (own) gpu.draw(own, { colour: FIXTURE });
    }
    canvas.dataset.setup = this.setup;
    if (pass === 2) return;
    if (shown.tool && this.track && this.clock < this.track.end) this.drawTool();
    if (shown.machine && this.machine) this.drawMachine();
    if (shown.path) {
      gpu.draw(shapes.path, { colour: rgb("#0b7a75"), unlit: true, uncut: true });
      gpu.draw(shapes.rapid, { colour: rgb("#c2410c"), unlit: true, uncut: true });
    }
    if (shown.stock) gpu.draw(shapes.stock, { colour: STOCK, alpha: 0.28 });
    if (shown.target) gpu.draw(shapes.target, { colour: TARGET, alpha: 0.45 });
    canvas.dataset.camera = String(camera);
    this.ondraw?.();
  }

  drawTool() {
    const at = this.track.at(this.clock);
    const tool = this.tools[at.tool];
    if (!tool) return;
    const side = Math.abs(at.axis[2]) > 0.9 ? [1, 0, 0] : [0, 0, 1];
    const x = unit(cross(side, at.axis));
    const model = framed([at.tip, x, cross(at.axis, x), at.axis]);
    this.gpu.draw(tool[0], { model, colour: CUTTER, uncut: true });
    this.gpu.draw(tool[1], { model, colour: BODY, alpha: 0.55, uncut: true });
  }

  /** From the world to what the camera sees: with the base still, the part moves. */
  get hold() {
    return this.machine && this.shown.still ? this.machine.hold(this.clock) : IDENTITY;
  }

  /** Where the camera sees a point of the world. */
  held(p) {
    return transformed(this.hold, p).slice(0, 3);
  }

  drawMachine() {
    const frames = this.machine.frames(this.clock);
    const meeting = this.machine.meeting(this.clock);
    // What is solid first, then what is seen through.
    const order = this.bodies.map((body, n) => ({ ...body, met: meeting.includes(n) })).sort((a, b) => b.met - a.met);
    for (const { link, shape, met } of order) {
      this.gpu.draw(shape, { model: frames[link], colour: met ? MEETING : MACHINE, alpha: met ? 0.8 : 0.4, uncut: true });
    }
    this.canvas.dataset.meeting = meeting.join(" ");
  }

  /** Where a point of the world is on the canvas, in its pixels, and how deep. */
  onCanvas(p) {
    const [x, y, z, w] = transformed(this.view, p);
    if (w <= 0) return null;
    return [(0.5 + (0.5 * x) / w) * this.canvas.clientWidth, (0.5 - (0.5 * y) / w) * this.canvas.clientHeight, z / w];
  }

  /** The point of the part or a fixture under a pixel of the canvas, or null. */
  pick(x, y) {
    const { canvas, camera } = this;
    this.draw(2);
    const ratio = canvas.width / canvas.clientWidth;
    const depth = this.gpu.depthAt(Math.floor(x * ratio), canvas.height - 1 - Math.floor(y * ratio));
    this.draw();
    if (depth === null || depth >= 1) return null;
    // The point of the ray whose depth is this.
    const back = sub(camera.centre, camera.eye);
    const forward = unit(back);
    const right = unit(cross(forward, [0, 0, 1]));
    const up = cross(right, forward);
    const aspect = canvas.clientWidth / canvas.clientHeight;
    const m = perspectiveOf(camera, aspect);
    const [u, v] = [(2 * x) / canvas.clientWidth - 1, 1 - (2 * y) / canvas.clientHeight];
    const far = m[14] / (2 * depth - 1 + m[10]);
    const place = add(camera.eye, scaled(forward, far));
    const seen = add(place, add(scaled(right, (u * far) / m[0]), scaled(up, (v * far) / m[5])));
    return transformed(inverted(this.hold), seen).slice(0, 3);
  }

  /** What is known of the surface near a point. */
  about(p) {
    const { layer } = this;
    const q = sub(p, this.head.frame[0]);
    const local = [1, 2, 3].map((k) => dot(q, this.head.frame[k]));
    const cell = layer?.nearest(local);
    if (!cell) return null;
    const n = cell[0] * layer.ny + cell[1];
    let best = null;
    for (let k = layer.first[n]; k < layer.first[n + 1]; k++)
      [layer.lower[k], layer.upper[k]].forEach((steps, side) => {
        const far = Math.abs(layer.height(steps) - local[2]);
        if (!best || far < best.far) best = { far, k, side };
      });
    if (!best || best.far > 2 * Math.max(...layer.spacing)) return null;
    const k = layer.final ? layer.asFinal[best.side][best.k] : layer.moments ? -1 : best.k;
    if (k < 0) return null;
    const source = layer.final ?? layer;
    const steps = source.deviations?.[best.side][k] ?? -32768;
    return { maker: source.makers[best.side][k], deviation: steps === -32768 ? null : steps * source.deviationStep };
  }
}

/** The projection alone, as the camera's matrix has it. */
function perspectiveOf(camera, aspect) {
  const whole = camera.matrix(aspect);
  const view = lookAt(camera.eye, camera.centre, [0, 0, 1]);
  // The view is a rotation and a shift, so its inverse is simple.
  const [a, b, c] = [0, 1, 2].map((i) => [view[i], view[4 + i], view[8 + i]]);
  const inverse = [...a, 0, ...b, 0, ...c, 0, ...camera.eye, 1];
  return product(whole, inverse);
}
