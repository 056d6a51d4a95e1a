// viz_node/web/page/pointer.ts -- mouse, finger or pen as a hand that drags ports and feels them.
import type { Connection } from './connection.ts';
import { joined, withUnit } from './format.ts';
import type { Marks, Point } from './marks.ts';
import type { Description, PointerPort, PointerState } from './protocol.ts';
import type { SceneView } from './scene_view.ts';

const REPEAT_MS = 80; // a page that says nothing for longer than 500 ms has let go
const NEAR_MOUSE_PX = 18; // beyond the mark of a port
const NEAR_FINGER_PX = 34;
const FULL_ARROW_N = 5;
const KEPT_DELAYS = 60;

/** Colours of what this page holds, and of what others hold. */
export interface HandColours {
  mine: string;
  others: string;
}

interface Drag {
  port: number;
  mat: number; // of its handle
  start: number[]; // of the handle when it was taken hold of [m]
  grip: number[]; // where the pointer was in the scene then [m]
  at: Point; // the pointer now, in the view
  event: number;
}

/** What window.viz says of the pointer. */
export interface PointerFigures {
  ports: { port: number; name: string; mat: number }[]; // that can be dragged, with the MAT of their handle
  held: { port: number; forceN: number; byThisPage: boolean }[];
  delays: number; // measured so far
  delayS: number | null; // from an event to the frame that shows its force: the median of the last ones
}

export class PointerHand {
  private readonly drags = new Map<number, Drag>(); // by pointerId
  private readonly eventMs = new Map<number, number>(); // when an event of the page happened
  private readonly delays: number[] = []; // [ms]
  private state: PointerState | null = null;
  private description: Description | null = null;
  private eventCount = 0;
  private seenEvent = 0; // newest whose force came
  private measured = 0;

  constructor(
    private readonly stage: HTMLElement,
    private readonly connection: Connection,
    private readonly view: () => SceneView | null,
    private readonly changed: () => void,
  ) {
    // Before the camera sees them: a port is dragged, anything else turns or moves the view.
    stage.addEventListener('pointerdown', (event) => this.takeHold(event), { capture: true });
    stage.addEventListener('pointermove', (event) => this.move(event), { capture: true });
    for (const name of ['pointerup', 'pointercancel', 'lostpointercapture'] as const)
      stage.addEventListener(name, (event) => this.letGo(event.pointerId, event), { capture: true });
    window.setInterval(() => this.repeat(), REPEAT_MS);
  }

  /** @param isSame  the scene goes on where it was: a hand that still drags takes hold again */
  describe(description: Description, isSame: boolean): void {
    if (!isSame) for (const id of [...this.drags.keys()]) this.letGo(id);
    this.description = description;
    this.state = null;
  }

  /** The connection is gone: viz_node lets go for the page, until repeat() takes hold again. */
  forget(): void {
    this.state = null;
    this.seenEvent = 0;
    this.eventMs.clear();
  }

  take(state: PointerState): void {
    this.state = state;
    this.changed();
  }

  get figures(): PointerFigures {
    const ports = this.state?.ports ?? [];
    const held = ports.filter((port) => port.held && port.plays);
    return {
      ports: ports.map(({ port }) => ({ port, name: this.description?.ports[port]?.name ?? '', mat: this.handleOf(port) ?? 0 })),
      held: held.map((port) => ({ port: port.port, forceN: Math.hypot(...port.force_n), byThisPage: this.isMine(port) })),
      delays: this.measured,
      delayS: this.delayMs === null ? null : this.delayMs / 1000,
    };
  }

  /** True if there is anything to take hold of. */
  get isOffered(): boolean {
    return (this.state?.ports.length ?? 0) > 0;
  }

  private get delayMs(): number | null {
    if (this.delays.length === 0) return null;
    return [...this.delays].sort((a, b) => a - b)[this.delays.length >> 1]!;
  }

  private isMine(port: PointerPort): boolean {
    return this.state !== null && port.holder === this.state.page;
  }

  private handleOf(port: number): number | null {
    return this.description?.ports[port]?.mat ?? null;
  }

  /** The port that a pointer there would take hold of. */
  private portAt(event: PointerEvent): number | null {
    const view = this.view();
    if (view === null || !this.connection.mayCommand) return null;
    const near = event.pointerType === 'mouse' ? NEAR_MOUSE_PX : NEAR_FINGER_PX;
    let best: number | null = null;
    let least = Number.POSITIVE_INFINITY;
    const pointer = view.ofPage(event.clientX, event.clientY);
    for (const { port } of this.state?.ports ?? []) {
      const mats = [this.handleOf(port), this.description?.tools[port] ?? null];
      for (const mat of mats) {
        if (mat === null) continue;
        const place = view.project(mat);
        const away = Math.hypot(place.x - pointer.x, place.y - pointer.y) - view.radiusOnScreen(mat);
        if (away > near || away >= least) continue;
        [best, least] = [port, away];
      }
    }
    return best;
  }

