// viz_node/web/page/format.ts -- numbers as a person reads them.

export const NONE = '–';

const PREFIXES: [number, string][] = [
  [1e9, 'G'],
  [1e6, 'M'],
  [1e3, 'k'],
  [1, ''],
  [1e-3, 'm'],
  [1e-6, 'µ'],
  [1e-9, 'n'],
];

/** The prefix that brings `size` between 1 and 1000, as [factor, letter]. */
export function prefixOf(size: number): [number, string] {
  const magnitude = Math.abs(size) * (1 + 1e-9);
  if (magnitude === 0 || !Number.isFinite(size)) return [1, ''];
  return PREFIXES.find(([factor]) => magnitude >= factor) ?? PREFIXES[PREFIXES.length - 1]!;
}

/** Three significant digits, no exponent: for a number between 0.1 and 9999. */
export function threeDigits(value: number): string {
  const size = Math.abs(value);
  const text = value.toFixed(size >= 99.95 ? 0 : size >= 9.995 ? 1 : 2);
  return Number(text) === 0 ? text.replace('-', '') : text;
}

/** [number, unit] with a prefix: 0.0123, "m" gives ["12.3", "mm"]. */
export function withUnit(value: number | null | undefined, unit: string): [string, string] {
  if (value === null || value === undefined || !Number.isFinite(value)) return [NONE, ''];
  if (unit === '' || unit === '1') return [plain(value), ''];
  const [factor, letter] = prefixOf(value);
  return [threeDigits(value / factor), letter + unit];
}

export function joined([number, unit]: [string, string]): string {
  return unit === '' ? number : `${number}\u202f${unit}`; // a narrow space
}

/** A number without a unit: plain where it can be, else 1.2e-9. */
export function plain(value: number): string {
  const size = Math.abs(value);
  if (size === 0) return '0';
  if (size >= 0.01 && size < 10000) return threeDigits(value);
  return value.toExponential(1).replace('e+', 'e');
}

/** A rate [Hz] to a tenth. */
export function rate(value: number | null | undefined): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return NONE;
  return value >= 99999.5 ? `${(value / 1000).toFixed(1)}k` : value.toFixed(value >= 9999.5 ? 0 : 1);
}

/** A count with thin spaces between thousands. */
export function count(value: number): string {
  return Math.round(value)
    .toString()
    .replace(/\B(?=(\d{3})+$)/g, '\u202f');
}

/** A stretch of time [s]: 12.3 s, 4 min 05 s. */
export function duration(value: number): string {
  if (value < 99.95) return value.toFixed(1) + ' s';
  const seconds = Math.floor(value);
  return `${Math.floor(seconds / 60)} min ${String(seconds % 60).padStart(2, '0')} s`;
}

/** The largest of 1, 2, 5, 10, 20 ... that is not above `length`. */
export function roundLength(length: number): number {
  const decade = 10 ** Math.floor(Math.log10(length));
  const digit = length / decade;
  return decade * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1);
}
