// viz_node/web/page/scene_view.ts -- the scene, drawn. Positions go from the message
// straight into a GPU buffer that matter and links share.
import { Box3, Vector3 } from 'three';
import type { Bodies } from './bodies.ts';
import { BondView } from './bond_view.ts';
import { ofList, ramp, sharesOf, type Palette } from './colours.ts';
import type { Colouring } from './colouring.ts';
import { SMALLER, type Component } from './components.ts';
import { GlCanvas, shapeOf, VertexArray, type Shape } from './gl_canvas.ts';
import { Ground } from './ground.ts';
import type { BondGroups, LinkGroups } from './link_groups.ts';
import { LinkView } from './link_view.ts';
import { matProgram, sceneUniforms, SHOWN_RING, shownKinds } from './mat_material.ts';
import { NetForces } from './net_forces.ts';
import type { Frame, Surface, Topology } from './protocol.ts';
import { Trails } from './trails.ts';
import { LINK_IS_IDLE, MAT_FIXED } from './wire.ts';
import type { Quality } from './quality.ts';
import { boundsWith } from './surface_shape.ts';
import { SurfaceView } from './surfaces.ts';
import { CameraRig, type Edges, type Pose } from './camera_rig.ts';
import type { Point } from './marks.ts';

// More MATs than this are sampled where every one would cost too much: bounds, typical lengths, fastest speed.
const SAMPLE = 4000;
const MATS_A_FRAME = 1000; // of larger scenes not every frame is looked at, whether all of it is seen
const SMALL = 0.4; // of the radius of balls, where the links are looked at
const FOLLOWED = 1000; // of them are looked at, whether all of it is seen
const FORCE_COLOURS = 256;
const FALL = 0.985; // of the full scales of speed and force, per frame
const OUTLIERS = 0.01; // share of the MATs that may fly off unfollowed, at either end of each axis

/** A MAT or a link near a point of the view. */
export interface Near {
  index: number;
  away: number; // [CSS pixels]
}

export class SceneView {
  readonly rig: CameraRig;
  private readonly canvas: GlCanvas;
  private readonly ground = new Ground();
  private readonly surfaceView: SurfaceView;
  private readonly uniforms = sceneUniforms();
  private readonly radii: VertexArray; // as they are drawn
  private readonly tints: VertexArray<Uint8Array>;
  private readonly matter: Shape;
  readonly links: LinkView | null;
  readonly bonds: BondView;
  private newest: VertexArray;
  private readonly reference: VertexArray; // places from which motion and stretch are counted
  private readonly trails: Trails;
  private readonly forces: NetForces;
  private before: VertexArray;
  private portForces = new Float32Array(0); // of the newest frame
  private newestS = Number.NaN;
  private shownForS = Number.NaN; // simulated time between the last two frames
  private fastest = 0; // [m/s], falls slowly
  private readonly forceSizes: Float32Array; // on each MAT [N], while they are shown
  private forceRamp: Uint8Array = new Uint8Array(); // their colours, the weakest first
  private strongest = 0; // of them, falls slowly [N]
  private framesSinceCheck = 0;
  private framed = false;
  private isDrum = false;
  private colouring: Colouring = 'bodies';
  private referenceS = 0; // simulated time that stretches are counted from [s]
  private tintedVersion = 0; // of the components that have their colours
  private width = 0; // of the view [CSS pixels]
  private height = 0;
  private knownEdges: Edges | null = null; // null: to be measured
  private readonly edgeWatch = new ResizeObserver(() => (this.knownEdges = null));

