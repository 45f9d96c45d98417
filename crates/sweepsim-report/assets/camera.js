// The point of view: around a centre, at a distance, with z upwards. Mouse, touch and keys move it.

const FIELD = (28 * Math.PI) / 180;
const SOON = matchMedia("(prefers-reduced-motion: reduce)").matches ? 0 : 450;

/** Where the viewer stands, in degrees: around z, where −90 is the front, and above the horizon. From right above, nothing would say what is up in the picture. */
const VIEWS = { corner: [-58, 36], front: [-90, 0], back: [90, 0], left: [180, 0], right: [0, 0], above: [-90, 88.9], below: [-90, -88.9] };

/** Half the width and the height of a picture at distance 1. On narrow pictures the width is fixed, on wide ones the height. */
function halves(aspect) {
  const half = Math.tan(FIELD / 2);
  return aspect < 1 ? [half, half / aspect] : [half * aspect, half];
}

class Camera {
  constructor(low, high, aspect) {
    this.aspect = aspect;
    this.low = low;
    this.high = high;
    /** How far things reach beyond the part. */
    this.beyond = 0;
    this.home();
  }

  /** The whole scene, from one of the `VIEWS`. */
  home(view = "corner") {
    [this.azimuth, this.elevation] = VIEWS[view].map((degrees) => (degrees * Math.PI) / 180);
    this.centre = mix(this.low, this.high, 0.5);
    this.reach = 0.5 * size(sub(this.high, this.low)) || 1;
    this.flight = null;
    // As near as all corners allow.
    const { towards, low, high, centre } = this;
    const right = unit(cross([0, 0, 1], towards));
    const up = cross(towards, right);
    const [wide, tall] = halves(this.aspect);
    this.distance = 0;
    for (let n = 0; n < 8; n++) {
      const corner = sub([0, 1, 2].map((k) => ((n >> k) & 1 ? high[k] : low[k])), centre);
      const far = Math.max(Math.abs(dot(corner, right)) / wide, Math.abs(dot(corner, up)) / tall);
      this.distance = Math.max(this.distance, 1.12 * far + dot(corner, towards));
    }
  }

  /** From the centre to the eye. */
  get towards() {
    const [ce, se] = [Math.cos(this.elevation), Math.sin(this.elevation)];
    return [ce * Math.cos(this.azimuth), ce * Math.sin(this.azimuth), se];
  }

  get eye() {
    return add(this.centre, scaled(this.towards, this.distance));
  }

  matrix(aspect) {
    this.aspect = aspect;
    const angle = 2 * Math.atan(halves(aspect)[1]);
    const far = this.distance + 4 * this.reach + this.beyond + size(sub(this.centre, mix(this.low, this.high, 0.5)));
    const near = Math.max(this.distance - far + this.distance, this.distance * 0.02);
    return product(perspective(angle, aspect, Math.min(near, this.distance * 0.2), far), lookAt(this.eye, this.centre, [0, 0, 1]));
  }

  turn(dx, dy) {
    this.flight = null;
    this.azimuth -= dx;
    this.elevation = Math.min(Math.max(this.elevation + dy, -1.553), 1.553);
  }

  /** Moves the centre across the picture; `dx` and `dy` are shares of its height. */
  shift(dx, dy) {
    this.flight = null;
    const right = unit(cross([0, 0, 1], this.towards));
    const up = cross(this.towards, right);
    const far = 2 * Math.tan(FIELD / 2) * this.distance;
    this.centre = add(this.centre, add(scaled(right, -dx * far), scaled(up, dy * far)));
  }

  zoom(factor) {
    this.flight = null;
    this.distance = Math.min(Math.max(this.distance * factor, this.reach * 0.01), this.reach * 40);
  }

  /** Flies to a place. */
  fly(centre, distance, elevation) {
    const { azimuth } = this;
    this.flight = { from: { ...this }, to: { centre, distance, elevation, azimuth }, start: null };
  }

  /** The next picture of a flight; whether it goes on. */
  step(now) {
    const { flight } = this;
    if (!flight) return false;
    flight.start ??= now;
    const t = SOON ? Math.min((now - flight.start) / SOON, 1) : 1;
    const s = t * t * (3 - 2 * t);
    this.centre = mix(flight.from.centre, flight.to.centre, s);
    this.distance = flight.from.distance * (flight.to.distance / flight.from.distance) ** s;
    this.elevation = flight.from.elevation + (flight.to.elevation - flight.from.elevation) * s;
    if (t >= 1) this.flight = null;
    return true;
  }

  /** As text: for tests, and to tell whether it moved. */
  toString() {
    return [...this.centre, this.distance, this.azimuth, this.elevation].map((c) => c.toFixed(4)).join(" ");
  }
}

/** Lets a canvas move a camera. `changed` is called after each move; `clicked(x, y)` for a press without a move; `hovered(x, y)` where a mouse is without a press, and without a place when it leaves. */
function steer(canvas, camera, changed, clicked, hovered) {
  const pointers = new Map();
  let moved = 0;
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    canvas.focus({ preventScroll: true });
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    if (pointers.size === 1) moved = 0;
    event.preventDefault();
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) {
      const box = canvas.getBoundingClientRect();
      if (event.pointerType === "mouse") hovered(event.clientX - box.left, event.clientY - box.top);
      return;
    }
    const now = [event.clientX, event.clientY];
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    const tall = canvas.clientHeight;
    moved += Math.abs(dx) + Math.abs(dy);
    if (pointers.size === 1) {
      const panning = event.buttons & 6 || event.shiftKey;
      if (panning) camera.shift(dx / tall, dy / tall);
      else camera.turn(dx * 0.008, dy * 0.008);
    } else if (pointers.size === 2) {
      const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
      const [far, near] = [before, now].map((p) => Math.hypot(p[0] - other[0], p[1] - other[1]));
      if (near > 0) camera.zoom(far / near);
      camera.shift(dx / 2 / tall, dy / 2 / tall);
    }
    pointers.set(event.pointerId, now);
    changed();
  });
  const lift = (event) => {
    if (pointers.delete(event.pointerId) && event.type === "pointerup" && !pointers.size && moved < 5 && event.button === 0) {
      const box = canvas.getBoundingClientRect();
      clicked(event.clientX - box.left, event.clientY - box.top);
    }
  };
  canvas.addEventListener("pointerup", lift);
  canvas.addEventListener("pointercancel", lift);
  for (const end of ["pointerleave", "pointerdown", "wheel"]) canvas.addEventListener(end, () => hovered(), { passive: true });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      camera.zoom(Math.exp(Math.min(Math.max(event.deltaY, -120), 120) * 0.0016));
      changed();
    },
    { passive: false },
  );
  canvas.addEventListener("dblclick", () => {
    camera.home();
    changed();
  });
  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const arrow = arrows[event.key];
    if (arrow && event.shiftKey) camera.shift(-arrow[0] * 0.06, -arrow[1] * 0.06);
    else if (arrow) camera.turn(-arrow[0] * 0.12, -arrow[1] * 0.12);
    else if (event.key === "+" || event.key === "=") camera.zoom(0.85);
    else if (event.key === "-" || event.key === "_") camera.zoom(1 / 0.85);
    else if (event.key === "Home" || event.key === "0") camera.home();
    else if (event.key === "Enter" || event.key === " ") clicked(canvas.clientWidth / 2, canvas.clientHeight / 2);
    else return;
    event.preventDefault();
    changed();
  });
}
