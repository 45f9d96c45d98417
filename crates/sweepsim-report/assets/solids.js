// Tools, fixtures, the stock and the target as triangles.

/** Triangles with normals for each corner: sharp edges stay sharp. */
class Triangles {
  constructor() {
    this.places = [];
    this.normals = [];
  }

  push(corners, normals) {
    for (let k = 0; k < 3; k++) {
      this.places.push(...corners[k]);
      this.normals.push(...normals[k].map((c) => c * 127), 0);
    }
  }

  get count() {
    return this.places.length / 3;
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

/** A mesh, smooth but for its sharp edges. */
function shaded(vertices, corners, triangles) {
  const flat = [];
  const around = new Map();
  const key = (v) => vertices[v].map((c) => c.toFixed(4)).join();
  const keys = vertices.map((_, v) => key(v));
  for (let t = 0; t < corners.length; t += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => vertices[corners[t + k]]);
    const area = cross(sub(b, a), sub(c, a));
    flat.push(area);
    for (let k = 0; k < 3; k++) {
      const at = keys[corners[t + k]];
      if (!around.has(at)) around.set(at, []);
      around.get(at).push(t / 3);
    }
  }
  const units = flat.map(unit);
  for (let t = 0; t < corners.length; t += 3) {
    const own = units[t / 3];
    const normals = [0, 1, 2].map((k) => {
      let sum = [0, 0, 0];
      for (const other of around.get(keys[corners[t + k]])) if (dot(units[other], own) > SHARP) sum = add(sum, flat[other]);
      return unit(sum);
    });
    triangles.push([0, 1, 2].map((k) => vertices[corners[t + k]]), normals);
  }
}

/** Reads the meshes of tools and solids, in their order. */
function readMeshes(head) {
  const d = head.data;
  const { places } = head.meshes;
  let [vertex, corner] = [0, 0];
  const mesh = ({ vertices, triangles }, into) => {
    const own = [];
    for (let v = vertex; v < vertex + vertices; v++) {
      own.push(["mesh.x", "mesh.y", "mesh.z"].map((name, k) => places[k].from + d[name][v] * places[k].step));
    }
    shaded(own, d["mesh.corners"].subarray(corner, corner + 3 * triangles), into);
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
