// viz_node/web/page/camera_rig.ts -- the camera: orbit, pan and zoom by mouse, presets and fit by
// key; orthographic for flat scenes.
import { Box3, MathUtils, MOUSE, OrthographicCamera, PerspectiveCamera, Vector3 } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

export type Preset = 'front' | 'side' | 'top' | 'free';

/** Where the camera stands and how: enough to stand there again. */
export interface Pose {
  orthographic: boolean;
  target: Vector3;
  offset: Vector3; // of the camera from the target
  metresPerPixel: number;
  moved: boolean; // by a person
}

const DIRECTIONS: Record<Preset, Vector3> = {
  front: new Vector3(0, 0, 1),
  side: new Vector3(1, 0, 0),
  top: new Vector3(0, 1, 1e-4), // not quite along the up axis, which would leave the view undetermined
  free: new Vector3(0.75, 0.6, 1).normalize(),
};

const FIELD_OF_VIEW = 40; // [degrees], vertical
const ROOM = 1.12; // of a fitted scene, from side to side
const FREE_ROOM = 1.06; // likewise, between what stands above and below it
const MIN_FREE = 0.4; // of the height
const FARTHEST = 4; // times the size of a scene at first, up to which it is followed

/** What stands over the view at its upper and lower edge [CSS pixels]. */
export interface Edges {
  top: number;
  bottom: number;
}

export class CameraRig {
  orthographic: boolean;
  private readonly first: Preset;
  private readonly perspectiveCamera = new PerspectiveCamera(FIELD_OF_VIEW);
  private readonly flatCamera = new OrthographicCamera();
  private readonly controls: OrbitControls;
  private width = 1;
  private height = 1;
  private home = new Box3();
  private firstSize = 0; // of the scene [m]
  private moved = false; // by a person: then it stays where it is

