// viz_node/web/page/clock.ts -- two clocks and one rate: how old the view is, and how fast
// simulated time runs.

const BUCKET_MS = 10_000;

/**
 * How far the page's clock is ahead of viz_node's, taken from the message that travelled fastest during the last 20 to 30 seconds. The
 * time that even this message took remains in it: what is measured with it is the delay beyond the fastest.
 */
export class ClockOffset {
  private buckets: { beginMs: number; minMs: number }[] = [];

  note(sentNsec: number, nowMs: number): void {
    const offset = nowMs - sentNsec * 1e-6;
    const last = this.buckets[this.buckets.length - 1];
    if (last === undefined || nowMs - last.beginMs > BUCKET_MS) {
      this.buckets.push({ beginMs: nowMs, minMs: offset });
      if (this.buckets.length > 3) this.buckets.shift();
    } else {
      last.minMs = Math.min(last.minMs, offset);
    }
  }

  /** viz_node's clock [ms] when the page's is `nowMs`. */
  serverMs(nowMs: number): number {
    return nowMs - Math.min(...this.buckets.map((bucket) => bucket.minMs));
  }

  clear(): void {
    this.buckets = [];
  }
}

/** Simulated seconds per second, over the last two seconds. */
export class RealTimeFactor {
  private samples: { takenS: number; simulatedS: number }[] = [];

  note(takenNsec: number, simulatedS: number): void {
    const takenS = takenNsec * 1e-9;
    const last = this.samples[this.samples.length - 1];
    if (last !== undefined && (simulatedS < last.simulatedS || takenS < last.takenS)) this.samples = [];
    this.samples.push({ takenS, simulatedS });
    while (takenS - this.samples[0]!.takenS > 2) this.samples.shift();
  }

  get value(): number {
    const first = this.samples[0];
    const last = this.samples[this.samples.length - 1];
    if (first === undefined || last === undefined || last.takenS - first.takenS < 0.3) return Number.NaN;
    return (last.simulatedS - first.simulatedS) / (last.takenS - first.takenS);
  }

  clear(): void {
    this.samples = [];
  }
}
