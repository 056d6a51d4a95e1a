// viz_node/web/page/signal_store.ts -- the last seconds of every signal, at full rate, in a ring of
// fixed size.
import type { Signals } from './protocol.ts';

const MAX_VALUES = 4_000_000; // 16 MB, whatever the scene
export const LONGEST_WINDOW_S = 20;

/** True if the rows of a batch end within a part of a period of where they would with that period. */
const fits = (batch: Signals, period: number): boolean => Math.abs(batch.rowPeriodS - period) * (batch.rowCount - 1) < 0.6 * period;

/** Rows are numbered from the start of the scene; rows that were lost on the way stand as NaN. */
export class SignalStore {
  private readonly values: Float32Array;
  private readonly capacity: number; // rows
  private nextRow = 0;
  private firstRow = 0;
  private originS = 0; // time of row 0
  private lastS = 0; // time of the newest row
  private period: number; // [s]
  gaps = 0; // rows lost so far

  constructor(
    readonly signalCount: number,
    private readonly rateHz: number,
  ) {
    this.period = 1 / rateHz;
    const wanted = Math.ceil(LONGEST_WINDOW_S * rateHz * 1.05) + 1;
    this.capacity = Math.max(2, Math.min(wanted, Math.floor(MAX_VALUES / Math.max(1, signalCount))));
    this.values = new Float32Array(this.capacity * Math.max(1, signalCount));
  }

  get rowCount(): number {
    return this.nextRow - this.firstRow;
  }

  /** Simulated time of the newest row [s]. */
  get newestS(): number {
    return this.timeOf(this.nextRow - 1);
  }

  get periodS(): number {
    return this.period;
  }

  newestOf(signal: number): number {
    return this.rowCount === 0 ? Number.NaN : this.valueAt(this.nextRow - 1, signal);
  }

  /** Rows come at a whole step each: their period is that of the scene but for a part of a step, another one in each batch. */
  append(batch: Signals): void {
    if (batch.signalCount !== this.signalCount || !(batch.rowPeriodS > 0) || batch.rowCount === 0) return;
    const missing = Math.round((batch.firstS - this.lastS) / this.period) - 1;
    if (this.rowCount === 0 || !fits(batch, this.period) || missing < 0 || missing > this.capacity) {
      this.restart(batch);
    } else {
      this.gaps += missing;
      for (let i = 0; i < missing; ++i) this.push(null, 0);
    }
    for (let r = 0; r < batch.rowCount; ++r) this.push(batch.values, r * this.signalCount);
    this.lastS = batch.firstS + (batch.rowCount - 1) * batch.rowPeriodS;
    this.originS = this.lastS - (this.nextRow - 1) * this.period;
  }

  private restart(batch: Signals): void {
    this.period = fits(batch, 1 / this.rateHz) ? 1 / this.rateHz : batch.rowPeriodS;
    this.nextRow = 0;
    this.firstRow = 0;
  }

  private push(source: Float32Array | null, offset: number): void {
    const base = (this.nextRow % this.capacity) * this.signalCount;
    for (let s = 0; s < this.signalCount; ++s) this.values[base + s] = source ? source[offset + s]! : Number.NaN;
    ++this.nextRow;
    if (this.rowCount > this.capacity) this.firstRow = this.nextRow - this.capacity;
  }

  private timeOf(row: number): number {
    return this.originS + row * this.period;
  }

  private valueAt(row: number, signal: number): number {
    return this.values[(row % this.capacity) * this.signalCount + signal]!;
  }

  /** Number of the row after the last one that is not later than `endS`. */
  private endRowAt(endS: number): number {
    return Math.max(this.firstRow, Math.min(this.nextRow, Math.floor((endS - this.originS) / this.period + 1e-6) + 1));
  }

  /** First row of `windowS` seconds up to a row. */
  private beginRow(endRow: number, windowS: number): number {
    return Math.max(this.firstRow, endRow - Math.ceil(windowS / this.period));
  }

  /**
   * `windowS` seconds of some signals up to `endS` as at most 2 x `columns` points: of each column the smallest and the largest value, so
   * that no peak is lost. Columns begin at multiples of their width, so that the curve does not shimmer while it moves.
   * Gives [times, values of signals[0], ...]; a gap is null.
   */
  window(signals: number[], windowS: number, columns: number, endS: number): (number | null)[][] {
    const endRow = this.endRowAt(endS);
    const wanted = endRow - this.beginRow(endRow, windowS);
    const rowsPerColumn = Math.max(1, Math.ceil(wanted / columns));
    const result: (number | null)[][] = Array.from({ length: signals.length + 1 }, () => []);
    if (wanted === 0) return result;
    if (rowsPerColumn <= 2) return this.everyRow(signals, endRow - wanted, endRow, result);
    const begin = Math.ceil((endRow - wanted) / rowsPerColumn) * rowsPerColumn;
    for (let row = begin; row < endRow; row += rowsPerColumn) {
      const end = Math.min(row + rowsPerColumn, endRow);
      result[0]!.push(this.timeOf(row), this.timeOf(row + 0.5 * (end - row)));
      signals.forEach((signal, i) => result[i + 1]!.push(...this.extremes(signal, row, end)));
    }
    return result;
  }

  /** `windowS` seconds up to `endS`, row after row: [time, values of the signals]; every nth where there are more than `most`. */
  rows(signals: number[], windowS: number, endS: number, most: number): number[][] {
    const endRow = this.endRowAt(endS);
    const begin = this.beginRow(endRow, windowS);
    const stride = Math.max(1, Math.ceil((endRow - begin) / most));
    const result: number[][] = [];
    for (let row = begin; row < endRow; row += stride) result.push([this.timeOf(row), ...signals.map((signal) => this.valueAt(row, signal))]);
    return result;
  }

  private everyRow(signals: number[], begin: number, end: number, result: (number | null)[][]): (number | null)[][] {
    for (let row = begin; row < end; ++row) {
      result[0]!.push(this.timeOf(row));
      signals.forEach((signal, i) => {
        const value = this.valueAt(row, signal);
        result[i + 1]!.push(Number.isFinite(value) ? value : null);
      });
    }
    return result;
  }

  /** Smallest and largest value of the rows, in the order in which they come. */
  private extremes(signal: number, begin: number, end: number): [number | null, number | null] {
    let smallest = Number.POSITIVE_INFINITY;
    let largest = Number.NEGATIVE_INFINITY;
    let smallestRow = begin;
    let largestRow = begin;
    for (let row = begin; row < end; ++row) {
      const value = this.valueAt(row, signal);
      if (value < smallest) [smallest, smallestRow] = [value, row];
      if (value > largest) [largest, largestRow] = [value, row];
    }
    if (!Number.isFinite(smallest) || !Number.isFinite(largest)) return [null, null];
    return smallestRow <= largestRow ? [smallest, largest] : [largest, smallest];
  }
}