  constructor(
    private readonly container: HTMLElement,
    private readonly topology: Topology,
    readonly bodies: Bodies,
    readonly groups: LinkGroups,
    bondGroups: BondGroups,
    private readonly tools: number[],
    private readonly portMats: number[], // of each port
    private readonly space: number,
    surfaces: Surface[],
    private palette: Palette,
    readonly quality: Quality,
    private readonly pose: Pose | null, // where the camera stood before, if it shall stay
    private readonly changed: () => void,
    contextLost: (lost: boolean) => void, // the browser took the graphics away, or gave them back
  ) {
    this.canvas = new GlCanvas(quality.antialias, quality.pixelRatio, (lost) => {
      contextLost(lost);
      changed();
    });
    this.canvas.clearTo(sharesOf(palette.background));
    container.prepend(this.canvas.element);
    this.rig = new CameraRig(this.canvas.element, space, () => this.edges(), changed);

    const coordinates = 3 * topology.matCount;
    this.newest = new VertexArray(new Float32Array(coordinates), 3);
    this.before = new VertexArray(new Float32Array(coordinates), 3);
    this.reference = new VertexArray(new Float32Array(coordinates), 3);
    this.radii = new VertexArray<Float32Array>(topology.radii.slice(), 1);
    this.tints = new VertexArray(bodies.tints(palette), 3);
    this.matter = this.matterShape();
    const vertices = { position: this.newest, previous: this.before, reference: this.reference };
    this.links = topology.linkCount > 0 ? new LinkView(topology, groups, vertices, this.uniforms, palette, quality.links) : null;
    this.bonds = new BondView(bondGroups, { ...vertices, radius: this.radii }, this.uniforms, palette, quality.links);
    const isMobile = (mat: number | null) => mat !== null && topology.kinds[mat] !== MAT_FIXED;
    const driven = [...surfaces.keys()].filter((i) => isMobile(surfaces[i]!.mat));
    this.surfaceView = new SurfaceView([...surfaces], driven, bodies.ofSurfaces, space);
    const shapes = new Set(bodies.shapes);
    this.trails = new Trails([...topology.kinds.keys()].filter((mat) => isMobile(mat) && !shapes.has(mat)), palette);
    this.forces = new NetForces(topology.masses);
    this.forceSizes = new Float32Array(topology.matCount);
    this.canvas.shapes.push(...this.surfaceView.shapes, this.matter, ...(this.links === null ? [] : [this.links.shape]), this.bonds.shape, this.trails.shape);
    if (space < 3 || !this.surfaceView.hasPlanes) this.canvas.shapes.push(this.ground.shape); // a plane is a grid itself
    for (const one of container.querySelectorAll('#sound, #legend, #control, #keyboards, #tools')) this.edgeWatch.observe(one);
    this.resize(container.clientWidth, container.clientHeight);
  }

  private matterShape(): Shape {
    const few = this.topology.matCount <= 3000;
    const least = few ? [3.2, 3.2, 6, 5] : [1.2, 1.2, 5, 2];
    this.uniforms.pixel_ratio = this.quality.pixelRatio;
    this.uniforms.min_pixels = least.map((pixels) => pixels * this.quality.pixelRatio);
    const kind = new VertexArray(Float32Array.from(shownKinds(this.topology.kinds, this.topology.radii, this.tools, this.bodies.shapes)), 1);
    const vertices = { position: this.newest, previous: this.before, reference: this.reference, radius: this.radii, tint: this.tints, kind };
    const all = { first: 0, count: this.topology.matCount, uniforms: {} };
    return shapeOf('points', matProgram(this.quality.spheres), vertices, { uniforms: this.uniforms, parts: [all], isVisible: false }); // until it has places
  }

  /** Takes a frame; draw() shows it. */
  show(frame: Frame): void {
    const first = Number.isNaN(this.newestS);
    [this.newest, this.before] = [this.before, this.newest];
    this.newest.set(frame.positions);
    this.forces.append(frame.positions, frame.simulatedS);
    if (first) {
      this.before.set(frame.positions.slice());
      this.sizePoints();
      this.measureFrom(frame.positions, frame.simulatedS);
      this.matter.isVisible = true;
    }
    this.links?.take(frame.positions, frame.linkStates);
    this.bonds.take(frame);
    this.portForces = frame.portForces;
    this.tintComponents();
    this.tintForces();
    for (const shape of [this.matter, this.links?.shape, this.bonds.shape]) if (shape !== undefined) Object.assign(shape.vertices, { position: this.newest, previous: this.before });
    this.shownForS = frame.simulatedS - this.newestS;
    this.measureSpeed(this.shownForS);
    this.newestS = frame.simulatedS;
    this.trails.append((mat) => this.drawnPlace(mat));
    this.followSurfaces();
    if (!this.framed) {
      this.framed = true;
      this.isDrum = this.liesFlat();
      if (this.isDrum) this.rig.turnByLeftButton();
      if (this.pose === null) this.rig.start(this.bounds(), this.isDrum ? 'free' : null);
      else this.rig.resume(this.pose, this.bounds());
      this.layGround();
    } else if (++this.framesSinceCheck >= this.topology.matCount / MATS_A_FRAME) {
      this.framesSinceCheck = 0;
      this.rig.follow(this.bounds(OUTLIERS, FOLLOWED));
    }
  }

