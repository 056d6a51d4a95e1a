// viz_node/web/page/bodies.ts -- which MATs belong together, and the names of MATs and links.
import { bytesOf, ofList, type Palette } from './colours.ts';
import type { Description, NamedRange, Topology } from './protocol.ts';
import { MAT_FIXED, MAT_MASS, MAT_PORT } from './wire.ts';

const MOST_NAMES = 60; // in the view

export interface Body {
  name: string;
  first: number; // its first MAT
}

/** The first part of a name: `stack` of `stack[2].balls`. */
export const bodyName = (name: string): string => name.split(/[.[]/, 1)[0]!;

/** `string[3]` for the fourth of the range `string`, by the narrowest range; empty where no range holds it. */
function nameIn(ranges: NamedRange[], index: number): string {
  const holds = ranges.filter(({ first, count }) => index >= first && index < first + count);
  const narrowest = holds.sort((a, b) => a.count - b.count)[0];
  if (narrowest === undefined) return '';
  return narrowest.count === 1 ? narrowest.name : `${narrowest.name}[${index - narrowest.first}]`;
}

/** Bodies in the order of the scene: ranges of matter with masses, by the first part of their names. */
export class Bodies {
  readonly list: Body[] = [];
  readonly shapes: number[]; // fixed MATs that are surfaces: they are drawn as these
  readonly hasFixedPoints: boolean;
  readonly hasFixedBalls: boolean;
  readonly hasPorts: boolean;
  private readonly bodyOf: Uint16Array; // per MAT
  private readonly isHeld: Uint8Array; // per MAT: a port, or the tool of one

  constructor(
    private readonly description: Description,
    private readonly topology: Topology,
  ) {
    const { kinds, radii, matCount } = topology;
    this.bodyOf = new Uint16Array(matCount);
    this.isHeld = new Uint8Array(matCount);
    for (const tool of description.tools) if (tool !== null) this.isHeld[tool] = 1;
    for (const { mat } of description.ports) this.isHeld[mat] = 1;
    for (let mat = 0; mat < matCount; ++mat) if (kinds[mat] === MAT_PORT) this.isHeld[mat] = 1;
    const numbers = new Map<string, number>();
    for (const { name, first, count } of description.matter) {
      if (!this.hasMass(first, count)) continue;
      const body = bodyName(name);
      if (!numbers.has(body)) {
        numbers.set(body, this.list.length);
        this.list.push({ name: body, first });
      }
      this.bodyOf.fill(numbers.get(body)!, first, first + count);
    }
    if (this.list.length === 0 && this.hasMass(0, matCount)) this.list.push({ name: 'mass', first: 0 });
    const names = new Set(description.surfaces.map(({ name }) => name));
    this.shapes = description.matter.filter(({ name, count }) => count === 1 && names.has(name)).map(({ first }) => first);
    this.hasFixedPoints = kinds.some((kind, mat) => kind === MAT_FIXED && radii[mat] === 0 && !this.shapes.includes(mat));
    this.hasFixedBalls = kinds.some((kind, mat) => kind === MAT_FIXED && radii[mat] !== 0);
    this.hasPorts = description.ports.length > 0;
  }

  private hasMass(first: number, count: number): boolean {
    for (let mat = first; mat < first + count; ++mat) if (this.topology.kinds[mat] === MAT_MASS && this.isHeld[mat] === 0) return true;
    return false;
  }

  /** Red, green, blue per MAT, 0..255. @param massColour  of the masses that no hand holds, where it is not that of their body */
  tints(palette: Palette, massColour: (mat: number) => string = (mat) => ofList(palette.bodies, this.bodyOf[mat]!)): Uint8Array {
    const bytes = new Map<string, [number, number, number]>();
    const tints = new Uint8Array(3 * this.topology.matCount);
    for (let mat = 0; mat < this.topology.matCount; ++mat) {
      const colour = this.ownColourOf(mat, palette) ?? massColour(mat);
      if (!bytes.has(colour)) bytes.set(colour, bytesOf(colour));
      tints.set(bytes.get(colour)!, 3 * mat);
    }
    return tints;
  }

  /** The colour of a MAT that is fixed or held by a hand; null for a free mass. */
  private ownColourOf(mat: number, palette: Palette): string | null {
    if (this.isHeld[mat] === 1) return palette.port;
    return this.topology.kinds[mat] === MAT_FIXED ? palette.fixed : null;
  }

  /** The name of a MAT as the scene has it: `string[3]`. */
  nameOf(mat: number): string {
    return this.description.ports.find((port) => port.mat === mat)?.name ?? (nameIn(this.description.matter, mat) || `MAT ${mat}`);
  }

  /** The name of a link as the scene has it. */
  linkNameOf(link: number): string {
    return nameIn(this.description.links, link) || `link ${link}`;
  }

  /** Ports and every range, or where these are too many, ports and bodies. */
  get named(): NamedRange[] {
    const { matter } = this.description;
    const ports = this.description.ports.map(({ name, mat }) => ({ name, first: mat, count: 1 }));
    const ranges = matter.length <= MOST_NAMES ? matter : this.list.map(({ name, first }) => ({ name, first, count: 1 }));
    return [...ports, ...ranges];
  }
}
