// viz_node/web/page/motion_box.ts -- how many times as large as it is the motion is drawn.
import { setText } from './rows.ts';

export class MotionBox {
  private readonly select = document.querySelector<HTMLSelectElement>('#motion')!;
  private readonly note = document.querySelector<HTMLElement>('#exaggeration')!;

  factor = Number(this.select.value); // of the box, which takes long to ask in each frame

  constructor(private readonly changed: () => void) {
    this.select.addEventListener('change', () => {
      this.take();
      this.select.blur(); // keys are for the view again
    });
  }

  /** The next larger factor; after the largest the motion as it is. */
  step(): void {
    this.select.selectedIndex = (this.select.selectedIndex + 1) % this.select.length;
    this.take();
  }

  private take(): void {
    this.factor = Number(this.select.value);
    this.changed();
  }

  /** What the view has to say of it; empty where the motion is drawn as it is. */
  textSince(sinceS: number): string {
    return this.factor === 1 ? '' : `motion ×${this.factor}, from where it was at ${sinceS.toFixed(2)} s`;
  }

  say(text: string): void {
    if (this.note.hidden !== (text === '')) this.note.hidden = text === '';
    setText(this.note, text);
  }
}
