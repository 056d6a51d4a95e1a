// viz_node/web/page/scene_view.ts -- the scene, drawn. Positions go from the message
// straight into a GPU buffer that matter and links share.
import * as THREE from 'three';
import type { Bodies } from './bodies.ts';
import type { Palette } from './colours.ts';
import { Ground } from './ground.ts';
import { linkMaterials, matMaterial, materialOfState, sceneUniforms, shownKinds } from './mat_material.ts';
import type { Frame, Topology } from './protocol.ts';
import { LINK_IS_IDLE } from './wire.ts';
import type { Quality } from './quality.ts';
import { CameraRig, type Pose } from './camera_rig.ts';

THREE.ColorManagement.enabled = false; // colours are chosen as they are shown
const CONTEXT_EVENTS = ['webglcontextlost', 'webglcontextrestored'];
// More MATs than this are sampled where every one would cost too much: bounds, typical lengths, fastest speed.
const SAMPLE = 4000;
const MATS_A_FRAME = 1000; // of larger scenes not every frame is looked at, whether all of it is seen
const ASTRAY = 0.01; // share of the MATs that may fly off unfollowed, at either end of each axis

/** A MAT or a link near a point of the page. */
export interface Near {
  index: number;
  away: number; // [CSS pixels]
}

export class SceneView {
  readonly rig: CameraRig;
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly ground = new Ground();
  private readonly uniforms = sceneUniforms();
  private readonly geometry = new THREE.BufferGeometry();
  private readonly linkGeometry = new THREE.BufferGeometry();
  private links: THREE.LineSegments<THREE.BufferGeometry, THREE.RawShaderMaterial[]> | null = null;
  private newest: THREE.BufferAttribute;
  private before: THREE.BufferAttribute;
  private newestS = Number.NaN;
  private shownForS = Number.NaN; // simulated time between the last two frames
  private fastest = 0; // [m/s], falls slowly
  private framesSinceLook = 0;
  private framed = false;
  private isDrum = false;
  private speeds = false;
  private states = new Uint8Array(0); // per link, as they are drawn

  constructor(
    private readonly container: HTMLElement,
    private readonly topology: Topology,
    readonly bodies: Bodies,
    private readonly tools: number[],
    private readonly space: number,
    private palette: Palette,
    readonly quality: Quality,
    private readonly pose: Pose | null, // where the camera stood before, if it shall stay
    private readonly changed: () => void,
    private readonly contextLost: (lost: boolean) => void, // the browser took the graphics away, or gave them back
  ) {
    this.renderer = new THREE.WebGLRenderer({ antialias: quality.antialias, powerPreference: 'high-performance' });
    this.renderer.setPixelRatio(quality.pixelRatio);
    this.renderer.setClearColor(palette.background);
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    container.prepend(this.renderer.domElement);
    for (const event of CONTEXT_EVENTS) this.renderer.domElement.addEventListener(event, this.noteContext);
    this.rig = new CameraRig(this.renderer.domElement, space, changed);

    const coordinates = 3 * topology.matCount;
    this.newest = new THREE.BufferAttribute(new Float32Array(coordinates), 3).setUsage(THREE.DynamicDrawUsage);
    this.before = new THREE.BufferAttribute(new Float32Array(coordinates), 3).setUsage(THREE.DynamicDrawUsage);
    this.buildMatter();
    if (quality.links && topology.linkCount > 0) this.buildLinks();
    this.scene.add(this.ground.group);
    this.resize();
  }

  private readonly noteContext = (event: Event): void => {
    this.contextLost(event.type === 'webglcontextlost');
    this.changed();
  };

  private buildMatter(): void {
    this.geometry.setAttribute('radius', new THREE.BufferAttribute(this.topology.radii.slice(), 1));
    const kinds = shownKinds(this.topology.kinds, this.topology.radii, this.tools);
    this.geometry.setAttribute('kind', new THREE.BufferAttribute(kinds, 1));
    this.geometry.setAttribute('tint', new THREE.BufferAttribute(this.bodies.tints(this.palette), 3, true));
    const few = this.topology.matCount <= 3000;
    const least = this.uniforms.min_pixels.value.set(few ? 3.2 : 1.2, few ? 3.2 : 1.2, few ? 6 : 5, few ? 5 : 2);
    least.multiplyScalar(this.quality.pixelRatio);
    const points = new THREE.Points(this.geometry, matMaterial(this.uniforms, this.quality.spheres));
    points.frustumCulled = false;
    this.scene.add(points);
  }

  private buildLinks(): void {
    this.linkGeometry.setIndex(new THREE.BufferAttribute(this.topology.linkEnds.slice(), 1));
    this.linkGeometry.addGroup(0, 2 * this.topology.linkCount, materialOfState(0));
    this.links = new THREE.LineSegments(this.linkGeometry, linkMaterials(this.uniforms, this.palette));
    this.links.frustumCulled = false;
    this.scene.add(this.links);
  }

