// viz_node/web/page/colouring.ts -- what the colours of the view say: the choice of a person, and
// the scale beside the legend.
import { joined, withUnit } from './format.ts';
import type { Palette } from './colours.ts';
import { setText } from './rows.ts';

export const COLOURINGS = ['bodies', 'speed', 'force', 'components', 'stretch'] as const;
export type Colouring = (typeof COLOURINGS)[number];

/** A scale of colours with its ends in words. */
export interface Scale {
  low: string;
  high: string;
  caption: string;
  colours: string[];
  isStepped: boolean; // a few colours, and none between them
}

/** @param fastest [m/s], 0 has the other end of the scale */
export function speedScale(fastest: number, palette: Palette): Scale {
  return { low: '0', high: joined(withUnit(fastest, 'm/s')), caption: 'speed, mean over a frame', colours: palette.speeds, isStepped: false };
}

/**
 * @param strongest  force that has the other end of the scale [N]
 * @param spanS      time over which it is a mean [s]
 */
export function forceScale(strongest: number, spanS: number, palette: Palette): Scale {
  const span = spanS > 0 ? `, mean over ${joined(withUnit(spanS, 's'))}` : '';
  return { low: '0', high: joined(withUnit(strongest, 'N')), caption: `net force on free masses${span}`, colours: palette.speeds, isStepped: false };
}

/**
 * @param widest  share of its length by which a link is longer or shorter
 * @param sinceS  simulated time of the lengths that are compared with [s]
 */
export function stretchScale(widest: number, sinceS: number, palette: Palette): Scale {
  const percent = widest > 0 ? percentOf(widest) : '0 %';
  const caption = `length of links against that at ${sinceS.toFixed(2)} s; balls are drawn small`;
  return { low: `−${percent}`, high: `+${percent}`, caption, colours: palette.stretches, isStepped: true };
}

/** A share as percent, two digits or more. */
export function percentOf(share: number): string {
  const percent = 100 * share;
  if (percent >= 9.95 || percent === 0) return `${Math.round(percent)} %`;
  return `${percent >= 0.01 ? percent.toPrecision(2) : percent.toExponential(1)} %`;
}

export class ColouringBox {
  private readonly select = document.querySelector<HTMLSelectElement>('#colouring')!;
  private readonly scale = document.querySelector<HTMLElement>('#scale')!;
  private readonly strip = this.scale.querySelector<HTMLElement>('i')!;

  private current = this.select.value as Colouring; // of the box, which takes long to ask in each frame

  constructor(private readonly chosen: () => void) {
    this.select.addEventListener('change', () => {
      this.choose(this.select.value as Colouring);
      this.select.blur(); // keys are for the view again
    });
  }

  get value(): Colouring {
    return this.current;
  }

  /** Components and stretch are of links, forces of free masses. */
  describe(linkCount: number, hasFreeMasses: boolean): void {
    const needs: Record<string, boolean> = { components: linkCount > 0, stretch: linkCount > 0, force: hasFreeMasses };
    for (const option of this.select.options) option.disabled = needs[option.value] === false;
    if (this.select.selectedOptions[0]?.disabled) this.choose('bodies');
  }

  /** The next one that this scene has. */
  step(): void {
    const values = [...this.select.options].filter(({ disabled }) => !disabled).map(({ value }) => value as Colouring);
    this.choose(values[(values.indexOf(this.value) + 1) % values.length]!);
  }

  show(scale: Scale | null): void {
    this.scale.hidden = scale === null;
    if (scale === null) return;
    ['low', 'high', 'caption'].forEach((part) => setText(this.scale.querySelector(`#scale-${part}`)!, scale[part as 'low' | 'high' | 'caption']));
    const gradient = `linear-gradient(90deg, ${stopsOf(scale).map(([colour, share]) => `${colour} ${(100 * share).toFixed(1)}%`).join(', ')})`;
    if (this.strip.dataset.gradient === gradient) return;
    this.strip.dataset.gradient = gradient;
    this.strip.style.background = gradient;
  }

  private choose(value: Colouring): void {
    this.select.value = this.current = value;
    this.chosen();
  }
}

/** Colours with their places, 0..1. */
export function stopsOf({ colours, isStepped }: Scale): [string, number][] {
  if (!isStepped) return colours.map((colour, i) => [colour, i / (colours.length - 1)]);
  return colours.flatMap((colour, i): [string, number][] => [[colour, i / colours.length], [colour, (i + 1) / colours.length]]);
}
