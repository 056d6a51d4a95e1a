// viz_node/web/page/marks.ts -- arrows of force and threads of hands, drawn over the view.

const ARROW_PX = 110; // of the force limit
const HEAD_PX = 9;

export interface Point {
  x: number;
  y: number;
}

/** A transparent sheet over the view, drawn again with each frame. Places are CSS pixels of the view. */
export class Marks {
  private readonly sheet = document.createElement('canvas');
  private readonly pen: CanvasRenderingContext2D | null;

  private width = 0; // of the view [CSS pixels]
  private height = 0;

  halo = '#000000'; // around letters: the colour of the background

  constructor(container: HTMLElement) {
    this.sheet.id = 'marks';
    container.prepend(this.sheet); // below words and buttons
    this.pen = this.sheet.getContext('2d');
  }

  get canvas(): HTMLCanvasElement {
    return this.sheet;
  }

  /** @param width, height  of the view [CSS pixels] */
  resize(width: number, height: number): void {
    [this.width, this.height] = [width, height];
  }

  begin(): void {
    const ratio = Math.min(window.devicePixelRatio, 2);
    const [width, height] = [Math.round(this.width * ratio), Math.round(this.height * ratio)];
    if (this.sheet.width !== width || this.sheet.height !== height) [this.sheet.width, this.sheet.height] = [width, height];
    this.pen?.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.pen?.clearRect(0, 0, this.width, this.height);
  }

  /** A dashed thread between two places. */
  thread(from: Point, to: Point, colour: string): void {
    this.stroke(colour, 1.5, [5, 4], (pen) => {
      pen.moveTo(from.x, from.y);
      pen.lineTo(to.x, to.y);
    });
    this.stroke(colour, 1.5, [], (pen) => pen.arc(to.x, to.y, 5, 0, 2 * Math.PI));
  }

  /** Outline of a shape, and how much of it is filled: a shape of its own. */
  shape(corners: Point[], filled: Point[], colour: string): void {
    const pen = this.pen;
    if (pen === null) return;
    const walk = (points: Point[]) => {
      points.forEach(({ x, y }, i) => (i === 0 ? pen.moveTo(x, y) : pen.lineTo(x, y)));
      pen.closePath();
    };
    pen.beginPath();
    walk(filled);
    pen.globalAlpha = 0.45;
    pen.fillStyle = colour;
    pen.fill();
    pen.globalAlpha = 1;
    this.stroke(colour, 1.2, [], () => walk(corners));
  }

  ring(middle: Point, radius: number, colour: string, width = 2): void {
    this.stroke(colour, width, [], (pen) => pen.arc(middle.x, middle.y, radius, 0, 2 * Math.PI));
  }

  /** An arrow from `from` along a direction on the screen (y downwards), its length a share of ARROW_PX. */
  arrow(from: Point, direction: Point, share: number, colour: string, label: string): void {
    const length = Math.hypot(direction.x, direction.y);
    if (length === 0 || share <= 0) return;
    const [ux, uy] = [direction.x / length, direction.y / length];
    const reach = ARROW_PX * Math.min(share, 1);
    const tip = { x: from.x + ux * reach, y: from.y + uy * reach };
    const head = Math.min(HEAD_PX, reach);
    this.stroke(colour, 3, [], (pen) => {
      pen.moveTo(from.x, from.y);
      pen.lineTo(tip.x, tip.y);
      pen.moveTo(tip.x - head * (ux - 0.6 * uy), tip.y - head * (uy + 0.6 * ux));
      pen.lineTo(tip.x, tip.y);
      pen.lineTo(tip.x - head * (ux + 0.6 * uy), tip.y - head * (uy - 0.6 * ux));
    });
    if (label !== '') this.text({ x: tip.x + 8 * ux, y: tip.y + 8 * uy - 8 }, label, colour);
  }

  text(place: Point, text: string, colour: string, size = 12): void {
    const pen = this.pen;
    if (pen === null) return;
    pen.font = `${size}px system-ui, "DejaVu Sans", sans-serif`;
    pen.lineWidth = 3;
    pen.setLineDash([]);
    pen.strokeStyle = this.halo;
    pen.strokeText(text, place.x, place.y);
    pen.fillStyle = colour;
    pen.fillText(text, place.x, place.y);
  }

  private stroke(colour: string, width: number, dash: number[], path: (pen: CanvasRenderingContext2D) => void): void {
    const pen = this.pen;
    if (pen === null) return;
    pen.strokeStyle = colour;
    pen.lineWidth = width;
    pen.lineCap = 'round';
    pen.lineJoin = 'round';
    pen.setLineDash(dash);
    pen.beginPath();
    path(pen);
    pen.stroke();
  }
}
