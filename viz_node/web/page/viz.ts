// viz_node/web/page/viz.ts -- window.viz: what the page knows, for tests and for the curious.
import type { Page } from './page.ts';
import type { PointerFigures } from './pointer.ts';
import type { NodeState, Reply } from './protocol.ts';
import type { Spectrum } from './sound/sound_panel.ts';
import type { SoundFigures } from './sound/sound_stream.ts';
import type { Take } from './take.ts';

export interface Viz {
  readonly connected: boolean;
  readonly frozen: boolean; // by a person
  readonly framesReceived: number;
  readonly framesDrawn: number;
  readonly lastFrame: { sequence: number; frame: number; step: number; simulatedS: number; matCount: number } | null;
  readonly lag_s: number;
  readonly dropped: number;
  readonly nodes: NodeState[];
  readonly replies: Reply[]; // to the commands of pages, newest last
  readonly errors: string[];
  readonly scene: { number: number; name: string; space: number; matCount: number; linkCount: number } | null;
  readonly camera: { preset: string; orthographic: boolean; target: number[]; metresPerPixel: number } | null;
  readonly signals: { count: number; rows: number; gaps: number; newestS: number } | null;
  readonly sound: { on: boolean; figures: SoundFigures | null };
  readonly pointer: PointerFigures;
  readonly take: Take | null; // null in a live session
  readonly quality: { software: boolean; spheres: boolean; links: boolean } | null;
  /** Newest value of the signal with this name, in its own unit; null while there is none. */
  signal(name: string): number | null;
  /** Coordinates of MAT `index` in the frame drawn last [m]. */
  position(index: number): number[] | null;
  /** Net force on MAT `index` along x, y and z, the mean over the last frames; else that of the liaisons on a port [N]; null where there is none to say. */
  force(index: number): number[] | null;
  /** Where MAT `index` is on the page [CSS pixels]. */
  project(index: number): { x: number; y: number } | null;
  /** Where a place of the scene [m] is on the page [CSS pixels]. */
  screenOf(place: number[]): { x: number; y: number } | null;
  /** The spectrum of the sound as it is played; null while none is. */
  soundSpectrum(): Spectrum | null;
  /** Red, green and blue of the view at a place on the page, 0..255. */
  pixelAt(x: number, y: number): number[] | null;
}

declare global {
  interface Window {
    viz: Viz;
  }
}

export function exposeViz(page: Page): void {
  window.viz = {
    get connected() {
      return page.connection.isOpen;
    },
    get frozen() {
      return page.frozen;
    },
    get framesReceived() {
      return page.framesReceived;
    },
    get framesDrawn() {
      return page.framesDrawn;
    },
    get lastFrame() {
      if (page.lastFrame === null) return null;
      const { sequence, frame, step, simulatedS, matCount } = page.lastFrame;
      return { sequence, frame, step, simulatedS, matCount };
    },
    get lag_s() {
      return page.lagS;
    },
    get dropped() {
      return page.dropped;
    },
    get nodes() {
      return page.hud.nodes;
    },
    get replies() {
      return page.hud.replies;
    },
    get errors() {
      return page.errors;
    },
    get scene() {
      const scene = page.description;
      if (scene === null) return null;
      const { scene: number, name, space, mat_count: matCount, link_count: linkCount } = scene;
      return { number, name, space, matCount, linkCount };
    },
    get camera() {
      const rig = page.view?.rig;
      if (!rig) return null;
      return {
        preset: rig.preset,
        orthographic: rig.orthographic,
        target: rig.target.toArray(),
        metresPerPixel: rig.metresPerPixel,
      };
    },
    get signals() {
      const store = page.store;
      return store && { count: store.signalCount, rows: store.rowCount, gaps: store.gaps, newestS: store.newestS };
    },
    get sound() {
      return { on: page.sound.isOn, figures: page.sound.figures };
    },
    get pointer() {
      return page.pointer.figures;
    },
    get take() {
      return page.takeBar.take;
    },
    get quality() {
      return page.view?.quality ?? null;
    },
    signal: (name) => {
      const index = page.description?.signals.findIndex((signal) => signal.name === name) ?? -1;
      const value = index < 0 ? undefined : page.store?.newestOf(index);
      return value === undefined || Number.isNaN(value) ? null : value;
    },
    position: (index) => (page.lastFrame ? [...page.lastFrame.positions.slice(3 * index, 3 * index + 3)] : null),
    force: (index) => page.view?.forceOn(index) ?? page.view?.portForceOn(index) ?? null,
    project: (index) => page.view?.onPage(page.view.project(index)) ?? null,
    screenOf: (place) => page.view?.onPage(page.view.screenOf(place)) ?? null,
    soundSpectrum: () => page.sound.spectrum(),
    pixelAt: (x, y) => page.view?.pixelAt(page.view.ofPage(x, y)) ?? null,
  };
}
