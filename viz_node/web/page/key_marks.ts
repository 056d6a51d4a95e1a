// viz_node/web/page/key_marks.ts -- the keys of keyboards in the view, each at its port: as wide as
// their pitch, as long as their way down, and filled as far as they are down.
import { depthOf, type Key, type Keyboard } from './keyboards.ts';
import type { Marks, Point } from './marks.ts';
import type { SceneView } from './scene_view.ts';

/** From the middle of a key to its right side [m]: across its way, and level where that is possible. */
export function halfWidthOf(up: number[], pitchM: number): number[] {
  const [x, y] = up as [number, number, number];
  const level = Math.hypot(x, y);
  return level > 1e-6 ? [(pitchM / 2) * (y / level), (pitchM / 2) * (-x / level), 0] : [pitchM / 2, 0, 0];
}

/** Draws every key that plays a port. */
export function drawKeys(keyboards: Keyboard[], view: SceneView, marks: Marks, colour: string): void {
  for (const { pitchM, keys } of keyboards) {
    for (const key of keys) if (key.port !== '') drawKey(key, pitchM, view, marks, colour);
  }
}

function drawKey(key: Key, pitchM: number, view: SceneView, marks: Marks, colour: string): void {
  const half = halfWidthOf(key.up, pitchM);
  const corner = (depthM: number, side: number): Point => {
    const middle = view.drawnAt(key.mat, key.rest.map((value, k) => value - depthM * key.up[k]!));
    return view.screenOf(middle.map((value, k) => value + side * half[k]!));
  };
  const between = (from: number, to: number) => [corner(from, -1), corner(from, 1), corner(to, 1), corner(to, -1)];
  const depth = Math.min(key.wayM, Math.max(0, depthOf(key, view.place(key.mat))));
  marks.shape(between(0, key.wayM), between(0, depth), colour);
}
