// viz_node/web/page/traces.ts -- plots of MATs and links that a person has picked, frame by frame.
import uPlot from 'uplot';
import { ofList, type Palette } from './colours.ts';
import { joined, withUnit } from './format.ts';
import { optionsOf, valuesPxOf } from './plot_options.ts';
import { setText } from './rows.ts';
import { LONGEST_WINDOW_S } from './signal_store.ts';

const MAX_TRACES = 4; // the oldest goes

/** What is plotted of a thing. */
export interface Traced {
  key: string; // one trace for each
  title: string;
  series: string[];
  unit: string;
  values: () => number[]; // now, one per series
}

class Trace {
  readonly box = Object.assign(document.createElement('section'), { className: 'plot trace' });
  private readonly canvas = Object.assign(document.createElement('div'), { className: 'chart' });
  private readonly head = document.createElement('header');
  private chart: uPlot | null = null;
  private readonly times: number[] = [];
  private readonly rows: number[][];
  private figures: HTMLElement[] = [];
  private readonly watch = new ResizeObserver(() => this.resize());

  constructor(readonly traced: Traced, close: () => void) {
    this.rows = traced.series.map(() => []);
    const button = Object.assign(document.createElement('button'), { textContent: '×', title: 'Plot it no longer' });
    button.setAttribute('aria-label', `Plot ${traced.title} no longer`);
    button.addEventListener('click', close);
    this.box.append(this.head, this.canvas);
    this.watch.observe(this.canvas);
    this.head.append(Object.assign(document.createElement('span'), { className: 'at', textContent: traced.title }), button);
  }

  append(timeS: number): void {
    if (timeS <= (this.times.at(-1) ?? Number.NEGATIVE_INFINITY)) return;
    this.times.push(timeS);
    this.traced.values().forEach((value, i) => this.rows[i]!.push(value));
    while (this.times[0]! < timeS - LONGEST_WINDOW_S) [this.times, ...this.rows].forEach((row) => row.shift());
  }

  paint(palette: Palette): void {
    this.chart?.destroy();
    this.head.querySelectorAll('.series').forEach((label) => label.remove());
    this.figures = this.traced.series.map((name, i) => {
      const label = Object.assign(document.createElement('span'), { className: 'series', textContent: name });
      label.style.setProperty('--colour', ofList(palette.signals, i));
      const figure = document.createElement('b');
      label.append(figure);
      this.head.lastElementChild!.before(label);
      return figure;
    });
    const look = { unit: this.traced.unit, seriesCount: this.rows.length, palette, valuesPx: valuesPxOf([this.traced.unit]), logarithmic: false, pointed: () => this.writeFigures() };
    this.chart = new uPlot(optionsOf(look), [[]], this.canvas);
    this.resize();
  }

  draw(windowS: number, endS: number): void {
    const { chart } = this;
    if (chart === null) return;
    chart.batch(() => {
      chart.setData([this.times, ...this.rows], false);
      chart.setScale('x', { min: endS - windowS, max: endS });
    });
    this.writeFigures();
  }

  /** The values under the pointer, or else the newest. */
  private writeFigures(): void {
    const column = this.chart?.cursor.idx ?? this.times.length - 1;
    this.figures.forEach((figure, i) => setText(figure, joined(withUnit(this.rows[i]![column], this.traced.unit))));
  }

  private resize(): void {
    const { chart, canvas } = this;
    const [width, height] = [Math.max(80, canvas.clientWidth), Math.max(40, canvas.clientHeight)];
    if (width !== chart?.width || height !== chart.height) chart?.setSize({ width, height });
  }

  close(): void {
    this.watch.disconnect();
    this.chart?.destroy();
    this.box.remove();
  }
}

export class Traces {
  private list: Trace[] = [];

  constructor(
    private palette: Palette,
    private readonly changed: () => void, // there are others
  ) {}

  get boxes(): HTMLElement[] {
    return this.list.map(({ box }) => box);
  }

  has(key: string): boolean {
    return this.list.some(({ traced }) => traced.key === key);
  }

  /** Plots a thing, or no longer. */
  toggle(traced: Traced): void {
    if (this.has(traced.key)) return this.remove(traced.key);
    if (this.list.length === MAX_TRACES) this.list.shift()!.close();
    const trace = new Trace(traced, () => this.remove(traced.key));
    trace.paint(this.palette);
    this.list.push(trace);
    this.changed();
  }

  /** Takes the values of a frame that is drawn. */
  append(timeS: number): void {
    for (const trace of this.list) trace.append(timeS);
  }

  draw(windowS: number, endS: number): void {
    for (const trace of this.list) trace.draw(windowS, endS);
  }

  paint(palette: Palette): void {
    this.palette = palette;
    for (const trace of this.list) trace.paint(palette);
  }

  /** The things of a scene go with it. */
  clear(): void {
    for (const trace of this.list) trace.close();
    this.list = [];
    this.changed();
  }

  private remove(key: string): void {
    this.list.filter(({ traced }) => traced.key === key).forEach((trace) => trace.close());
    this.list = this.list.filter(({ traced }) => traced.key !== key);
    this.changed();
  }
}
