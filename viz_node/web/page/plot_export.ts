// viz_node/web/page/plot_export.ts -- signals as a table, and plots as an image.
import type { Palette } from './colours.ts';
import type { Description } from './protocol.ts';
import type { SignalStore } from './signal_store.ts';

const HEAD_PX = 20; // above each plot

/** Gives the browser a file to keep. */
export function download(content: Blob, name: string): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(content);
  link.download = name;
  link.click();
  URL.revokeObjectURL(link.href);
}

/** A cell of a table; quoted where it has to be. */
const cell = (text: string): string => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

/** Signals at their full rate, comma-separated; a value that is missing is empty. */
export function csvOf(store: SignalStore, all: Description['signals'], chosen: number[], windowS: number, endS: number): string {
  const units = chosen.map((signal) => all[signal]!).map(({ name, unit }) => cell(unit === '' ? name : `${name} [${unit}]`));
  const rows = store.rows(chosen, windowS, endS, Number.POSITIVE_INFINITY);
  const lines = rows.map(([time, ...values]) => [time!.toFixed(6), ...values.map((value) => (Number.isFinite(value) ? String(value) : ''))].join(','));
  return `${['time [s]', ...units].join(',')}\n${lines.join('\n')}\n`;
}

/** All plots of `container`, one below the other, each under the names of its signals. */
export function imageOf(container: HTMLElement, palette: Palette): Promise<Blob | null> {
  const canvases = [...container.querySelectorAll('canvas')];
  const ratio = Math.min(window.devicePixelRatio, 2);
  const head = HEAD_PX * ratio;
  const width = Math.max(1, ...canvases.map((canvas) => canvas.width));
  const height = Math.max(1, canvases.reduce((sum, canvas) => sum + canvas.height + head, 0));
  const sheet = Object.assign(document.createElement('canvas'), { width, height });
  const pen = sheet.getContext('2d');
  if (pen === null) return Promise.resolve(null);
  pen.fillStyle = palette.background;
  pen.fillRect(0, 0, width, height);
  pen.font = `${12 * ratio}px system-ui, "DejaVu Sans", sans-serif`;
  let y = 0;
  for (const canvas of canvases) {
    let x = 8 * ratio;
    for (const { name, colour } of namesOf(canvas.closest('.plot')!, palette)) {
      pen.fillStyle = colour;
      pen.fillText(name, x, y + 14 * ratio);
      x += pen.measureText(name).width + 14 * ratio;
    }
    pen.drawImage(canvas, 0, y + head);
    y += canvas.height + head;
  }
  return new Promise((resolve) => sheet.toBlob(resolve));
}

function namesOf(plot: Element, palette: Palette): { name: string; colour: string }[] {
  const labels = [...plot.querySelectorAll<HTMLElement>('.series')];
  if (labels.length > 0) return labels.map((label) => ({ name: label.firstChild!.textContent!, colour: label.style.getPropertyValue('--colour') }));
  const chosen = [...plot.querySelectorAll('select')].map((select) => select.selectedOptions[0]?.text ?? '');
  return [{ name: chosen.join(' against '), colour: palette.text }];
}
