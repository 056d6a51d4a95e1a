// viz_node/web/page/names.ts -- names of matter and ports, written into the view.
import type { Marks, Point } from './marks.ts';
import type { SceneView } from './scene_view.ts';

const ROW_PX = 13;
const COLUMN_PX = 60;

/** Writes names beside what they name, the first of those that would cover each other. */
export function drawNames(marks: Marks, view: SceneView, colour: string): void {
  const taken: Point[] = [];
  for (const { name, first, count } of view.bodies.named) {
    const mat = first + Math.floor((count - 1) / 2);
    const middle = view.project(mat);
    const place = { x: middle.x + view.radiusOnScreen(mat) + 6, y: middle.y - 6 };
    if (taken.some(({ x, y }) => Math.abs(y - place.y) < ROW_PX && Math.abs(x - place.x) < COLUMN_PX)) continue;
    taken.push(place);
    marks.text(place, name, colour);
  }
}
