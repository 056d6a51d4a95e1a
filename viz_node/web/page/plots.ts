// viz_node/web/page/plots.ts -- live plots of the signals: one per unit, the newest at the right
// edge.
import uPlot from 'uplot';
import { ofList, paletteOf, type Palette } from './colours.ts';
import { joined, prefixOf, threeDigits, withUnit } from './format.ts';
import type { Description } from './protocol.ts';
import { SignalStore } from './signal_store.ts';

const MOST_PLOTS = 4;
const MOST_PER_PLOT = paletteOf('dark').signals.length;
const AXIS_FONT = '11px system-ui, "DejaVu Sans", sans-serif';

interface Plot {
  chart: uPlot;
  box: HTMLElement;
  signals: number[]; // columns of the store
  values: HTMLElement[]; // newest value of each
  unit: string;
}

export class Plots {
  private plots: Plot[] = [];
  private store: SignalStore | null = null;
  private windowS = 5;
  private description: Description | null = null;
  private palette: Palette = paletteOf('dark');

  constructor(private readonly container: HTMLElement) {
    new ResizeObserver(() => this.resize()).observe(container);
  }

  /** Sets up for the signals of a scene; gives back the store to fill. */
  describe(description: Description): SignalStore {
    this.description = description;
    this.store = new SignalStore(description.signals.length, description.gesture_rate_hz);
    this.buildAll(description);
    return this.store;
  }

  /** Draws all of them in the colours of a palette. */
  paint(palette: Palette): void {
    this.palette = palette;
    if (this.description !== null) this.buildAll(this.description);
  }

  private buildAll(description: Description): void {
    for (const plot of this.plots) plot.chart.destroy();
    this.container.replaceChildren();
    const groups = new Map<string, number[]>();
    description.signals.forEach(({ unit }, index) => groups.set(unit, [...(groups.get(unit) ?? []), index]));
    const shown = [...groups].slice(0, MOST_PLOTS);
    this.plots = shown.map(([unit, signals]) => this.build(unit, signals.slice(0, MOST_PER_PLOT), description));
    const hidden = description.signals.length - this.plots.reduce((sum, plot) => sum + plot.signals.length, 0);
    if (description.signals.length === 0) this.say('This scene names no signals. List them under `signals:` in its file.');
    if (hidden > 0) this.say(`${hidden} more signals are not drawn`);
    this.resize();
  }

  setWindow(seconds: number): void {
    this.windowS = seconds;
    this.draw();
  }

  draw(): void {
    if (this.store === null || this.store.rowCount === 0) return;
    const newest = this.store.newestS;
    for (const plot of this.plots) {
      const data = this.store.window(plot.signals, this.windowS, Math.max(50, Math.floor(plot.chart.width)));
      plot.chart.batch(() => {
        plot.chart.setData(data as uPlot.AlignedData, false);
        plot.chart.setScale('x', { min: newest - this.windowS, max: newest });
      });
      plot.signals.forEach((signal, i) => {
        plot.values[i]!.textContent = joined(withUnit(this.store!.newestOf(signal), plot.unit));
      });
    }
  }

  private say(text: string): void {
    const note = document.createElement('p');
    note.className = 'note';
    note.textContent = text;
    this.container.append(note);
  }

  private build(unit: string, signals: number[], description: Description): Plot {
    const box = document.createElement('section');
    box.className = 'plot';
    const head = document.createElement('header');
    const values = signals.map((signal, i) => {
      const label = document.createElement('span');
      label.className = 'series';
      label.style.setProperty('--colour', ofList(this.palette.signals, i));
      const value = document.createElement('b');
      label.append(description.signals[signal]!.name, value);
      head.append(label);
      return value;
    });
    const canvas = document.createElement('div');
    canvas.className = 'chart';
    box.append(head, canvas);
    this.container.append(box);
    return { chart: new uPlot(optionsOf(unit, signals.length, this.palette), [[]], canvas), box: canvas, signals, values, unit };
  }

  private resize(): void {
    for (const { chart, box } of this.plots) {
      const [width, height] = [Math.max(80, box.clientWidth), Math.max(40, box.clientHeight)];
      if (width !== chart.width || height !== chart.height) chart.setSize({ width, height });
    }
    this.draw();
  }
}

function optionsOf(unit: string, seriesCount: number, palette: Palette): uPlot.Options {
  const lines = { stroke: palette.grid_coarse, width: 1 };
  const axis = { stroke: palette.quiet, font: AXIS_FONT, grid: lines, ticks: { ...lines, size: 4 } };
  return {
    width: 320,
    height: 120,
    legend: { show: false },
    cursor: { show: false },
    padding: [6, 10, 0, 0],
    scales: { x: { time: false, auto: false }, y: { range: (_chart, low, high) => rangeOf(low, high) } },
    axes: [
      { ...axis, size: 22, space: 50, values: (_chart, ticks) => ticks.map((t) => (t < 0 ? '' : `${+t.toFixed(3)} s`)) },
      { ...axis, size: 58, space: 26, values: (_chart, ticks) => labelsOf(ticks, unit) },
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

/** Some room around the values; a constant value lies in the middle, 0 between 1 and -1. */
function rangeOf(low: number | null, high: number | null): [number, number] {
  if (low === null || high === null || (low === 0 && high === 0)) return [-1, 1];
  const size = Math.max(Math.abs(low), Math.abs(high));
  const room = Math.max(0.08 * (high - low), 1e-3 * size, 1e-12);
  return [low - room, high + room];
}

/** One prefix for all ticks of an axis, with as many decimals as their distance asks for. */
function labelsOf(ticks: number[], unit: string): string[] {
  if (ticks.length === 0) return [];
  const largest = Math.max(...ticks.map(Math.abs));
  const [factor, letter] = unit === '' ? [1, ''] : prefixOf(largest);
  const step = ticks.length > 1 ? Math.abs(ticks[1]! - ticks[0]!) / factor : 1;
  let decimals = Math.min(6, Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));
  if (decimals < 6 && Math.abs(step * 10 ** decimals - Math.round(step * 10 ** decimals)) > 0.01) ++decimals; // 0.25
  return ticks.map((tick) => {
    const number = ticks.length > 1 ? (tick / factor).toFixed(decimals) : threeDigits(tick / factor);
    return unit === '' ? number : `${number} ${letter}${unit}`;
  });
}
