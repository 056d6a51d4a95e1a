// viz_node/web/page/sound/clock_follower.ts -- how fast a buffer is read, so that it stays as full
// as it should although its writer has another clock.

const SMOOTHING_S = 1; // of the fill: what arrives a little early or late does not bend the pitch
const GAIN_PER_S = 0.1; // rate per second of error: errors die away within 10 s
const INTEGRAL_PER_S2 = 0.0015; // learns the drift of the clocks; without overshoot at this gain
const MAX_CHANGE = 0.003; // 5 cents

/** Follows the clock of a writer by the fill of the buffer between the two. */
export class ClockFollower {
  private errorS = 0; // of the fill, smoothed
  private drift = 0; // of the writer's clock, as learnt so far

  /** What the reader's rate is multiplied by, 1 +- 0.003. */
  get ratio(): number {
    const change = this.drift + GAIN_PER_S * this.errorS;
    return 1 + Math.max(-MAX_CHANGE, Math.min(MAX_CHANGE, change));
  }

  /** Takes how full the buffer was over the last `durationS`, and how full it should be [s]. */
  note(fillS: number, targetS: number, durationS: number): void {
    const share = Math.min(1, durationS / SMOOTHING_S);
    this.errorS += share * (fillS - targetS - this.errorS);
    const learnt = this.drift + INTEGRAL_PER_S2 * this.errorS * durationS;
    this.drift = Math.max(-MAX_CHANGE, Math.min(MAX_CHANGE, learnt));
  }

  /** The buffer was filled again: its fill so far says nothing any more; the clocks are the same. */
  restart(): void {
    this.errorS = 0;
  }
}
