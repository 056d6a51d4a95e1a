// viz_node/web/page/net_forces.ts -- the force on a MAT from its motion: frames carry no forces.

/**
 * Net force on MATs, the mean over the last two frames, where the middle counts most. It is what all
 * that acts on a mass adds up to: links, contacts, fields and the medium.
 *
 * With places x0, x1, x2 at times h1 and h2 apart, 2 ((x2 - x1) / h2 - (x1 - x0) / h1) / (h1 + h2) is the mean of the acceleration,
 * weighted by a triangle whose tip is at x1. It is exact, whatever happened between the frames.
 */
export class NetForces {
  private places: Float32Array[] = []; // of the last frames, the newest last
  private timesS: number[] = [];

  constructor(private readonly masses: Float32Array) {}

  /** Takes a frame. One that is no later than the last begins again. */
  append(positions: Float32Array, timeS: number): void {
    const last = this.timesS.at(-1);
    if (last !== undefined && timeS <= last) [this.places, this.timesS] = [[], []];
    this.places = [...this.places.slice(-2), positions];
    this.timesS = [...this.timesS.slice(-2), timeS];
  }

  /** Along x, y and z [N]; null for what is fixed or moved by a device, and before the third frame. */
  of(mat: number): number[] | null {
    const mass = this.masses[mat] ?? 0;
    if (mass === 0 || this.places.length < 3) return null;
    const [x0, x1, x2] = this.places as [Float32Array, Float32Array, Float32Array];
    const [t0, t1, t2] = this.timesS as [number, number, number];
    return [0, 1, 2].map((axis) => {
      const place = 3 * mat + axis;
      const change = (x2[place]! - x1[place]!) / (t2 - t1) - (x1[place]! - x0[place]!) / (t1 - t0);
      return (2 * mass * change) / (t2 - t0);
    });
  }
}
