// From intervals on lines to triangles: top and bottom faces that follow the surface where neighbours belong together, and walls where they do not.

/** Quads that grow. Each has four corners, normals of one byte a coordinate, and the end of the interval it belongs to (−1: a wall of unknown making). */
class Quads {
  constructor(most) {
    this.count = 0;
    this.reserve(most);
  }

  reserve(most) {
    const grown = (type, old, n) => {
      const next = new type(n);
      if (old) next.set(old);
      return next;
    };
    this.most = most;
    this.places = grown(Float32Array, this.places, 12 * most);
    this.normals = grown(Int8Array, this.normals, 16 * most);
    this.ends = grown(Int32Array, this.ends, most);
  }

  /** The place of a new quad. */
  next(end) {
    if (this.count === this.most) this.reserve(Math.ceil(this.most * 1.6) + 64);
    this.ends[this.count] = end;
    return this.count++;
  }

  /** The corners of two triangles a quad. */
  corners() {
    const indices = new Uint32Array(6 * this.count);
    for (let q = 0; q < this.count; q++) {
      const v = 4 * q;
      indices.set([v, v + 1, v + 2, v, v + 2, v + 3], 6 * q);
    }
    return indices;
  }

  corner(quad, k, x, y, z, nx, ny, nz) {
    const p = 12 * quad + 3 * k;
    this.places[p] = x;
    this.places[p + 1] = y;
    this.places[p + 2] = z;
    const n = 16 * quad + 4 * k;
    this.normals[n] = nx * 127;
    this.normals[n + 1] = ny * 127;
    this.normals[n + 2] = nz * 127;
  }
}

// The corners of a cell, and their neighbours across x, across both, and across y.
const CORNERS = [[-1, -1], [1, -1], [1, 1], [-1, 1]];

