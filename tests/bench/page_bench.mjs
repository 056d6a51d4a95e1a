// tests/bench/page_bench.mjs -- how long the script of the page runs for each frame it draws, in
// headless Chromium: node tests/bench/page_bench.mjs --viz-node build/release/bin/viz_node
// --scene-source build/release/bin/scene_source --web "$PWD/viz_node/web" --out /tmp/page_bench
import { openScenePage, viz } from '../viz/browser.mjs';
import { pause, until } from '../viz/session.mjs';

const MEASURED_MS = 8_000;
const SCENE = ['--scene', 'grid', '--mats', '10000'];
const COLOURINGS = (process.env.CORDIS_COLOURINGS ?? 'bodies speed force components stretch').split(' ');

/** Processor time of script, and of all work of the page's thread, for each frame drawn. The browser counts it. */
async function perFrame(page, cdp) {
  const figures = async () => {
    const { metrics } = await cdp.send('Performance.getMetrics');
    const valueOf = (name) => metrics.find((metric) => metric.name === name).value;
    return { script: valueOf('ScriptDuration'), task: valueOf('TaskDuration'), frames: await viz(page, 'framesDrawn') };
  };
  const begin = await figures();
  await pause(MEASURED_MS);
  const end = await figures();
  const frames = end.frames - begin.frames;
  const share = (name) => ((1000 * (end[name] - begin[name])) / frames).toFixed(2);
  return `${share('script')} ms of script, ${share('task')} ms of all, ${(frames / (MEASURED_MS / 1000)).toFixed(1)} frames per second`;
}

const session = await openScenePage(...SCENE);
const { page } = session;
await page.setViewportSize({ width: 480, height: 360 }); // few pixels: a machine without a graphics card draws them in time
const cdp = await page.context().newCDPSession(page);
await cdp.send('Performance.enable', { timeDomain: 'threadTicks' }); // processor time
await until('it draws', async () => (await viz(page, 'framesDrawn')) > 20);
for (const colouring of COLOURINGS) {
  await page.selectOption('#colouring', colouring);
  await pause(2000);
  console.log(`10,000 balls and their links, colours of ${colouring}: ${await perFrame(page, cdp)}`);
}
await session.close();
