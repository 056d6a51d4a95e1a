// viz_node/web/page/link_view.ts -- the links as lines, one call per colour and pattern.
import type { Palette } from './colours.ts';
import type { Colouring } from './colouring.ts';
import { Components } from './components.ts';
import { shapeOf, VertexArray, type Part, type Shape, type Uniforms } from './gl_canvas.ts';
import { PATTERNS, type LinkGroups } from './link_groups.ts';
import { colourOfState, LINK_PROGRAM, linkUniforms } from './mat_material.ts';
import type { Topology } from './protocol.ts';
import { LINK_IS_IDLE } from './wire.ts';

const NOT_DRAWN = 255;
const FALL = 0.985; // of the full scale of stretches, per frame

export class LinkView {
  readonly shape: Shape;
  readonly components: Components;
  readonly keys: Uint8Array; // per link: which part draws it
  componentsVersion = 0; // +1 when they are others
  widest = 0; // largest stretch shown lately, a share
  private states: Uint8Array; // + LINK_IS_IDLE where a link does nothing
  private readonly lengths: Float32Array; // that stretches are counted from [m]
  private looks: Uniforms[] = []; // by key
  private colouring: Colouring = 'bodies';
  private isOld = true; // the parts, since the colouring or the palette changed

  constructor(
    private readonly topology: Topology,
    readonly groups: LinkGroups,
    vertices: Shape['vertices'],
    uniforms: Uniforms,
    private palette: Palette,
    private readonly isDrawn: boolean,
  ) {
    const { linkCount, matCount } = topology;
    this.states = new Uint8Array(linkCount);
    this.keys = new Uint8Array(linkCount);
    this.lengths = new Float32Array(linkCount);
    this.components = new Components(matCount);
    const index = new VertexArray<Uint32Array>(new Uint32Array(2 * linkCount), 1);
    this.shape = shapeOf('lines', LINK_PROGRAM, vertices, { index, uniforms, isVisible: isDrawn });
  }

  /** State of a link, + LINK_IS_IDLE where it does nothing; 0 for links without states. */
  stateOf(link: number): number {
    return this.states[link] ?? 0;
  }

  colourBy(colouring: Colouring, positions: Float32Array): void {
    this.colouring = colouring;
    this.widest = 0;
    this.isOld = true;
    this.take(positions, this.states);
  }

  paint(palette: Palette): void {
    this.palette = palette;
    this.isOld = true;
  }

  /** Stretches are counted from the lengths at these positions. */
  measureFrom(positions: Float32Array): void {
    for (let link = 0; link < this.lengths.length; ++link) this.lengths[link] = this.lengthAt(positions, link);
  }

  /** How much longer a link is than it was, a share; 0 for one that had no length. */
  stretchOf(positions: Float32Array, link: number): number {
    const before = this.lengths[link]!;
    return before > 0 ? this.lengthAt(positions, link) / before - 1 : 0;
  }

  /** Takes a frame. */
  take(positions: Float32Array, states: Uint8Array): void {
    const isOther = states.length === this.states.length && !states.every((state, link) => state === this.states[link]);
    if (isOther) this.states = states.slice();
    if (this.colouring === 'components' && (isOther || this.isOld)) {
      this.components.update(this.topology.linkEnds, (link) => this.states[link]! < LINK_IS_IDLE);
      ++this.componentsVersion;
    }
    if (this.colouring === 'stretch') this.sortByStretch(positions);
    else if (isOther || this.isOld) this.sortByState();
    this.isOld = false;
  }

  private sortByState(): void {
    const { states, keys } = this;
    const counts = new Uint32Array(NOT_DRAWN + 1);
    for (let link = 0; link < keys.length; ++link) {
      const key = states[link]! >= LINK_IS_IDLE ? NOT_DRAWN : PATTERNS.length * colourOfState(states[link]!) + this.groups.of(link).pattern;
      keys[link] = key;
      counts[key]! += 1;
    }
    if (this.isOld) this.looks = this.palette.link_states.flatMap((colour) => PATTERNS.map((_, pattern) => linkUniforms(colour, pattern)));
    this.layOut(counts);
  }

  private sortByStretch(positions: Float32Array): void {
    const colours = this.palette.stretches;
    const counts = new Uint32Array(NOT_DRAWN + 1);
    // The full scale is that of the last frames, until a link is beyond it.
    const scale = FALL * this.widest;
    const widest = this.keyByStretch(positions, scale, counts);
    this.widest = Math.max(widest, scale);
    if (widest > scale) this.keyByStretch(positions, widest, counts.fill(0));
    if (this.isOld) this.looks = colours.map((colour) => linkUniforms(colour, 0));
    this.layOut(counts);
  }

  /**
   * Gives each link the key of its stretch. One loop does it all, without a call for each link: there are many.
   * @param full    stretch that has the last colour
   * @param counts  receives how many links each key has
   * @returns the largest stretch
   */
  private keyByStretch(positions: Float32Array, full: number, counts: Uint32Array): number {
    const { states, keys, lengths } = this;
    const { linkEnds } = this.topology;
    const last = this.palette.stretches.length - 1;
    const middle = last / 2;
    const scale = full > 0 ? middle / full : 0;
    let widest = 0;
    for (let link = 0, end = 0; link < keys.length; ++link, end += 2) {
      let key = NOT_DRAWN;
      if (states[link]! < LINK_IS_IDLE) {
        const before = lengths[link]!;
        const a = 3 * linkEnds[end]!;
        const b = 3 * linkEnds[end + 1]!;
        const x = positions[a]! - positions[b]!;
        const y = positions[a + 1]! - positions[b + 1]!;
        const z = positions[a + 2]! - positions[b + 2]!;
        const stretch = before > 0 ? Math.sqrt(x * x + y * y + z * z) / before - 1 : 0; // as stretchOf()
        const size = Math.abs(stretch);
        if (size > widest) widest = size;
        const place = middle + scale * stretch + 0.5;
        key = place < 0 ? 0 : place < last ? place | 0 : last;
      }
      keys[link] = key;
      counts[key]! += 1;
    }
    return widest;
  }

  /**
   * Lays the links of one key side by side in the index. Those that do nothing are not drawn.
   * @param counts  how many links each key has
   */
  private layOut(counts: Uint32Array): void {
    if (!this.isDrawn) return;
    const { keys } = this;
    const ends = this.topology.linkEnds;
    const places = new Uint32Array(NOT_DRAWN);
    const parts: Part[] = [];
    let filled = 0;
    for (let key = 0; key < NOT_DRAWN; ++key) {
      const count = 2 * counts[key]!;
      places[key] = filled;
      if (count > 0) parts.push({ first: filled, count, uniforms: this.looks[key]! });
      filled += count;
    }
    const index = this.shape.index!;
    for (let link = 0, end = 0; link < keys.length; ++link, end += 2) {
      const key = keys[link]!;
      if (key === NOT_DRAWN) continue;
      const place = places[key]!;
      index.array[place] = ends[end]!;
      index.array[place + 1] = ends[end + 1]!;
      places[key] = place + 2;
    }
    this.shape.parts = parts;
    index.set();
  }

  private lengthAt(positions: Float32Array, link: number): number {
    const a = 3 * this.topology.linkEnds[2 * link]!;
    const b = 3 * this.topology.linkEnds[2 * link + 1]!;
    const x = positions[a]! - positions[b]!;
    const y = positions[a + 1]! - positions[b + 1]!;
    const z = positions[a + 2]! - positions[b + 2]!;
    return Math.sqrt(x * x + y * y + z * z);
  }
}
