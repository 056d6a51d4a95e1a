// viz_node/web/page/legend.ts -- what each colour and mark of the view means.
import { bodyName, stateNames, type Bodies } from './bodies.ts';
import { ofList, type Palette } from './colours.ts';
import type { Description } from './protocol.ts';
import { fillRows, setText } from './rows.ts';

const MOST_BODIES = 8;
const MOST_SURFACES = 3; // names in the legend

export interface LegendEntry {
  mark: 'mass' | 'fixed-point' | 'handle' | 'tool' | 'link' | 'surface';
  text: string;
  colour: string;
}

export function legendOf(description: Description, bodies: Bodies, palette: Palette): LegendEntry[] {
  const { list } = bodies;
  const entries: LegendEntry[] = list.slice(0, MOST_BODIES).map(({ name }, number) => ({ mark: 'mass', text: name, colour: ofList(palette.bodies, number) }));
  if (list.length > MOST_BODIES) entries.at(-1)!.text += ` and ${list.length - MOST_BODIES} more`;
  if (bodies.hasFixedPoints) entries.push({ mark: 'fixed-point', text: 'fixed point', colour: palette.fixed });
  if (bodies.hasFixedBalls) entries.push({ mark: 'mass', text: 'fixed ball', colour: palette.fixed });
  if (bodies.hasPorts) entries.push({ mark: 'handle', text: 'handle of a device', colour: palette.port });
  if (description.tools.some((tool) => tool !== null)) entries.push({ mark: 'tool', text: 'tool that it holds', colour: palette.port });
  if (description.surfaces.length > 0) entries.push({ mark: 'surface', text: surfaceText(description), colour: palette.surface });
  if (description.link_count > 0) entries.push(...linkEntries(description, palette.link_states));
  return entries;
}

/** `surface: floor, step`: the first parts of the names. */
function surfaceText({ surfaces }: Description): string {
  const names = [...new Set(surfaces.map(({ name }) => bodyName(name)))].filter((name) => name !== '');
  const more = names.length > MOST_SURFACES ? ' …' : '';
  return names.length === 0 ? 'surface' : `surface: ${names.slice(0, MOST_SURFACES).join(', ')}${more}`;
}

/** Links without states have the colour of the first state. */
function linkEntries(description: Description, colours: string[]): LegendEntry[] {
  const texts = colours.map((_, number) => stateNames(description, number, colours.length));
  texts[0] = texts[0] === '' ? 'link' : `link, ${texts[0]}`;
  return texts.map((text, number): LegendEntry => ({ mark: 'link', text, colour: colours[number]! })).filter(({ text }) => text !== '');
}

export function showLegend(entries: LegendEntry[]): void {
  const make = () => document.createElement('li');
  fillRows(document.querySelector<HTMLElement>('#legend')!, entries, make, (item, { mark, text, colour }) => {
    item.className = mark;
    setText(item, text);
    item.style.setProperty('--colour', colour);
  });
}
