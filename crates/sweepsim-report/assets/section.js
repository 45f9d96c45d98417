// The plane of a section: along an axis or turned at will, moved by its slider, or dragged and turned in the picture.

class Section {
  constructor(viewer) {
    this.viewer = viewer;
    this.normal = null;
  }

  get isOn() {
    return this.normal !== null;
  }

  off() {
    this.normal = null;
  }

  /** The plane across an axis or a direction, in the middle of the part; material on the side of the normal is cut away. */
  across(normal) {
    this.normal = unit(normal);
    const { low, high } = this.viewer.camera;
    this.at = dot(this.normal, mix(low, high, 0.5));
  }

  /** The plane as a normal and its distance from the origin along it; null if there is none. */
  get plane() {
    return this.isOn ? [this.normal, this.at] : null;
  }

  /** The least and the greatest place of the plane at which it meets the box around the part. */
  get range() {
    const { low, high } = this.viewer.camera;
    const ends = this.normal.map((c, k) => [c * low[k], c * high[k]]);
    return [0, 1].map((side) => ends.reduce((sum, pair) => sum + (side ? Math.max(...pair) : Math.min(...pair)), 0));
  }

  get share() {
    const [from, to] = this.range;
    return to > from ? (this.at - from) / (to - from) : 0.5;
  }

  set share(share) {
    const [from, to] = this.range;
    this.at = from + (to - from) * share;
  }

  flip() {
    [this.normal, this.at] = [scaled(this.normal, -1), -this.at];
  }

  /** Where the handle is: on the plane, as near to the middle of the part as can be. */
  get handle() {
    const { low, high } = this.viewer.camera;
    const middle = mix(low, high, 0.5);
    return add(middle, scaled(this.normal, this.at - dot(this.normal, middle)));
  }

  /** The end of the arrow by which the plane is turned. */
  get tip() {
    return add(this.handle, scaled(this.normal, this.arm));
  }

  get arm() {
    return 0.16 * this.viewer.camera.distance;
  }

  /** Moves the plane by as much as the pointer goes along the arrow. */
  drag(dx, dy) {
    const [a, b] = [this.handle, this.tip].map((p) => this.viewer.onCanvas(p));
    if (!a || !b) return;
    const [ux, uy] = [b[0] - a[0], b[1] - a[1]];
    const square = ux * ux + uy * uy;
    // Seen along the arrow, there is no way: up is out.
    const way = square > 100 ? (dx * ux + dy * uy) / square : -dy / 100;
    const [from, to] = this.range;
    this.at = Math.min(Math.max(this.at + way * this.arm, from), to);
  }

  /** Turns the plane about its handle so that the arrow points to a pixel: on the near half of a ball. */
  turn(x, y) {
    const { viewer, handle, arm } = this;
    const { origin, towards } = viewer.ray(x, y);
    const from = sub(origin, handle);
    const [b, c] = [dot(from, towards), dot(from, from) - arm * arm];
    const root = b * b - c;
    const hit = add(from, scaled(towards, root > 0 ? -b - Math.sqrt(root) : -b));
    this.normal = unit(hit);
    this.at = dot(this.normal, handle);
  }

  /** Turns the plane by an angle about the vertical and about a level axis: by keys. */
  tilt(about, up) {
    const [x, y, z] = this.normal;
    const [azimuth, elevation] = [Math.atan2(y, x) + about, Math.min(Math.max(Math.asin(z) + up, -1.57), 1.57)];
    const { handle } = this;
    this.normal = [Math.cos(elevation) * Math.cos(azimuth), Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation)];
    this.at = dot(this.normal, handle);
  }
}
