// Where a ray meets triangles.

/** Triangles of one box, which a ray may miss altogether. */
const BLOCK = 64;

class Solid {
  /** Places, three numbers each; the corners of triangles, or null if each three places are one; and from the solid's frame to the world. */
  constructor(places, corners, model) {
    const count = (corners ? corners.length : places.length / 3) / 3;
    Object.assign(this, { places, corners, count, model: model ?? IDENTITY });
    this.boxes = null;
  }

  corner(triangle, k) {
    const v = 3 * (this.corners ? this.corners[3 * triangle + k] : 3 * triangle + k);
    return [this.places[v], this.places[v + 1], this.places[v + 2]];
  }

  /** Boxes of blocks, made when the first ray asks. */
  prepare() {
    const blocks = Math.ceil(this.count / BLOCK);
    this.boxes = new Float32Array(6 * blocks);
    for (let b = 0; b < blocks; b++) {
      const box = this.boxes.subarray(6 * b, 6 * b + 6);
      box.set([Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity]);
      const end = 3 * Math.min((b + 1) * BLOCK, this.count);
      for (let n = 3 * b * BLOCK; n < end; n++) {
        const v = 3 * (this.corners ? this.corners[n] : n);
        for (let k = 0; k < 3; k++) {
          const c = this.places[v + k];
          if (c < box[k]) box[k] = c;
          if (c > box[3 + k]) box[3 + k] = c;
        }
      }
    }
  }

  /** The first triangle that a ray of the world meets between two distances: distance, triangle, shares of its second and third corner, and normal. */
  first(origin, towards, [from, to]) {
    if (!this.boxes) this.prepare();
    const world = inverted(this.model);
    const o = transformed(world, origin).slice(0, 3);
    const d = sub(transformed(world, add(origin, towards)).slice(0, 3), o);
    let [best, hit] = [to, null];
    for (let b = 0; 6 * b < this.boxes.length; b++) {
      let [near, far] = [from, best];
      for (let k = 0; k < 3; k++) {
        const [low, high] = [this.boxes[6 * b + k] - 1e-4, this.boxes[6 * b + 3 + k] + 1e-4];
        if (d[k] === 0) {
          if (o[k] < low || o[k] > high) far = -Infinity;
          continue;
        }
        const [one, other] = [(low - o[k]) / d[k], (high - o[k]) / d[k]];
        near = Math.max(near, Math.min(one, other));
        far = Math.min(far, Math.max(one, other));
      }
      if (near > far) continue;
      const end = Math.min((b + 1) * BLOCK, this.count);
      for (let t = b * BLOCK; t < end; t++) {
        const found = meets(o, d, this.corner(t, 0), this.corner(t, 1), this.corner(t, 2));
        if (!found || found[0] < from || found[0] >= best) continue;
        best = found[0];
        hit = { far: best, triangle: t, u: found[1], v: found[2], solid: this };
      }
    }
    if (hit) {
      const [a, b, c] = [0, 1, 2].map((k) => this.corner(hit.triangle, k));
      const normal = unit(cross(sub(b, a), sub(c, a)));
      const zero = transformed(this.model, [0, 0, 0]).slice(0, 3);
      hit.normal = sub(transformed(this.model, normal).slice(0, 3), zero);
    }
    return hit;
  }
}

/** Distance and the shares of the second and third corner where a ray meets a triangle (Möller, Trumbore 1997). */
function meets(o, d, a, b, c) {
  const [e1x, e1y, e1z] = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
  const [e2x, e2y, e2z] = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
  const [px, py, pz] = [d[1] * e2z - d[2] * e2y, d[2] * e2x - d[0] * e2z, d[0] * e2y - d[1] * e2x];
  const det = e1x * px + e1y * py + e1z * pz;
  if (det === 0) return null;
  const [sx, sy, sz] = [o[0] - a[0], o[1] - a[1], o[2] - a[2]];
  const u = (sx * px + sy * py + sz * pz) / det;
  // A little wider, so that no ray slips through an edge.
  if (u < -1e-7 || u > 1 + 1e-7) return null;
  const [qx, qy, qz] = [sy * e1z - sz * e1y, sz * e1x - sx * e1z, sx * e1y - sy * e1x];
  const v = (d[0] * qx + d[1] * qy + d[2] * qz) / det;
  if (v < -1e-7 || u + v > 1 + 1e-7) return null;
  return [(e2x * qx + e2y * qy + e2z * qz) / det, u, v];
}

/** The part of a ray that a section leaves: from one distance to another. Material where `dot(normal, p) > at` is cut away. */
function left(origin, towards, section) {
  if (!section) return [0, Infinity];
  const [normal, at] = section;
  const [here, pace] = [dot(normal, origin) - at, dot(normal, towards)];
  if (pace === 0) return here > 0 ? [1, 0] : [0, Infinity];
  const cut = -here / pace;
  return pace < 0 ? [Math.max(cut, 0), Infinity] : [0, cut];
}
