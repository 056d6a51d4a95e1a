// viz_node/web/page/take.ts -- a take that is played: where it is, and the bar that moves it.
import type { Connection } from './connection.ts';
import { setText } from './rows.ts';
import type { NodeState } from './protocol.ts';

const SILENT_AFTER_S = 2; // the player speaks twice a second
const SEEK_PERIOD_MS = 100; // while the bar is dragged
const SETTLES_MS = 700; // after a jump, until the player has said where it is
const JUMP_S = 5;

/** What the player of a take says of itself. */
export interface Take {
  positionS: number;
  lengthS: number;
  rate: number;
  file: string;
  state: 'playing' | 'paused' | 'over';
}

/** The take that is played now, read from the status of its player, whose warnings follow after "; "; null in a live session. */
export function takeIn(nodes: NodeState[]): Take | null {
  const player = nodes.find(({ kind, received_s }) => kind === 'player' && received_s < SILENT_AFTER_S);
  const words = player && /^([\d.]+) of ([\d.]+) s, rate ([\d.e+-]+), (.*?)(?:; .*)?$/s.exec(player.text);
  if (!words) return null;
  const state = player.state === 'paused' ? 'paused' : player.state === 'stopped' ? 'over' : 'playing';
  return { positionS: Number(words[1]), lengthS: Number(words[2]), rate: Number(words[3]), file: words[4]!, state };
}

/** 1:05.2 */
export function clockTime(seconds: number): string {
  const tenths = Math.round(10 * seconds);
  return `${Math.floor(tenths / 600)}:${((tenths % 600) / 10).toFixed(1).padStart(4, '0')}`;
}

export class TakeBar {
  take: Take | null = null;

  private readonly panel = document.querySelector<HTMLElement>('#take')!;
  private readonly bar = document.querySelector<HTMLInputElement>('#seek')!;
  private readonly time = document.querySelector<HTMLElement>('#take-time')!;
  private readonly rate = document.querySelector<HTMLSelectElement>('#take-rate')!;
  private readonly file = document.querySelector<HTMLElement>('#take-file')!;
  private receivedMs = 0; // when `take` was said
  private isDragged = false;
  private askedMs = Number.NEGATIVE_INFINITY; // of the last jump
  private askedS = 0; // where to
  private timer = 0;

  constructor(private readonly connection: Connection) {
    this.bar.addEventListener('input', () => {
      this.isDragged = true;
      setText(this.time, this.timeText(Number(this.bar.value)));
      if (this.timer === 0) this.timer = window.setTimeout(() => this.seek(Number(this.bar.value)), SEEK_PERIOD_MS);
    });
    this.bar.addEventListener('change', () => {
      this.isDragged = false;
      this.seek(Number(this.bar.value));
      this.bar.blur(); // keys are those of the page again
    });
    this.rate.addEventListener('change', () => {
      this.connection.command('rate', { value: Number(this.rate.value) });
      this.rate.blur();
    });
    window.setInterval(() => this.draw(), 100);
  }

  update(nodes: NodeState[]): void {
    const take = takeIn(nodes);
    if (take?.positionS !== this.take?.positionS || take?.state !== this.take?.state) this.receivedMs = performance.now();
    this.take = take;
    this.panel.hidden = take === null;
    this.bar.disabled = this.rate.disabled = !this.connection.mayCommand;
    if (take === null) return;
    this.bar.max = String(take.lengthS);
    setText(this.file, take.file);
    this.file.title = take.file;
    this.showRate(take.rate);
    this.draw();
  }

  /** A key of the page; true when it was one of the take. */
  key(name: string): boolean {
    const { take } = this;
    if (take === null) return false;
    const nowS = this.nowS(take);
    const rates = [...this.rate.options].map(({ value }) => Number(value));
    const actions: Record<string, () => void> = {
      ' ': () => this.connection.command(take.state === 'paused' ? 'resume' : 'pause'),
      ArrowLeft: () => this.seek(nowS - JUMP_S),
      ArrowRight: () => this.seek(nowS + JUMP_S),
      Home: () => this.seek(0),
      '[': () => this.setRate(rates.filter((rate) => rate < take.rate * 0.999).at(-1)),
      ']': () => this.setRate(rates.find((rate) => rate > take.rate * 1.001)),
    };
    actions[name]?.();
    return name in actions;
  }

  private setRate(value: number | undefined): void {
    if (value !== undefined) this.connection.command('rate', { value });
  }

  private seek(wantedS: number): void {
    clearTimeout(this.timer);
    this.timer = 0;
    this.askedS = Math.max(0, Math.min(wantedS, this.take?.lengthS ?? 0));
    this.askedMs = performance.now();
    this.connection.command('seek', { value: this.askedS });
    this.draw();
  }

  /** A rate that a shell has set is shown as well. */
  private showRate(rate: number): void {
    const text = `${Number(rate.toPrecision(3))}×`;
    const options = [...this.rate.options];
    let option = options.find(({ value }) => Math.abs(Number(value) - rate) < 1e-3 * rate);
    if (option === undefined) {
      option = options.find(({ dataset }) => dataset.other === 'yes') ?? this.rate.appendChild(new Option());
      option.dataset.other = 'yes';
      option.value = String(rate);
      option.text = text;
    }
    if (document.activeElement !== this.rate) option.selected = true;
  }

  /** Where it is now: the player says so twice a second only. */
  private nowS(take: Take): number {
    const now = performance.now();
    if (now - this.askedMs < SETTLES_MS) return this.askedS;
    const sinceS = take.state === 'playing' ? ((now - this.receivedMs) / 1000) * take.rate : 0;
    return Math.min(take.lengthS, take.positionS + sinceS);
  }

  private timeText(atS: number): string {
    return `${clockTime(atS)} / ${clockTime(this.take?.lengthS ?? 0)}`;
  }

  private draw(): void {
    if (this.take === null || this.isDragged) return;
    const nowS = this.nowS(this.take);
    this.bar.value = String(nowS);
    setText(this.time, this.timeText(nowS));
  }
}
