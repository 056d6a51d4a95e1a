// Buttons that command the simulation, and what it says to them.
import type { Connection } from './connection.ts';
import type { NodeState, Reply } from './protocol.ts';

const SHOWN_MS = 6000;
const PATIENCE_MS = 4000;

export class Controls {
  private readonly buttons = [...document.querySelectorAll<HTMLButtonElement>('#control button')];
  private readonly reply = document.querySelector<HTMLElement>('#reply')!;
  private paused = false;
  private shownNumber = 0; // of the reply shown last
  private askedMs = 0; // when a command was sent that has no reply yet
  private timer = 0;

  constructor(private readonly connection: Connection) {
    for (const button of this.buttons) {
      button.addEventListener('click', () => {
        this.send(button.dataset.verb!);
        button.blur();
      });
    }
  }

  /** Takes what is newest about the simulation; undefined when there is none. */
  update(sim: NodeState | undefined, replies: Reply[]): void {
    this.paused = sim?.state === 'paused';
    for (const button of this.buttons) {
      button.disabled = sim === undefined;
      if (button.dataset.verb === 'pause') {
        button.textContent = this.paused ? 'Resume' : 'Pause';
        button.classList.toggle('on', this.paused);
      }
    }
    const newest = replies[replies.length - 1];
    if (newest !== undefined && newest.number !== this.shownNumber) {
      // What was answered before this page came is of no interest.
      if (this.askedMs > 0) this.say(newest.text.split('\n')[0]!, !newest.accepted);
      this.shownNumber = newest.number;
      this.askedMs = 0;
    }
    if (this.askedMs > 0 && performance.now() - this.askedMs > PATIENCE_MS) {
      this.say('sim_node does not answer', true);
      this.askedMs = 0;
    }
  }

  private send(button: string): void {
    const verb = button === 'pause' && this.paused ? 'resume' : button;
    this.askedMs = performance.now();
    this.connection.command(verb);
  }

  private say(text: string, refused: boolean): void {
    this.reply.textContent = text;
    this.reply.dataset.level = refused ? 'bad' : '';
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => (this.reply.textContent = ''), SHOWN_MS);
  }
}
