// The surface of the part or of the workpiece as triangles, with sharp walls: what is there at any moment, and what is known of it.

/** Cells along the longest side of the part, of the surface that is drawn while the view moves. */
const COARSE = 90;
/** Smaller surfaces are drawn as they are. */
const LARGE = 60000;

class Sharp {
  /** The surface of the part, or with `course` that of the workpiece at all moments, for a shape to draw. */
  constructor(head, name, shape) {
    const d = (array) => head.data[`${name}.${array}`];
    const { places } = name === "course" ? head.surface_course : head.surface;
    this.shape = shape;
    this.step = head.deviation;
    const count = d("x").length;
    this.places = new Float32Array(3 * count);
    ["x", "y", "z"].forEach((array, k) => {
      const { from, step } = places[k];
      const steps = d(array);
      for (let v = 0; v < count; v++) this.places[3 * v + k] = from + steps[v] * step;
    });
    this.normals = new Int8Array(4 * count);
    const [us, vs] = [d("u"), d("v")];
    for (let v = 0; v < count; v++) {
      const normal = fromOctahedron(us[v] / 127, vs[v] / 127);
      for (let k = 0; k < 3; k++) this.normals[4 * v + k] = 127 * normal[k];
    }
    this.makers = d("maker");
    this.deviations = d("deviation") ?? null;
    [this.all, this.from, this.to] = [d("corners"), d("from"), d("to")];
    shape.places(this.places, this.normals);
    if (name === "course") this.seek(0);
    else this.take(this.all);
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

  /** Goes to a moment: takes the triangles that are there. */
  seek(moment) {
    if (this.moment === moment) return;
    this.moment = moment;
    const { all, from, to } = this;
    const corners = new Uint32Array(all.length);
    let count = 0;
    for (let t = 0; t < from.length; t++) {
      if (from[t] > moment || moment >= to[t]) continue;
      for (let k = 0; k < 3; k++) corners[count++] = all[3 * t + k];
    }
    this.take(corners.slice(0, count));
  }

  take(corners) {
    this.corners = corners;
    this.count = corners.length / 3;
    this.shape.triangles(corners);
    /** What can be picked, made when it is needed. */
    this.picked = null;
  }

  get solid() {
    return (this.picked ??= new Solid(this.places, this.corners));
  }

  place(v) {
    return [this.places[3 * v], this.places[3 * v + 1], this.places[3 * v + 2]];
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
