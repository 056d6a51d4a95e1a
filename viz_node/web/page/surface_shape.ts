// viz_node/web/page/surface_shape.ts -- surfaces of a scene as faces and edges; likewise
// viz_node/render/surface_shape.cpp for images.
import { Box3, Vector3 } from 'three';
import { roundLength } from './format.ts';
import type { Surface } from './protocol.ts';

const SURFACE_ROOM = 0.15; // beyond the scene in space, in its diagonals
const FLAT_ROOM = 3; // likewise of a flat one
const PLANE_CELLS = 12; // across the larger side of a plane, at least
const HATCH_LENGTH = 0.7; // in cells
const NEAR_DIAGONALS = 10; // from which on nothing unbounded counts
const CIRCLE_CORNERS = 48;
const LIGHT = new Vector3(-0.45, 0.75, 0.6).normalize();

/** A flat convex face; its corners [m] go counterclockwise for a viewer on its outer side. */
export interface SurfaceFace {
  corners: Vector3[];
  normal: Vector3;
}

export interface SurfaceShape {
  faces: SurfaceFace[];
  edges: [Vector3, Vector3][];
}

interface Span {
  low: number;
  high: number;
}

const vectorOf = ([x = 0, y = 0, z = 0]: number[]): Vector3 => new Vector3(x, y, z);
const sizeOf = (box: Box3): Vector3 => box.getSize(new Vector3());
const middleOf = (box: Box3): Vector3 => box.getCenter(new Vector3());

/** Share of its colour that a face with this normal shows, 0.6 to 1: lit from above the left shoulder. */
export const lightOnSurface = (normal: Vector3): number => Math.min(1, 0.7 + 0.1 * normal.y + 0.3 * Math.max(normal.dot(LIGHT), 0));

/** Half of the extent of a box along an axis [m]. */
function halfExtent(box: Box3, axis: Vector3): number {
  const size = sizeOf(box);
  return 0.5 * (Math.abs(axis.x) * size.x + Math.abs(axis.y) * size.y + Math.abs(axis.z) * size.z);
}

/** A unit vector across `axis`, along a coordinate axis where that is possible. */
function across(axis: Vector3): Vector3 {
  const sizes = axis.toArray().map(Math.abs);
  const least = sizes.findIndex((size) => size < Math.min(...sizes) + 1e-9);
  const along = new Vector3().setComponent(least, 1);
  return along.addScaledVector(axis, -along.dot(axis)).normalize();
}

/** The side of a plane that matter can be on, or both. */
class HalfSpace {
  readonly at: Vector3;
  readonly normal: Vector3;
  readonly hasBothSides: boolean;

  constructor({ centre, axis }: Surface, next: Surface | undefined) {
    this.hasBothSides = next?.kind === 'inner_face';
    this.at = vectorOf(centre);
    this.normal = vectorOf(axis);
  }

  height(point: Vector3): number {
    return point.clone().sub(this.at).dot(this.normal);
  }

  /** What of a face is on this side. */
  clipFace(corners: Vector3[]): Vector3[] {
    return corners.flatMap((from, i) => {
      const next = corners[(i + 1) % corners.length]!;
      const [begins, ends] = [this.height(from), this.height(next)];
      const kept = begins >= 0 ? [from] : [];
      return begins >= 0 === ends >= 0 ? kept : [...kept, from.clone().lerp(next, begins / (begins - ends))];
    });
  }

  /** What of a line is on this side. */
  clipLine([from, to]: [Vector3, Vector3]): [Vector3, Vector3][] {
    const [begins, ends] = [this.height(from), this.height(to)];
    if (begins < 0 && ends < 0) return [];
    const cut = from.clone().lerp(to, begins / (begins - ends));
    return [[begins < 0 ? cut : from, ends < 0 ? cut : to]];
  }
}

