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
  private readonly stretches: Float32Array; // in the newest frame, while they are shown
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
    this.stretches = new Float32Array(linkCount);
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
    for (let link = 0; link < keys.length; ++link)
      keys[link] = states[link]! >= LINK_IS_IDLE ? NOT_DRAWN : PATTERNS.length * colourOfState(states[link]!) + this.groups.of(link).pattern;
    if (this.isOld) this.looks = this.palette.link_states.flatMap((colour) => PATTERNS.map((_, pattern) => linkUniforms(colour, pattern)));
    this.layOut();
  }

  private sortByStretch(positions: Float32Array): void {
    const { states, keys, stretches, lengths } = this;
    const { linkEnds } = this.topology;
    let widest = 0;
    // As stretchOf(), without a call for each link: there are many.
    for (let link = 0; link < keys.length; ++link) {
      const before = lengths[link]!;
      if (before === 0 || states[link]! >= LINK_IS_IDLE) {
        stretches[link] = 0;
        continue;
      }
      const a = 3 * linkEnds[2 * link]!;
      const b = 3 * linkEnds[2 * link + 1]!;
      const x = positions[a]! - positions[b]!;
      const y = positions[a + 1]! - positions[b + 1]!;
      const z = positions[a + 2]! - positions[b + 2]!;
      const stretch = Math.sqrt(x * x + y * y + z * z) / before - 1;
      stretches[link] = stretch;
      if (stretch > widest) widest = stretch;
      else if (-stretch > widest) widest = -stretch;
    }
    this.widest = Math.max(widest, FALL * this.widest);
    const colours = this.palette.stretches;
    const half = (colours.length - 1) / 2;
    const scale = this.widest > 0 ? half / this.widest : 0;
    for (let link = 0; link < keys.length; ++link)
      keys[link] = states[link]! >= LINK_IS_IDLE ? NOT_DRAWN : Math.round(half + scale * stretches[link]!);
    if (this.isOld) this.looks = colours.map((colour) => linkUniforms(colour, 0));
    this.layOut();
  }

  /** Lays the links of one key side by side in the index. Those that do nothing are not drawn. */
  private layOut(): void {
    if (!this.isDrawn) return;
    const { keys } = this;
    const ends = this.topology.linkEnds;
    const places = new Uint32Array(NOT_DRAWN + 1);
    for (const key of keys) places[key]! += 2;
    const parts: Part[] = [];
    let filled = 0;
    for (let key = 0; key < NOT_DRAWN; ++key) {
      const count = places[key]!;
      places[key] = filled;
      if (count > 0) parts.push({ first: filled, count, uniforms: this.looks[key]! });
      filled += count;
    }
    const index = this.shape.index!;
    for (let link = 0; link < keys.length; ++link) {
      const key = keys[link]!;
      if (key === NOT_DRAWN) continue;
      const place = places[key]!;
      index.array[place] = ends[2 * link]!;
      index.array[place + 1] = ends[2 * link + 1]!;
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