  private takeHold(event: PointerEvent): void {
    if (event.button !== 0 || !(event.target instanceof HTMLCanvasElement)) return;
    const port = this.portAt(event);
    const view = this.view();
    const mat = port === null ? null : this.handleOf(port);
    if (port === null || view === null || mat === null) return;
    event.stopPropagation();
    event.preventDefault();
    if ([...this.drags.values()].some((drag) => drag.port === port)) return;
    try {
      this.stage.setPointerCapture(event.pointerId);
    } catch {
      // a pointer that is gone already
    }
    const start = view.place(mat);
    const pointer = view.ofPage(event.clientX, event.clientY);
    const grip = view.unproject(pointer, view.drawnAt(mat, start));
    this.drags.set(event.pointerId, { port, mat, start, grip, at: pointer, event: 0 });
    this.stage.classList.add('dragging');
    this.send(event.pointerId, event.timeStamp);
  }

  private move(event: PointerEvent): void {
    const drag = this.drags.get(event.pointerId);
    if (drag === undefined) {
      if (event.pointerType === 'mouse' && event.buttons === 0) this.stage.classList.toggle('grabbable', this.portAt(event) !== null);
      return;
    }
    event.stopPropagation();
    drag.at = this.view()?.ofPage(event.clientX, event.clientY) ?? drag.at;
    this.send(event.pointerId, event.timeStamp);
    this.changed();
  }

  private letGo(id: number, event?: PointerEvent): void {
    const drag = this.drags.get(id);
    if (drag === undefined) return;
    event?.stopPropagation();
    this.drags.delete(id);
    if (this.drags.size === 0) this.stage.classList.remove('dragging');
    this.connection.drag(drag.port, null, ++this.eventCount);
    this.changed();
  }

  private wanted(drag: Drag): number[] {
    const view = this.view();
    if (view === null) return drag.start;
    const now = view.unproject(drag.at, view.drawnAt(drag.mat, drag.start));
    return drag.start.map((start, k) => start + (now[k]! - drag.grip[k]!) / view.exaggeration);
  }

  private send(id: number, timeMs: number): void {
    const drag = this.drags.get(id);
    if (drag === undefined) return;
    drag.event = ++this.eventCount;
    this.eventMs.set(drag.event, timeMs);
    for (const event of this.eventMs.keys()) if (event < this.eventCount - 200) this.eventMs.delete(event);
    this.connection.drag(drag.port, this.wanted(drag), drag.event);
  }

  /** A hand that does not move still holds. It is no new event. */
  private repeat(): void {
    for (const drag of this.drags.values()) this.connection.drag(drag.port, this.wanted(drag), drag.event);
  }

  /** Marks of what is held, in the frame that is drawn now. */
  draw(marks: Marks, colours: HandColours): void {
    const view = this.view();
    if (view === null || this.state === null) return;
    for (const port of this.state.ports) {
      const mat = this.handleOf(port.port);
      if (mat === null || !port.held || !port.plays) continue;
      const mine = this.isMine(port);
      const colour = mine ? colours.mine : colours.others;
      const handle = view.project(mat);
      const drag = [...this.drags.values()].find((one) => one.port === port.port);
      const place = view.drawnPlace(mat);
      const hand = view.screenOf(view.drawnAt(mat, drag !== undefined ? this.wanted(drag) : port.target_m));
      marks.thread(handle, hand, colour);
      const force = Math.hypot(...port.force_n);
      const tip = view.screenOf(place.map((x, k) => x + (port.force_n[k]! / (force || 1)) * view.rig.metresPerPixel * 100));
      marks.arrow(handle, { x: tip.x - handle.x, y: tip.y - handle.y }, force / FULL_ARROW_N, colour, joined(withUnit(force, 'N')));
      if (!mine) marks.text({ x: handle.x + 14, y: handle.y - 14 }, `held on page ${port.holder}`, colour);
      if (mine && port.event > this.seenEvent) this.noteDelay(port.event);
    }
  }

  /** The force of this event is drawn now. */
  private noteDelay(event: number): void {
    this.seenEvent = event;
    const begun = this.eventMs.get(event);
    if (begun === undefined) return;
    this.delays.push(performance.now() - begun);
    ++this.measured;
    if (this.delays.length > KEPT_DELAYS) this.delays.shift();
  }

  /** One line for a person; empty when there is nothing to drag. */
  get line(): string {
    if (!this.isOffered) return '';
    const held = this.state!.ports.filter((port) => port.holder !== 0);
    const ms = this.delayMs;
    const delay = ms === null ? '' : ` · ${Math.round(ms)} ms from pointer to force`;
    if (held.length === 0) return `Drag a ringed port${delay}`;
    if (held.every((port) => this.isMine(port))) return `Your hand${delay}`;
    return `Held on page ${held[0]!.holder}`;
  }
}