/** The shapes of surfaces around a scene in `home`. A plane ends where another one with one side is. */
export function shapesOf(surfaces: Surface[], home: Box3, space: number): SurfaceShape[] {
  const planes = surfaces.map((surface, i) => (surface.kind === 'plane' ? new HalfSpace(surface, surfaces[i + 1]) : null));
  const size = sizeOf(home);
  const level = home.min.z - 0.0005 * Math.max(size.x, size.y, 1e-6); // of sections: between the grid and all matter
  return surfaces.map((surface, i) => {
    const plane = planes[i] ?? null;
    if (plane !== null) {
      // One that faces the same way is no border.
      const borders = planes.filter((other) => other !== null && other !== plane && !other.hasBothSides && other.normal.dot(plane.normal) <= 1 - 1e-9) as HalfSpace[];
      return space < 3 ? lineOf(plane, borders, home, level) : planeOf(plane, borders, home);
    }
    if (surface.kind === 'segment') {
      const [from, to] = endsOf(surface);
      return { faces: [], edges: [[from.setZ(level), to.setZ(level)]] };
    }
    if (surface.kind === 'inner_face') return { faces: [], edges: [] }; // its body shows it
    const shape = isBox(surface)
      ? space < 3 ? boxSection(surface, home, level) : boxOf(surface, home)
      : space < 3 ? cylinderSection(surface, home, level) : cylinderOf(surface, home);
    return surface.kind.startsWith('hollow') ? hollowOf(shape, space) : shape;
  });
}

/** A face as seen from its other side. */
const turned = ({ corners, normal }: SurfaceFace): SurfaceFace => ({ corners: [...corners].reverse(), normal: normal.clone().negate() });

const isBox = ({ kind }: Surface): boolean => kind === 'box' || kind === 'hollow_box';

/** The inner sides of a body: a viewer sees those behind what is inside, past the ones before it. Of a section the outline. */
function hollowOf({ faces, edges }: SurfaceShape, space: number): SurfaceShape {
  if (space < 3) return { faces: [], edges };
  return { faces: faces.map(turned), edges };
}

/** The box around `matter` and the surfaces. What is unbounded counts by its nearest place, where that is near. */
export function boundsWith(surfaces: Surface[], matter: Box3, space: number): Box3 {
  const box = matter.clone();
  const middle = middleOf(matter);
  const farthest = NEAR_DIAGONALS * sizeOf(matter).length();
  const uniteNear = (foot: Vector3, there: Box3) => foot.distanceTo(middle) <= farthest && box.union(there);
  for (const surface of surfaces) {
    if (surface.kind === 'inner_face') continue;
    const [centre, axis] = [vectorOf(surface.centre), vectorOf(surface.axis)];
    const along = middle.clone().sub(centre).dot(axis);
    if (isBox(surface)) {
      const spans = [0, 1, 2].map((k) => spanOf(surface, matter, k, 0));
      box.union(new Box3(vectorOf(spans.map(({ low }) => low)), vectorOf(spans.map(({ high }) => high))));
    } else if (surface.kind === 'segment') {
      for (const end of endsOf(surface)) box.expandByPoint(end);
    } else if (surface.kind === 'plane') {
      const foot = middle.clone().addScaledVector(axis, -along);
      uniteNear(foot, new Box3(foot, foot.clone()));
    } else if (surface.size[1]! > 0) {
      box.union(boxAround(surface, centre));
    } else {
      const foot = centre.addScaledVector(axis, along);
      uniteNear(foot, boxAround(surface, foot));
    }
  }
  if (space < 3) [box.min.z, box.max.z] = [matter.min.z, matter.max.z];
  return box;
}

/** The two ends of a segment. */
function endsOf({ centre, axis, size }: Surface): [Vector3, Vector3] {
  const half = vectorOf(axis).multiplyScalar(0.5 * size[0]!);
  return [vectorOf(centre).sub(half), vectorOf(centre).add(half)];
}

/** The box around a cylinder whose middle is `near`. */
function boxAround({ axis, size }: Surface, near: Vector3): Box3 {
  const reach = vectorOf(axis.map((share) => 0.5 * size[1]! * Math.abs(share) + size[0]! * Math.sqrt(Math.max(0, 1 - share * share))));
  return new Box3(near.clone().sub(reach), near.clone().add(reach));
}