  constructor(
    element: HTMLElement,
    space: number,
    private readonly edges: () => Edges, // that a fitted scene is kept out of
    private readonly changed: () => void,
  ) {
    this.orthographic = space < 3;
    this.first = space < 3 ? 'front' : 'free';
    this.flatCamera.position.set(0, 0, 1);
    this.perspectiveCamera.position.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, element);
    element.style.cursor = ''; // as the style sheet has it
    this.controls.zoomToCursor = true;
    if (space < 3) {
      // A flat scene is moved rather than turned.
      this.controls.mouseButtons = { LEFT: MOUSE.PAN, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.ROTATE };
    }
    this.controls.addEventListener('change', changed);
    this.controls.addEventListener('start', () => (this.moved = true));
  }

  get camera(): PerspectiveCamera | OrthographicCamera {
    return this.orthographic ? this.flatCamera : this.perspectiveCamera;
  }

  get target(): Vector3 {
    return this.controls.target;
  }

  /** The preset that the camera looks along now; 'free' when it is none. */
  get preset(): Preset {
    const direction = this.camera.position.clone().sub(this.target).normalize();
    const presets = Object.keys(DIRECTIONS) as Preset[];
    return presets.find((name) => DIRECTIONS[name].angleTo(direction) < 1e-3) ?? 'free';
  }

  /** Length of one CSS pixel at the target [m]. */
  get metresPerPixel(): number {
    if (this.orthographic) return (this.flatCamera.top - this.flatCamera.bottom) / this.flatCamera.zoom / this.height;
    const distance = this.camera.position.distanceTo(this.target);
    return (2 * distance * Math.tan(MathUtils.degToRad(FIELD_OF_VIEW / 2))) / this.height;
  }

  /** @param preset  where it looks from at first; null: from where scenes of this space are seen best */
  start(box: Box3, preset: Preset | null = null): void {
    this.firstSize = box.getSize(new Vector3()).length();
    this.look(preset ?? this.first, box);
  }

  /** The left button turns the view, the right one moves it. */
  turnByLeftButton(): void {
    this.controls.mouseButtons = { LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.PAN };
  }

  /** Looks at a place from the same side and distance. */
  moveTo(place: number[]): void {
    const offset = this.camera.position.clone().sub(this.target);
    this.target.fromArray(place);
    this.camera.position.copy(this.target).add(offset);
    this.moved = true;
  }

  /** Steps back when the scene has outgrown the view. */
  follow(box: Box3): void {
    if (this.moved || this.sees(box)) return;
    const grown = box.clone().union(this.home);
    if (grown.getSize(new Vector3()).length() <= FARTHEST * this.firstSize) this.fit(grown);
  }

  get pose(): Pose {
    const offset = this.camera.position.clone().sub(this.target);
    return { orthographic: this.orthographic, target: this.target.clone(), offset, metresPerPixel: this.metresPerPixel, moved: this.moved };
  }

  /** Stands where `pose` says, before a scene of this size. */
  resume(pose: Pose, box: Box3): void {
    this.start(box);
    this.orthographic = pose.orthographic;
    this.moved = pose.moved;
    this.controls.object = this.camera;
    this.target.copy(pose.target);
    this.camera.position.copy(pose.target).add(pose.offset);
    if (this.orthographic) this.setFlatScale(pose.metresPerPixel);
    this.changed();
  }

  fit(box: Box3): void {
    const direction = this.camera.position.clone().sub(this.target).normalize();
    this.place(direction, box);
  }

  look(preset: Preset, box: Box3 = this.home): void {
    this.place(DIRECTIONS[preset], box);
  }

  toggleProjection(): void {
    const direction = this.camera.position.clone().sub(this.target);
    const scale = this.metresPerPixel;
    this.orthographic = !this.orthographic;
    this.controls.object = this.camera;
    if (this.orthographic) {
      this.camera.position.copy(this.target).add(direction);
      this.setFlatScale(scale);
    } else {
      const distance = (scale * this.height) / (2 * Math.tan(MathUtils.degToRad(FIELD_OF_VIEW / 2)));
      this.camera.position.copy(this.target).addScaledVector(direction.normalize(), distance);
    }
    this.setDepth();
    this.changed();
  }

  resize(width: number, height: number): void {
    const scale = this.metresPerPixel;
    this.width = Math.max(1, width);
    this.height = Math.max(1, height);
    this.perspectiveCamera.aspect = this.width / this.height;
    this.perspectiveCamera.updateProjectionMatrix();
    this.setFlatScale(Number.isFinite(scale) ? scale : 1);
    if (this.firstSize > 0 && !this.moved) this.fit(this.home);
  }

  update(): void {
    this.controls.update();
  }

  dispose(): void {
    this.controls.dispose();
  }

  /** Looks at the middle of `box` from `direction`, from so far that all of it is seen. */
  private place(direction: Vector3, box: Box3): void {
    const centre = box.getCenter(new Vector3());
    const corners = box.getSize(new Vector3()).multiplyScalar(0.5);
    const extent = Math.max(corners.length(), 1e-9);
    const right = new Vector3().crossVectors(new Vector3(0, 1, 0), direction).normalize();
    const up = new Vector3().crossVectors(direction, right).normalize();
    const reach = (axis: Vector3) =>
      Math.abs(axis.x) * corners.x + Math.abs(axis.y) * corners.y + Math.abs(axis.z) * corners.z;
    const { top, bottom } = this.keptFree();
    const scale = Math.max(
      (2 * ROOM * reach(right)) / this.width,
      (2 * FREE_ROOM * reach(up)) / (this.height - top - bottom),
      (0.02 * extent) / this.width,
    );
    centre.addScaledVector(up, 0.5 * (top - bottom) * scale);
    const half = Math.tan(MathUtils.degToRad(FIELD_OF_VIEW / 2));
    const distance = (scale * this.height) / (2 * half) + reach(direction);
    this.target.copy(centre);
    for (const camera of [this.flatCamera, this.perspectiveCamera]) {
      camera.position.copy(centre).addScaledVector(direction, Math.max(distance, 2 * extent * 1e-3));
      camera.lookAt(centre);
    }
    this.setFlatScale(scale);
    this.home = box;
    this.moved = false;
    this.setDepth();
    this.changed();
  }

  /** At most so much of the edges that enough of the view is left. */
  private keptFree(): Edges {
    const { top, bottom } = this.edges();
    const share = Math.min(1, ((1 - MIN_FREE) * this.height) / Math.max(top + bottom, 1));
    return { top: share * top, bottom: share * bottom };
  }

  private sees(box: Box3): boolean {
    const { top, bottom } = this.keptFree();
    const [highest, lowest] = [1 - (2 * top) / this.height, (2 * bottom) / this.height - 1];
    this.camera.updateMatrixWorld();
    const ends = [box.min, box.max];
    for (let corner = 0; corner < 8; ++corner) {
      const point = new Vector3(ends[corner & 1]!.x, ends[(corner >> 1) & 1]!.y, ends[corner >> 2]!.z).project(this.camera);
      if (Math.abs(point.x) > 1 || point.y > highest || point.y < lowest) return false;
    }
    return true;
  }

  private setFlatScale(metresPerPixel: number): void {
    const camera = this.flatCamera;
    camera.zoom = 1;
    camera.right = 0.5 * this.width * metresPerPixel;
    camera.left = -camera.right;
    camera.top = 0.5 * this.height * metresPerPixel;
    camera.bottom = -camera.top;
    camera.updateProjectionMatrix();
  }

  /** Near and far planes for a scene of this size, wherever the camera goes. */
  private setDepth(): void {
    const extent = Math.max(this.home.getSize(new Vector3()).length(), 1e-6);
    this.perspectiveCamera.near = extent / 200;
    this.perspectiveCamera.far = extent * 50;
    this.flatCamera.near = -50 * extent;
    this.flatCamera.far = 50 * extent;
    this.perspectiveCamera.updateProjectionMatrix();
    this.flatCamera.updateProjectionMatrix();
  }
}
