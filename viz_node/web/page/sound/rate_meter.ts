// viz_node/web/page/sound/rate_meter.ts -- how fast a sound arrives, against how fast it is to be
// played.

const BUCKET_S = 0.5;
const BUCKETS = 4;
const SILENCE_S = 0.4;
const JUMP_S = 0.5; // a take was moved

/** The block of half a second that arrived with the least delay. */
interface Bucket {
  beginS: number;
  nowS: number;
  delayS: number;
}

/** Seconds of sound per second of the clock. Of each half second only the fastest block counts: a machine that stops for a moment does not. */
export class RateMeter {
  private buckets: Bucket[] = []; // oldest first; the last one is not complete
  private lastS = Number.NEGATIVE_INFINITY; // when a block came
  private endS = Number.NEGATIVE_INFINITY; // where the sound ended with it

  /** NaN before one and a half seconds have been seen. */
  value = Number.NaN;

  /** Takes a block that arrives at `nowS` and ends `soundS` after the beginning of the scene. */
  note(nowS: number, soundS: number): void {
    if (soundS <= this.endS || soundS > this.endS + JUMP_S || nowS - this.lastS > SILENCE_S) this.clear();
    this.lastS = nowS;
    this.endS = soundS;
    const delayS = nowS - soundS;
    const last = this.buckets[this.buckets.length - 1];
    if (last === undefined || nowS - last.beginS >= BUCKET_S) this.begin({ beginS: nowS, nowS, delayS });
    else if (delayS < last.delayS) Object.assign(last, { nowS, delayS });
  }

  private begin(bucket: Bucket): void {
    if (this.buckets.length >= 3) {
      const oldest = this.buckets[0]!;
      const newest = this.buckets[this.buckets.length - 1]!;
      this.value = 1 - (newest.delayS - oldest.delayS) / (newest.nowS - oldest.nowS);
    }
    this.buckets.push(bucket);
    if (this.buckets.length > BUCKETS) this.buckets.shift();
  }

  private clear(): void {
    this.buckets = [];
    this.value = Number.NaN;
  }
}
