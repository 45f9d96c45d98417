// Colours, chosen so that people with any kind of colour vision can tell them apart (Okabe and Ito 2008; ColorBrewer's PuOr; cividis).

const rgb = (hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16));

const PLAIN = rgb("#b9c0c8");
const STOCK = rgb("#aeb6bf");
const CUT = rgb("#c9a27a");
const UNMEASURED = rgb("#8d939b");
const SECTION = rgb("#7b4f72");
const FIXTURE = rgb("#56616f");
const TARGET = rgb("#3f9c8f");
const BODY = rgb("#8a929c");
const MACHINE = rgb("#7f8ea3");
const WIRE = rgb("#1c2733");
const MEETING = rgb("#d1341f");
const CUTTER = rgb("#e8b04a");

/** Tools, by number. */
const TOOLS = ["#e69f00", "#56b4e9", "#009e73", "#cc79a7", "#0072b2", "#d55e00", "#f0e442", "#8c6bb1"].map(rgb);

/** Kinds of findings, and states of proofs. */
const KINDS = { collision: "#c2410c", machine: "#c2410c", rapid: "#9333a8", fixture: "#b45309", gouge: "#be123c", excess: "#1d4ed8", proven: "#0f6b4f", refuted: "#a3160f", open: "#7a4a00" };
const OTHER_KIND = "#475569";

/** Multiples of the limits, and the colours between them: too deep on the left, too much left on the right. */
const STEPS = [-5, -2, -1, -0.5, 0.5, 1, 2, 5];
const DEVIATIONS = ["#7f2704", "#d9610c", "#fdae6b", "#ecd5b8", "#d3dadf", "#c5c9e6", "#a29ed0", "#6a51a3", "#3f007d"].map(rgb);

/** Along the program: from first to last. */
const COURSE = ["#00204c", "#31446b", "#666870", "#958f78", "#cbba69", "#ffe945"].map(rgb);

function ramp(colours, t) {
  const at = Math.min(Math.max(t, 0), 1) * (colours.length - 1);
  const k = Math.min(Math.floor(at), colours.length - 2);
  return mix(colours[k], colours[k + 1], at - k).map(Math.round);
}

/** More than any share of a limit: there is none. */
const NOT_MEASURED = 1e9;

/** A deviation in units of the limits. */
function shareOf(deviation, [gouge, excess]) {
  const limit = deviation < 0 ? gouge : excess;
  return limit > 0 ? Math.min(Math.max(deviation / limit, -1e5), 1e5) : Math.sign(deviation) * 10;
}

/** The step of a deviation in units of the limits. */
function deviationStep(deviation, limits) {
  const share = shareOf(deviation, limits);
  let step = 0;
  while (step < STEPS.length && share > STEPS[step]) step++;
  return step;
}

/** How ends are coloured: `colour(end)` gives red, green and blue, and `look(end)` a number that is the same for ends of one colour. */
class Colours {
  constructor(head, mode) {
    this.head = head;
    this.mode = mode;
    this.moves = head.paths.length ? head.paths[head.paths.length - 1][0] : 0;
    this.limits = head.limits ?? [0.1, 0.1];
  }

  /** The tool of a move, counted over the program from 0. */
  toolOf(move) {
    let [low, high] = [0, this.head.paths.length - 1];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.head.paths[middle][0] > move) high = middle;
      else low = middle + 1;
    }
    return this.head.paths[low]?.[1] ?? 0;
  }

  /** The colours of a layer's ends, by number: `2 · interval + (0 lower | 1 upper)`, −1 for the stock's sides, −2 for walls of unknown making. */
  of(layer, track) {
    const { mode } = this;
    const source = layer.final ?? layer;
    const final = (end) => (layer.final ? layer.asFinal[end & 1][end >> 1] : layer.moments ? -1 : end >> 1);
    const maker = (end) => {
      if (end < 0) return end === -1 ? 0 : -1;
      const k = final(end);
      if (k >= 0 && source.makers) return source.makers[end & 1][k];
      const moment = layer.moments?.[end & 1][end >> 1] ?? 0;
      return moment && track ? track.at(this.clocks[moment - 1]).move + 1 : moment;
    };
    if (mode === "deviation") {
      // Those of a moment are its own.
      const known = layer.moments ? layer : source;
      const place = layer.moments ? (end) => end >> 1 : final;
      return (end) => {
        const k = end < 0 ? -1 : place(end);
        const steps = k < 0 ? UNKNOWN : known.deviations?.[end & 1][k] ?? UNKNOWN;
        if (steps === UNKNOWN) return UNMEASURED;
        return DEVIATIONS[deviationStep(steps * known.deviationStep, this.limits)];
      };
    }
    return (end) => this.ofMaker(maker(end));
  }

  /** The colour of what the stock left (0), a move made (1 plus its number), or something made that is not known (negative). */
  ofMaker(made) {
    if (this.mode === "plain") return made === 0 ? PLAIN : CUT;
    if (made === 0 && this.mode !== "deviation") return STOCK;
    if (made < 0 || this.mode === "deviation") return UNMEASURED;
    if (this.mode === "tool") return TOOLS[this.toolOf(made - 1) % TOOLS.length];
    return ramp(COURSE, (made - 1) / Math.max(this.moves - 1, 1));
  }

  /** Rows of the legend: colour and words. */
  legend(tools) {
    const mm = (x) => `${Number(x.toPrecision(3))}`;
    if (this.mode === "deviation") {
      const [gouge, excess] = this.limits;
      const bound = (k) => mm(STEPS[k] * (STEPS[k] < 0 ? gouge : excess)).replace("-", "−");
      const rows = DEVIATIONS.map((colour, k) => {
        if (k === 0) return [colour, `below ${bound(0)}`];
        if (k === STEPS.length) return [colour, `above ${bound(k - 1)}`];
        return [colour, `${bound(k - 1)} … ${bound(k)}`];
      });
      const [deep, fine, high] = [rows.slice(0, 3), rows.slice(3, 6), rows.slice(6)];
      return {
        title: "Deviation, mm",
        rows: [["", "too little removed"], ...high.reverse(), ["", "within the limits"], ...fine.reverse(), ["", "too much removed"], ...deep.reverse(), [UNMEASURED, "not measured"]],
      };
    }
    if (this.mode === "tool") return { title: "Cut by", rows: [...tools.map((tool, n) => [TOOLS[n % TOOLS.length], tool.name]), [STOCK, "stock"]] };
    if (this.mode === "move")
      return { title: "Cut by move", rows: [0, 0.25, 0.5, 0.75, 1].map((t) => [ramp(COURSE, t), String(1 + Math.round(t * Math.max(this.moves - 1, 0)))]).concat([[STOCK, "stock"]]) };
    return { title: "", rows: [] };
  }
}