  draw(): void {
    this.rig.update();
    const camera = this.rig.camera;
    this.uniforms.pixels_per_unit = 0.5 * this.canvas.element.height * camera.projectionMatrix.elements[5]!;
    this.uniforms.orthographic = this.rig.orthographic;
    [this.uniforms.view_width, this.uniforms.view_height] = [this.canvas.element.width, this.canvas.element.height];
    camera.updateMatrixWorld();
    this.canvas.draw(camera.matrixWorldInverse.elements, camera.projectionMatrix.elements);
  }

  /** @param width, height  of the view [CSS pixels] */
  resize(width: number, height: number): void {
    [this.width, this.height] = [width, height];
    this.knownEdges = null;
    this.canvas.resize(width, height);
    this.rig.resize(width, height);
    this.changed();
  }

  /** Legend and buttons above, keyboards and tools below: a scene that is fitted stands between them. */
  private edges(): Edges {
    return (this.knownEdges ??= this.measureEdges());
  }

  private measureEdges(): Edges {
    const stage = this.container.getBoundingClientRect();
    const boxes = (selector: string) => [...this.container.querySelectorAll(selector)].map((one) => one.getBoundingClientRect()).filter(({ height }) => height > 0);
    const top = boxes('#legend, #control').map((box) => box.bottom - stage.top);
    const bottom = boxes('#keyboards, #tools').map((box) => stage.bottom - box.top);
    return { top: Math.max(0, ...top), bottom: Math.max(0, ...bottom) };
  }

  fit(): void {
    this.rig.fit(this.bounds());
  }

  /** Draws all of it in the colours of a palette. */
  paint(palette: Palette): void {
    this.palette = palette;
    this.canvas.clearTo(sharesOf(palette.background));
    this.links?.paint(palette);
    this.bonds.paint(palette);
    this.trails.paint(palette);
    this.colourBy(this.colouring);
    if (this.framed) this.layGround();
    this.changed();
  }

  private followSurfaces(): void {
    this.surfaceView.follow((mat) => this.drawnPlace(mat));
  }

  private layGround(): void {
    const home = this.bounds();
    this.ground.lay(home, this.isDrum ? 3 : this.space, this.palette);
    this.surfaceView.lay(home, this.palette);
  }

  /** A 1-D scene that is laid out on a floor: from the front it is a line. */
  private liesFlat(): boolean {
    if (this.space !== 1) return false;
    const size = this.matterBounds().getSize(new Vector3());
    return size.z > 0.2 * size.x && size.x > 0.2 * size.z;
  }

  /** Nearest MAT to a point of the view, and how far its edge is [CSS pixels]; null when none is within so many. */
  matAt({ x, y }: Point, within: number): Near | null {
    let best: Near | null = null;
    for (let mat = 0; mat < this.topology.matCount; ++mat) {
      const middle = this.project(mat);
      const away = Math.max(0, Math.hypot(middle.x - x, middle.y - y) - this.radiusOnScreen(mat));
      if (away < (best?.away ?? within)) best = { index: mat, away };
    }
    return best;
  }

  /** Likewise the nearest link that is drawn. */
  linkAt({ x, y }: Point, within: number): Near | null {
    let best: Near | null = null;
    for (let link = 0; this.quality.links && link < this.topology.linkCount; ++link) {
      if (this.stateOf(link) >= LINK_IS_IDLE) continue;
      const [a, b] = this.endsOf(link).map((mat) => this.project(mat)) as [Point, Point];
      const [dx, dy] = [b.x - a.x, b.y - a.y];
      const share = Math.min(1, Math.max(0, ((x - a.x) * dx + (y - a.y) * dy) / (dx * dx + dy * dy || 1)));
      const away = Math.hypot(a.x + share * dx - x, a.y + share * dy - y);
      if (away < (best?.away ?? within)) best = { index: link, away };
    }
    return best;
  }

