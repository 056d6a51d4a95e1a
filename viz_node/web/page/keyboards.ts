// viz_node/web/page/keyboards.ts -- keyboards as what they are: keys side by side, each as deep as
// its port is pressed.
import { joined } from './format.ts';
import type { Description, DeviceShape } from './protocol.ts';
import { fillRows, setText } from './rows.ts';
import type { SceneView } from './scene_view.ts';
import { MAX_AXES } from './wire.ts';

const PRESSED = 0.1; // share of the way down from which on a key is pressed
const USUAL_WAY_M = 0.005; // down, of a key that does not say

/** A key of a device, and the port that it plays. */
export interface Key {
  axis: number;
  port: string; // its name; empty where the scene does not use the key
  mat: number; // of the port
  rest: number[]; // of that MAT [m]
  up: number[]; // along which the key moves it
  wayM: number; // down to its stop
}

/** A keyboard of the scene. */
export interface Keyboard {
  name: string;
  pitchM: number; // of its keys
  keys: Key[];
}

/** The keyboards that play ports of a scene. */
export function keyboardsOf({ ports }: Description, devices: DeviceShape[]): Keyboard[] {
  const described = devices.filter(({ name, key_pitch_m: pitch }) => (pitch ?? 0) > 0 && ports.some(({ device }) => device === name));
  return described.map((device) => {
    const keys = Array.from({ length: Math.min(device.travel_m.length, MAX_AXES) }, (_, axis) => keyOf(ports, device, axis));
    return { name: device.name, pitchM: device.key_pitch_m!, keys };
  });
}

function keyOf(ports: Description['ports'], { name, lowest_m: lowest, travel_m: travels }: DeviceShape, axis: number): Key {
  const port = ports.find(({ device, axes, rest, direction }) => device === name && axes[0] === axis && rest.length === 3 && direction.length >= 3);
  const wayM = (lowest ?? 0) < 0 ? -lowest! : (travels[axis] ?? 0) / 2 || USUAL_WAY_M;
  return { axis, port: port?.name ?? '', mat: port?.mat ?? 0, rest: port?.rest ?? [], up: port?.direction.slice(0, 3) ?? [], wayM };
}

/** How far a key is down [m], below 0 where it is above its rest. */
export function depthOf({ rest, up }: Key, place: number[]): number {
  return up.reduce((sum, share, k) => sum - share * (place[k]! - rest[k]!), 0);
}

/** A length to a hundredth of a millimetre. */
const inMillimetres = (length: number): string => joined([String(Number((1000 * length).toFixed(2))), 'mm']);

/** `keyboard: 16 keys of 13.75 mm, 220 mm side by side` */
function caption({ name, pitchM, keys }: Keyboard): string {
  const number = keys.length === 1 ? '1 key' : `${keys.length} keys`;
  const all = keys.length === 1 ? '' : `, ${inMillimetres(pitchM * keys.length)} side by side`;
  return `${name}: ${number} of ${inMillimetres(pitchM)}${all}`;
}

export class KeyboardPanel {
  list: Keyboard[] = [];
  private known = ''; // what the list was made from
  private readonly panel = document.querySelector<HTMLElement>('#keyboards')!;

  /** @param pick  the MAT of a port whose key a person has pressed on the page */
  constructor(private readonly pick: (mat: number) => void) {}

  /** True if a key plays a port. */
  get playsPorts(): boolean {
    return this.list.some(({ keys }) => keys.some(({ port }) => port !== ''));
  }

  /** Takes what is known of scene and devices; draws again where that has changed. @returns whether it has */
  describe(description: Description, devices: DeviceShape[]): boolean {
    const list = keyboardsOf(description, devices);
    const words = JSON.stringify([description.scene, list]);
    if (words === this.known) return false;
    this.known = words;
    this.list = list;
    this.panel.hidden = list.length === 0;
    fillRows(this.panel, list, () => this.makeKeyboard(), (row, keyboard) => this.writeKeyboard(row, keyboard));
    return true;
  }

  /** Shows how deep each key is. */
  draw(view: SceneView): void {
    this.list.forEach((keyboard, number) => {
      const keys = this.panel.children[number]!.querySelectorAll<HTMLButtonElement>('button');
      keyboard.keys.forEach((key, place) => {
        if (key.port !== '') this.showDepth(keys[place]!, key, depthOf(key, view.place(key.mat)));
      });
    });
  }

  private showDepth(button: HTMLButtonElement, key: Key, depthM: number): void {
    const share = Math.min(1, Math.max(0, depthM / key.wayM));
    const isPressed = share >= PRESSED;
    button.style.setProperty('--depth', share.toFixed(2));
    if (button.classList.contains('pressed') === isPressed && button.ariaLabel !== '') return;
    button.classList.toggle('pressed', isPressed);
    button.ariaLabel = `key ${key.axis}, port ${key.port}: ${isPressed ? 'pressed' : 'up'}`;
  }

  private makeKeyboard(): HTMLElement {
    const figure = document.createElement('figure');
    figure.append(document.createElement('figcaption'), document.createElement('div'));
    return figure;
  }

  private writeKeyboard(row: HTMLElement, keyboard: Keyboard): void {
    setText(row.querySelector('figcaption')!, caption(keyboard));
    const keys = row.querySelector<HTMLElement>('div')!;
    keys.replaceChildren(...keyboard.keys.map((key) => this.makeKey(key)));
  }

  private makeKey(key: Key): HTMLButtonElement {
    const button = document.createElement('button');
    button.ariaLabel = '';
    button.textContent = String(key.axis);
    button.title = key.port === '' ? `key ${key.axis}: no port of the scene` : `key ${key.axis}: port ${key.port}`;
    button.disabled = key.port === '';
    button.addEventListener('click', () => {
      this.pick(key.mat);
      button.blur(); // keys are for the view again
    });
    return button;
  }
}
