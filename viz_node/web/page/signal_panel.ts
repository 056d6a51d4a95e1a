// viz_node/web/page/signal_panel.ts -- the plots and what a person does with them: which signals,
// how long, on which scale, against each other, and into files.
import { paletteOf, type Palette } from './colours.ts';
import { PhasePlot } from './phase_plot.ts';
import { csvOf, download, imageOf } from './plot_export.ts';
import { Plots } from './plots.ts';
import type { Description } from './protocol.ts';
import { press } from './rows.ts';
import type { SignalStore } from './signal_store.ts';
import { Traces } from './traces.ts';

const ZOOM_PER_PX = 1e-3; // of the wheel

function find<T extends HTMLElement>(selector: string): T {
  return document.querySelector<T>(selector)!;
}

export class SignalPanel {
  private readonly container = find('#plots');
  private readonly choices = find('#choices');
  private readonly plots = new Plots(this.container);
  private palette: Palette = paletteOf('dark');
  private store: SignalStore | null = null;
  private signals: Description['signals'] = [];
  private phase: PhasePlot | null = null;
  readonly traces: Traces;
  private isLogarithmic = false;

  constructor(
    private readonly fileName: (ending: string) => string,
    tracesChanged: () => void,
  ) {
    this.traces = new Traces(this.palette, () => {
      this.placePhase();
      tracesChanged();
    });
    for (const button of this.windowButtons) button.addEventListener('click', () => this.setWindow(Number(button.dataset.window)));
    this.container.addEventListener('wheel', (event) => this.zoom(event), { passive: false });
    this.on('log', (button) => {
      this.isLogarithmic = !this.isLogarithmic;
      press(button, this.isLogarithmic);
      this.plots.setLogarithmic(this.isLogarithmic);
      this.placePhase();
    });
    this.on('phase', () => this.togglePhase());
    this.on('choose', (button) => {
      this.choices.hidden = !this.choices.hidden;
      press(button, !this.choices.hidden);
    });
    this.on('csv', () => this.saveTable());
    this.on('png', () => void imageOf(this.container, this.palette).then((image) => image && download(image, this.fileName('plots.png'))));
  }

  /** Sets up for the signals of a scene; gives back the store to fill. */
  describe(description: Description): SignalStore {
    if (this.phase !== null) this.togglePhase();
    this.traces.clear();
    this.signals = description.signals;
    this.store = this.plots.describe(description);
    this.listChoices();
    return this.store;
  }

  paint(palette: Palette): void {
    this.palette = palette;
    this.plots.paint(palette);
    this.traces.paint(palette);
    this.placePhase();
  }

  /** What is shown stays while the view is frozen. */
  hold(wanted: boolean): void {
    this.plots.hold(wanted);
    this.draw();
  }

  draw(): void {
    this.plots.draw();
    this.traces.draw(this.plots.windowS, this.plots.endS);
    if (this.store !== null) this.phase?.draw(this.store, this.plots.windowS, this.plots.endS, this.palette);
  }

  togglePhase(): void {
    this.phase?.box.remove();
    this.phase = this.phase === null && this.signals.length > 0 ? new PhasePlot(this.signals, () => this.draw()) : null;
    press(find('#phase'), this.phase !== null);
    this.placePhase();
  }

  /** Farther or nearer: the window is `factor` times as long. */
  stretch(factor: number): void {
    this.setWindow(this.plots.windowS * factor);
  }

  /** Over the curves; elsewhere the wheel scrolls. */
  private zoom(event: WheelEvent): void {
    if (!(event.target instanceof Element && event.target.closest('.chart'))) return;
    event.preventDefault();
    this.stretch(Math.exp(ZOOM_PER_PX * event.deltaY));
  }

  private setWindow(seconds: number): void {
    this.plots.setWindow(seconds);
    for (const button of this.windowButtons) press(button, Number(button.dataset.window) === this.plots.windowS);
    this.draw();
  }

  /** The plots were built again: above them. */
  private placePhase(): void {
    this.container.prepend(...(this.phase === null ? [] : [this.phase.box]), ...this.traces.boxes);
    this.draw();
  }

  private listChoices(): void {
    const rows = this.signals.map(({ name, unit }, signal) => {
      const box = Object.assign(document.createElement('input'), { type: 'checkbox', checked: this.plots.chosen.has(signal) });
      box.addEventListener('change', () => {
        this.plots.choose(signal, box.checked);
        this.placePhase();
      });
      const label = document.createElement('label');
      label.append(box, unit === '' ? name : `${name} [${unit}]`);
      return label;
    });
    this.choices.replaceChildren(...rows);
  }

  private saveTable(): void {
    if (this.store === null) return;
    const chosen = [...this.plots.chosen].sort((a, b) => a - b);
    const table = csvOf(this.store, this.signals, chosen, this.plots.windowS, this.plots.endS);
    download(new Blob([table], { type: 'text/csv' }), this.fileName('csv'));
  }

  private get windowButtons(): HTMLButtonElement[] {
    return [...document.querySelectorAll<HTMLButtonElement>('#windows button')];
  }

  private on(id: string, action: (button: HTMLButtonElement) => void): void {
    const button = find<HTMLButtonElement>(`#${id}`);
    button.addEventListener('click', () => {
      action(button);
      button.blur();
    });
  }
}
