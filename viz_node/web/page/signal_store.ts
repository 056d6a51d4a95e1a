// viz_node/web/page/signal_store.ts -- the last seconds of every signal, at full rate, in a ring of
// fixed size.
import type { Signals } from './protocol.ts';

const MOST_VALUES = 4_000_000; // 16 MB, whatever the scene
const BLOCK = 64; // rows
export const LONGEST_WINDOW_S = 20;

/** Rows are numbered from the start of the scene; rows that were lost on the way stand as NaN. */
export class SignalStore {
  private values = new Float32Array();
  private smallest = new Float32Array(); // of each block of rows, per signal
  private largest = new Float32Array();
  private capacity = 0; // rows, whole blocks
  private nextRow = 0;
  private firstRow = 0;
  private originS = 0; // time of row 0
  private period: number; // [s]
  gaps = 0; // rows lost so far

  /** @param rateHz of the rows; the first batch says it better: a scene with sound has one for each step */
  constructor(
    readonly signalCount: number,
    rateHz: number,
  ) {
    this.period = 1 / rateHz;
    this.makeRoom();
  }

  /** Makes room for the longest window at the present period, or for less where that is too much. */
  private makeRoom(): void {
    const signals = Math.max(1, this.signalCount);
    const wanted = (LONGEST_WINDOW_S * 1.05) / this.period + 1;
    const blocks = Math.max(1, Math.ceil(Math.min(wanted, MOST_VALUES / signals) / BLOCK));
    if (blocks * BLOCK === this.capacity) return;
    this.capacity = blocks * BLOCK;
    this.values = new Float32Array(this.capacity * signals);
    this.smallest = new Float32Array(blocks * signals);
    this.largest = new Float32Array(blocks * signals);
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

  append(batch: Signals): void {
    if (batch.signalCount !== this.signalCount || !(batch.rowPeriodS > 0)) return;
    const row = Math.round((batch.firstS - this.originS) / batch.rowPeriodS);
    const missing = row - this.nextRow;
    if (this.rowCount === 0 || batch.rowPeriodS !== this.period || missing < 0 || missing > this.capacity) {
      this.restart(batch);
    } else {
      this.gaps += missing;
      for (let i = 0; i < missing; ++i) this.push(null, 0);
    }
    for (let r = 0; r < batch.rowCount; ++r) this.push(batch.values, r * this.signalCount);
  }

  private restart(batch: Signals): void {
    this.originS = batch.firstS;
    this.period = batch.rowPeriodS;
    this.makeRoom();
    this.nextRow = 0;
    this.firstRow = 0;
  }

  private push(source: Float32Array | null, offset: number): void {
    const slot = this.nextRow % this.capacity;
    const base = slot * this.signalCount;
    const block = Math.floor(slot / BLOCK) * this.signalCount;
    const begins = slot % BLOCK === 0;
    for (let s = 0; s < this.signalCount; ++s) {
      const value = source ? source[offset + s]! : Number.NaN;
      this.values[base + s] = value;
      if (begins) [this.smallest[block + s], this.largest[block + s]] = [Number.POSITIVE_INFINITY, Number.NEGATIVE_INFINITY];
      if (value < this.smallest[block + s]!) this.smallest[block + s] = value;
      if (value > this.largest[block + s]!) this.largest[block + s] = value;
    }
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

  /** Smallest and largest value of the rows, in the order in which they come, or in which their blocks do. */
  private extremes(signal: number, begin: number, end: number): [number | null, number | null] {
    let smallest = Number.POSITIVE_INFINITY;
    let largest = Number.NEGATIVE_INFINITY;
    let smallestRow = begin;
    let largestRow = begin;
    for (let row = begin; row < end; ) {
      const isBlock = row % BLOCK === 0 && row + BLOCK <= end;
      const block = (Math.floor(row / BLOCK) % (this.capacity / BLOCK)) * this.signalCount + signal;
      const low = isBlock ? this.smallest[block]! : this.valueAt(row, signal);
      const high = isBlock ? this.largest[block]! : low;
      if (low < smallest) [smallest, smallestRow] = [low, row];
      if (high > largest) [largest, largestRow] = [high, row];
      row += isBlock ? BLOCK : 1;
    }
    if (!Number.isFinite(smallest) || !Number.isFinite(largest)) return [null, null];
    return smallestRow <= largestRow ? [smallest, largest] : [largest, smallest];
  }
}
