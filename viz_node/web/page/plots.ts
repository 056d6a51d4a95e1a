// viz_node/web/page/plots.ts -- live plots of the signals: one per unit, the newest at the right
// edge.
import uPlot from 'uplot';
import { ofList, paletteOf, type Palette } from './colours.ts';
import { joined, withUnit } from './format.ts';
import { optionsOf, valuesPxOf } from './plot_options.ts';
import type { Description } from './protocol.ts';
import { setText } from './rows.ts';
import { LONGEST_WINDOW_S, SignalStore } from './signal_store.ts';

const MAX_PLOTS = 4; // at first; more when a person chooses more
const MAX_PER_PLOT = paletteOf('dark').signals.length;
const SHORTEST_WINDOW_ROWS = 20;

interface Plot {
  chart: uPlot;
  box: HTMLElement;
  pointedTime: HTMLElement; // that the pointer is at
  signals: number[];
  values: HTMLElement[];
  shown: (number | null)[][]; // time, then a row per signal
  unit: string;
}

export class Plots {
  store: SignalStore | null = null;
  description: Description | null = null;
  palette: Palette = paletteOf('dark');
  windowS = 5;
  chosen = new Set<number>(); // signals
  private plots: Plot[] = [];
  private isLogarithmic = false;
  private heldS: number | null = null; // the time at the right edge while the view is frozen

  constructor(private readonly container: HTMLElement) {
    new ResizeObserver(() => this.resize()).observe(container);
  }

  /** Sets up for the signals of a scene; gives back the store to fill. */
  describe(description: Description): SignalStore {
    this.description = description;
    this.store = new SignalStore(description.signals.length, description.gesture_rate_hz);
    this.heldS = null;
    const groups = [...this.byUnit(description.signals.map((_, signal) => signal))].slice(0, MAX_PLOTS);
    this.chosen = new Set(groups.flatMap(([, signals]) => signals.slice(0, MAX_PER_PLOT)));
    this.buildAll();
    return this.store;
  }

  /** Draws all of them in the colours of a palette. */
  paint(palette: Palette): void {
    this.palette = palette;
    this.buildAll();
  }

  /** Draws a signal, or leaves it out. */
  choose(signal: number, wanted: boolean): void {
    if (wanted) this.chosen.add(signal);
    else this.chosen.delete(signal);
    this.buildAll();
  }

  /** The sizes of the values on a logarithmic scale, or the values on a linear one. */
  setLogarithmic(wanted: boolean): void {
    this.isLogarithmic = wanted;
    this.buildAll();
  }

  setWindow(seconds: number): void {
    const shortest = SHORTEST_WINDOW_ROWS * (this.store?.periodS ?? 1e-3);
    this.windowS = Math.min(LONGEST_WINDOW_S, Math.max(shortest, seconds));
    this.draw();
  }

  /** What is shown stays, whatever comes; it can be looked at closer. */
  hold(wanted: boolean): void {
    this.heldS = wanted ? this.endS : null;
    this.draw();
  }

  /** Time at the right edge [s]. */
  get endS(): number {
    return this.heldS ?? this.store?.newestS ?? 0;
  }

  draw(): void {
    if (this.store === null || this.store.rowCount === 0) return;
    for (const plot of this.plots) {
      plot.shown = this.store.window(plot.signals, this.windowS, Math.max(50, Math.floor(plot.chart.width)), this.endS);
      const [times, ...rows] = plot.shown;
      const drawn = this.isLogarithmic ? rows.map((row) => row.map((value) => (value ? Math.abs(value) : null))) : rows;
      plot.chart.batch(() => {
        plot.chart.setData([times, ...drawn] as uPlot.AlignedData, false);
        plot.chart.setScale('x', { min: this.endS - this.windowS, max: this.endS });
      });
      this.writeValues(plot);
    }
  }

  /** The values under the pointer, or else the newest. */
  private writeValues(plot: Plot): void {
    const column = plot.chart.cursor.idx ?? plot.shown[0]!.length - 1;
    plot.signals.forEach((_, i) => {
      setText(plot.values[i]!, joined(withUnit(plot.shown[i + 1]?.[column], plot.unit)));
    });
    const pointedS = plot.chart.cursor.idx == null ? undefined : plot.shown[0]?.[column];
    setText(plot.pointedTime, typeof pointedS === 'number' ? `at ${pointedS.toFixed(3)} s` : '');
  }

  private byUnit(signals: number[]): Map<string, number[]> {
    const groups = new Map<string, number[]>();
    for (const signal of signals) {
      const { unit } = this.description!.signals[signal]!;
      groups.set(unit, [...(groups.get(unit) ?? []), signal]);
    }
    return groups;
  }

  private buildAll(): void {
    if (this.description === null) return;
    const { signals } = this.description;
    for (const plot of this.plots) plot.chart.destroy();
    this.container.replaceChildren();
    this.plots = [...this.byUnit([...this.chosen].sort((a, b) => a - b))].map(([unit, group]) => this.build(unit, group, signals));
    const hidden = signals.length - this.chosen.size;
    if (signals.length === 0) this.say('This scene names no signals. List them under `signals:` in its file.');
    if (hidden > 0) this.say(`${hidden} more ${hidden === 1 ? 'signal is' : 'signals are'} not drawn: Choose`);
    this.resize();
  }

  private say(text: string): void {
    const note = document.createElement('p');
    note.className = 'note';
    note.textContent = text;
    this.container.append(note);
  }

  private build(unit: string, group: number[], signals: Description['signals']): Plot {
    const box = document.createElement('section');
    box.className = 'plot';
    const head = document.createElement('header');
    const values = group.map((signal, i) => {
      const label = document.createElement('span');
      label.className = 'series';
      label.style.setProperty('--colour', ofList(this.palette.signals, i));
      const value = document.createElement('b');
      label.append(signals[signal]!.name, value);
      head.append(label);
      return value;
    });
    const pointedTime = Object.assign(document.createElement('span'), { className: 'at' });
    head.append(pointedTime);
    const canvas = document.createElement('div');
    canvas.className = 'chart';
    box.append(head, canvas);
    this.container.append(box);
    const pointed = () => this.writeValues(plot);
    const valuesPx = valuesPxOf([...this.chosen].map((signal) => signals[signal]!.unit));
    const look = { unit, seriesCount: group.length, palette: this.palette, valuesPx, logarithmic: this.isLogarithmic, pointed };
    const plot: Plot = { chart: new uPlot(optionsOf(look), [[]], canvas), box: canvas, pointedTime, signals: group, values, shown: [[]], unit };
    return plot;
  }

  private resize(): void {
    for (const { chart, box } of this.plots) {
      const [width, height] = [Math.max(80, box.clientWidth), Math.max(40, box.clientHeight)];
      if (width !== chart.width || height !== chart.height) chart.setSize({ width, height });
    }
    this.draw();
  }
}
