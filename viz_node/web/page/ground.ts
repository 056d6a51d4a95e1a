// viz_node/web/page/ground.ts -- a grid of round lengths under or behind the scene: a viewer
// has something to hold on to.
import * as THREE from 'three';
import { bytesOf, type Palette } from './colours.ts';

/** Red, green and blue of "#rrggbb", 0..1. */
const sharesOf = (hex: string): number[] => bytesOf(hex).map((byte) => byte / 255);

const CELLS = 24; // across the larger side of the scene, about

/** The largest of 1, 2, 5, 10, 20 ... that is not above `length`. */
export function roundLength(length: number): number {
  const decade = 10 ** Math.floor(Math.log10(length));
  const digit = length / decade;
  return decade * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1);
}

export class Ground {
  readonly group = new THREE.Group();

  /** Lays the grid again: upright through the scene when it is flat, on the floor when it is not. */
  lay(box: THREE.Box3, space: number, palette: Palette): void {
    this.dispose();
    const size = box.getSize(new THREE.Vector3());
    const centre = box.getCenter(new THREE.Vector3());
    const flat = space < 3;
    const across = Math.max(size.x, flat ? size.y : size.z, 1e-6);
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
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(points, 3));
    geometry.setAttribute('color', new THREE.Float32BufferAttribute(colours, 3));
    this.group.add(new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ vertexColors: true, depthWrite: false })));
  }

  dispose(): void {
    for (const child of [...this.group.children]) {
      const lines = child as THREE.LineSegments;
      lines.geometry.dispose();
      (lines.material as THREE.Material).dispose();
      this.group.remove(lines);
    }
  }
}