/** A surface in the lines' frame; the ends' numbers are `2 · interval + (0 lower | 1 upper)`. */
function surfaceOf(layer) {
  const { nx, ny, first, spacing, min } = layer;
  const [dx, dy] = spacing;
  const total = first[nx * ny];
  const z = [new Float32Array(total), new Float32Array(total)];
  for (let k = 0; k < total; k++) {
    z[0][k] = layer.height(layer.lower[k]);
    z[1][k] = layer.height(layer.upper[k]);
  }
  const { normals: known, guessed } = normalsOf(layer, z);
  // Eight corners an interval, lower then upper: height, shifts from the cell's corner, normal.
  const corner = new Float32Array(total * 8 * 3);
  const bent = new Int8Array(total * 8 * 3);

  /** The interval on line (i, j) whose end `side` continues that of interval k of (i0, j0), or −1. */
  const continues = (side, k, i, j, a, b) => {
    if (i < 0 || j < 0 || i >= nx || j >= ny) return -1;
    const n = i * ny + j;
    const own = z[side][k];
    let best = -1;
    let nearest = Infinity;
    for (let m = first[n]; m < first[n + 1]; m++) {
      if (z[1][m] < z[0][k] || z[0][m] > z[1][k]) continue; // must overlap
      const gap = Math.abs(z[side][m] - own);
      if (gap < nearest) [nearest, best] = [gap, m];
    }
    if (best < 0) return -1;
    // What the slopes of both ends predict, with some room; where slopes are guessed, up to 50°.
    const run = Math.hypot(a * dx, b * dy);
    const slope = (m) => {
      const s = 3 * (2 * m + side);
      const up = Math.max(Math.abs(known[s + 2]), 0.12);
      return -(known[s] * a * dx + known[s + 1] * b * dy) / (known[s + 2] < 0 ? -up : up);
    };
    const [from, to] = [slope(k), slope(best)];
    const expected = 0.5 * (from + to);
    let room = 0.25 * run + 0.6 * Math.abs(from - to) + 0.3 * Math.abs(expected);
    if (guessed[2 * k + side] || guessed[2 * best + side]) room = Math.max(room, 1.2 * run - Math.abs(expected));
    return Math.abs(z[side][best] - own - expected) <= room ? best : -1;
  };

  /** Whether an end and those of the eight neighbours are at one height, and upright: most are. */
  const isFlat = (side, k, i, j) => {
    if (i < 1 || j < 1 || i > nx - 2 || j > ny - 2) return false;
    const steps = side ? layer.upper : layer.lower;
    for (let n = (i - 1) * ny + j; n <= (i + 1) * ny + j; n += ny)
      for (let m = n - 1; m <= n + 1; m++) {
        const f = first[m];
        if (first[m + 1] !== f + 1 || steps[f] !== steps[k]) return false;
        if (Math.abs(known[3 * (2 * f + side) + 2]) < 0.9999) return false;
      }
    return true;
  };

  /** Whether the cells around a corner that do not continue an end are at one height: only then do both sides agree on the outline. */
  const hasTwoLevels = (side, k, ring, [i, j, a, b]) => {
    const lines = [i * ny + j, (i + a) * ny + j, (i + a) * ny + j + b, i * ny + j + b];
    const room = 1.2 * Math.max(dx, dy);
    let other = null;
    for (let r = 0; r < 4; r++) {
      const n = lines[r];
      const many = first[n + 1] - first[n];
      if (many > 1) return false;
      if (ring[r] >= 0) {
        if (Math.abs(z[side][ring[r]] - z[side][k]) > room) return false;
        continue;
      }
      const height = many ? z[side][first[n]] : -Infinity;
      if (other !== null && height !== other && !(Math.abs(height - other) <= room)) return false;
      other ??= height;
    }
    return true;
  };

  for (let i = 0; i < nx; i++)
    for (let j = 0; j < ny; j++)
      for (let k = first[i * ny + j]; k < first[i * ny + j + 1]; k++)
        for (let side = 0; side < 2; side++) {
          const at = 3 * (8 * k + 4 * side);
          if (isFlat(side, k, i, j)) {
            for (let c = 0; c < 12; c += 3) {
              corner[at + c] = z[side][k];
              bent[at + c + 2] = side ? 127 : -127;
            }
            continue;
          }
          // The eight neighbours, once each.
          const near = [];
          for (let a = -1; a <= 1; a++) for (let b = -1; b <= 1; b++) near.push(a || b ? continues(side, k, i + a, j + b, a, b) : k);
          CORNERS.forEach(([a, b], c) => {
            const ring = [k, near[(a + 1) * 3 + 1], near[(a + 1) * 3 + b + 1], near[3 + b + 1]];
            let [sum, count, px, py, pz] = [0, 0, 0, 0, 0];
            ring.forEach((m, r) => {
              if (m < 0) return;
              let own = z[side][m];
              const s = 3 * (2 * m + side);
              const [sx, sy] = [r === 0 || r === 3 ? a : -a, r === 0 || r === 1 ? b : -b];
              const up = known[s + 2];
              if (Math.abs(up) > 0.3) own -= (known[s] * sx * dx + known[s + 1] * sy * dy) / (2 * up);
              px += known[s];
              py += known[s + 1];
              pz += known[s + 2];
              sum += own;
              count++;
            });
            // Between cells that belong together and others, the outline runs through the middles between lines.
            let [mx, my] = [0, 0];
            let crossings = 0;
            const inside = i + a >= 0 && i + a < nx && j + b >= 0 && j + b < ny;
            if (inside && count < 4 && hasTwoLevels(side, k, ring, [i, j, a, b])) {
              const offsets = [[0, -b], [a, 0], [0, b], [-a, 0]];
              for (let r = 0; r < 4; r++)
                if (ring[r] < 0 !== ring[(r + 1) % 4] < 0) {
                  mx += offsets[r][0];
                  my += offsets[r][1];
                  crossings++;
                }
            }
            const p = at + 3 * c;
            corner[p] = sum / count;
            corner[p + 1] = crossings ? (0.5 * mx) / crossings : 0;
            corner[p + 2] = crossings ? (0.5 * my) / crossings : 0;
            const long = Math.hypot(px, py, pz) || 1;
            bent[p] = (127 * px) / long;
            bent[p + 1] = (127 * py) / long;
            bent[p + 2] = (127 * pz) / long;
          });
        }
  const quads = new Quads(2 * total + 4 * (nx + ny) + 64);
  const x = (i, a, at) => min[0] + (i + 0.5 + 0.5 * a + corner[at + 1]) * dx;
  const y = (j, b, at) => min[1] + (j + 0.5 + 0.5 * b + corner[at + 2]) * dy;
  faces(layer, quads, corner, bent, x, y);
  walls(layer, quads, corner, x, y, z);
  return quads;
}

