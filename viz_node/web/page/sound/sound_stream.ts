// viz_node/web/page/sound/sound_stream.ts -- blocks of sound in, as they arrive, and a steady sound
// out: buffered, at the rate of the listener, without clicks.
import { ClockFollower } from './clock_follower.ts';
import { RateMeter } from './rate_meter.ts';
import { Resampler } from './resampler.ts';

const TARGET_S = 0.06; // how full the buffer is kept
const PER_DROPOUT_S = 0.03; // fuller after each dropout, up to
const MAX_TARGET_S = 0.18;
const BEYOND_TARGET_S = 0.25; // more than this above the target is given up at once
const AT_START_S = 0.02; // the same, while nothing is audible
const FADE_S = 0.005;
const BUFFER_S = 1; // at least
const PAUSE_S = 0.4; // a silence so long is a pause of the scene, and no dropout
const LONGEST_GAP_S = 0.1; // of lost sound that is kept as a silence
const LONGEST_LOSS_S = 1; // what is further on is another place of a take
const MAX_RATE_HZ = 4e6; // 16 MB of buffer
const RATE_LIMIT = 0.02; // a scene further from real time is not played

/** One block of the sounds of a scene, mixed. */
export interface SoundBlock {
  firstStep: number;
  rateHz: number; // samples per second of simulated time
  samples: Float32Array; // 1 is the loudest
}

export interface SoundFigures {
  state: 'waiting' | 'playing' | 'paused' | 'off rate';
  bufferS: number; // how much sound waits to be heard
  targetS: number;
  dropouts: number; // times the buffer ran empty while the scene went on, or was given up
  lostS: number; // of sound that never came
  ratio: number; // of the listener's clock to the sender's, as it is followed
  sceneRate: number; // seconds of sound per second; NaN when not known
  steadyS: number; // for how long it has been heard without a gap
  nowS: number; // the time of these figures, by the clock of the listener
}

const fade = (share: number) => 0.5 - 0.5 * Math.cos(Math.PI * Math.max(0, Math.min(1, share)));

/** As it is up to 0.8, and never beyond 1. */
export function limited(value: number): number {
  const size = Math.abs(value);
  return size <= 0.8 ? value : Math.sign(value) * (0.8 + 0.2 * Math.tanh((size - 0.8) / 0.2));
}

/** The stream has no clock of its own: whoever calls says what time it is. */
export class SoundStream {
  private ring = new Float32Array(0);
  private resampler: Resampler | null = null;
  private rateHz = 0; // of the sound
  private written = 0; // samples, since the rate began
  private position = 0; // that is heard next
  private nextStep = Number.NaN; // that should come next
  private rampIn = 0; // samples of a fade that are still to be written
  private level = 0; // of the fade, 0 to 1
  private isAudible = false; // it fades in, or is there
  private targetS = TARGET_S;
  private dropouts = 0;
  private lostS = 0;
  private starvedS = Number.NaN; // when it ran empty, until it is known why
  private lastPushS = Number.NEGATIVE_INFINITY;
  private readonly follower = new ClockFollower();
  private meter = new RateMeter();
  private isPaused = false;
  private isLeaving = false; // another rate begins
  private brokenUntil = 0; // samples up to here are not all of one piece
  private steady = 0; // samples of the listener without a gap
  private nowS = 0;

  /** @param outputHz  samples per second of read() */
  constructor(private readonly outputHz: number) {}

  /** Takes the next block, at the time `nowS` of the caller's clock. */
  push(block: SoundBlock, nowS: number): void {
    if (!(block.rateHz > 0 && block.rateHz <= MAX_RATE_HZ) || block.samples.length === 0) return;
    this.isLeaving = block.rateHz !== this.rateHz && this.level > 0;
    if (this.isLeaving) return; // the block is lost: what is heard fades out first
    if (block.rateHz !== this.rateHz) this.begin(block.rateHz);
    const missing = block.firstStep - this.nextStep;
    if (missing !== 0 && this.written > 0) this.join(missing);
    this.nextStep = block.firstStep + block.samples.length;
    this.write(block.samples);
    this.evaluateSilence(nowS);
    this.lastPushS = nowS;
    this.isPaused = false;
    this.meter.note(nowS, this.nextStep / this.rateHz);
  }

  /** Fills `out`, whose first sample is heard at `nowS`. */
  read(out: Float32Array, nowS: number): void {
    this.nowS = nowS + out.length / this.outputHz;
    if (nowS - this.lastPushS > PAUSE_S) this.isPaused = true;
    if (this.resampler === null) return void out.fill(0);
    const wasWhole = this.level === 1;
    const ahead = this.bufferS;
    if (this.isAudible) this.follower.note(ahead, this.aimS, out.length / this.outputHz);
    this.control(ahead, out.length / this.outputHz, nowS);
    const step = (this.rateHz / this.outputHz) * this.follower.ratio;
    const change = 1 / (FADE_S * this.outputHz);
    for (let i = 0; i < out.length; ++i) {
      this.level = Math.max(0, Math.min(1, this.level + (this.isAudible ? change : -change)));
      if (this.level === 0 || this.readable <= 0) {
        out[i] = 0;
        continue;
      }
      const first = Math.floor(this.position);
      out[i] = limited(fade(this.level) * this.resampler.valueAt(this.ring, first, this.position - first));
      this.position += step;
    }
    this.steady = wasWhole && this.level === 1 && this.position > this.brokenUntil ? this.steady + out.length : 0;
  }

