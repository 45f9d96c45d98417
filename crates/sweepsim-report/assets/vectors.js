// Vectors of three numbers, and matrices of sixteen, column by column.

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const size = (a) => Math.hypot(a[0], a[1], a[2]);
const unit = (a) => scaled(a, 1 / (size(a) || 1));
const mix = (a, b, t) => a.map((x, k) => x + (b[k] - x) * t);

const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

function product(a, b) {
  const c = new Array(16).fill(0);
  for (let i = 0; i < 4; i++)
    for (let j = 0; j < 4; j++) for (let k = 0; k < 4; k++) c[4 * j + i] += a[4 * k + i] * b[4 * j + k];
  return c;
}

/** The inverse of a turn and a shift. */
function inverted(m) {
  const row = (i) => [m[4 * i], m[4 * i + 1], m[4 * i + 2]];
  const [a, b, c, o] = [0, 1, 2, 3].map(row);
  return [a[0], b[0], c[0], 0, a[1], b[1], c[1], 0, a[2], b[2], c[2], 0, -dot(a, o), -dot(b, o), -dot(c, o), 1];
}

/** A point under a matrix, with its fourth coordinate. */
function transformed(m, p) {
  const row = (i) => m[i] * p[0] + m[4 + i] * p[1] + m[8 + i] * p[2] + m[12 + i];
  return [row(0), row(1), row(2), row(3)];
}

/** The matrix with the given axes and origin. */
const framed = ([o, x, y, z]) => [...x, 0, ...y, 0, ...z, 0, ...o, 1];

/** From the world to a camera at `eye` that looks at `centre`. */
function lookAt(eye, centre, up) {
  const back = unit(sub(eye, centre));
  const right = unit(cross(up, back));
  const top = cross(back, right);
  return [
    right[0], top[0], back[0], 0,
    right[1], top[1], back[1], 0,
    right[2], top[2], back[2], 0,
    -dot(right, eye), -dot(top, eye), -dot(back, eye), 1,
  ];
}

function perspective(angle, aspect, near, far) {
  const f = 1 / Math.tan(angle / 2);
  return [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0];
}

/** A unit vector from two numbers in [−1, 1]: an octahedron, unfolded. */
function fromOctahedron(u, v) {
  const z = 1 - Math.abs(u) - Math.abs(v);
  if (z >= 0) return unit([u, v, z]);
  const folded = (a, b) => (1 - Math.abs(b)) * (a < 0 || Object.is(a, -0) ? -1 : 1);
  return unit([folded(u, v), folded(v, u), z]);
}
