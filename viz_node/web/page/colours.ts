// viz_node/web/page/colours.ts -- the colours of both themes, from viz_node/colours.json, which the
// renderer of films and figures reads too.
import table from '../../colours.json';

export type ThemeName = 'dark' | 'light';
export type Palette = (typeof table)['dark'];

const KEY = 'cordis.theme';

/** The theme that a person chose in this browser; dark before that. */
export function firstTheme(): ThemeName {
  try {
    const kept = localStorage.getItem(KEY);
    if (kept === 'light' || kept === 'dark') return kept;
  } catch {
    // This browser keeps nothing.
  }
  return 'dark';
}

export function keepTheme(theme: ThemeName): void {
  try {
    localStorage.setItem(KEY, theme);
  } catch {
    // This browser keeps nothing.
  }
}

export const paletteOf = (theme: ThemeName): Palette => table[theme];

/** Red, green and blue of "#rrggbb", 0..255. */
export function bytesOf(hex: string): [number, number, number] {
  const value = Number.parseInt(hex.slice(1), 16);
  return [value >> 16, (value >> 8) & 255, value & 255];
}

/** Red, green and blue of "#rrggbb", 0..1. */
export const sharesOf = (hex: string): number[] => bytesOf(hex).map((byte) => byte / 255);

/** `count` colours from the first of a list to its last, three bytes each. */
export function ramp(colours: string[], count: number): Uint8Array {
  const bytes = new Uint8Array(3 * count);
  for (let i = 0; i < count; ++i) {
    const place = (i / (count - 1)) * (colours.length - 1);
    const first = Math.min(Math.floor(place), colours.length - 2);
    bytes.set(bytesOf(mixed(colours[first]!, colours[first + 1]!, place - first)), 3 * i);
  }
  return bytes;
}

const MIN_CONTRAST = 3; // of a mark of the view to its background: WCAG 2.1, 1.4.11
const STEPS = 20; // on the way to the colour of texts

/** Relative luminance of "#rrggbb", 0..1. */
function luminance(hex: string): number {
  const [red, green, blue] = sharesOf(hex).map((share) => (share <= 0.03928 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4)) as [number, number, number];
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

/** The ratio of contrast of two colours, 1 to 21. */
export function contrast(first: string, second: string): number {
  const [a, b] = [luminance(first), luminance(second)];
  return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
}

/** The colour between two, `share` of the way from the first. */
export function mixed(first: string, second: string, share: number): string {
  const [from, to] = [bytesOf(first), bytesOf(second)];
  return `#${from.map((byte, k) => Math.round(byte + (to[k]! - byte) * share).toString(16).padStart(2, '0')).join('')}`;
}

/** A colour that a scene asks for, as a theme shows it: as far towards that of texts as it takes to be seen on the background. */
export function readable(wanted: string, { background, text }: Palette): string {
  for (let step = 0; step < STEPS; ++step) {
    const colour = mixed(wanted, text, step / STEPS);
    if (contrast(colour, background) >= MIN_CONTRAST) return colour;
  }
  return text;
}

/** The colour of something that has this number in a list, round and round. */
export const ofList = (list: string[], index: number): string => list[index % list.length]!;
