// viz_node/web/page/controls.ts -- buttons that command the simulation, and what it says to them.
import type { Connection } from './connection.ts';
import { parametersIn } from './parameters.ts';
import type { NodeState, Reply } from './protocol.ts';
import { isStale } from './stale_reply.ts';

const SHOWN_MS = 6000;
const PATIENCE_MS = 4000;

export class Controls {
  private readonly buttons = [...document.querySelectorAll<HTMLButtonElement>('#control button')];
  private readonly viewOnly = document.querySelector<HTMLElement>('#view-only')!;
  private readonly reply = document.querySelector<HTMLElement>('#reply')!;
  private readonly scenes = document.querySelector<HTMLSelectElement>('#scenes')!;
  private paused = false;
  private shownNumber = 0; // of the reply shown last
  private asked = false; // a command was sent that has no reply yet
  private impatientMs = Number.POSITIVE_INFINITY; // when its silence is reported
  private timer = 0;

  constructor(private readonly connection: Connection) {
    this.scenes.addEventListener('change', () => {
      if (this.scenes.value !== '') this.command('load', { scene: Number(this.scenes.value) });
      this.scenes.value = '';
      this.scenes.blur(); // keys are for the view again
    });
    for (const button of this.buttons) {
      button.addEventListener('click', () => {
        this.send(button.dataset.verb!);
        button.blur();
      });
    }
  }

  /** Lists the scenes that the launch file lets this page load. The first entry stands for the one that is played. */
  list(scenes: string[]): void {
    this.scenes.hidden = scenes.length === 0;
    const nameOf = (path: string) => path.replace(/^.*\//, '').replace(/\.ya?ml$/, '');
    this.scenes.replaceChildren(new Option('Load …', ''), ...scenes.map((path, number) => new Option(nameOf(path), String(number))));
  }

  /** Takes what is newest about the simulation; undefined when there is none. */
  update(sim: NodeState | undefined, replies: Reply[]): void {
    const wasPaused = this.paused;
    this.paused = sim?.state === 'paused';
    // Another terminal may command too.
    if (isStale(this.reply.textContent ?? '', wasPaused, this.paused)) this.reply.textContent = '';
    this.viewOnly.hidden = this.connection.mayCommand;
    this.scenes.disabled = sim === undefined || sim.kind !== 'sim_node' || !this.connection.mayCommand;
    for (const button of this.buttons) {
      button.disabled = sim === undefined || !this.connection.mayCommand;
      if (button.dataset.verb === 'pause') {
        button.textContent = this.paused ? 'Resume' : 'Pause';
        button.classList.toggle('on', this.paused);
      }
    }
    const newest = replies.filter((reply) => parametersIn(reply) === null).at(-1); // parameters are shown elsewhere
    if (newest === undefined) this.shownNumber = 0; // a viz_node that was restarted counts from 1
    if (newest !== undefined && newest.number !== this.shownNumber) {
      // What was answered before this page came is of no interest; a late answer is.
      if (this.asked) this.say(newest.text.split('\n')[0]!, !newest.accepted);
      this.shownNumber = newest.number;
      this.asked = false;
      this.impatientMs = Number.POSITIVE_INFINITY;
    }
    if (performance.now() > this.impatientMs) {
      this.say('sim_node does not answer', true);
      this.impatientMs = Number.POSITIVE_INFINITY;
    }
  }

  /** A key does what a button does. */
  press(button: 'pause' | 'step'): void {
    if (!this.buttons[0]!.disabled) this.send(button);
  }

  /** Commands it, and shows what is said to it. */
  command(verb: string, more: Parameters<Connection['command']>[1] = {}): void {
    this.asked = true;
    this.impatientMs = performance.now() + PATIENCE_MS;
    this.connection.command(verb, more);
  }

  private send(button: string): void {
    this.command(button === 'pause' && this.paused ? 'resume' : button);
  }

  private say(text: string, refused: boolean): void {
    this.reply.textContent = text;
    this.reply.dataset.level = refused ? 'bad' : '';
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => (this.reply.textContent = ''), SHOWN_MS);
  }
}
