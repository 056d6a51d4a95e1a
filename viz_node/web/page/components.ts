// viz_node/web/page/components.ts -- which MATs hang together by links, and the colours of these
// components.

const MAX_COLOURED = 8; // the largest; the others share one colour
export const SMALLER = 255; // the colour number of a component that is not among the largest

export interface Component {
  root: number; // its lowest MAT
  size: number; // MATs
  colour: number; // below MAX_COLOURED, or SMALLER
}

/** Connected components of a graph of links. One that stays among the largest keeps its colour. */
export class Components {
  list: Component[] = []; // of two MATs or more, the largest first
  private readonly parents: Uint32Array;
  private readonly places: Uint32Array; // per MAT that is a root: its place in `list`, counted from 1; else 0

  constructor(private readonly matCount: number) {
    this.parents = new Uint32Array(matCount);
    this.places = new Uint32Array(matCount);
  }

  /** Joins the two ends of every link for which `holds`. */
  update(ends: Uint32Array, holds: (link: number) => boolean): void {
    const { parents } = this;
    for (let mat = 0; mat < this.matCount; ++mat) parents[mat] = mat;
    for (let link = 0; 2 * link < ends.length; ++link) {
      if (!holds(link)) continue;
      const a = this.rootOf(ends[2 * link]!);
      const b = this.rootOf(ends[2 * link + 1]!);
      if (a < b) parents[b] = a;
      else parents[a] = b;
    }
    const sizes = new Uint32Array(this.matCount);
    for (let mat = 0; mat < this.matCount; ++mat) ++sizes[this.rootOf(mat)]!;
    const found: Component[] = [];
    sizes.forEach((size, root) => size > 1 && found.push({ root, size, colour: SMALLER }));
    found.sort((a, b) => b.size - a.size || a.root - b.root);
    this.giveColours(found.slice(0, MAX_COLOURED));
    this.list = found;
    this.places.fill(0);
    found.forEach(({ root }, place) => (this.places[root] = place + 1));
  }

  /** The component of a MAT, and its place among the largest, from 1; null for a MAT without links. */
  of(mat: number): { component: Component; place: number } | null {
    const place = this.places[this.rootOf(mat)]!;
    return place === 0 ? null : { component: this.list[place - 1]!, place };
  }

  private giveColours(largest: Component[]): void {
    const before = new Map(this.list.map(({ root, colour }) => [root, colour]));
    for (const component of largest) component.colour = before.get(component.root) ?? SMALLER;
    const taken = new Set(largest.map(({ colour }) => colour));
    let next = 0;
    for (const component of largest) {
      if (component.colour !== SMALLER) continue;
      while (taken.has(next)) ++next;
      component.colour = next;
      taken.add(next);
    }
  }

  private rootOf(mat: number): number {
    const { parents } = this;
    let root = mat;
    while (parents[root] !== root) root = parents[root]!;
    for (let next = mat; next !== root; ) {
      const above = parents[next]!;
      parents[next] = root;
      next = above;
    }
    return root;
  }
}