/** Top and bottom faces. Flat ones of one making are joined along a column. */
function faces(layer, quads, corner, bent, x, y) {
  const { nx, ny, first } = layer;
  for (let i = 0; i < nx; i++) {
    const run = [null, null];
    for (let j = 0; j < ny; j++) {
      const n = i * ny + j;
      const single = first[n + 1] - first[n] === 1;
      for (let k = first[n]; k < first[n + 1]; k++)
        for (let side = 0; side < 2; side++) {
          const end = 2 * k + side;
          const at = 3 * (8 * k + 4 * side);
          const look = layer.look ? layer.look(end) : 0;
          let flat = single;
          for (let c = 0; c < 4 && flat; c++) {
            const p = at + 3 * c;
            flat = corner[p] === corner[at] && corner[p + 1] === 0 && corner[p + 2] === 0 && Math.abs(bent[p + 2]) > 126;
          }
          const before = run[side];
          if (flat && before && before.j === j - 1 && before.z === corner[at] && before.look === look) {
            // Corners 2 and 3 move on by a row.
            for (const c of [2, 3]) {
              const slot = side ? c : 3 - c;
              quads.places[12 * before.quad + 3 * slot + 1] = y(j, 1, at + 3 * c) + SEAM * layer.spacing[1];
            }
            before.j = j;
            continue;
          }
          const quad = quads.next(end);
          for (let c = 0; c < 4; c++) {
            const p = at + 3 * c;
            const slot = side ? c : 3 - c;
            const [a, b] = CORNERS[c];
            const scale = 1 / 127;
            quads.corner(quad, slot, x(i, a, p), y(j, b, p), corner[p], bent[p] * scale, bent[p + 1] * scale, bent[p + 2] * scale);
          }
          // Joined faces meet others along their sides: a little wider, they leave no seam.
          if (flat) widened(quads, quad, layer.spacing);
          run[side] = flat ? { quad, j, z: corner[at], look } : null;
        }
    }
  }
}

/** By how much joined faces overlap others, in cells. */
const SEAM = 0.012;

/** Moves the corners of a flat quad outwards. */
function widened(quads, quad, [dx, dy]) {
  const p = quads.places.subarray(12 * quad, 12 * quad + 12);
  const [cx, cy] = [0, 1].map((k) => (p[k] + p[3 + k] + p[6 + k] + p[9 + k]) / 4);
  for (let c = 0; c < 12; c += 3) {
    p[c] += Math.sign(p[c] - cx) * SEAM * dx;
    p[c + 1] += Math.sign(p[c + 1] - cy) * SEAM * dy;
  }
}

// The four sides of a cell: the neighbour's step, and the two corners there, counter-clockwise seen from outside the cell.
const SIDES = [
  { step: [-1, 0], own: [3, 0], other: [2, 1] },
  { step: [1, 0], own: [1, 2], other: [0, 3] },
  { step: [0, -1], own: [0, 1], other: [3, 2] },
  { step: [0, 1], own: [2, 3], other: [1, 0] },
];

