// viz_node/web/page/given_colours.ts -- the colours that a scene gives to its matter.
import { readable, type Palette } from './colours.ts';
import type { ColouredRange } from './protocol.ts';

const NONE = 0xffffffff;

export class GivenColours {
  private readonly numberOf: Uint32Array; // per MAT; empty where the scene gives none
  private readonly colours: string[];

  constructor(ranges: ColouredRange[], matCount: number) {
    this.colours = ranges.map(({ colour }) => colour);
    this.numberOf = new Uint32Array(ranges.length > 0 ? matCount : 0).fill(NONE);
    ranges.forEach(({ first, count }, number) => this.numberOf.fill(number, first, first + count));
  }

  get isEmpty(): boolean {
    return this.colours.length === 0;
  }

  /** As the scene says it; null where it gives none. */
  of(mat: number): string | null {
    return this.colours[this.numberOf[mat] ?? NONE] ?? null;
  }
}

/** Colours of a scene as one theme shows them. Each is looked at once. */
export class ShownColours {
  private readonly known = new Map<string, string>();

  constructor(private readonly palette: Palette) {}

  of(wanted: string): string {
    let shown = this.known.get(wanted);
    if (shown === undefined) this.known.set(wanted, (shown = readable(wanted, this.palette)));
    return shown;
  }
}
