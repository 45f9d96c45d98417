// Material on lines: the part at the end, and the workpiece at any moment of the program.

/** The value of a deviation that is not known. */
const UNKNOWN = -32768;
/** Numbers of an interval of a course: both ends, the moments that made them, and their deviations. */
const STRIDE = 6;

/** Lines with their intervals: `first[n]` to `first[n + 1]` are those of line n, heights in steps. */
class Layer {
  constructor(head, scale, counts, lower, upper) {
    [this.nx, this.ny] = head.cells;
    this.min = head.min;
    this.spacing = [0, 1].map((k) => (head.max[k] - head.min[k]) / head.cells[k]);
    this.scale = scale;
    this.first = new Uint32Array(counts.length + 1);
    for (let n = 0; n < counts.length; n++) this.first[n + 1] = this.first[n] + counts[n];
    this.lower = lower;
    this.upper = upper;
  }

  /** The height of an end. */
  height(steps) {
    return this.scale.from + steps * this.scale.step;
  }

  /** Column and row of the line nearest to a point in the lines' frame, or null. */
  nearest([x, y]) {
    const i = Math.floor((x - this.min[0]) / this.spacing[0]);
    const j = Math.floor((y - this.min[1]) / this.spacing[1]);
    return i >= 0 && j >= 0 && i < this.nx && j < this.ny ? [i, j] : null;
  }
}

/** The part at the end, with all that is known of its surface. */
function finalLayer(head) {
  const d = head.data;
  const layer = new Layer(head.part, head.height, d["part.counts"], d.lower, d.upper);
  layer.makers = [d["lower.maker"], d["upper.maker"]];
  if (d["upper.u"]) layer.normals = [[d["lower.u"], d["lower.v"]], [d["upper.u"], d["upper.v"]]];
  if (head.deviation) {
    layer.deviations = [d["lower.deviation"], d["upper.deviation"]];
    layer.deviationStep = head.deviation;
  }
  return layer;
}

/** How many of these moments have passed at a time. */
function momentAt(clocks, clock) {
  let [low, high] = [0, clocks.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (clocks[middle] <= clock + 1e-9) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** The workpiece at the moments of the program, on lines. Ends carry the moment that made them, 0 for the stock. */
class Course {
  constructor(head) {
    const d = head.data;
    this.head = head;
    this.clocks = head.course.clocks;
    this.start = new Layer(head.course.layer, head.height, d["start.counts"], d["start.lower"], d["start.upper"]);
    this.offsets = [];
    let [line, interval] = [0, 0];
    for (const size of d["frames.size"]) {
      this.offsets.push([line, interval]);
      for (let end = line + size; line < end; line++) interval += d["frames.counts"][line];
    }
    this.offsets.push([line, interval]);
    const { start } = this;
    const deviation = ["start.lower.deviation", "start.upper.deviation"].map((name) => d[name]);
    this.begin = Array.from({ length: start.nx * start.ny }, (_, n) => {
      const own = [];
      for (let k = start.first[n]; k < start.first[n + 1]; k++) own.push(start.lower[k], start.upper[k], 0, 0, deviation[0]?.[k] ?? UNKNOWN, deviation[1]?.[k] ?? UNKNOWN);
      return own;
    });
    this.reset();
  }

  reset() {
    this.moment = 0;
    this.lines = this.begin.slice();
  }

  /** Goes to a moment: forwards from the present one, or from the start. */
  seek(moment) {
    if (moment < this.moment) this.reset();
    const d = this.head.data;
    for (; this.moment < moment; this.moment++) {
      let [at, k] = this.offsets[this.moment];
      const end = this.offsets[this.moment + 1][0];
      for (; at < end; at++) {
        const before = this.lines[d["frames.line"][at]];
        const own = [];
        for (let n = 0; n < d["frames.counts"][at]; n++, k++) {
          const [lower, upper] = [d["frames.lower"][k], d["frames.upper"][k]];
          const maker = (z, which) => {
            for (let m = which; m < before.length; m += STRIDE) if (before[m] === z) return before[m + 2];
            return this.moment + 1;
          };
          own.push(lower, upper, maker(lower, 0), maker(upper, 1), d["frames.lower.deviation"]?.[k] ?? UNKNOWN, d["frames.upper.deviation"]?.[k] ?? UNKNOWN);
        }
        this.lines[d["frames.line"][at]] = own;
      }
    }
  }

  /** The workpiece as a layer. Where it is as at the end already, it looks as at the end. */
  layer(final) {
    const counts = this.lines.map((line) => line.length / STRIDE);
    const total = counts.reduce((a, b) => a + b, 0);
    const [lower, upper] = [new Uint16Array(total), new Uint16Array(total)];
    const layer = new Layer(this.head.course.layer, this.head.height, counts, lower, upper);
    layer.moments = [new Uint32Array(total), new Uint32Array(total)];
    layer.deviations = [new Int16Array(total), new Int16Array(total)];
    layer.deviationStep = this.head.deviation;
    const same = final && final.nx === layer.nx && final.ny === layer.ny;
    if (same) layer.asFinal = [new Int32Array(total).fill(-1), new Int32Array(total).fill(-1)];
    let k = 0;
    this.lines.forEach((line, n) => {
      for (let m = 0; m < line.length; m += STRIDE, k++) {
        [lower[k], upper[k]] = [line[m], line[m + 1]];
        for (const side of [0, 1]) [layer.moments[side][k], layer.deviations[side][k]] = [line[m + 2 + side], line[m + 4 + side]];
        if (!same) continue;
        for (let f = final.first[n]; f < final.first[n + 1]; f++) {
          if (Math.abs(final.lower[f] - lower[k]) <= 1) layer.asFinal[0][k] = f;
          if (Math.abs(final.upper[f] - upper[k]) <= 1) layer.asFinal[1][k] = f;
        }
      }
    });
    if (same) layer.final = final;
    return layer;
  }
}