  /** The two MATs of a link. */
  endsOf(link: number): [number, number] {
    const { linkEnds } = this.topology;
    return [linkEnds[2 * link]!, linkEnds[2 * link + 1]!];
  }

  /** State of a link in the newest frame, + LINK_IS_IDLE where it does nothing; 0 in scenes without states. */
  stateOf(link: number): number {
    return this.links?.stateOf(link) ?? 0;
  }

  /** Speed of a MAT, the mean over the last frame [m/s]. */
  speedOf(mat: number): number {
    const [now, then] = [this.newest.array, this.before.array];
    const moved = [0, 1, 2].map((k) => now[3 * mat + k]! - then[3 * mat + k]!);
    return this.shownForS > 0 ? Math.hypot(...moved) / this.shownForS : Number.NaN;
  }

  /** Net force on a MAT along x, y and z, the mean over `forceSpanS` [N]; null where there is none to say. */
  forceOn(mat: number): number[] | null {
    return this.forces.of(mat);
  }

  /** What the liaisons do to the port at a MAT along x, y and z in the newest frame [N]; null where there is no port. */
  portForceOn(mat: number): number[] | null {
    const port = this.portMats.indexOf(mat);
    const force = [...this.portForces.subarray(3 * port, 3 * port + 3)];
    return port >= 0 && force.length === 3 ? force : null;
  }

  get forceSpanS(): number {
    return this.forces.spanS;
  }

  toggleGround(): void {
    this.ground.shape.isVisible = !this.ground.shape.isVisible;
    this.changed();
  }

  private measureFrom(positions: Float32Array, timeS: number): void {
    this.reference.array.set(positions);
    this.reference.set();
    this.links?.measureFrom(positions);
    this.referenceS = timeS;
  }

  /** Motion and stretch are counted from the newest frame on. */
  measureFromNow(): void {
    if (Number.isNaN(this.newestS)) return;
    this.measureFrom(this.newest.array, this.newestS);
    this.followSurfaces();
    this.trails.clear();
    this.colourBy(this.colouring);
  }

  /** Motion is drawn so many times as large as it is. */
  exaggerate(factor: number): void {
    this.uniforms.exaggeration = factor;
    this.followSurfaces();
    this.trails.clear();
    this.changed();
  }

  get exaggeration(): number {
    return this.uniforms.exaggeration;
  }

  showTrails(wanted: boolean): void {
    this.trails.show(wanted);
    this.changed();
  }

  /** How much longer a link is than at `countedSinceS`, a share. */
  stretchOf(link: number): number {
    return this.links?.stretchOf(this.newest.array, link) ?? 0;
  }

  /** The component of a MAT, where these have colours. */
  componentOf(mat: number): { component: Component; place: number } | null {
    return this.colouring === 'components' ? (this.links?.components.of(mat) ?? null) : null;
  }

  /** Simulated time of the frame that is drawn [s]. */
  get newestTimeS(): number {
    return this.newestS;
  }

  /** The axes along which the scene moves: 0 x, 1 y, 2 z. A 1-D scene moves along y. */
  get axes(): number[] {
    return this.space === 1 ? [1] : this.space === 2 ? [0, 1] : [0, 1, 2];
  }

  get countedSinceS(): number {
    return this.referenceS;
  }

  colourBy(colouring: Colouring): void {
    this.colouring = colouring;
    this.forceRamp = ramp(this.palette.speeds, FORCE_COLOURS);
    this.uniforms.radius_share = colouring === 'stretch' ? SMALL : 1;
    this.measureSpeed(this.shownForS);
    this.links?.colourBy(colouring, this.newest.array);
    this.bonds.colourBy(colouring);
    if (colouring === 'components') this.tintComponents();
    else this.tints.set(this.bodies.tints(this.palette, colouring === 'stretch' || colouring === 'force' ? () => this.palette.quiet : undefined));
    this.tintForces();
    this.changed();
  }

