// Measuring on the part: distances, diameters and thicknesses.

/** The circle through three points: centre, diameter and axis; null if they are in line. */
function circle([a, b, c]) {
  const [u, v] = [sub(b, a), sub(c, a)];
  const axis = cross(u, v);
  const square = dot(axis, axis);
  if (square <= 1e-9 * dot(u, u) * dot(v, v)) return null;
  const side = add(scaled(cross(v, axis), dot(u, u)), scaled(cross(axis, u), dot(v, v)));
  const out = scaled(side, 1 / (2 * square));
  return { centre: add(a, out), diameter: 2 * size(out), axis: unit(axis) };
}

/** Points on the wall of a hole or a shaft at one height: along its axis, if the normals there tell one. */
function levelled(hits) {
  const normals = hits.map((hit) => hit.normal);
  const axes = [[0, 1], [1, 2], [2, 0]].map(([a, b]) => cross(normals[a], normals[b]));
  const axis = unit(axes.reduce((best, next) => (size(next) > size(best) ? next : best)));
  const places = hits.map((hit) => hit.round);
  if (size(axis) < 0.5 || normals.some((normal) => Math.abs(dot(normal, axis)) > ACROSS)) return places;
  return places.map((p) => add(p, scaled(axis, dot(axis, sub(places[0], p)))));
}

/** The most that a normal of a wall leans along its axis. */
const ACROSS = 0.1;

/** What is measured, the points it takes, and what is asked for. */
const MEASURES = {
  distance: { points: 2, ask: ["Pick two points", "Pick the second point"] },
  diameter: { points: 3, ask: ["Pick three points on the wall of a hole or a shaft", "Pick the second point", "Pick the third point"] },
  thickness: { points: 1, ask: ["Pick a point: the thickness is that of the material below it, across the surface"] },
};

class Measuring {
  constructor(viewer) {
    this.viewer = viewer;
    this.kind = null;
    this.hits = [];
  }

  /** Begins anew with a kind of measure, or ends with null; what is asked for. */
  start(kind) {
    this.kind = kind;
    this.hits = [];
    this.viewer.measured = { points: [], lines: [], circle: null };
    return kind ? MEASURES[kind].ask[0] : "";
  }

  /** Takes a point that was picked; what it says. */
  take(hit) {
    const { kind, viewer } = this;
    const { points: wanted, ask } = MEASURES[kind];
    if (this.hits.length === wanted) this.hits = [];
    this.hits.push(hit);
    const points = this.hits.map(({ place }) => place);
    const drawn = { points, lines: [], circle: null };
    viewer.measured = drawn;
    if (points.length < wanted) return ask[points.length];
    if (kind === "distance") {
      const d = sub(points[1], points[0]);
      drawn.lines.push([...points]);
      return `${short(size(d))} mm  (${d.map(short).join(", ")})`;
    }
    if (kind === "diameter") {
      const found = circle(levelled(this.hits));
      if (!found) return "These points are in line: pick three around a circle";
      drawn.circle = found;
      return `⌀ ${short(found.diameter)} mm, centre ${found.centre.map(short).join(", ")}`;
    }
    const through = viewer.through(hit);
    if (!through) return "The surface has no other side there";
    drawn.points.push(through.place);
    drawn.lines.push([hit.place, through.place]);
    return `${short(through.far)} mm thick, along ${scaled(hit.normal, -1).map(short).join(", ")}`;
  }
}
