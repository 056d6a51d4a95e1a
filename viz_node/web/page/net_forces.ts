// viz_node/web/page/net_forces.ts -- the force on a MAT from its motion: frames carry no forces.

// Places are 32-bit numbers: at 0.3 m they are rounded by up to 15 nm. Frames that are this far apart show 0.1 mN of that on 1 g;
// single steps of a fast scene would show a thousand times as much.
const MIN_APART_S = 1e-3;
const MIN_KEPT_APART_S = MIN_APART_S / 4;

interface Kept {
  positions: Float32Array;
  timeS: number;
}

/**
 * Net force on MATs, the mean over two intervals of at least MIN_APART_S, where the middle counts most. They are those of the last
 * two frames where frames are so far apart. It is what all that acts on a mass adds up to: links, contacts, fields and the medium.
 *
 * With places x0, x1, x2 at times h1 and h2 apart, 2 ((x2 - x1) / h2 - (x1 - x0) / h1) / (h1 + h2) is the mean of the acceleration,
 * weighted by a triangle whose tip is at x1. It is exact, whatever happened between the frames.
 */
export class NetForces {
  private kept: Kept[] = []; // the oldest first, as many as are needed
  private newest: Kept | null = null;

  constructor(private readonly masses: Float32Array) {}

  /** Takes a frame. The same one again changes nothing, and an earlier one begins again. */
  append(positions: Float32Array, timeS: number): void {
    const last = this.newest;
    if (timeS === last?.timeS) return;
    this.newest = { positions, timeS };
    if (last === null) return;
    if (timeS < last.timeS) {
      this.kept = [];
      return;
    }
    const lastKept = this.kept.at(-1);
    if (lastKept === undefined || last.timeS - lastKept.timeS >= MIN_KEPT_APART_S) this.kept.push(last);
    // Whoever is older than the first of the three is not needed.
    while (this.kept.length > 2 && this.threeOf(this.kept.slice(1)) !== null) this.kept.shift();
  }

  /** The newest frame and two before it, the oldest first; null where there are none. */
  private threeOf(kept: Kept[]): [Kept, Kept, Kept] | null {
    const lastBefore = (one: Kept | null) => kept.filter(({ timeS }) => one !== null && one.timeS - timeS >= MIN_APART_S).at(-1) ?? null;
    const x2 = this.newest;
    const x1 = lastBefore(x2);
    const x0 = lastBefore(x1);
    return x0 === null ? null : [x0, x1!, x2!];
  }

  /** Time over which of() is a mean [s]; 0 where there is none. */
  get spanS(): number {
    const three = this.threeOf(this.kept);
    return three === null ? 0 : three[2].timeS - three[0].timeS;
  }

  /**
   * Size of the force on each MAT [N]; NaN where of() has none.
   * @returns whether there are three frames, else `sizes` stays as it is
   */
  sizesOfAll(sizes: Float32Array): boolean {
    const three = this.threeOf(this.kept);
    if (three === null) return false;
    const [x0, x1, x2] = three.map(({ positions }) => positions) as [Float32Array, Float32Array, Float32Array];
    const [t0, t1, t2] = three.map(({ timeS }) => timeS) as [number, number, number];
    const { masses } = this;
    const [before, after, factor] = [1 / (t1 - t0), 1 / (t2 - t1), 2 / (t2 - t0)];
    for (let mat = 0, place = 0; mat < sizes.length; ++mat, place += 3) {
      const mass = masses[mat] ?? 0;
      const [middleX, middleY, middleZ] = [x1[place]!, x1[place + 1]!, x1[place + 2]!];
      const x = (x2[place]! - middleX) * after - (middleX - x0[place]!) * before;
      const y = (x2[place + 1]! - middleY) * after - (middleY - x0[place + 1]!) * before;
      const z = (x2[place + 2]! - middleZ) * after - (middleZ - x0[place + 2]!) * before;
      sizes[mat] = mass === 0 ? Number.NaN : factor * mass * Math.sqrt(x * x + y * y + z * z);
    }
    return true;
  }

  /** Along x, y and z [N]; null for what is fixed or moved by a device, and before there are three frames. */
  of(mat: number): number[] | null {
    const mass = this.masses[mat] ?? 0;
    const three = this.threeOf(this.kept);
    if (mass === 0 || three === null) return null;
    const [t0, t1, t2] = three.map(({ timeS }) => timeS) as [number, number, number];
    const [x0, x1, x2] = three.map(({ positions }) => positions) as [Float32Array, Float32Array, Float32Array];
    return [0, 1, 2].map((axis) => {
      const place = 3 * mat + axis;
      const change = (x2[place]! - x1[place]!) / (t2 - t1) - (x1[place]! - x0[place]!) / (t1 - t0);
      return (2 * mass * change) / (t2 - t0);
    });
  }
}