/** Upright faces between the material of a line and the air of its neighbour. */
function walls(layer, quads, corner, x, y, z) {
  const { nx, ny, first } = layer;
  const [dx, dy] = layer.spacing;
  const solid = (i, j, height) => {
    if (i < 0 || j < 0 || i >= nx || j >= ny) return 0;
    const n = i * ny + j;
    for (let m = first[n]; m < first[n + 1]; m++) if (z[0][m] <= height && height <= z[1][m]) return 1;
    return 0;
  };
  /** The way out of the material around (i, j) at a height, seen from a few cells away. */
  const outwards = (i, j, [a, b], height) => {
    const edge = i + a < 0 || j + b < 0 || i + a >= nx || j + b >= ny;
    if (edge) return [a, b, 0];
    let [gx, gy] = [0, 0];
    for (let p = -2; p <= 2; p++)
      for (let q = -2; q <= 2; q++) {
        const far = Math.hypot(p - 0.5 * a, q - 0.5 * b);
        if (far > 2.6) continue;
        const full = solid(Math.min(Math.max(i + p, 0), nx - 1), Math.min(Math.max(j + q, 0), ny - 1), height);
        gx -= (full * (p - 0.5 * a)) / dx;
        gy -= (full * (q - 0.5 * b)) / dy;
      }
    const normal = unit([gx, gy, 0]);
    return normal[0] * a + normal[1] * b > 0.2 ? normal : [a, b, 0];
  };
  for (let i = 0; i < nx; i++)
    for (let j = 0; j < ny; j++)
      for (const { step, own, other } of SIDES) {
        const [u, v] = [i + step[0], j + step[1]];
        const within = u >= 0 && v >= 0 && u < nx && v < ny;
        const n = u * ny + v;
        for (let k = first[i * ny + j]; k < first[i * ny + j + 1]; k++) {
          const mine = (side) => own.map((c) => ({ cell: [i, j], c, at: 3 * (8 * k + 4 * side + c) }));
          const theirs = (m, side) => other.map((c) => ({ cell: [u, v], c, at: 3 * (8 * m + 4 * side + c) }));
          const mean = (edge) => 0.5 * (corner[edge[0].at] + corner[edge[1].at]);
          const emit = (low, high, end) => {
            const [from, to] = [mean(low), mean(high)];
            if (to - from < 1e-6 * (Math.abs(to) + 1)) return;
            const normal = outwards(i, j, step, 0.5 * (from + to));
            const quad = quads.next(end);
            [low[0], low[1], high[1], high[0]].forEach(({ cell, c, at }, slot) => {
              const [a, b] = CORNERS[c];
              quads.corner(quad, slot, x(cell[0], a, at), y(cell[1], b, at), corner[at], ...normal);
            });
          };
          let [cursor, maker] = [mine(0), -1];
          const top = mine(1);
          if (within)
            for (let m = first[n]; m < first[n + 1]; m++) {
              const [low, high] = [theirs(m, 0), theirs(m, 1)];
              if (mean(high) <= mean(cursor)) {
                maker = 2 * m + 1;
                continue;
              }
              if (mean(low) >= mean(top)) {
                if (maker < 0) maker = 2 * m;
                break;
              }
              emit(cursor, low, maker < 0 ? 2 * m : maker);
              [cursor, maker] = [high, 2 * m + 1];
            }
          // A wall at the edge of all lines, or through to the bottom: of the stock, or of an unknown making.
          emit(cursor, top, maker < 0 ? (within ? -2 : -1) : maker);
        }
      }
}

/** Unit normals of all ends, three numbers each: those that are stored; elsewhere from the slopes to neighbours at nearly the same height. */
function normalsOf(layer, z) {
  const { nx, ny, first, spacing } = layer;
  const total = layer.lower.length;
  const source = layer.final ?? layer;
  const normals = new Float32Array(6 * total);
  const guessed = new Uint8Array(2 * total);
  /** The slope from an end along an axis. */
  const slope = (side, k, n, step, within, run) => {
    let [sum, count] = [0, 0];
    for (const way of [-1, 1]) {
      if (!within(way)) continue;
      for (let m = first[n + way * step]; m < first[n + way * step + 1]; m++) {
        const rise = z[side][m] - z[side][k];
        if (Math.abs(rise) > 1.3 * run) continue;
        sum += (way * rise) / run;
        count++;
        break;
      }
    }
    return count ? sum / count : 0;
  };
  for (let i = 0; i < nx; i++)
    for (let j = 0; j < ny; j++) {
      const n = i * ny + j;
      for (let k = first[n]; k < first[n + 1]; k++)
        for (let side = 0; side < 2; side++) {
          const from = layer.final ? layer.asFinal[side][k] : layer.moments ? -1 : k;
          if (source.normals && from >= 0) {
            const [u, v] = source.normals[side];
            normals.set(fromOctahedron(u[from] / 127, v[from] / 127), 6 * k + 3 * side);
            continue;
          }
          const sx = slope(side, k, n, ny, (way) => i + way >= 0 && i + way < nx, spacing[0]);
          const sy = slope(side, k, n, 1, (way) => j + way >= 0 && j + way < ny, spacing[1]);
          const out = side ? 1 : -1;
          const long = Math.hypot(sx, sy, 1) * out;
          normals.set([-sx / long, -sy / long, 1 / long], 6 * k + 3 * side);
          guessed[2 * k + side] = 1;
        }
    }
  return { normals, guessed };
}
