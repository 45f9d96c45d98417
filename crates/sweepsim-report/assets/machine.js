// The machine: a chain of joints from the part to the tool, and where its links are at a time.

/** The turn by degrees about an axis through a point. */
function turned(axis, pivot, degrees) {
  const [s, c] = [Math.sin((degrees * Math.PI) / 180), Math.cos((degrees * Math.PI) / 180)];
  const of = (p) => {
    const along = scaled(axis, dot(axis, p));
    return add(along, add(scaled(sub(p, along), c), scaled(cross(axis, p), s)));
  };
  const [x, y, z] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map(of);
  return framed([sub(pivot, of(pivot)), x, y, z]);
}

class Machine {
  constructor(head) {
    const { joints, base, place, clock, values, contacts } = head.machine;
    Object.assign(this, { joints, base, contacts });
    this.place = framed(place);
    this.clocks = Float64Array.from(head.data["axes.clock"], (n) => clock.from + n * clock.step);
    this.begins = head.data["axes.begins"];
    this.values = values.map(({ from, step }, k) => Float64Array.from(head.data[`axes.${k}`], (n) => from + n * step));
  }

  /** The values of all joints at a time. */
  at(clock) {
    let [low, high] = [0, this.clocks.length - 1];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.clocks[middle] < clock - 1e-9) low = middle + 1;
      else high = middle;
    }
    const before = low > 0 && !this.begins[low] ? low - 1 : low;
    const span = this.clocks[low] - this.clocks[before];
    const t = span > 0 ? Math.min(Math.max((clock - this.clocks[before]) / span, 0), 1) : 1;
    return this.values.map((own) => own[before] + (own[low] - own[before]) * t);
  }

  /** Where each link is in the world. */
  frames(clock) {
    const values = this.at(clock);
    const all = [this.place];
    this.joints.forEach(({ axis, pivot }, k) => {
      const step = pivot ? turned(axis, pivot, values[k]) : framed([scaled(axis, values[k]), [1, 0, 0], [0, 1, 0], [0, 0, 1]]);
      all.push(product(all[k], step));
    });
    return all;
  }

  /** From the world to where it is if the base stands still. */
  hold(clock) {
    return product(this.place, inverted(this.frames(clock)[this.base]));
  }

  /** The bodies that meet at a time, by number. */
  meeting(clock) {
    const near = this.contacts.find(([at]) => Math.abs(at - clock) <= 1e-6 * (1 + Math.abs(clock)));
    return near ? near[1] : [];
  }

  /** How far the bodies reach from a point. */
  reach(bodies, centre) {
    const frames = this.frames(this.clocks[0] ?? 0);
    let most = 0;
    for (const { link, triangles } of bodies)
      for (let k = 0; k < triangles.places.length; k += 3) {
        const place = transformed(frames[link], triangles.places.slice(k, k + 3)).slice(0, 3);
        most = Math.max(most, size(sub(place, centre)));
      }
    return most;
  }
}
