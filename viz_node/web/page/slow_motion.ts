// viz_node/web/page/slow_motion.ts -- how fast simulated time passes in a realtime session, and the
// slider that slows it.
import type { Description, DeviceShape, NodeState } from './protocol.ts';
import { setText } from './rows.ts';

const SEND_PERIOD_MS = 100; // while the slider is dragged
const SETTLES_MS = 1000; // after a command, until sim_node has said how fast it plays
const SLOWEST = 0.01;

/** Simulated seconds per second that a sim_node has as its target, 1 without a status. */
export function timeScaleOf(sim: NodeState | undefined, description: Description | null): number {
  const ratio = (sim?.target_rate_hz ?? 0) / (description?.gesture_rate_hz ?? 0);
  return Number.isFinite(ratio) && ratio > 0 ? Math.min(1, ratio) : 1;
}

/** True in a realtime session whose scene plays no real device. */
export function canBeSlowed(sim: NodeState | undefined, description: Description | null, devices: DeviceShape[]): boolean {
  if (sim?.kind !== 'sim_node' || description === null || !((sim.target_rate_hz ?? 0) > 0)) return false;
  const played = new Set(description.ports.map(({ device }) => device));
  return devices.every(({ name, simulated }) => simulated || !played.has(name));
}

/** 0.1 as ×0.1, 0.0316 as ×0.032. */
export const timeScaleText = (scale: number): string => `×${Number(scale.toPrecision(2))}`;

export class SlowMotion {
  private readonly box = document.querySelector<HTMLElement>('#slow')!;
  private readonly slider = document.querySelector<HTMLInputElement>('#slow-scale')!;
  private readonly text = document.querySelector<HTMLElement>('#slow-text')!;
  private isDragged = false;
  private askedMs = Number.NEGATIVE_INFINITY; // when a command was sent last
  private timer = 0;

  constructor(private readonly command: (verb: string, more: { value: number }) => void) {
    this.slider.addEventListener('input', () => {
      this.isDragged = true;
      this.showText(this.wanted);
      if (this.timer === 0) this.timer = window.setTimeout(() => this.send(), SEND_PERIOD_MS);
    });
    this.slider.addEventListener('change', () => {
      this.isDragged = false;
      this.send();
      this.slider.blur(); // keys are for the view again
    });
  }

  update(sim: NodeState | undefined, description: Description | null, devices: DeviceShape[], mayCommand: boolean): void {
    this.box.hidden = !canBeSlowed(sim, description, devices);
    this.slider.disabled = !mayCommand;
    if (this.isDragged || performance.now() - this.askedMs < SETTLES_MS) return;
    const scale = timeScaleOf(sim, description);
    this.slider.value = String(Math.log10(scale));
    this.showText(scale);
  }

  /** A key of the page; true when it was one of slow motion. */
  key(name: string): boolean {
    if (this.box.hidden || this.slider.disabled || !['[', ']'].includes(name)) return false;
    if (name === '[') this.slider.stepDown(5);
    else this.slider.stepUp(5);
    this.showText(this.wanted);
    this.send();
    return true;
  }

  /** The slider is logarithmic: its value is a power of ten. */
  private get wanted(): number {
    return Math.min(1, Math.max(SLOWEST, Number((10 ** Number(this.slider.value)).toPrecision(2))));
  }

  private showText(scale: number): void {
    setText(this.text, timeScaleText(scale));
    this.slider.setAttribute('aria-valuetext', timeScaleText(scale));
    this.box.classList.toggle('on', scale < 1);
  }

  private send(): void {
    clearTimeout(this.timer);
    this.timer = 0;
    this.askedMs = performance.now();
    this.command('rate', { value: this.wanted });
  }
}
