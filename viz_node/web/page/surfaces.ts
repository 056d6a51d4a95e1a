// viz_node/web/page/surfaces.ts -- the surfaces of a scene in the view: matte faces that are
// seen from outside, and their edges.
import type { Box3, Vector3 } from 'three';
import { mixed, readable, sharesOf, type Palette } from './colours.ts';
import { shapeOf, VertexArray } from './gl_canvas.ts';
import { COLOURED } from './ground.ts';
import type { Surface } from './protocol.ts';
import { lightOnSurface, shapesOf } from './surface_shape.ts';

const EDGE_SHARE = 0.35; // of the colour of texts in the edge of a coloured surface

/** Places and colours of vertices. */
class ColouredVertices {
  readonly position = new VertexArray(new Float32Array(0), 3);
  readonly tint = new VertexArray(new Float32Array(0), 3);

  set(places: Vector3[], colours: number[][]): void {
    this.position.set(new Float32Array(places.flatMap((place) => place.toArray())));
    this.tint.set(new Float32Array(colours.flat()));
  }
}

export class SurfaceView {
  private readonly corners = new ColouredVertices();
  private readonly ends = new ColouredVertices();
  private readonly faces = shapeOf('triangles', COLOURED, { ...this.corners }, { isBehindLines: true, isOneSided: true });
  private readonly edges = shapeOf('lines', COLOURED, { ...this.ends });
  readonly shapes = [this.faces, this.edges];
  private laid: { home: Box3; palette: Palette } | null = null; // what for

  constructor(
    readonly surfaces: Surface[], // where they are
    private readonly moving: number[], // those that are driven
    private readonly given: (string | null)[], // colours of the scene
    private readonly space: number,
  ) {}

  /** Puts those that are driven where their MATs are. */
  follow(placeOf: (mat: number) => number[]): void {
    if (this.moving.length === 0) return;
    for (const i of this.moving) this.surfaces[i] = { ...this.surfaces[i]!, centre: placeOf(this.surfaces[i]!.mat!) };
    if (this.laid !== null) this.lay(this.laid.home, this.laid.palette);
  }

  /** True if one of them is a plane, which is drawn as a grid. */
  get hasPlanes(): boolean {
    return this.surfaces.some(({ kind }) => kind === 'plane');
  }

  private coloursOf(wanted: string | null, palette: Palette): { face: string; edge: string } {
    if (wanted === null) return { face: palette.surface, edge: palette.surface_edge };
    const face = readable(wanted, palette);
    return { face, edge: mixed(face, palette.text, EDGE_SHARE) };
  }

  /** Lays all of them around a scene in `home`. */
  lay(home: Box3, palette: Palette): void {
    this.laid = { home, palette };
    const shapes = shapesOf(this.surfaces, home, this.space);
    const colours = this.given.map((wanted) => this.coloursOf(wanted, palette));
    const triangles = shapes.flatMap(({ faces }, number) =>
      faces.flatMap(({ corners, normal }) => {
        const tint = sharesOf(colours[number]!.face).map((share) => share * lightOnSurface(normal));
        return corners.slice(2).map((corner, i) => ({ places: [corners[0]!, corners[i + 1]!, corner], tint }));
      }),
    );
    this.corners.set(triangles.flatMap(({ places }) => places), triangles.flatMap(({ tint }) => [tint, tint, tint]));
    const ends = shapes.flatMap(({ edges }) => edges.flat());
    this.ends.set(ends, shapes.flatMap(({ edges }, number) => edges.flat().map(() => sharesOf(colours[number]!.edge))));
    this.faces.parts = [{ first: 0, count: 3 * triangles.length, uniforms: {} }];
    this.edges.parts = [{ first: 0, count: ends.length, uniforms: {} }];
  }
}
