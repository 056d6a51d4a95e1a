// viz_node/web/page/ground.ts -- a grid of round lengths under or behind the scene: a viewer
// has something to hold on to.
import { type Box3, Vector3 } from 'three';
import { sharesOf, type Palette } from './colours.ts';
import { roundLength } from './format.ts';
import { COLOUR_FRAGMENT, shapeOf, VertexArray, type Program } from './gl_canvas.ts';

const CELLS = 24; // across the larger side of the scene, about
const UPRIGHT = 0.5; // of the height of a scene, the least width of the grid under it

/** Vertices that have their colours with them. */
export const COLOURED: Program = {
  vertex: /* glsl */ `
    precision highp float;
    in vec3 position;
    in vec3 tint;
    uniform mat4 modelViewMatrix;
    uniform mat4 projectionMatrix;
    out vec3 colour;
    void main() {
      gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      colour = tint;
    }
  `,
  fragment: COLOUR_FRAGMENT,
};

export class Ground {
  private readonly points = new VertexArray(new Float32Array(0), 3);
  private readonly colours = new VertexArray(new Float32Array(0), 3);
  readonly shape = shapeOf('lines', COLOURED, { position: this.points, tint: this.colours }, { writesDepth: false });

  /** Lays the grid again: upright through the scene when it is flat, on the floor when it is not. */
  lay(box: Box3, space: number, palette: Palette): void {
    const size = box.getSize(new Vector3());
    const centre = box.getCenter(new Vector3());
    const flat = space < 3;
    const across = Math.max(size.x, flat ? size.y : size.z, UPRIGHT * size.y, 1e-6);
    const cell = roundLength((2 * across) / CELLS);
    const half = Math.ceil((flat ? 3 : 1) * (across / cell)) * cell;
    const middle = [Math.round(centre.x / cell) * cell, Math.round((flat ? centre.y : centre.z) / cell) * cell] as const;
    const level = flat ? box.min.z - 0.001 * across : box.min.y - 0.25 * across;
    const point = (u: number, v: number) => (flat ? [u, v, level] : [u, level, v]);

    const points: number[] = [];
    const colours: number[] = [];
    const line = (from: number[], to: number[], colour: number[]) => {
      points.push(...from, ...to);
      colours.push(...colour, ...colour);
    };
    const [fine, coarse, axis] = [sharesOf(palette.grid_fine), sharesOf(palette.grid_coarse), sharesOf(palette.grid_axis)];
    const colourOf = (coordinate: number) => {
      const index = Math.round(coordinate / cell);
      return index === 0 ? axis : index % 5 === 0 ? coarse : fine;
    };
    // Fine lines first: coarse ones are drawn over them.
    for (const wanted of [fine, coarse, axis]) {
      for (let offset = -half; offset <= half + 0.5 * cell; offset += cell) {
        const u = middle[0] + offset;
        const v = middle[1] + offset;
        if (colourOf(u) === wanted) line(point(u, middle[1] - half), point(u, middle[1] + half), wanted);
        if (colourOf(v) === wanted) line(point(middle[0] - half, v), point(middle[0] + half, v), wanted);
      }
    }
    this.points.set(new Float32Array(points));
    this.colours.set(new Float32Array(colours));
    this.shape.parts = [{ first: 0, count: points.length / 3, uniforms: {} }];
  }
}
