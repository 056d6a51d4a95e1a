// viz_node/web/page/trails.ts -- where MATs have been in the frames before: lines that fade.
import { sharesOf, type Palette } from './colours.ts';
import { COLOUR_FRAGMENT, shapeOf, VertexArray, type Program, type Shape } from './gl_canvas.ts';

const MAX_MATS = 300; // more are sampled
const FRAMES = 60; // of one trail

const TRAIL_PROGRAM: Program = {
  vertex: /* glsl */ `
    precision highp float;
    in vec3 position;
    in float age;        // 0 now, 1 the oldest
    uniform mat4 modelViewMatrix;
    uniform mat4 projectionMatrix;
    uniform vec3 trail_colour;
    uniform vec3 background;
    out vec3 colour;
    void main() {
      gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      colour = mix(trail_colour, background, 0.85 * age);
    }
  `,
  fragment: COLOUR_FRAGMENT,
};

export class Trails {
  readonly shape: Shape;
  private readonly mats: number[];
  private readonly places: VertexArray; // of each MAT FRAMES places, the newest first
  private frames = 0;

  /** @param mats  those that may move */
  constructor(mats: number[], palette: Palette) {
    const stride = Math.max(1, Math.ceil(mats.length / MAX_MATS));
    this.mats = mats.filter((_, i) => i % stride === 0);
    this.places = new VertexArray(new Float32Array(3 * FRAMES * this.mats.length), 3);
    const ages = Float32Array.from({ length: FRAMES * this.mats.length }, (_, i) => (i % FRAMES) / (FRAMES - 1));
    const index = new Uint32Array(2 * (FRAMES - 1) * this.mats.length);
    let filled = 0;
    // Step by step into the past, so that the first part of the index is what there is yet.
    for (let age = 0; age + 1 < FRAMES; ++age) {
      for (let trail = 0; trail < this.mats.length; ++trail) {
        index[filled++] = trail * FRAMES + age;
        index[filled++] = trail * FRAMES + age + 1;
      }
    }
    const vertices = { position: this.places, age: new VertexArray(ages, 1) };
    this.shape = shapeOf('lines', TRAIL_PROGRAM, vertices, { index: new VertexArray<Uint32Array>(index, 1), isVisible: false });
    this.paint(palette);
  }

  /** Shows them from now on, or no longer. */
  show(wanted: boolean): void {
    this.shape.isVisible = wanted;
    this.clear();
  }

  clear(): void {
    this.frames = 0;
    this.shape.parts = [];
  }

  /** Takes the places of a frame, as they are drawn. */
  append(placeOf: (mat: number) => number[]): void {
    if (!this.shape.isVisible || this.mats.length === 0) return;
    const { array } = this.places;
    array.copyWithin(3, 0, array.length - 3); // the oldest of each goes where the newest of the next will be
    this.mats.forEach((mat, trail) => array.set(placeOf(mat), 3 * FRAMES * trail));
    this.places.set();
    this.frames = Math.min(this.frames + 1, FRAMES);
    this.shape.parts = [{ first: 0, count: 2 * (this.frames - 1) * this.mats.length, uniforms: {} }];
  }

  paint(palette: Palette): void {
    Object.assign(this.shape.uniforms, { trail_colour: sharesOf(palette.quiet), background: sharesOf(palette.background) });
  }
}
