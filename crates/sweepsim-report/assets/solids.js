// Tools, fixtures, the stock and the target as triangles.

/** Triangles with normals for each corner: sharp edges stay sharp. */
class Triangles {
  constructor() {
    this.count = 0;
    [this.allPlaces, this.allNormals] = [new Float32Array(900), new Int8Array(1200)];
  }

  /** Room for so many more corners. */
  reserve(more) {
    const need = this.count + more;
    if (4 * need <= this.allNormals.length) return;
    const most = Math.max(need, Math.ceil(1.6 * this.count));
    for (const [name, type, width] of [["allPlaces", Float32Array, 3], ["allNormals", Int8Array, 4]]) {
      const next = new type(width * most);
      next.set(this[name]);
      this[name] = next;
    }
  }

  corner(x, y, z, nx, ny, nz) {
    const n = this.count++;
    this.allPlaces[3 * n] = x;
    this.allPlaces[3 * n + 1] = y;
    this.allPlaces[3 * n + 2] = z;
    this.allNormals[4 * n] = nx * 127;
    this.allNormals[4 * n + 1] = ny * 127;
    this.allNormals[4 * n + 2] = nz * 127;
  }

  push(corners, normals) {
    this.reserve(3);
    for (let k = 0; k < 3; k++) this.corner(...corners[k], ...normals[k]);
  }

  get places() {
    return this.allPlaces.subarray(0, 3 * this.count);
  }

  get normals() {
    return this.allNormals.subarray(0, 4 * this.count);
  }
}

/** Sides of a solid of revolution. */
const SECTORS = 48;
/** Edges sharper than this (a cosine: 35°) are drawn sharp. */
const SHARP = 0.82;

/** A profile turned about z. */
function revolved(profile, triangles) {
  const points = profile.filter((p, k) => k === 0 || Math.hypot(p[0] - profile[k - 1][0], p[1] - profile[k - 1][1]) > 1e-9);
  const pieces = points.slice(1).map((p, k) => {
    const [r, z] = [p[0] - points[k][0], p[1] - points[k][1]];
    const long = Math.hypot(r, z);
    return { from: points[k], to: p, normal: [z / long, -r / long] };
  });
  // Where pieces meet smoothly, they share a normal.
  pieces.forEach((piece, k) => {
    const joint = (other) => {
      if (!other || piece.normal[0] * other.normal[0] + piece.normal[1] * other.normal[1] < SHARP) return piece.normal;
      const sum = [piece.normal[0] + other.normal[0], piece.normal[1] + other.normal[1]];
      return sum.map((c) => c / Math.hypot(...sum));
    };
    piece.normals = [joint(pieces[k - 1]), joint(pieces[k + 1])];
  });
  for (const { from, to, normals } of pieces)
    for (let s = 0; s < SECTORS; s++) {
      const at = (turn, [r, z]) => [r * Math.cos(turn), r * Math.sin(turn), z];
      const [a, b] = [s, s + 1].map((k) => (2 * Math.PI * k) / SECTORS);
      const corners = [at(a, from), at(b, from), at(b, to), at(a, to)];
      const own = [at(a, normals[0]), at(b, normals[0]), at(b, normals[1]), at(a, normals[1])];
      if (from[0] > 1e-9) triangles.push([corners[0], corners[1], corners[2]], [own[0], own[1], own[2]]);
      if (to[0] > 1e-9) triangles.push([corners[0], corners[2], corners[3]], [own[0], own[2], own[3]]);
    }
}

/** A mesh, smooth but for its sharp edges: three numbers a place; those with equal `keys` are one. */
function shaded(places, keys, corners, triangles) {
  const count = corners.length / 3;
  const flat = new Float64Array(3 * count);
  const long = new Float64Array(count);
  for (let t = 0; t < count; t++) {
    const [a, b, c] = [3 * corners[3 * t], 3 * corners[3 * t + 1], 3 * corners[3 * t + 2]];
    const [ux, uy, uz] = [places[b] - places[a], places[b + 1] - places[a + 1], places[b + 2] - places[a + 2]];
    const [vx, vy, vz] = [places[c] - places[a], places[c + 1] - places[a + 1], places[c + 2] - places[a + 2]];
    flat[3 * t] = uy * vz - uz * vy;
    flat[3 * t + 1] = uz * vx - ux * vz;
    flat[3 * t + 2] = ux * vy - uy * vx;
    long[t] = Math.hypot(flat[3 * t], flat[3 * t + 1], flat[3 * t + 2]) || 1;
  }
  // The triangles around each place.
  const numbers = new Map();
  const own = Uint32Array.from(keys, (key) => {
    if (!numbers.has(key)) numbers.set(key, numbers.size);
    return numbers.get(key);
  });
  const first = new Uint32Array(numbers.size + 1);
  for (const v of corners) first[own[v] + 1]++;
  for (let n = 1; n < first.length; n++) first[n] += first[n - 1];
  const around = new Uint32Array(corners.length);
  const next = first.slice();
  for (let k = 0; k < corners.length; k++) around[next[own[corners[k]]]++] = (k / 3) | 0;
  triangles.reserve(corners.length);
  for (let k = 0; k < corners.length; k++) {
    const [v, t] = [corners[k], 3 * ((k / 3) | 0)];
    let [x, y, z] = [0, 0, 0];
    for (let m = first[own[v]]; m < first[own[v] + 1]; m++) {
      const o = 3 * around[m];
      const cosine = flat[o] * flat[t] + flat[o + 1] * flat[t + 1] + flat[o + 2] * flat[t + 2];
      if (cosine <= SHARP * long[around[m]] * long[t / 3]) continue;
      x += flat[o];
      y += flat[o + 1];
      z += flat[o + 2];
    }
    const size = Math.hypot(x, y, z) || 1;
    triangles.corner(places[3 * v], places[3 * v + 1], places[3 * v + 2], x / size, y / size, z / size);
  }
}