function planeOf(plane: HalfSpace, borders: HalfSpace[], home: Box3): SurfaceShape {
  const u = across(plane.normal);
  const v = plane.normal.clone().cross(u);
  const middle = middleOf(home);
  const foot = middle.clone().addScaledVector(plane.normal, -plane.height(middle));
  const room = SURFACE_ROOM * Math.max(sizeOf(home).length(), 1e-6);
  const halves = [halfExtent(home, u) + room, halfExtent(home, v) + room] as const;
  const cell = roundLength((2 * Math.max(...halves)) / PLANE_CELLS);
  const span = (axis: Vector3, half: number): Span => ({ low: cell * Math.floor((foot.dot(axis) - half) / cell), high: cell * Math.ceil((foot.dot(axis) + half) / cell) });
  const [us, vs] = [span(u, halves[0]), span(v, halves[1])];
  const base = plane.normal.clone().multiplyScalar(plane.at.dot(plane.normal));
  const placeAt = (alongU: number, alongV: number) => base.clone().addScaledVector(u, alongU).addScaledVector(v, alongV);
  const lines: [Vector3, Vector3][] = [
    ...gridPlaces(us, plane.at.dot(u), cell).map((place): [Vector3, Vector3] => [placeAt(place, vs.low), placeAt(place, vs.high)]),
    ...gridPlaces(vs, plane.at.dot(v), cell).map((place): [Vector3, Vector3] => [placeAt(us.low, place), placeAt(us.high, place)]),
  ];
  const square = [placeAt(us.low, vs.low), placeAt(us.high, vs.low), placeAt(us.high, vs.high), placeAt(us.low, vs.high)];
  const corners = borders.reduce((left, border) => border.clipFace(left), square);
  const face: SurfaceFace = { corners, normal: plane.normal };
  const faces = plane.hasBothSides ? [face, turned(face)] : [face];
  return { faces: corners.length < 3 ? [] : faces, edges: clippedLines(lines, borders) };
}

/** What is left of `place` over whole cells, 0 or more. */
const withinCell = (place: number, cell: number): number => place - cell * Math.floor(place / cell);

/** Places of the lines of a grid that goes along with its plane: both ends, and each whole cell from `origin` between them. */
function gridPlaces({ low, high }: Span, origin: number, cell: number): number[] {
  const cells = Math.round((high - low) / cell);
  const first = low + withinCell(origin, cell);
  const inner = Array.from({ length: cells }, (_, k) => first + k * cell).filter((place) => place > low && place < high);
  return [low, ...inner, high];
}

const clippedLines = (lines: [Vector3, Vector3][], borders: HalfSpace[]): [Vector3, Vector3][] =>
  borders.reduce((left, border) => left.flatMap((line) => border.clipLine(line)), lines);

/** A line far past the view, with short lines on the side where matter cannot be, if there is one. They go along with the plane. */
function lineOf(plane: HalfSpace, borders: HalfSpace[], home: Box3, level: number): SurfaceShape {
  const along = new Vector3(-plane.normal.y, plane.normal.x, 0);
  const size = sizeOf(home);
  const reach = Math.max(size.x, size.y, 1e-6);
  const cell = roundLength(reach / PLANE_CELLS);
  const middle = middleOf(home);
  const foot = middle.clone().addScaledVector(plane.normal, -plane.height(middle)).setZ(level);
  const whole: [Vector3, Vector3] = [foot.clone().addScaledVector(along, -FLAT_ROOM * reach), foot.clone().addScaledVector(along, FLAT_ROOM * reach)];
  const edges = clippedLines([whole], borders);
  if (plane.hasBothSides) return { faces: [], edges };
  const hatch = plane.normal.clone().add(along).normalize().multiplyScalar(-HATCH_LENGTH * cell);
  for (const [from, to] of [...edges]) {
    const first = withinCell(plane.at.clone().sub(from).dot(along) + 0.5 * cell, cell);
    for (let place = first; place < to.clone().sub(from).dot(along); place += cell) {
      const begin = from.clone().addScaledVector(along, place);
      edges.push([begin, begin.clone().add(hatch)]);
    }
  }
  return { faces: [], edges };
}

/** The range of a box along an axis, past the scene where it has no bound. */
function spanOf({ centre, size }: Surface, home: Box3, axis: number, room: number): Span {
  const [middle, half] = [centre[axis]!, 0.5 * size[axis]!];
  if (half > 0) return { low: middle - half, high: middle + half };
  return { low: home.min.getComponent(axis) - room, high: home.max.getComponent(axis) + room };
}

function boxOf(box: Surface, home: Box3): SurfaceShape {
  const room = SURFACE_ROOM * sizeOf(home).length();
  const spans = [0, 1, 2].map((axis) => spanOf(box, home, axis, room));
  const shape: SurfaceShape = { faces: [], edges: [] };
  for (let axis = 0; axis < 3; ++axis) {
    const [next, last] = [(axis + 1) % 3, (axis + 2) % 3];
    const { low, high } = spans[axis]!;
    const { low: b0, high: b1 } = spans[next]!;
    const { low: c0, high: c1 } = spans[last]!;
    const placeAt = (a: number, b: number, c: number) => new Vector3().setComponent(axis, a).setComponent(next, b).setComponent(last, c);
    shape.faces.push({ corners: [placeAt(low, b0, c0), placeAt(low, b0, c1), placeAt(low, b1, c1), placeAt(low, b1, c0)], normal: new Vector3().setComponent(axis, -1) });
    shape.faces.push({ corners: [placeAt(high, b0, c0), placeAt(high, b1, c0), placeAt(high, b1, c1), placeAt(high, b0, c1)], normal: new Vector3().setComponent(axis, 1) });
    for (const b of [b0, b1]) for (const c of [c0, c1]) shape.edges.push([placeAt(low, b, c), placeAt(high, b, c)]);
  }
  return shape;
}