  /** Lays the links of one colour side by side in the index: one call draws each colour. Those that do nothing are not drawn. */
  private sortLinks(states: Uint8Array): void {
    const index = this.linkGeometry.index;
    if (index === null || states.length !== this.topology.linkCount) return;
    if (states.length === this.states.length && states.every((state, l) => state === this.states[l])) return;
    this.states = states.slice();
    const ends = this.topology.linkEnds;
    const sorted = index.array;
    this.linkGeometry.clearGroups();
    let filled = 0;
    const shown = [...new Set(states)].filter((state) => state < LINK_IS_IDLE);
    for (const material of new Set(shown.map(materialOfState))) {
      const begin = filled;
      for (let l = 0; l < states.length; ++l) {
        const state = states[l]!;
        if (state >= LINK_IS_IDLE || materialOfState(state) !== material) continue;
        sorted[filled++] = ends[2 * l]!;
        sorted[filled++] = ends[2 * l + 1]!;
      }
      this.linkGeometry.addGroup(begin, filled - begin, material);
    }
    index.needsUpdate = true;
  }

  /** Takes a frame; draw() shows it. */
  show(frame: Frame): void {
    const first = Number.isNaN(this.newestS);
    [this.newest, this.before] = [this.before, this.newest];
    this.newest.array = frame.positions;
    this.newest.needsUpdate = true;
    this.sortLinks(frame.linkStates);
    if (first) {
      this.before.array = frame.positions.slice();
      this.before.needsUpdate = true;
      this.sizePoints();
    }
    for (const geometry of [this.geometry, this.linkGeometry]) {
      geometry.setAttribute('position', this.newest);
      geometry.setAttribute('previous', this.before);
    }
    this.shownForS = frame.simulatedS - this.newestS;
    this.measureSpeed(this.shownForS);
    this.newestS = frame.simulatedS;
    if (!this.framed) {
      this.framed = true;
      this.isDrum = this.liesFlat();
      if (this.isDrum) this.rig.turnByLeftButton();
      if (this.pose === null) this.rig.start(this.bounds(), this.isDrum ? 'free' : null);
      else this.rig.resume(this.pose, this.bounds());
      this.layGround();
    } else if (++this.framesSinceLook >= this.topology.matCount / MATS_A_FRAME) {
      this.framesSinceLook = 0;
      this.rig.follow(this.bounds(ASTRAY));
    }
  }

  draw(): void {
    this.rig.update();
    const camera = this.rig.camera;
    const height = this.renderer.domElement.height;
    this.uniforms.pixels_per_unit.value = 0.5 * height * camera.projectionMatrix.elements[5]!;
    this.uniforms.orthographic.value = this.rig.orthographic;
    this.renderer.render(this.scene, camera);
  }

  resize(): void {
    const { clientWidth, clientHeight } = this.container;
    this.renderer.setSize(clientWidth, clientHeight);
    this.rig.resize(clientWidth, clientHeight);
    this.changed();
  }

  fit(): void {
    this.rig.fit(this.bounds());
  }

  /** Draws all of it in the colours of a palette. */
  paint(palette: Palette): void {
    this.palette = palette;
    this.renderer.setClearColor(palette.background);
    const tint = this.geometry.getAttribute('tint') as THREE.BufferAttribute;
    tint.array.set(this.bodies.tints(palette));
    tint.needsUpdate = true;
    this.links?.material.forEach((material, state) => (material.uniforms.link_colour!.value as THREE.Color).set(palette.link_states[state]!));
    if (this.framed) this.layGround();
    this.changed();
  }

  private layGround(): void {
    this.ground.lay(this.bounds(), this.isDrum ? 3 : this.space, this.palette);
  }

  /** A 1-D scene that is laid out on a floor: from the front it is a line. */
  private liesFlat(): boolean {
    if (this.space !== 1) return false;
    const size = this.bounds().getSize(new THREE.Vector3());
    return size.z > 0.2 * size.x && size.x > 0.2 * size.z;
  }

  /** Nearest MAT to a point of the page, and how far its edge is [CSS pixels]; null when none is within so many. */
  matAt(x: number, y: number, within: number): Near | null {
    let best: Near | null = null;
    for (let mat = 0; mat < this.topology.matCount; ++mat) {
      const middle = this.project(mat);
      const away = Math.max(0, Math.hypot(middle.x - x, middle.y - y) - this.radiusOnScreen(mat));
      if (away < (best?.away ?? within)) best = { index: mat, away };
    }
    return best;
  }