/** Reads the meshes of tools and solids, in their order. */
function readMeshes(head) {
  const d = head.data;
  const { places } = head.meshes;
  let [vertex, corner] = [0, 0];
  const mesh = ({ vertices, triangles }, into) => {
    const own = new Float32Array(3 * vertices);
    const keys = new Float64Array(vertices);
    const steps = ["mesh.x", "mesh.y", "mesh.z"].map((name) => d[name]);
    for (let v = 0; v < vertices; v++) {
      for (let k = 0; k < 3; k++) own[3 * v + k] = places[k].from + steps[k][vertex + v] * places[k].step;
      keys[v] = (steps[0][vertex + v] * 65536 + steps[1][vertex + v]) * 65536 + steps[2][vertex + v];
    }
    shaded(own, keys, d["mesh.corners"].subarray(corner, corner + 3 * triangles), into);
    vertex += vertices;
    corner += 3 * triangles;
    return into;
  };
  const shapes = (list) => {
    const all = new Triangles();
    for (const shape of list) {
      if (shape.profile) revolved(shape.profile, all);
      else mesh(shape.mesh, all);
    }
    return all;
  };
  const tools = head.meshes.tools.map((tool) => ({ name: tool.name, cutter: shapes(tool.cutter), bodies: shapes(tool.bodies) }));
  // The fixtures of each set-up by themselves.
  const solids = { stock: new Triangles(), target: new Triangles(), fixture: new Triangles() };
  const bodies = [];
  for (const solid of head.meshes.solids) {
    if (solid.kind === "body") {
      bodies.push({ link: solid.link, triangles: mesh(solid, new Triangles()) });
      continue;
    }
    const name = solid.setup == null ? solid.kind : `${solid.kind} ${solid.setup}`;
    mesh(solid, (solids[name] ??= new Triangles()));
  }
  return { tools, solids, bodies };
}

/** The way of the tools, and where they are at a time. */
class Track {
  constructor(head) {
    const d = head.data;
    const { clock, tip } = head.track;
    this.count = d["track.clock"].length;
    this.unit = head.track.unit;
    this.clocks = Float64Array.from(d["track.clock"], (n) => clock.from + n * clock.step);
    this.tips = ["track.x", "track.y", "track.z"].map((name, k) => Float32Array.from(d[name], (n) => tip[k].from + n * tip[k].step));
    [this.u, this.v] = [d["track.u"], d["track.v"]];
    this.moves = d["track.move"];
    this.flags = d["track.flags"];
    this.tools = d["track.tool"];
    this.files = d["moves.file"];
    this.lines = d["moves.line"];
    this.end = this.clocks[this.count - 1] ?? 0;
  }

  tip(n) {
    return [this.tips[0][n], this.tips[1][n], this.tips[2][n]];
  }

  axis(n) {
    return fromOctahedron(this.u[n] / 32767, this.v[n] / 32767);
  }

  isRapid(n) {
    return (this.flags[n] & 1) !== 0;
  }

  begins(n) {
    return (this.flags[n] & 2) !== 0;
  }

  /** Tip, axis, move and tool at a time. */
  at(clock) {
    let [low, high] = [0, this.count - 1];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.clocks[middle] < clock - 1e-9) low = middle + 1;
      else high = middle;
    }
    const after = low;
    const before = after > 0 && !this.begins(after) ? after - 1 : after;
    const span = this.clocks[after] - this.clocks[before];
    const t = span > 0 ? Math.min(Math.max((clock - this.clocks[before]) / span, 0), 1) : 1;
    return {
      tip: mix(this.tip(before), this.tip(after), t),
      axis: unit(mix(this.axis(before), this.axis(after), t)),
      move: this.moves[after],
      tool: this.tools[after],
      rapid: this.isRapid(after),
    };
  }
}
