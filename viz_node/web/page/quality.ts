// viz_node/web/page/quality.ts -- how much the view may cost: a machine without a graphics card
// draws with its CPU.

export interface Quality {
  readonly software: boolean; // WebGL is computed by the CPU
  readonly antialias: boolean;
  readonly pixelRatio: number;
  readonly spheres: boolean; // shaded spheres, else flat points
  readonly links: boolean;
  readonly note: string; // what a person should know; empty when nothing is left out
}

// Measured with software WebGL at 1280x720: 10k spheres reach 25 Hz, 100k flat points without links 15 Hz.
const SMOOTH_UP_TO = 5_000;
const FULL_UP_TO = 15_000;

/** Name of the WebGL renderer, and true if it is software; null without WebGL 2. */
export function findRenderer(): { name: string; software: boolean } | null {
  const context = document.createElement('canvas').getContext('webgl2');
  if (context === null) return null;
  const details = context.getExtension('WEBGL_debug_renderer_info');
  const name = String(context.getParameter(details ? details.UNMASKED_RENDERER_WEBGL : context.RENDERER));
  context.getExtension('WEBGL_lose_context')?.loseContext();
  return { name, software: /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name) };
}

export function chooseQuality(software: boolean, elementCount: number, screenRatio: number): Quality {
  if (!software) {
    return { software, antialias: true, pixelRatio: Math.min(screenRatio, 2), spheres: true, links: true, note: '' };
  }
  const full = elementCount <= FULL_UP_TO;
  return {
    software,
    antialias: elementCount <= SMOOTH_UP_TO,
    pixelRatio: 1,
    spheres: full,
    links: full,
    note: full ? '' : 'no graphics card: flat points, links not drawn',
  };
}
