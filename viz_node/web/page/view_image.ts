// viz_node/web/page/view_image.ts -- an image of the view to keep, with its scene, time, legend and
// a length to measure by.
import { stopsOf, type Scale } from './colouring.ts';
import type { Palette } from './colours.ts';
import { joined, roundLength, withUnit } from './format.ts';
import type { LegendEntry } from './legend.ts';
import type { SceneView } from './scene_view.ts';

const ROOM_PX = 16; // at the edges
const ROW_PX = 20; // of the legend
const STRIP_PX = 120; // of a scale

export interface Caption {
  scene: string;
  simulatedS: number;
  legend: LegendEntry[];
  scale: Scale | null; // where the colours are numbers
  note: string; // how the motion is drawn; empty where it is as it is
  palette: Palette;
}

/** The view, `marks` over it, and the caption. */
export async function imageOfView(view: SceneView, marks: HTMLCanvasElement, caption: Caption): Promise<Blob | null> {
  const image = await view.image();
  if (image === null) return null;
  const drawn = await createImageBitmap(image);
  const sheet = Object.assign(document.createElement('canvas'), { width: drawn.width, height: drawn.height });
  const pen = sheet.getContext('2d');
  if (pen === null) return null;
  pen.drawImage(drawn, 0, 0);
  pen.drawImage(marks, 0, 0, drawn.width, drawn.height);
  const ratio = drawn.width / marks.clientWidth;
  pen.scale(ratio, ratio);
  pen.font = '13px system-ui, "DejaVu Sans", sans-serif';
  const { palette } = caption;
  pen.fillStyle = palette.text;
  pen.fillText(`${caption.scene} · ${caption.simulatedS.toFixed(3)} s${caption.note === '' ? '' : ` · ${caption.note}`}`, ROOM_PX, 24);
  const bottom = writeLegend(pen, caption.legend, palette, marks.clientWidth);
  if (caption.scale !== null) writeScale(pen, bottom, caption.scale, palette);
  const scale = view.rig.metresPerPixel;
  const length = roundLength(160 * scale);
  pen.fillStyle = palette.quiet;
  pen.fillRect(ROOM_PX, marks.clientHeight - 36, length / scale, 2);
  pen.fillText(joined(withUnit(length, 'm')), ROOM_PX, marks.clientHeight - 16);
  return new Promise((resolve) => sheet.toBlob(resolve));
}

/** Writes rows of marks and names; gives back where the next row would be. */
function writeLegend(pen: CanvasRenderingContext2D, legend: LegendEntry[], palette: Palette, width: number): number {
  let [x, y] = [ROOM_PX, 46];
  for (const { mark, text, colour } of legend) {
    const size = 22 + pen.measureText(text).width;
    if (x > ROOM_PX && x + size > width - ROOM_PX) [x, y] = [ROOM_PX, y + ROW_PX];
    drawMark(pen, mark, { x: x + 7, y: y - 4.5 }, colour);
    pen.fillStyle = palette.quiet;
    pen.fillText(text, x + 20, y);
    x += size + 14;
  }
  return y + ROW_PX;
}

function drawMark(pen: CanvasRenderingContext2D, mark: LegendEntry['mark'], { x, y }: { x: number; y: number }, colour: string): void {
  pen.fillStyle = colour;
  pen.strokeStyle = colour;
  pen.lineWidth = 2;
  pen.beginPath();
  if (mark === 'link solid') pen.rect(x - 7, y - 1.5, 14, 3);
  else if (mark === 'link dashed') [-7, 2].forEach((left) => pen.rect(x + left, y - 1.5, 5, 3));
  else if (mark === 'link dotted') [-7, -2, 3].forEach((left) => pen.rect(x + left, y - 1.5, 2, 3));
  else if (mark === 'fixed-point' || mark === 'surface') pen.rect(x - 4, y - 4, 8, 8);
  else if (mark === 'key') pen.rect(x - 3.5, y, 7, 6);
  else pen.arc(x, y, mark === 'handle' || mark === 'ring' ? 6 : 4.5, 0, 2 * Math.PI);
  if (mark === 'ring') pen.lineWidth = 3;
  if (mark === 'handle' || mark === 'ring' || mark === 'fixed-point') pen.stroke();
  else pen.fill();
  if (mark === 'key') pen.strokeRect(x - 3.5, y - 6, 7, 12);
}

function writeScale(pen: CanvasRenderingContext2D, y: number, scale: Scale, palette: Palette): void {
  const left = ROOM_PX + pen.measureText(scale.low).width + 8;
  const colours = pen.createLinearGradient(left, 0, left + STRIP_PX, 0);
  for (const [colour, share] of stopsOf(scale)) colours.addColorStop(share, colour);
  pen.fillStyle = colours;
  pen.fillRect(left, y - 8, STRIP_PX, 8);
  pen.fillStyle = palette.quiet;
  pen.fillText(scale.low, ROOM_PX, y);
  pen.fillText(scale.high, left + STRIP_PX + 8, y);
  pen.fillText(scale.caption, left + STRIP_PX + 24 + pen.measureText(scale.high).width, y);
}
