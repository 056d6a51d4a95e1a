// viz_node/web/page/port_arrows.ts -- the forces on ports as arrows over the view.
import { joined, withUnit } from './format.ts';
import type { Marks } from './marks.ts';
import type { SceneView } from './scene_view.ts';

const FALL = 0.995; // of the force with the full length, per frame
const MIN_SHARE = 0.02; // of the full length; below it nothing is drawn

/** Draws a force at a MAT. @param largestN  the force that has the full length */
export function drawForce(marks: Marks, view: SceneView, mat: number, force: number[], largestN: number, colour: string): void {
  const size = Math.hypot(...force);
  if (size === 0) return;
  const place = view.drawnPlace(mat);
  const from = view.screenOf(place);
  const tip = view.screenOf(place.map((x, k) => x + (force[k]! / size) * view.rig.metresPerPixel * 100));
  marks.arrow(from, { x: tip.x - from.x, y: tip.y - from.y }, size / largestN, colour, joined(withUnit(size, 'N')));
}

export class PortArrows {
  private largestN = 0; // of late, at any port

  /** @param mats  of the ports */
  draw(marks: Marks, view: SceneView, mats: number[], colour: string): void {
    const forces = mats.map((mat) => ({ mat, force: view.portForceOn(mat) ?? [0, 0, 0] }));
    this.largestN = Math.max(FALL * this.largestN, ...forces.map(({ force }) => Math.hypot(...force)));
    for (const { mat, force } of forces)
      if (Math.hypot(...force) > MIN_SHARE * this.largestN) drawForce(marks, view, mat, force, this.largestN, colour);
  }
}