  /** The components have changed: the largest ones have colours of their own. */
  private tintComponents(): void {
    const { links, palette } = this;
    if (links === null || this.colouring !== 'components' || this.tintedVersion === links.componentsVersion) return;
    this.tintedVersion = links.componentsVersion;
    this.tints.set(
      this.bodies.tints(palette, (mat) => {
        const colour = links.components.of(mat)?.component.colour ?? SMALLER;
        return colour === SMALLER ? palette.quiet : ofList(palette.bodies, colour);
      }),
    );
  }

  /** Free masses get the colours of the net forces on them. Without three frames they keep what they have. */
  private tintForces(): void {
    if (this.colouring !== 'force' || !this.forces.sizesOfAll(this.forceSizes)) return;
    const [sizes, kinds, tints] = [this.forceSizes, this.matter.vertices.kind!.array, this.tints.array];
    let largest = FALL * this.strongest;
    for (let mat = 0; mat < sizes.length; ++mat) if (kinds[mat] === 0 && sizes[mat]! > largest) largest = sizes[mat]!;
    this.strongest = largest;
    const { forceRamp } = this;
    const scale = largest > 0 ? (FORCE_COLOURS - 1) / largest : 0;
    for (let mat = 0, place = 0; mat < sizes.length; ++mat, place += 3) {
      if (kinds[mat] !== 0 || Number.isNaN(sizes[mat]!)) continue;
      const colour = 3 * Math.round(scale * sizes[mat]!);
      tints[place] = forceRamp[colour]!;
      tints[place + 1] = forceRamp[colour + 1]!;
      tints[place + 2] = forceRamp[colour + 2]!;
    }
    this.tints.set();
  }

  /** True if a net force can be said of a MAT that has no colour of its own. */
  get hasFreeMasses(): boolean {
    const kinds = this.matter.vertices.kind!.array;
    return this.topology.masses.some((mass, mat) => mass > 0 && kinds[mat] === 0);
  }

  /** The full scale of the colours of forces [N]. */
  get strongestForce(): number {
    return this.strongest;
  }

  get fastestSpeed(): number {
    return this.fastest;
  }

  /** Where MAT `index` is in the scene [m]. */
  place(index: number): number[] {
    return [...this.newest.array.slice(3 * index, 3 * index + 3)];
  }

  /** Where MAT `index` is drawn in the scene [m]. */
  drawnPlace(index: number): number[] {
    return this.drawnAt(index, this.place(index));
  }

  /** Where MAT `index` is drawn when it is at `place` [m]. */
  drawnAt(index: number, place: number[]): number[] {
    const extra = this.uniforms.exaggeration - 1;
    return place.map((value, k) => value + extra * (value - this.reference.array[3 * index + k]!));
  }

  /** Where MAT `index` is in the view [CSS pixels]. */
  project(index: number): Point {
    return this.screenOf(this.drawnPlace(index));
  }

  /** Where a place of the scene is in the view [CSS pixels]. */
  screenOf(place: number[]): Point {
    const point = new Vector3().fromArray(place).project(this.rig.camera);
    return { x: (0.5 + 0.5 * point.x) * this.width, y: (0.5 - 0.5 * point.y) * this.height };
  }

  /** The place [m] behind a point of the view that is as far from the camera as `through`. */
  unproject({ x, y }: Point, through: number[]): number[] {
    const depth = new Vector3().fromArray(through).project(this.rig.camera).z;
    const point = new Vector3((2 * x) / this.width - 1, 1 - (2 * y) / this.height, depth);
    return point.unproject(this.rig.camera).toArray();
  }

  /** A point of the view as one of the page. */
  onPage({ x, y }: Point): Point {
    const { left, top } = this.canvas.element.getBoundingClientRect();
    return { x: left + x, y: top + y };
  }

  /** A point of the page as one of the view. */
  ofPage(x: number, y: number): Point {
    const { left, top } = this.canvas.element.getBoundingClientRect();
    return { x: x - left, y: y - top };
  }

