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

/** The colour of something that has this number in a list, round and round. */
export const ofList = (list: string[], index: number): string => list[index % list.length]!;
