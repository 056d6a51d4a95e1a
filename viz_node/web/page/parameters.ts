// viz_node/web/page/parameters.ts -- sliders for the parameters of liaisons, links and world.
import type { Reply } from './protocol.ts';
import { fillRows, press } from './rows.ts';

const LINE = /^(\S+\.[^\s.]+) = (-?[\d.]+(?:e[+-]?\d+)?)$/;
const DECADES = 1; // that a slider goes up and down from the first value that was seen
const GRAVITY = '_m_per_s2';
const MIN_GRAVITY_SPAN = 20; // [m/s^2], either way
const UNITS: [ending: string, unit: string][] = [
  ['_n_per_m', 'N/m'],
  ['_n_s_per_m', 'N s/m'],
  ['_m_per_s', 'm/s'],
  [GRAVITY, 'm/s²'],
  ['_kg', 'kg'],
  ['_hz', 'Hz'],
  ['_n', 'N'],
  ['_m', 'm'],
  ['_s', 's'],
];

interface Parameter {
  name: string;
  value: number;
  first: number; // the value in the middle of its slider
}

/** What a slider can do with a parameter: gravity goes from one direction to the other, what is above 0 by decades. */
interface SliderScale {
  min: number;
  max: number;
  placeOf: (value: number) => number;
  valueOf: (place: number) => number;
}

function scaleOf(name: string, first: number): SliderScale | null {
  if (name.endsWith(GRAVITY)) {
    const span = Math.max(2 * Math.abs(first), MIN_GRAVITY_SPAN);
    return { min: -span, max: span, placeOf: (value) => value, valueOf: (place) => place };
  }
  if (first <= 0) return null;
  return { min: -DECADES, max: DECADES, placeOf: (value) => (value > 0 ? Math.log10(value / first) : 0), valueOf: (place) => first * 10 ** place };
}

/** `finger.stiffness_n_per_m` in words: [finger stiffness, N/m]. */
function wordsOf(name: string): [string, string] {
  const [ending, unit] = [...UNITS].sort(([a], [b]) => b.length - a.length).find(([end]) => name.endsWith(end)) ?? ['', ''];
  return [name.slice(0, name.length - ending.length).replace(/\.(?=[^.]*$)/, ' ').replaceAll('_', ' '), unit];
}

/** The parameters in the reply to `get`; null for any other reply. */
export function parametersIn({ accepted, text }: Reply): [string, number][] | null {
  const found = text.split('\n').map((line) => LINE.exec(line));
  if (!accepted || found[0] === null) return null;
  return found.flatMap((match) => (match === null ? [] : [[match[1]!, Number(match[2])]])); // the last line may be cut off
}

export class ParameterPanel {
  private list: Parameter[] = [];
  private shownNumber = 0; // of the newest reply that was looked at
  private isOpen = false;
  private readonly section = document.querySelector<HTMLElement>('#parameters')!;
  private readonly button = document.querySelector<HTMLButtonElement>('#parameters-open')!;
  private readonly rows = document.querySelector<HTMLElement>('#parameters-list')!;
  private readonly none = document.querySelector<HTMLElement>('#parameters-none')!;

  /** @param ask  asks something of the simulation, whose reply is shown when `isShown` */
  constructor(private readonly ask: (verb: 'get' | 'set', more: { parameter?: string; value?: number }, isShown: boolean) => void) {
    this.button.addEventListener('click', () => {
      this.isOpen = !this.isOpen;
      press(this.button, this.isOpen);
      this.rows.hidden = !this.isOpen;
      this.none.hidden = true;
      if (this.isOpen) this.ask('get', {}, false);
      this.button.blur();
    });
  }

  /** Another scene has other parameters. */
  describe(): void {
    this.list = [];
    this.write();
    if (this.isOpen) this.ask('get', {}, false);
  }

  /** Takes what is newest; `isOffered` while there is a simulation that this page may command. */
  update(isOffered: boolean, replies: Reply[]): void {
    this.section.hidden = !isOffered;
    for (const reply of replies) {
      if (reply.number <= this.shownNumber) continue;
      const found = parametersIn(reply);
      if (found !== null) this.take(found);
      else if (reply.text === 'no parameters') this.none.hidden = !this.isOpen;
    }
    this.shownNumber = replies.at(-1)?.number ?? 0; // a viz_node that was restarted counts from 1
  }

  private take(found: [string, number][]): void {
    const first = new Map(this.list.map((one) => [one.name, one.first]));
    this.list = found.map(([name, value]) => ({ name, value, first: first.get(name) ?? value }));
    this.write();
  }

  private write(): void {
    fillRows(this.rows, this.list, () => this.makeRow(), (row, { name, value, first }) => {
      const [text, unit] = wordsOf(name);
      const [label, slider, number] = [...row.querySelectorAll<HTMLElement>('label, input')] as [HTMLLabelElement, HTMLInputElement, HTMLInputElement];
      const scale = scaleOf(name, first);
      row.dataset.parameter = name;
      row.dataset.first = String(first);
      label.textContent = `${text}${unit === '' ? '' : ` [${unit}]`}`;
      row.title = name;
      number.id = label.htmlFor = `parameter-${name}`;
      slider.setAttribute('aria-label', `${name}, slider`);
      slider.disabled = scale === null;
      slider.min = String(scale?.min ?? 0);
      slider.max = String(scale?.max ?? 0);
      if (document.activeElement !== number) number.value = String(value);
      if (document.activeElement !== slider || !slider.matches(':active')) slider.value = String(scale?.placeOf(value) ?? 0);
    });
  }

  private makeRow(): HTMLElement {
    const row = document.createElement('li');
    const slider = Object.assign(document.createElement('input'), { type: 'range', step: '0.01' });
    const number = Object.assign(document.createElement('input'), { type: 'number', step: 'any' });
    const valueOf = () => Number(scaleOf(row.dataset.parameter!, Number(row.dataset.first))!.valueOf(Number(slider.value)).toPrecision(3));
    slider.addEventListener('input', () => (number.value = String(valueOf())));
    slider.addEventListener('change', () => this.set(row.dataset.parameter!, valueOf()));
    number.addEventListener('change', () => number.value !== '' && this.set(row.dataset.parameter!, Number(number.value)));
    row.append(document.createElement('label'), slider, number);
    return row;
  }

  /** Sets it, and asks what the parameters are then: what follows by a formula follows. */
  private set(parameter: string, value: number): void {
    this.ask('set', { parameter, value }, true);
    this.ask('get', {}, false);
  }
}