  /** Radius of MAT `index` as it is drawn, at the middle of the scene [CSS pixels]. */
  radiusOnScreen(index: number): number {
    const share = this.matter.vertices.kind!.array[index] === SHOWN_RING ? 1 : this.uniforms.radius_share;
    return (share * this.radii.array[index]!) / this.rig.metresPerPixel;
  }

  /** Colour of one pixel of the view as it is drawn now, 0..255. */
  pixelAt({ x, y }: Point): number[] {
    this.draw();
    return this.canvas.pixelAt(x, this.height - y);
  }

  image(): Promise<Blob | null> {
    this.draw();
    return new Promise((resolve) => this.canvas.element.toBlob(resolve));
  }

  dispose(): void {
    this.edgeWatch.disconnect();
    this.rig.dispose();
    this.canvas.dispose();
  }

  /** What holds the surfaces and the MATs with their radii, but for this share of these at either end of each axis. */
  private bounds(outliers = 0, sample = SAMPLE): Box3 {
    return boundsWith(this.surfaceView.surfaces, this.matterBounds(outliers, sample), this.space);
  }

  private matterBounds(outliers = 0, sample = SAMPLE): Box3 {
    const stride = Math.max(1, Math.floor(this.topology.matCount / sample));
    const count = Math.ceil(this.topology.matCount / stride);
    const left = Math.floor(outliers * count);
    const radii = this.radii.array;
    const extra = this.uniforms.exaggeration - 1;
    const low = new Float32Array(count);
    const high = new Float32Array(count);
    const box = new Box3();
    for (let axis = 0; axis < 3; ++axis) {
      for (let k = 0; k < count; ++k) {
        const place = 3 * k * stride + axis;
        const moved = this.newest.array[place]! - this.reference.array[place]!;
        const coordinate = this.newest.array[place]! + extra * moved;
        low[k] = coordinate - radii[k * stride]!;
        high[k] = coordinate + radii[k * stride]!;
      }
      box.min.setComponent(axis, low.sort()[left] ?? 0);
      box.max.setComponent(axis, high.sort()[count - 1 - left] ?? 0);
    }
    return box;
  }

  /** Punctual MATs get a size to be seen: a share of the usual length of a link. */
  private sizePoints(): void {
    const { linkEnds, linkCount, radii } = this.topology;
    const positions = this.newest.array;
    const extent = this.matterBounds().getSize(new Vector3()).length() || 1;
    const lengths: number[] = [];
    const stride = Math.max(1, Math.floor(linkCount / SAMPLE));
    for (let l = 0; l < linkCount; l += stride) {
      const a = 3 * linkEnds[2 * l]!;
      const b = 3 * linkEnds[2 * l + 1]!;
      lengths.push(
        Math.hypot(
          positions[a]! - positions[b]!,
          positions[a + 1]! - positions[b + 1]!,
          positions[a + 2]! - positions[b + 2]!,
        ),
      );
    }
    lengths.sort((a, b) => a - b);
    const usual = lengths[Math.floor(lengths.length / 2)] ?? extent / 100;
    const shown = Math.min(Math.max(0.3 * usual, extent / 2000), extent / 80);
    for (let i = 0; i < radii.length; ++i) this.radii.array[i] = radii[i] || shown;
    this.radii.set();
  }

  /** The full scale of the colours follows the fastest MAT, at once upwards and slowly down. */
  private measureSpeed(elapsedS: number): void {
    if (this.colouring !== 'speed') {
      this.uniforms.speed_scale = 0;
      return;
    }
    if (!(elapsedS > 0)) return;
    let longest = 0;
    const stride = Math.max(1, Math.floor(this.topology.matCount / SAMPLE));
    const now = this.newest.array;
    const then = this.before.array;
    for (let i = 0; i < this.topology.matCount; i += stride) {
      const dx = now[3 * i]! - then[3 * i]!;
      const dy = now[3 * i + 1]! - then[3 * i + 1]!;
      const dz = now[3 * i + 2]! - then[3 * i + 2]!;
      longest = Math.max(longest, dx * dx + dy * dy + dz * dz);
    }
    this.fastest = Math.max(Math.sqrt(longest) / elapsedS, FALL * this.fastest);
    this.uniforms.speed_scale = this.fastest > 0 ? 1 / (this.fastest * elapsedS) : 1;
  }
}
