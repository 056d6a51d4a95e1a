// viz_node/web/page/legend.ts -- what each colour and mark of the view means.
import { bodyName } from './bodies.ts';
import { ofList, readable, type Palette } from './colours.ts';
import { count } from './format.ts';
import type { Colouring } from './colouring.ts';
import { SMALLER } from './components.ts';
import { PATTERNS, stateName } from './link_groups.ts';
import type { Description, Surface } from './protocol.ts';
import { fillRows, setText } from './rows.ts';
import type { SceneView } from './scene_view.ts';
import { MAX_BONDS } from './wire.ts';

const MAX_BODIES = 8;
const MAX_SURFACES = 3; // names in the legend
const MAX_STATES = 3; // that have one colour and one pattern
const MAX_LINKS = 12;

export interface LegendEntry {
  mark: 'mass' | 'fixed-point' | 'handle' | 'tool' | 'ring' | 'key' | 'link solid' | 'link dashed' | 'link dotted' | 'surface';
  text: string;
  colour: string;
}

/** @param hasKeys  keys of a keyboard are drawn in the view */
export function legendOf(description: Description, view: SceneView, hasKeys: boolean, colouring: Colouring, palette: Palette): LegendEntry[] {
  const { bodies } = view;
  const entries = massEntries(view, colouring, palette);
  if (bodies.hasFixedPoints) entries.push({ mark: 'fixed-point', text: 'fixed point', colour: palette.fixed });
  if (bodies.hasFixedBalls) entries.push({ mark: 'mass', text: 'fixed ball', colour: palette.fixed });
  if (bodies.hasPorts) entries.push({ mark: 'handle', text: 'handle of a device', colour: palette.port });
  if (bodies.hasRings) entries.push({ mark: 'ring', text: 'tool that it holds, in true size', colour: palette.port });
  if (bodies.hasPunctualTools) entries.push({ mark: 'tool', text: 'tool that it holds', colour: palette.port });
  if (hasKeys) entries.push({ mark: 'key', text: 'key in true size, filled as far as it is down', colour: palette.port });
  const ofSurfaces = bodies.ofSurfaces;
  const plain = description.surfaces.filter((_, i) => ofSurfaces[i] === null);
  if (plain.length > 0) entries.push({ mark: 'surface', text: surfaceText(plain), colour: palette.surface });
  for (const { mark, name, wanted } of bodies.colouredFixed.slice(0, MAX_BODIES))
    entries.push({ mark, text: mark === 'surface' ? `surface: ${name}` : `${name}, fixed`, colour: readable(wanted, palette) });
  if (colouring !== 'stretch') entries.push(...linkEntries(view, palette.link_states));
  return entries;
}

/** What the colours of free masses say; a scale says it of speeds and forces. */
function massEntries(view: SceneView, colouring: Colouring, palette: Palette): LegendEntry[] {
  if (colouring === 'speed' || colouring === 'force') return [];
  if (colouring === 'stretch') return [{ mark: 'mass', text: 'mass', colour: palette.quiet }];
  if (colouring === 'components') return componentEntries(view, palette);
  const { list } = view.bodies;
  const entries = list.slice(0, MAX_BODIES).map((body): LegendEntry => ({ mark: 'mass', text: body.name, colour: view.bodies.colourOf(body, palette) }));
  if (list.length > MAX_BODIES) entries.at(-1)!.text += ` and ${list.length - MAX_BODIES} more`;
  return entries;
}

/** The largest components by their sizes. */
function componentEntries({ links }: SceneView, palette: Palette): LegendEntry[] {
  const list = links?.components.list ?? [];
  const large = list.filter(({ colour }) => colour !== SMALLER);
  const entries = large.map(({ size, colour }): LegendEntry => ({ mark: 'mass', text: `${count(size)} MATs`, colour: ofList(palette.bodies, colour) }));
  if (entries.length > 0) entries[0]!.text = `joined by links: ${entries[0]!.text}`;
  const more = list.length - large.length;
  entries.push({ mark: 'mass', text: more > 0 ? `${count(more)} smaller ones, and MATs alone` : 'MATs alone', colour: palette.quiet });
  return entries;
}

/** `surface: floor, step`: the first parts of the names. */
function surfaceText(surfaces: Surface[]): string {
  const names = [...new Set(surfaces.map(({ name }) => bodyName(name)))].filter((name) => name !== '');
  const more = names.length > MAX_SURFACES ? ' …' : '';
  return names.length === 0 ? 'surface' : `surface: ${names.slice(0, MAX_SURFACES).join(', ')}${more}`;
}

/** A colour for each state, a pattern for each liaison where there are several. States that look the same share an entry. */
function linkEntries({ groups: { list }, bonds }: SceneView, colours: string[]): LegendEntry[] {
  const links = list.flatMap(({ name, states, pattern }) => {
    const liaison = list.length > 1 ? name : '';
    if (states.length === 0) return [{ pattern, number: 0, text: list.length > 1 ? 'without states' : '' }];
    return states.map((state, number) => ({ pattern, number, text: stateName(liaison, state) }));
  });
  const ofBonds = bonds.groups.list.flatMap(({ name, states, shown, pattern }) => shown.map((number) => ({ pattern, number, text: stateName(name, states[number]!) })));
  const cut = bonds.isCut ? ` (the first ${count(MAX_BONDS)} of all)` : '';
  const entries = [...entriesOf(links, 'link', colours), ...entriesOf(ofBonds, `bond of sets${cut}`, colours)];
  if (entries.length > MAX_LINKS) entries[MAX_LINKS - 1]!.text += ' …';
  return entries.slice(0, MAX_LINKS);
}

/** One entry for each colour and pattern. @param what  before the first */
function entriesOf(states: { pattern: number; number: number; text: string }[], what: string, colours: string[]): LegendEntry[] {
  const texts = new Map<number, string[]>();
  for (const { pattern, number, text } of states) {
    const look = PATTERNS.length * (number % colours.length) + pattern;
    texts.set(look, [...(texts.get(look) ?? []), text]);
  }
  const looks = [...texts.keys()].sort((a, b) => (a % PATTERNS.length) - (b % PATTERNS.length) || a - b);
  const entries = looks.map((look): LegendEntry => {
    const names = [...new Set(texts.get(look)!)];
    const text = names.slice(0, MAX_STATES).join(' or ') + (names.length > MAX_STATES ? ' …' : '');
    return { mark: `link ${PATTERNS[look % PATTERNS.length]!}`, text, colour: colours[Math.floor(look / PATTERNS.length)]! };
  });
  if (entries.length > 0) entries[0]!.text = entries[0]!.text === '' ? what : `${what}, ${entries[0]!.text}`;
  return entries;
}

export function showLegend(entries: LegendEntry[]): void {
  const make = () => document.createElement('li');
  fillRows(document.querySelector<HTMLElement>('#legend')!, entries, make, (item, { mark, text, colour }) => {
    item.className = mark;
    setText(item, text);
    item.style.setProperty('--colour', colour);
  });
}