  /** Likewise the nearest link that is drawn. */
  linkAt(x: number, y: number, within: number): Near | null {
    let best: Near | null = null;
    for (let link = 0; this.links !== null && link < this.topology.linkCount; ++link) {
      if (this.stateOf(link) >= LINK_IS_IDLE) continue;
      const [a, b] = this.endsOf(link).map((mat) => this.project(mat)) as [{ x: number; y: number }, { x: number; y: number }];
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
    return this.states[link] ?? 0;
  }

  /** Speed of a MAT, the mean over the last frame [m/s]. */
  speedOf(mat: number): number {
    const [now, then] = [this.newest.array, this.before.array];
    const moved = [0, 1, 2].map((k) => now[3 * mat + k]! - then[3 * mat + k]!);
    return this.shownForS > 0 ? Math.hypot(...moved) / this.shownForS : Number.NaN;
  }

  toggleGround(): void {
    this.ground.group.visible = !this.ground.group.visible;
    this.changed();
  }

  colourBySpeed(wanted: boolean): void {
    this.speeds = wanted;
    this.measureSpeed(this.shownForS);
    this.changed();
  }

  get fastestSpeed(): number {
    return this.fastest;
  }

  /** Where MAT `index` is in the scene [m]. */
  place(index: number): number[] {
    return [...this.newest.array.slice(3 * index, 3 * index + 3)];
  }

  /** Where MAT `index` is on the page [CSS pixels]. */
  project(index: number): { x: number; y: number } {
    return this.screenOf(this.place(index));
  }

  /** Where a place of the scene is on the page [CSS pixels]. */
  screenOf(place: number[]): { x: number; y: number } {
    const point = new THREE.Vector3().fromArray(place).project(this.rig.camera);
    const box = this.renderer.domElement.getBoundingClientRect();
    return { x: box.left + (0.5 + 0.5 * point.x) * box.width, y: box.top + (0.5 - 0.5 * point.y) * box.height };
  }

  /** The place [m] behind a point of the page that is as far from the camera as `through`. */
  unproject(x: number, y: number, through: number[]): number[] {
    const box = this.renderer.domElement.getBoundingClientRect();
    const depth = new THREE.Vector3().fromArray(through).project(this.rig.camera).z;
    const point = new THREE.Vector3((2 * (x - box.left)) / box.width - 1, 1 - (2 * (y - box.top)) / box.height, depth);
    return point.unproject(this.rig.camera).toArray();
  }

  /** Radius of MAT `index` as it is drawn, at the middle of the scene [CSS pixels]. */
  radiusOnScreen(index: number): number {
    return this.geometry.getAttribute('radius').array[index]! / this.rig.metresPerPixel;
  }

  /** Colour of one pixel of the view as it is drawn now, 0..255; a place on the page [CSS pixels]. */
  pixelAt(x: number, y: number): number[] {
    this.draw();
    const gl = this.renderer.getContext();
    const box = this.renderer.domElement.getBoundingClientRect();
    const ratio = this.quality.pixelRatio;
    const colour = new Uint8Array(4);
    const row = Math.floor((box.bottom - y) * ratio);
    gl.readPixels(Math.floor((x - box.left) * ratio), row, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, colour);
    return [...colour.slice(0, 3)];
  }

  image(): Promise<Blob | null> {
    this.draw();
    return new Promise((resolve) => this.renderer.domElement.toBlob(resolve));
  }

  dispose(): void {
    this.rig.dispose();
    this.geometry.dispose();
    this.linkGeometry.dispose();
    this.ground.dispose();
    for (const event of CONTEXT_EVENTS) this.renderer.domElement.removeEventListener(event, this.noteContext);
    this.renderer.dispose();
    this.renderer.forceContextLoss();
    this.renderer.domElement.remove();
  }

  /** What holds the MATs with their radii, but for this share of them at either end of each axis. */
  private bounds(outliers = 0): THREE.Box3 {
    const stride = Math.max(1, Math.floor(this.topology.matCount / SAMPLE));
    const count = Math.ceil(this.topology.matCount / stride);
    const left = Math.floor(outliers * count);
    const radii = this.geometry.getAttribute('radius').array;
    const low = new Float32Array(count);
    const high = new Float32Array(count);
    const box = new THREE.Box3();
    for (let axis = 0; axis < 3; ++axis) {
      for (let k = 0; k < count; ++k) {
        const coordinate = this.newest.array[3 * k * stride + axis]!;
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
    const extent = this.bounds().getSize(new THREE.Vector3()).length() || 1;
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
    const sizes = this.geometry.getAttribute('radius') as THREE.BufferAttribute;
    for (let i = 0; i < radii.length; ++i) sizes.array[i] = radii[i] || shown;
    sizes.needsUpdate = true;
  }

  /** The full scale of the colours follows the fastest MAT, at once upwards and slowly down. */
  private measureSpeed(elapsedS: number): void {
    if (!this.speeds) {
      this.uniforms.speed_scale.value = 0;
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
    this.fastest = Math.max(Math.sqrt(longest) / elapsedS, 0.985 * this.fastest);
    this.uniforms.speed_scale.value = this.fastest > 0 ? 1 / (this.fastest * elapsedS) : 1;
  }
}
