// viz_node/web/page/bodies.ts -- which MATs belong together, and the names of MATs and links.
import { bytesOf, ofList, readable, type Palette } from './colours.ts';
import { GivenColours, ShownColours } from './given_colours.ts';
import type { Description, NamedRange, Topology } from './protocol.ts';
import { MAT_FIXED, MAT_MASS, MAT_PORT } from './wire.ts';

const MAX_NAMES = 60; // in the view

/** Matter that looks alike: a body, or a part of it to which the scene gives a colour. */
export interface Body {
  name: string;
  first: number; // its first MAT
  number: number; // of the body
  wanted: string | null; // colour that the scene gives
}

/** Something fixed to which the scene gives a colour. */
export interface ColouredFixed {
  mark: 'mass' | 'fixed-point' | 'surface';
  name: string;
  wanted: string;
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

/** The narrowest range that holds a MAT, without the numbers of copies: `stack.balls` of `stack[2].balls`. */
function kindName(ranges: NamedRange[], mat: number): string {
  const holds = ranges.filter(({ first, count }) => mat >= first && mat < first + count);
  return (holds.sort((a, b) => a.count - b.count)[0]?.name ?? '').replace(/\[\d+\]/g, '');
}

/** Bodies in the order of the scene: ranges of matter with masses, by the first part of their names. */
export class Bodies {
  readonly list: Body[] = []; // with masses
  readonly colouredFixed: ColouredFixed[] = [];
  readonly shapes: number[]; // MATs that are surfaces: they are drawn as these
  readonly hasFixedPoints: boolean;
  readonly hasFixedBalls: boolean;
  readonly hasPorts: boolean;
  readonly hasRings: boolean; // tools with a radius
  readonly hasPunctualTools: boolean;
  private readonly given: GivenColours;
  private readonly bodyOf: Uint16Array; // per MAT an index in the list
  private readonly isHeld: Uint8Array; // per MAT: a port, or the tool of one

  constructor(
    private readonly description: Description,
    private readonly topology: Topology,
  ) {
    const { kinds, radii, matCount } = topology;
    this.bodyOf = new Uint16Array(matCount);
    this.isHeld = new Uint8Array(matCount);
    const tools = description.tools.filter((tool) => tool !== null);
    for (const tool of tools) this.isHeld[tool] = 1;
    this.hasRings = tools.some((tool) => radii[tool] !== 0);
    this.hasPunctualTools = tools.some((tool) => radii[tool] === 0);
    for (const { mat } of description.ports) this.isHeld[mat] = 1;
    for (let mat = 0; mat < matCount; ++mat) if (kinds[mat] === MAT_PORT) this.isHeld[mat] = 1;
    this.given = new GivenColours(description.colours, matCount);
    const numbers = new Map<string, number>();
    for (const { name, first, count } of description.matter) {
      if (!this.hasMass(first, count)) continue;
      const body = bodyName(name);
      if (!numbers.has(body)) {
        numbers.set(body, this.list.length);
        this.list.push({ name: body, first, number: this.list.length, wanted: null });
      }
      this.bodyOf.fill(numbers.get(body)!, first, first + count);
    }
    if (this.list.length === 0 && this.hasMass(0, matCount)) this.list.push({ name: 'mass', first: 0, number: 0, wanted: null });
    this.shapes = description.surfaces.flatMap(({ mat }) => mat ?? []);
    const isPlain = (mat: number) => this.given.of(mat) === null;
    this.hasFixedPoints = kinds.some((kind, mat) => kind === MAT_FIXED && radii[mat] === 0 && isPlain(mat) && !this.shapes.includes(mat));
    this.hasFixedBalls = kinds.some((kind, mat) => kind === MAT_FIXED && radii[mat] !== 0 && isPlain(mat));
    if (!this.given.isEmpty) {
      this.split();
      this.nameFixed();
    }
    this.hasPorts = description.ports.length > 0;
  }

