// viz_node/web/page/bond_view.ts -- the bonds of sets as lines, one call per colour and pattern.
import type { Palette } from './colours.ts';
import type { Colouring } from './colouring.ts';
import { shapeOf, VertexArray, type Part, type Shape } from './gl_canvas.ts';
import { PATTERNS, type BondGroups } from './link_groups.ts';
import { BOND_PROGRAM, colourOfState, linkUniforms, type SceneUniforms } from './mat_material.ts';
import type { Frame } from './protocol.ts';
import { LINK_IS_IDLE } from './wire.ts';

/** They are drawn from middle to middle, before the two balls: these touch, so nothing would be seen between them. */
export class BondView {
  readonly shape: Shape;
  isCut = false; // there are more than frames hold
  private readonly index = new VertexArray<Uint32Array>(new Uint32Array(0), 1);
  private parts: { key: number; first: number; count: number }[] = [];

  constructor(
    readonly groups: BondGroups,
    vertices: Shape['vertices'],
    uniforms: SceneUniforms,
    private palette: Palette,
    private readonly isDrawn: boolean,
  ) {
    this.shape = shapeOf('lines', BOND_PROGRAM, vertices, { index: this.index, uniforms, isVisible: isDrawn });
  }

  /** Frames say nothing of their stretch. */
  colourBy(colouring: Colouring): void {
    this.shape.isVisible = this.isDrawn && colouring !== 'stretch';
  }

  paint(palette: Palette): void {
    this.palette = palette;
    this.look();
  }

  /** Takes a frame. Bonds that do nothing are not drawn. */
  take({ bondEnds, bondCounts, bondStates, bondsLeftOut }: Frame): void {
    this.isCut = bondsLeftOut > 0;
    const byKey = new Map<number, number[]>(); // the bonds
    let bond = 0;
    bondCounts.forEach((count, set) => {
      const pattern = this.groups.patternOf(set);
      for (const end = bond + count; bond < end; ++bond) {
        if (bondStates[bond]! >= LINK_IS_IDLE) continue;
        const key = PATTERNS.length * colourOfState(bondStates[bond]!) + pattern;
        if (!byKey.has(key)) byKey.set(key, []);
        byKey.get(key)!.push(bond);
      }
    });
    const ends = new Uint32Array(bondEnds.length);
    let filled = 0;
    this.parts = [...byKey].map(([key, bonds]) => {
      const first = filled;
      for (const one of bonds) {
        ends[filled++] = bondEnds[2 * one]!;
        ends[filled++] = bondEnds[2 * one + 1]!;
      }
      return { key, first, count: filled - first };
    });
    this.index.set(ends);
    this.look();
  }

  private look(): void {
    const colours = this.palette.link_states;
    this.shape.parts = this.parts.map(({ key, first, count }): Part => {
      return { first, count, uniforms: linkUniforms(colours[Math.floor(key / PATTERNS.length)]!, key % PATTERNS.length) };
    });
  }
}