/** Directions of the corners of a circle across `axis`, from `from` on. */
function circleOf(axis: Vector3, from: Vector3): Vector3[] {
  const other = axis.clone().cross(from);
  return Array.from({ length: CIRCLE_CORNERS }, (_, i) => {
    const angle = (2 * Math.PI * i) / CIRCLE_CORNERS;
    return from.clone().multiplyScalar(Math.cos(angle)).addScaledVector(other, Math.sin(angle));
  });
}

function cylinderOf(cylinder: Surface, home: Box3): SurfaceShape {
  const [axis, centre] = [vectorOf(cylinder.axis), vectorOf(cylinder.centre)];
  const [radius, length] = cylinder.size as [number, number];
  let span = { low: -0.5 * length, high: 0.5 * length };
  if (length === 0) {
    const middle = middleOf(home).sub(centre).dot(axis);
    const half = halfExtent(home, axis) + SURFACE_ROOM * sizeOf(home).length();
    span = { low: middle - half, high: middle + half };
  }
  const around = circleOf(axis, across(axis));
  const ring = (along: number) => around.map((direction) => centre.clone().addScaledVector(axis, along).addScaledVector(direction, radius));
  const [low, high] = [ring(span.low), ring(span.high)];
  const shape: SurfaceShape = { faces: [], edges: [] };
  around.forEach((direction, i) => {
    const next = (i + 1) % CIRCLE_CORNERS;
    shape.faces.push({ corners: [low[i]!, low[next]!, high[next]!, high[i]!], normal: direction.clone().add(around[next]!).normalize() });
    shape.edges.push([low[i]!, low[next]!], [high[i]!, high[next]!]);
  });
  shape.faces.push({ corners: high, normal: axis }, { corners: [...low].reverse(), normal: axis.clone().negate() });
  return shape;
}

/** A filled outline at `level`, behind the matter of a flat scene. */
function sectionOf(outline: Vector3[], level: number): SurfaceShape {
  const corners = outline.map((corner) => corner.clone().setZ(level));
  const edges = corners.map((corner, i): [Vector3, Vector3] => [corner, corners[(i + 1) % corners.length]!]);
  return { faces: [{ corners, normal: new Vector3(0, 0, 1) }], edges };
}

function boxSection(box: Surface, home: Box3, level: number): SurfaceShape {
  const size = sizeOf(home);
  const room = FLAT_ROOM * Math.max(size.x, size.y, 1e-6);
  const [x, y] = [spanOf(box, home, 0, room), spanOf(box, home, 1, room)];
  return sectionOf([new Vector3(x.low, y.low), new Vector3(x.high, y.low), new Vector3(x.high, y.high), new Vector3(x.low, y.high)], level);
}

/** A disc where the axis points to the viewer, else a strip. */
function cylinderSection(cylinder: Surface, home: Box3, level: number): SurfaceShape {
  const [axis, centre] = [vectorOf(cylinder.axis), vectorOf(cylinder.centre)];
  const [radius, length] = cylinder.size as [number, number];
  if (Math.abs(axis.z) > 0.5) {
    const around = circleOf(new Vector3(0, 0, 1), new Vector3(1, 0, 0));
    return sectionOf(around.map((direction) => centre.clone().addScaledVector(direction, radius)), level);
  }
  const along = axis.setZ(0).normalize();
  const aside = new Vector3(-along.y, along.x, 0).multiplyScalar(radius);
  const size = sizeOf(home);
  const half = length > 0 ? 0.5 * length : FLAT_ROOM * Math.max(size.x, size.y, 1e-6);
  const middle = length > 0 ? centre : centre.clone().addScaledVector(along, middleOf(home).sub(centre).dot(along));
  const placeAt = (end: number, side: number) => middle.clone().addScaledVector(along, end * half).addScaledVector(aside, side);
  return sectionOf([placeAt(-1, -1), placeAt(1, -1), placeAt(1, 1), placeAt(-1, 1)], level);
}
