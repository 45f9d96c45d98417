// The scene: what is drawn, how it is coloured, and what is under the pointer.

/** A picture that takes longer, in milliseconds, is slow; and how long the view rests before it is drawn in full. */
const LONG = 60;
const REST = 180;

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
    /** The surfaces of the part and of the workpiece during the program, where they are known; elsewhere lines are drawn. */
    this.sharp = head.surface ? new Sharp(head, "surface", new Shape(gl)) : null;
    this.changing = head.surface_course ? new Sharp(head, "course", new Shape(gl)) : null;
    this.clocks = (head.surface_course ?? head.course)?.clocks;
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
    this.shown = { part: true, mesh: false, target: false, fixture: true, stock: false, tool: true, path: false, machine: meets, still: false };
    this.clock = this.track?.end ?? 0;
    this.section = new Section(this);
    /** What is marked in the picture: points, lines between two of them, and a circle. */
    this.measured = { points: [], lines: [], circle: null };
    /** What can be picked, by name; made when it is needed. */
    this.solids = {};
    if (this.track) this.drawPath();
    const [low, high] = this.extent();
    this.camera = new Camera(low, high, canvas.clientWidth / canvas.clientHeight || 1);
    if (this.machine) this.camera.beyond = this.machine.reach(this.meshes.bodies, this.camera.centre);
    this.rebuilt = -1;
    this.mode = "plain";
    const asked = () => this.ask();
    const moved = () => this.move();
    steer(canvas, this.camera, moved, (x, y) => this.onclick?.(x, y), (x, y) => this.onhover?.(x, y));
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
    for (const places of [this.meshes.solids.target.places, this.sharp?.places ?? [], this.changing?.places ?? []])
      for (let k = 0; k < places.length; k += 3)
        for (let c = 0; c < 3; c++) [low[c], high[c]] = [Math.min(low[c], places[k + c]), Math.max(high[c], places[k + c])];
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
    if (!this.clocks || this.clock >= this.track.end) return -1;
    return momentAt(this.clocks, this.clock);
  }

  /** The number of the set-up at this time. */
  get setup() {
    if (!this.track) return 0;
    const { move } = this.track.at(this.clock);
    const number = this.head.setups.findIndex(([end]) => move < end);
    return Math.max(number, 0);
  }

  /** The surface that is drawn now; null if lines are. */
  get surface() {
    return this.moment < 0 ? this.sharp : this.changing;
  }

  /** The part as it is to be drawn now. */
  rebuild() {
    const { moment, surface, shapes, mode } = this;
    if (this.rebuilt === `${moment} ${mode}`) return;
    this.rebuilt = `${moment} ${mode}`;
    const begin = performance.now();
    const colours = new Colours(this.head, mode);
    colours.clocks = this.clocks ?? [];
    if (surface && moment >= 0) surface.seek(moment);
    if (surface && surface.tinted !== mode) {
      surface.tinted = mode;
      surface.shape.put(2, surface.tints((made) => colours.ofMaker(made)));
      if (mode === "deviation") surface.shape.shares(surface.shares(colours.limits));
    }
    const data = { moment, mode, triangles: surface?.count ?? 0, quads: 0 };
    this.quads = null;
    delete this.solids.part;
    if (!surface) {
      if (moment >= 0) this.course.seek(moment);
      const layer = moment < 0 ? this.final : this.course.layer(this.final);
      this.layer = layer;
      const colour = colours.of(layer, this.track);
      layer.look = (end) => colour(end).reduce((all, c) => all * 256 + c, 0);
      this.quads = surfaceOf(layer);
      data.quads = this.quads.count;
      shapes.part.quads(this.quads);
      shapes.part.colours(this.quads, colour);
    }
    data.milliseconds = Math.round(performance.now() - begin);
    Object.assign(this.canvas.dataset, data);
  }

  /** The view moves: where pictures take long, they are coarse until it rests. */
  move() {
    clearTimeout(this.resting);
    this.moving = true;
    this.resting = setTimeout(() => {
      this.moving = false;
      this.before = null;
      this.ask();
    }, REST);
    this.ask();
  }

  /** Whether the surface is to be drawn by fewer triangles now. */
  get isCoarse() {
    const { surface } = this;
    if (!this.moving || !this.slow || !(surface?.count >= LARGE)) return false;
    if (!surface.shape.coarseCount) surface.shape.coarser(surface.coarse());
    return true;
  }

  ask() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame((now) => {
      this.asked = false;
      if (this.moving && this.before && now - this.before > LONG) this.slow = true;
      this.before = now;
      if (this.camera.step(now)) this.ask();
      // For tests: whether the picture is still moving.
      if (this.camera.flight) this.canvas.dataset.flying = "1";
      else delete this.canvas.dataset.flying;
      this.draw();
    });
  }

  draw() {
    const { canvas, gpu, shapes, shown, camera } = this;
    if (!canvas.clientWidth) return;
    this.rebuild();
    const ratio = Math.min(devicePixelRatio || 1, 2);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((c) => Math.round(c * ratio));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    const view = product(camera.matrix(width / height), this.hold);
    this.view = view;
    gpu.begin(width, height, view, transformed(inverted(this.hold), camera.eye).slice(0, 3), this.section.plane);
    const { surface, isCoarse } = this;
    canvas.dataset.drawn = isCoarse ? surface.shape.coarseCount / 3 : surface?.count ?? 0;
    if (shown.part) this.drawPart(isCoarse);
    for (const name of this.fixtures()) gpu.draw(shapes[name], { colour: FIXTURE });
    canvas.dataset.setup = this.setup;
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

  drawPart(coarse) {
    const { gpu, surface, shown } = this;
    const shape = surface?.shape ?? this.shapes.part;
    const model = surface ? IDENTITY : this.frame;
    const wires = { colour: WIRE, alpha: 0.18, unlit: true, wires: true };
    gpu.draw(shape, { model, banded: surface !== null && this.mode === "deviation", coarse, behind: shown.mesh });
    if (shown.mesh && !coarse) gpu.draw(shape, { model, ...wires });
  }

  /** The fixtures that are shown now. */
  fixtures() {
    return this.shown.fixture ? ["fixture", `fixture ${this.setup}`].filter((name) => this.shapes[name]) : [];
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

  /** The ray of the world behind a pixel of the canvas. */
  ray(x, y) {
    const { canvas, camera } = this;
    const forward = scaled(camera.towards, -1);
    const right = unit(cross(forward, [0, 0, 1]));
    const up = cross(right, forward);
    const [wide, tall] = halves(canvas.clientWidth / canvas.clientHeight);
    const [u, v] = [(2 * x) / canvas.clientWidth - 1, 1 - (2 * y) / canvas.clientHeight];
    const seen = unit(add(forward, add(scaled(right, u * wide), scaled(up, v * tall))));
    const back = inverted(this.hold);
    const origin = transformed(back, camera.eye).slice(0, 3);
    return { origin, towards: sub(transformed(back, add(camera.eye, seen)).slice(0, 3), origin) };
  }

  /** The solids that can be picked now. */
  pickable() {
    const { solids, surface, quads } = this;
    const all = [];
    if (this.shown.part) all.push(surface ? surface.solid : (solids.part ??= new Solid(quads.places, quads.corners(), this.frame)));
    for (const name of this.fixtures()) all.push((solids[name] ??= new Solid(this.meshes.solids[name].places, null)));
    return all;
  }

  /** The first of what is seen that a ray meets between two distances. */
  cast(origin, towards, range) {
    let [best, end] = [null, range[1]];
    for (const solid of this.pickable()) {
      const hit = solid.first(origin, towards, [range[0], end]);
      if (hit) [best, end] = [hit, hit.far];
    }
    if (!best) return null;
    const place = add(origin, scaled(towards, best.far));
    return { ...best, place, round: best.solid === this.surface?.solid ? this.surface.rounded(best, place) : place };
  }

  /** What is under a pixel of the canvas: place, normal, and the triangle, or null for the face of a section. */
  pick(x, y) {
    this.rebuild();
    const { origin, towards } = this.ray(x, y);
    const { plane } = this.section;
    const range = left(origin, towards, plane);
    const hit = this.cast(origin, towards, range);
    if (!hit || !plane || dot(hit.normal, towards) < 0 || range[0] <= 0) return hit;
    // Inside of the material where the section begins.
    const place = add(origin, scaled(towards, range[0]));
    return { far: range[0], place, round: place, normal: plane[0], triangle: null };
  }

  /** The other side of the material below a point: place and distance, or null. */
  through({ place, normal }) {
    const inwards = scaled(normal, -1);
    const hit = this.cast(place, inwards, [1e-4 * this.camera.reach, Infinity]);
    return hit && { place: hit.place, far: hit.far };
  }

  /** The end of an interval that a face picked among the lines belongs to, as flat ones are joined; null on walls. */
  endAt({ place, normal }) {
    const { layer, frame } = this;
    const back = inverted(frame);
    const up = sub(transformed(back, add(place, normal)), transformed(back, place))[2];
    const local = transformed(back, place);
    const cell = layer.nearest(local);
    if (Math.abs(up) < 0.1 || !cell) return null;
    const side = up > 0 ? 1 : 0;
    let [best, nearest] = [null, Infinity];
    const n = cell[0] * layer.ny + cell[1];
    for (let k = layer.first[n]; k < layer.first[n + 1]; k++) {
      const far = Math.abs(layer.height((side ? layer.upper : layer.lower)[k]) - local[2]);
      if (far < nearest) [nearest, best] = [far, 2 * k + side];
    }
    return best;
  }

  /** What is known of the surface where it was picked: the deviation, and 0 for the stock or 1 plus the number of the move; each null if it is not known. */
  about(hit) {
    const { solid, triangle, u, v } = hit;
    const { surface, solids, quads, layer } = this;
    if (triangle === null) return null;
    if (solid === surface?.solid) return { maker: surface.maker(triangle), deviation: surface.deviation(triangle, u, v) };
    if (solid !== solids.part) return null;
    const end = this.endAt(hit) ?? quads.ends[triangle >> 1];
    if (end < 0) return { maker: end === -1 ? 0 : null, deviation: null };
    const [k, side] = [end >> 1, end & 1];
    const steps = layer.deviations?.[side][k] ?? UNKNOWN;
    const deviation = steps === UNKNOWN ? null : steps * layer.deviationStep;
    if (!layer.moments) return { maker: layer.makers[side][k], deviation };
    const made = layer.moments[side][k];
    return { maker: made === 0 ? 0 : this.track.at(this.course.clocks[made - 1]).move + 1, deviation };
  }
}
