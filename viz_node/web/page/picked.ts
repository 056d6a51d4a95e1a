// viz_node/web/page/picked.ts -- the MAT or the link that a person has picked: its name and values.
import type { Palette } from './colours.ts';
import { percentOf } from './colouring.ts';
import { count, joined, withUnit } from './format.ts';
import { stateName } from './link_groups.ts';
import type { Marks, Point } from './marks.ts';
import { drawForce } from './port_arrows.ts';
import { press, setText } from './rows.ts';
import type { SceneView } from './scene_view.ts';
import type { Traced, Traces } from './traces.ts';
import { LINK_IS_IDLE } from './wire.ts';

const NEAR_MAT_PX = 8; // beyond its edge
const NEAR_LINK_PX = 6;
const ON_MAT_PX = 2; // so near its edge a MAT is meant, and no link
const MOVED_PX = 4; // a click that moves farther turns the view
const REFRESH_MS = 150;
const FALL = 0.995; // of the full length of the arrow, per frame

/** One MAT, or one link. */
export type PickedThing = { mat: number } | { link: number };

export class Picked {
  thing: PickedThing | null = null;
  private follows = false;
  private showsForce = false;
  private largestN = 0; // force of what is picked, that the arrow is measured by; falls slowly
  private down: Point | null = null;
  private shownMs = 0;
  private readonly panel = document.querySelector<HTMLElement>('#picked')!;
  private readonly name = document.querySelector('#picked-name')!;
  private readonly values = document.querySelector('#picked-values')!;
  private readonly plotButton = document.querySelector<HTMLButtonElement>('#picked-plot')!;
  private readonly forceButton = document.querySelector<HTMLButtonElement>('#picked-force')!;
  private readonly followButton = document.querySelector<HTMLButtonElement>('#picked-follow')!;

  constructor(
    stage: HTMLElement,
    private readonly view: () => SceneView | null,
    private readonly traces: Traces,
    private readonly changed: () => void,
  ) {
    stage.addEventListener('pointerdown', ({ clientX: x, clientY: y, target }) => {
      this.down = target instanceof HTMLCanvasElement ? { x, y } : null;
    });
    stage.addEventListener('pointerup', ({ clientX: x, clientY: y }) => {
      if (this.down === null || Math.hypot(x - this.down.x, y - this.down.y) > MOVED_PX) return;
      this.pick(this.thingAt(x, y));
    });
    document.querySelector('#picked-close')!.addEventListener('click', () => this.pick(null));
    this.plotButton.addEventListener('click', () => {
      const traced = this.traced;
      if (traced !== null) this.traces.toggle(traced);
    });
    this.followButton.addEventListener('click', () => this.follow(!this.follows));
    this.forceButton.addEventListener('click', () => {
      this.showsForce = !this.showsForce;
      press(this.forceButton, this.showsForce);
      this.changed();
    });
  }

  pick(thing: PickedThing | null): void {
    this.thing = thing;
    this.panel.hidden = thing === null;
    this.followButton.hidden = thing === null || !('mat' in thing);
    this.forceButton.hidden = this.followButton.hidden;
    this.largestN = 0;
    this.write(); // at once: the panel never names what was picked before
    this.follow(false);
    this.showPlotted();
  }

  /** Writes its name and its values in the newest frame. */
  private write(): void {
    const view = this.view();
    if (view === null || this.thing === null) return;
    this.shownMs = performance.now();
    const [name, values] = 'mat' in this.thing ? matText(view, this.thing.mat) : linkText(view, this.thing.link);
    setText(this.name, name);
    setText(this.values, values);
  }

  /** Shows whether it is plotted. */
  showPlotted(): void {
    const traced = this.traced;
    press(this.plotButton, traced !== null && this.traces.has(traced.key));
  }

  /** Marks it in the frame that is drawn now, and writes its values. */
  draw(marks: Marks, palette: Palette): void {
    const view = this.view();
    if (view === null || this.thing === null) return;
    const ring = (mat: number, room: number) => marks.ring(view.project(mat), view.radiusOnScreen(mat) + room, palette.text);
    if ('mat' in this.thing) {
      if (this.follows) view.rig.moveTo(view.drawnPlace(this.thing.mat));
      ring(this.thing.mat, 6);
      if (this.showsForce) this.drawForce(view, this.thing.mat, marks, palette);
    } else {
      view.endsOf(this.thing.link).forEach((mat) => ring(mat, 3));
    }
    if (performance.now() - this.shownMs >= REFRESH_MS) this.write();
  }

