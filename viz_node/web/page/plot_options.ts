// viz_node/web/page/plot_options.ts -- how a plot looks: its scales, axes and labels.
import type uPlot from 'uplot';
import { ofList, type Palette } from './colours.ts';
import { joined, prefixOf, threeDigits, withUnit } from './format.ts';

const VALUES_PX = 72; // least room for the labels of values
const LETTER_PX = 7;
const SHORT_UNIT = 4; // letters for which that is enough
const MAX_DECADES = 6; // below the largest value
const LABELLED_DECADES = 4;
export const AXIS_FONT = '11px system-ui, "DejaVu Sans", sans-serif';

export interface PlotLook {
  unit: string;
  seriesCount: number;
  palette: Palette;
  valuesPx: number; // room for the labels of values, the same in all plots so that their times stand below each other
  logarithmic: boolean;
  pointed: () => void; // the pointer is elsewhere, or has left
}

/** Room for labels of values with any of these units. */
export const valuesPxOf = (units: string[]): number => VALUES_PX + LETTER_PX * Math.max(0, ...units.map(({ length }) => length - SHORT_UNIT));

export function optionsOf({ unit, seriesCount, palette, valuesPx, logarithmic, pointed }: PlotLook): uPlot.Options {
  const lines = { stroke: palette.grid_coarse, width: 1 };
  const axis = { stroke: palette.quiet, font: AXIS_FONT, grid: lines, ticks: { ...lines, size: 4 } };
  const values: uPlot.Scale = logarithmic
    ? { distr: 3, range: (_chart, low, high) => decadesOf(low, high) }
    : { range: (_chart, low, high) => rangeOf(low, high) };
  const valueAxis: uPlot.Axis = logarithmic
    ? { splits: (_chart, _axis, low, high) => decadeTicks(low, high), filter: (_chart, ticks) => ticks, values: (_chart, ticks) => ticks.map((tick) => joined(withUnit(tick, unit))) }
    : { splits: (_chart, _axis, low, high, step) => withEnds(low, high, step, 0.6), values: (_chart, ticks) => labelsOf(ticks, unit) };
  return {
    width: 320,
    height: 120,
    legend: { show: false },
    cursor: { y: false, points: { show: false }, drag: { x: false, y: false }, sync: { key: 'signals' } },
    hooks: { setCursor: [pointed] },
    padding: [6, 22, 0, 0],
    scales: { x: { time: false, auto: false }, y: values },
    axes: [
      { ...axis, size: 22, space: 50, splits: (_chart, _axis, low, high, step) => withEnds(low, high, step, 1), values: (_chart, ticks) => timeLabels(ticks) },
      { ...axis, size: valuesPx, space: 26, ...valueAxis },
    ],
    series: [
      {},
      ...Array.from({ length: seriesCount }, (_, i) => ({
        stroke: ofList(palette.signals, i),
        width: 1.4,
        points: { show: false },
        spanGaps: false,
      })),
    ],
  };
}

/** Ticks at round values, and one near either end: an axis says how far it reaches. None lies nearer than `apart` steps to an end. */
function withEnds(low: number, high: number, step: number, apart: number): number[] {
  const unit = 0.1 * step;
  const first = Math.ceil((low + 0.02 * (high - low)) / unit) * unit;
  const last = Math.floor((high - 0.02 * (high - low)) / unit) * unit;
  const ticks: number[] = [];
  for (let k = Math.ceil(low / step); k * step <= high; ++k)
    if (k * step - first > apart * step && last - k * step > apart * step) ticks.push(k * step);
  return [first, ...ticks, last];
}

/** Times before the scene began have no label. */
function timeLabels(ticks: number[]): string[] {
  return labelsOf(ticks, 's').map((label, i) => (ticks[i]! < 0 ? '' : label));
}

/** Some room around the values; a constant value lies in the middle, 0 between 1 and -1. */
export function rangeOf(low: number | null, high: number | null): [number, number] {
  if (low === null || high === null || (low === 0 && high === 0)) return [-1, 1];
  const size = Math.max(Math.abs(low), Math.abs(high));
  const room = Math.max(0.08 * (high - low), 1e-3 * size, 1e-12);
  return [low - room, high + room];
}

/** The decades that hold positive values, not more than MAX_DECADES of them. */
function decadesOf(low: number | null, high: number | null): [number, number] {
  if (low === null || high === null || !(high > 0)) return [0.1, 1];
  const top = Math.ceil(Math.log10(high) - 1e-9);
  const bottom = Math.max(top - MAX_DECADES, Math.floor(Math.log10(Math.max(low, Number.MIN_VALUE)) + 1e-9));
  return [10 ** Math.min(bottom, top - 1), 10 ** top];
}

/** Powers of ten, both ends among them. */
function decadeTicks(low: number, high: number): number[] {
  const [bottom, top] = [Math.round(Math.log10(low)), Math.round(Math.log10(high))];
  const step = Math.max(1, Math.ceil((top - bottom) / LABELLED_DECADES));
  const ticks = [10 ** bottom];
  for (let decade = bottom + step; decade <= top - step; decade += step) ticks.push(10 ** decade);
  return [...ticks, 10 ** top];
}

/** One prefix for all ticks of an axis, with as many decimals as they need. */
export function labelsOf(ticks: number[], unit: string): string[] {
  const largest = Math.max(...ticks.map(Math.abs));
  const [factor, letter] = unit === '' || unit === 's' ? [1, ''] : prefixOf(largest);
  const isExact = (decimals: number) => ticks.every((tick) => Math.abs((tick / factor) * 10 ** decimals - Math.round((tick / factor) * 10 ** decimals)) < 0.01);
  const decimals = [0, 1, 2, 3, 4, 5].find(isExact) ?? 6;
  return ticks.map((tick) => {
    const number = ticks.length > 1 ? (tick / factor).toFixed(decimals) : threeDigits(tick / factor);
    return unit === '' ? number : `${number} ${letter}${unit}`;
  });
}