  private hasMass(first: number, count: number): boolean {
    for (let mat = first; mat < first + count; ++mat) if (this.topology.kinds[mat] === MAT_MASS && this.isHeld[mat] === 0) return true;
    return false;
  }

  /** Makes bodies of the parts of bodies to which the scene gives other colours. */
  private split(): void {
    const { kinds, matCount } = this.topology;
    const parts = new Map<string, Body>(); // by body and colour
    const places = new Map<Body, number>();
    const counts = new Map<number, number>(); // of parts, by body
    for (let mat = 0; mat < matCount; ++mat) {
      if (kinds[mat] !== MAT_MASS || this.isHeld[mat] === 1) continue;
      const body = this.list[this.bodyOf[mat]!]!;
      const wanted = this.given.of(mat);
      const key = `${body.number} ${wanted}`;
      let part = parts.get(key);
      if (part === undefined) {
        part = { ...body, first: mat, wanted };
        parts.set(key, part);
        places.set(part, places.size);
        counts.set(body.number, (counts.get(body.number) ?? 0) + 1);
      }
      this.bodyOf[mat] = places.get(part)!;
    }
    if (places.size === 0) return;
    this.list.splice(0, this.list.length, ...places.keys());
    for (const part of this.list) if (counts.get(part.number)! > 1) part.name = kindName(this.description.matter, part.first) || part.name;
  }

  /** What is fixed and has a colour of its own: the legend names it. */
  private nameFixed(): void {
    const { kinds, radii } = this.topology;
    const known = new Set(this.list.map(({ name, wanted }) => `${name} ${wanted}`));
    for (const { name, first: mat, count } of this.description.matter) {
      const wanted = this.given.of(mat);
      const key = `${bodyName(name)} ${wanted}`;
      if (count === 0 || wanted === null || known.has(key)) continue;
      const isShape = this.shapes.includes(mat);
      if (kinds[mat] !== MAT_FIXED && !isShape) continue;
      known.add(key);
      const mark = isShape ? 'surface' : radii[mat] === 0 ? 'fixed-point' : 'mass';
      this.colouredFixed.push({ mark, name: bodyName(name), wanted });
    }
  }

  /** The colours that the scene gives to its surfaces, in their order; null where it gives none. */
  get ofSurfaces(): (string | null)[] {
    return this.description.surfaces.map(({ mat }) => (mat === null ? null : this.given.of(mat)));
  }

  /** The colour of a body as a theme shows it. */
  colourOf({ number, wanted }: Body, palette: Palette): string {
    return wanted === null ? ofList(palette.bodies, number) : readable(wanted, palette);
  }

  /** Red, green, blue per MAT, 0..255. @param massColour  of the masses that no hand holds, where it is not that of their body */
  tints(palette: Palette, massColour?: (mat: number) => string): Uint8Array {
    const bodyColours = this.list.map((body) => this.colourOf(body, palette));
    const shown = new ShownColours(palette);
    const bytes = new Map<string, [number, number, number]>();
    const tints = new Uint8Array(3 * this.topology.matCount);
    for (let mat = 0; mat < this.topology.matCount; ++mat) {
      const colour = this.ownColourOf(mat, palette, shown) ?? massColour?.(mat) ?? bodyColours[this.bodyOf[mat]!] ?? palette.quiet;
      if (!bytes.has(colour)) bytes.set(colour, bytesOf(colour));
      tints.set(bytes.get(colour)!, 3 * mat);
    }
    return tints;
  }

  /** The colour of a MAT that is fixed or held by a hand; null for a free mass. */
  private ownColourOf(mat: number, palette: Palette, shown: ShownColours): string | null {
    if (this.isHeld[mat] === 1) return palette.port;
    if (this.topology.kinds[mat] !== MAT_FIXED) return null;
    const wanted = this.given.of(mat);
    return wanted === null ? palette.fixed : shown.of(wanted);
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
    const ranges = matter.length <= MAX_NAMES ? matter : this.list.map(({ name, first }) => ({ name, first, count: 1 }));
    return [...ports, ...ranges];
  }
}