  get figures(): SoundFigures {
    const { targetS, dropouts, lostS, nowS } = this;
    const steadyS = this.steady / this.outputHz;
    const sceneRate = this.meter.value;
    const state = this.isPaused ? 'paused' : this.isOffRate ? 'off rate' : this.isAudible ? 'playing' : 'waiting';
    return { state, bufferS: this.bufferS, targetS, dropouts, lostS, ratio: this.follower.ratio, sceneRate, steadyS, nowS };
  }

  private get isOffRate(): boolean {
    return Math.abs(this.meter.value - 1) > RATE_LIMIT;
  }

  /** How much sound is there beyond what is heard now [s]. */
  private get bufferS(): number {
    return this.rateHz > 0 ? Math.max(0, this.written - this.position) / this.rateHz : 0;
  }

  /** How full the buffer is kept: the target, and what the kernel looks ahead [s]. */
  private get aimS(): number {
    return this.targetS + this.resampler!.reach / this.rateHz;
  }

  /** Samples that can be passed before the kernel reaches past the end. */
  private get readable(): number {
    return this.written - this.position - this.resampler!.reach - 1;
  }

  private begin(rateHz: number): void {
    this.rateHz = rateHz;
    this.resampler = new Resampler(rateHz, this.outputHz);
    this.meter = new RateMeter();
    const needed = BUFFER_S * rateHz + 4 * this.resampler.reach;
    this.ring = new Float32Array(2 ** Math.ceil(Math.log2(needed)));
    this.written = 0;
    this.position = 0;
    this.brokenUntil = 0;
    this.nextStep = Number.NaN;
    this.rampIn = 0;
    this.level = 0;
    this.isAudible = false;
  }

  /** Sound is missing, or another scene begins: what is there fades out, and what comes fades in. */
  private join(missing: number): void {
    const ramp = Math.ceil(FADE_S * this.rateHz);
    const mask = this.ring.length - 1;
    const length = Math.min(ramp, Math.max(0, Math.floor(this.readable)));
    for (let i = 0; i < length; ++i) this.ring[(this.written - 1 - i) & mask]! *= fade(i / length);
    this.rampIn = ramp;
    this.brokenUntil = this.written + ramp;
    if (!(missing > 0) || missing > LONGEST_LOSS_S * this.rateHz) return;
    this.lostS += missing / this.rateHz;
    const silence = missing <= LONGEST_GAP_S * this.rateHz ? missing : 0;
    for (let i = 0; i < silence; ++i) this.ring[this.written++ & mask] = 0;
    this.brokenUntil = this.written + ramp;
  }

  private write(samples: Float32Array): void {
    const mask = this.ring.length - 1;
    const ramp = Math.ceil(FADE_S * this.rateHz);
    for (const sample of samples) {
      const share = this.rampIn > 0 ? fade(1 - this.rampIn-- / ramp) : 1;
      this.ring[this.written++ & mask] = Number.isFinite(sample) ? share * sample : 0;
    }
    // The reader has stopped for most of a second: what was written over is not heard.
    this.position = Math.max(this.position, this.written - this.ring.length + 2 * this.resampler!.reach);
  }

  /** Begins and ends to be audible, and jumps while it is not. */
  private control(ahead: number, turnS: number, nowS: number): void {
    const fadeSamples = (FADE_S + turnS) * this.rateHz * 1.01 + 1; // it looks again after a turn
    if (this.isAudible) {
      const isEmpty = this.readable < fadeSamples;
      const isLate = ahead > this.aimS + BEYOND_TARGET_S;
      if (isEmpty) this.starvedS = nowS;
      if (isLate) ++this.dropouts;
      if (isEmpty || isLate || this.isLeaving || this.isOffRate) this.isAudible = false;
      return;
    }
    if (this.level > 0 || this.isLeaving) return;
    const latest = this.written - Math.ceil(this.aimS * this.rateHz);
    if (this.isOffRate || ahead > this.aimS + AT_START_S) this.position = Math.max(this.position, latest);
    if (this.isOffRate || this.isPaused || this.bufferS < this.aimS) return;
    this.follower.restart();
    this.isAudible = true;
  }

  /** Why it ran empty: after a long silence the scene was paused, after a short one sound came too late. */
  private evaluateSilence(nowS: number): void {
    if (Number.isNaN(this.starvedS)) return;
    const isDropout = nowS - this.lastPushS <= PAUSE_S;
    if (isDropout && !this.isOffRate) {
      ++this.dropouts;
      this.targetS = Math.min(MAX_TARGET_S, this.targetS + PER_DROPOUT_S);
    }
    this.starvedS = Number.NaN;
  }
}
