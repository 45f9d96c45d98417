// The part's surface as triangles, with sharp walls: what is seen of it at any moment, and what is known of it.

/** Cells along the longest side of the part, of the surface that is drawn while the view moves. */
const COARSE = 90;
/** Smaller surfaces are drawn as they are. */
const LARGE = 60000;

class Sharp {
  constructor(head) {
    const d = head.data;
    const { places, farthest, whole } = head.surface;
    Object.assign(this, { farthest, whole });
    this.step = head.deviation;
    const count = d["surface.x"].length;
    this.places = new Float32Array(3 * count);
    ["surface.x", "surface.y", "surface.z"].forEach((name, k) => {
      const { from, step } = places[k];
      const steps = d[name];
      for (let v = 0; v < count; v++) this.places[3 * v + k] = from + steps[v] * step;
    });
    this.normals = new Int8Array(4 * count);
    for (let v = 0; v < count; v++) {
      const normal = fromOctahedron(d["surface.u"][v] / 127, d["surface.v"][v] / 127);
      for (let k = 0; k < 3; k++) this.normals[4 * v + k] = 127 * normal[k];
    }
    this.corners = d["surface.corners"];
    this.makers = d["surface.maker"];
    this.deviations = d["surface.deviation"] ?? null;
    this.count = this.corners.length / 3;
    /** Of each triangle, as of its last corner, the moment from which it is seen. */
    this.since = new Float32Array(count);
  }

  /** What made a triangle: 0 for the stock, else 1 plus the number of the move. */
  maker(triangle) {
    return this.makers[this.corners[3 * triangle + 2]];
  }

  /** The deviation at a place of a triangle, given by the shares of its second and third corner; null if it is not known. */
  deviation(triangle, u, v) {
    if (!this.deviations) return null;
    const [a, b, c] = [0, 1, 2].map((k) => this.deviations[this.corners[3 * triangle + k]]);
    if (Math.min(a, b, c) === UNKNOWN) return null;
    return (a * (1 - u - v) + b * u + c * v) * this.step;
  }

  /** A place of a triangle on the round surface that its corners' normals tell of: halfway to the mean of its projections onto their tangent planes, which is exact on circles (Boubekeur, Alexa 2008). */
  rounded({ triangle, u, v }, place) {
    let moved = place;
    [1 - u - v, u, v].forEach((share, k) => {
      const corner = this.corners[3 * triangle + k];
      const normal = unit([0, 1, 2].map((c) => this.normals[4 * corner + c]));
      moved = add(moved, scaled(normal, 0.5 * share * dot(normal, sub(this.place(corner), place))));
    });
    return moved;
  }

  /** Where triangles begin to be seen: from the moment at which a point just outside of them is free. */
  follow(course, frame) {
    const { start } = course;
    const reach = 0.75 * Math.max(...start.spacing);
    const world = inverted(frame);
    // Triangles by the line beside them, and the heights of the points outside.
    const lines = new Int32Array(this.count).fill(-1);
    const heights = new Float32Array(this.count);
    const first = new Uint32Array(start.nx * start.ny + 1);
    for (let t = 0; t < this.count; t++) {
      const corners = [0, 1, 2].map((k) => this.place(this.corners[3 * t + k]));
      const normal = unit(cross(sub(corners[1], corners[0]), sub(corners[2], corners[0])));
      const middle = corners.reduce((sum, p) => add(sum, scaled(p, 1 / 3)), scaled(normal, reach));
      const local = transformed(world, middle);
      const cell = start.nearest(local);
      if (!cell) continue;
      lines[t] = cell[0] * start.ny + cell[1];
      heights[t] = local[2];
      first[lines[t] + 1]++;
    }
    for (let n = 1; n < first.length; n++) first[n] += first[n - 1];
    const own = new Uint32Array(first[first.length - 1]);
    const next = first.slice();
    for (let t = 0; t < this.count; t++) if (lines[t] >= 0) own[next[lines[t]]++] = t;
    // At the end, all is seen.
    const since = new Float32Array(this.count).fill(course.clocks.length);
    const look = (line, moment, intervals) => {
      for (let k = first[line]; k < first[line + 1]; k++) {
        const t = own[k];
        if (since[t] <= moment) continue;
        let free = true;
        for (let m = 0; m < intervals.length && free; m += STRIDE) free = heights[t] < start.height(intervals[m]) || heights[t] > start.height(intervals[m + 1]);
        if (free) since[t] = moment;
      }
    };
    lines.forEach((line, t) => line < 0 && (since[t] = 0));
    course.seek(0);
    course.lines.forEach((intervals, line) => look(line, 0, intervals));
    for (let moment = 1; moment <= course.clocks.length; moment++) {
      const changed = course.changed(moment);
      course.seek(moment);
      for (const line of changed) look(line, moment, course.lines[line]);
    }
    // A corner that is the last of several triangles shows the earliest.
    this.since.fill(Infinity);
    for (let t = 0; t < this.count; t++) {
      const last = this.corners[3 * t + 2];
      this.since[last] = Math.min(this.since[last], since[t]);
    }
  }

  place(v) {
    return [this.places[3 * v], this.places[3 * v + 1], this.places[3 * v + 2]];
  }

  /** Whether a triangle is seen at a moment; −1 is the end. */
  isSeen(triangle, moment) {
    return moment < 0 || this.since[this.corners[3 * triangle + 2]] <= moment;
  }

  /** The corners of fewer triangles, to be drawn while the view moves: those that are left if corners of one cell and one side become one (Rossignac, Borrel 1993). */
  coarse() {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    this.places.forEach((c, n) => ([low[n % 3], high[n % 3]] = [Math.min(low[n % 3], c), Math.max(high[n % 3], c)]));
    const cell = Math.max(...sub(high, low)) / COARSE || 1;
    const first = new Map();
    const number = Uint32Array.from(this.makers, (_, v) => {
      const [x, y, z] = this.place(v).map((c, k) => Math.floor((c - low[k]) / cell));
      const normal = this.normals.subarray(4 * v, 4 * v + 3);
      const axis = Math.abs(normal[0]) > Math.abs(normal[1]) ? (Math.abs(normal[0]) > Math.abs(normal[2]) ? 0 : 2) : Math.abs(normal[1]) > Math.abs(normal[2]) ? 1 : 2;
      const key = (((x * 256 + y) * 256 + z) * 3 + axis) * 2 + (normal[axis] < 0 ? 1 : 0);
      if (!first.has(key)) first.set(key, v);
      return first.get(key);
    });
    const corners = [];
    for (let k = 0; k < this.corners.length; k += 3) {
      const [a, b, c] = [number[this.corners[k]], number[this.corners[k + 1]], number[this.corners[k + 2]]];
      if (a !== b && b !== c && c !== a) corners.push(a, b, c);
    }
    return Uint32Array.from(corners);
  }

  /** Red, green and blue of each corner: those of a triangle are those of its last. */
  tints(colour) {
    const bytes = new Uint8Array(4 * this.makers.length);
    for (let v = 0; v < this.makers.length; v++) bytes.set(colour(this.makers[v]), 4 * v);
    return bytes;
  }

  /** The deviations of all corners as shares of the limits. */
  shares(limits) {
    const shares = new Float32Array(this.makers.length).fill(NOT_MEASURED);
    if (this.deviations)
      for (let v = 0; v < shares.length; v++) if (this.deviations[v] !== UNKNOWN) shares[v] = shareOf(this.deviations[v] * this.step, limits);
    return shares;
  }
}