  /** An arrow whose full length is the largest force of late. */
  private drawForce(view: SceneView, mat: number, marks: Marks, palette: Palette): void {
    const force = view.forceOn(mat) ?? view.portForceOn(mat);
    if (force === null) return;
    this.largestN = Math.max(Math.hypot(...force), FALL * this.largestN);
    drawForce(marks, view, mat, force, this.largestN, palette.text);
  }

  /** What a plot of it shows. */
  private get traced(): Traced | null {
    const view = this.view();
    if (view === null || this.thing === null) return null;
    return 'mat' in this.thing ? tracedMat(view, this.thing.mat) : tracedLink(view, this.thing.link);
  }

  /** What a person means who presses there on the page. */
  private thingAt(x: number, y: number): PickedThing | null {
    const view = this.view();
    if (view === null) return null;
    const point = view.ofPage(x, y);
    const mat = view.matAt(point, NEAR_MAT_PX);
    const link = view.linkAt(point, NEAR_LINK_PX);
    if (mat !== null && (link === null || mat.away <= Math.max(link.away, ON_MAT_PX))) return { mat: mat.index };
    return link === null ? null : { link: link.index };
  }

  private follow(wanted: boolean): void {
    this.follows = wanted;
    press(this.followButton, wanted);
    this.changed();
  }
}

/** Its way from where it is now, along the axes of the scene. */
function tracedMat(view: SceneView, mat: number): Traced {
  const start = view.place(mat);
  const axes = view.axes;
  const values = () => axes.map((axis) => view.place(mat)[axis]! - start[axis]!);
  return { key: `mat ${mat}`, title: `${view.bodies.nameOf(mat)}: way from ${view.newestTimeS.toFixed(2)} s on`, series: axes.map((axis) => 'xyz'[axis]!), unit: 'm', values };
}

function tracedLink(view: SceneView, link: number): Traced {
  return { key: `link ${link}`, title: `${view.bodies.linkNameOf(link)}, a value per frame`, series: ['length'], unit: 'm', values: () => [lengthOf(view, link)] };
}

function lengthOf(view: SceneView, link: number): number {
  const [a, b] = view.endsOf(link).map((mat) => view.place(mat)) as [number[], number[]];
  return Math.hypot(...a.map((value, k) => value - b[k]!));
}

function matText(view: SceneView, mat: number): [string, string] {
  const [x, y, z] = view.place(mat).map((value) => joined(withUnit(value, 'm')));
  const part = view.componentOf(mat);
  const force = view.forceOn(mat);
  const span = joined(withUnit(view.forceSpanS, 's'));
  const net = force === null ? '' : ` · net force ${joined(withUnit(Math.hypot(...force), 'N'))}, mean over ${span}`;
  const onPort = view.portForceOn(mat);
  const felt = onPort === null ? '' : ` · force on the port ${joined(withUnit(Math.hypot(...onPort), 'N'))}`;
  const component = part === null ? '' : ` · component ${part.place} by size, ${count(part.component.size)} MATs`;
  return [view.bodies.nameOf(mat), `x ${x} · y ${y} · z ${z} · speed ${joined(withUnit(view.speedOf(mat), 'm/s'))}${net}${felt}${component}`];
}

function linkText(view: SceneView, link: number): [string, string] {
  const [a, b] = view.endsOf(link);
  const length = lengthOf(view, link);
  const stretch = view.stretchOf(link);
  const since = `${stretch < 0 ? '−' : '+'}${percentOf(Math.abs(stretch))} since ${view.countedSinceS.toFixed(2)} s`;
  const state = stateText(view, link);
  const ends = `${view.bodies.nameOf(a)} to ${view.bodies.nameOf(b)}`;
  return [view.bodies.linkNameOf(link), `${ends} · length ${joined(withUnit(length, 'm'))}, ${since}${state === '' ? '' : ` · ${state}`}`];
}

/** The state with its liaison where the scene has several; empty for a link without states. */
function stateText(view: SceneView, link: number): string {
  const state = view.stateOf(link);
  const { list } = view.groups;
  const { name, states } = view.groups.of(link);
  if (states.length === 0) return state >= LINK_IS_IDLE ? 'does nothing' : '';
  const named = stateName(list.length > 1 ? name : '', states[state & ~LINK_IS_IDLE] ?? '');
  return [named, state >= LINK_IS_IDLE ? 'does nothing' : ''].filter((text) => text !== '').join(', ');
}
