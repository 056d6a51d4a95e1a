// viz_node/web/page/phase_plot.ts -- one signal against another, as force against position.
import type { Palette } from './colours.ts';
import { AXIS_FONT, labelsOf, rangeOf } from './plot_options.ts';
import type { Description } from './protocol.ts';
import type { SignalStore } from './signal_store.ts';

const MAX_POINTS = 2000;
const [LEFT, RIGHT, TOP, BOTTOM] = [72, 12, 6, 20]; // around the curve [CSS pixels]

export class PhasePlot {
  readonly box = Object.assign(document.createElement('section'), { className: 'plot phase' });
  private readonly canvas = Object.assign(document.createElement('canvas'), { className: 'chart' });
  private readonly x: HTMLSelectElement;
  private readonly y: HTMLSelectElement;
  private width = 0; // of the canvas [CSS pixels]
  private height = 0;

  constructor(
    private readonly signals: Description['signals'],
    private readonly changed: () => void, // other signals are chosen
  ) {
    this.y = this.chooser('N', 1, 'upwards');
    this.x = this.chooser('m', 0, 'to the right');
    const head = document.createElement('header');
    head.append(this.y, ' against ', this.x);
    this.box.append(head, this.canvas);
    new ResizeObserver(() => {
      [this.width, this.height] = [this.canvas.clientWidth, this.canvas.clientHeight];
      this.changed();
    }).observe(this.canvas);
  }

  /** Draws `windowS` seconds up to `endS`, with a dot at their end. */
  draw(store: SignalStore, windowS: number, endS: number, palette: Palette): void {
    const { width, height } = this;
    const pen = this.canvas.getContext('2d');
    if (pen === null || width === 0 || height === 0) return;
    const ratio = Math.min(window.devicePixelRatio, 2);
    [this.canvas.width, this.canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
    pen.scale(ratio, ratio);
    const [ix, iy] = [Number(this.x.value), Number(this.y.value)];
    const rows = store.rows([ix, iy], windowS, endS, MAX_POINTS) as [number, number, number][];
    const finite = rows.filter(([, a, b]) => Number.isFinite(a) && Number.isFinite(b));
    const [x0, x1] = spanOf(finite.map(([, a]) => a));
    const [y0, y1] = spanOf(finite.map(([, , b]) => b));
    const [right, bottom] = [width - RIGHT, height - BOTTOM];
    pen.font = AXIS_FONT;
    pen.strokeStyle = palette.grid_axis;
    pen.strokeRect(LEFT, TOP, right - LEFT, bottom - TOP);
    pen.fillStyle = palette.quiet;
    const [lowest, highest] = labelsOf([y0, y1].map(threeFigures), this.signals[iy]!.unit) as [string, string];
    const [leftmost, rightmost] = labelsOf([x0, x1].map(threeFigures), this.signals[ix]!.unit) as [string, string];
    pen.textAlign = 'right';
    pen.fillText(highest, LEFT - 4, TOP + 10);
    pen.fillText(lowest, LEFT - 4, bottom);
    pen.fillText(rightmost, right, bottom + 14);
    pen.textAlign = 'left';
    pen.fillText(leftmost, LEFT, bottom + 14);
    const placeOf = (a: number, b: number) => [LEFT + ((a - x0) / (x1 - x0)) * (right - LEFT), bottom - ((b - y0) / (y1 - y0)) * (bottom - TOP)] as const;
    pen.strokeStyle = palette.signals[0]!;
    pen.lineWidth = 1.4;
    pen.beginPath();
    let isDown = false; // a gap lifts the pen
    for (const [, a, b] of rows) {
      const isThere = Number.isFinite(a) && Number.isFinite(b);
      if (isThere && isDown) pen.lineTo(...placeOf(a, b));
      else if (isThere) pen.moveTo(...placeOf(a, b));
      isDown = isThere;
    }
    pen.stroke();
    const last = finite.at(-1);
    if (last === undefined) return;
    pen.fillStyle = palette.text;
    pen.beginPath();
    pen.arc(...placeOf(last[1], last[2]), 3, 0, 2 * Math.PI);
    pen.fill();
  }

  /** A list of the signals; at first the first one of this unit is chosen, or else the one of this number. */
  private chooser(unit: string, otherwise: number, label: string): HTMLSelectElement {
    const select = document.createElement('select');
    select.setAttribute('aria-label', label);
    select.append(...this.signals.map(({ name }, signal) => new Option(name, String(signal))));
    const found = this.signals.findIndex((signal) => signal.unit === unit);
    select.value = String(found >= 0 ? found : Math.min(otherwise, this.signals.length - 1));
    select.addEventListener('change', () => this.changed());
    return select;
  }
}

const spanOf = (values: number[]): [number, number] =>
  values.length === 0 ? [-1, 1] : rangeOf(Math.min(...values), Math.max(...values));

const threeFigures = (value: number): number => Number(value.toPrecision(3));
