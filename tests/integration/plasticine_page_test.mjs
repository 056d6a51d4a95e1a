// tests/integration/plasticine_page_test.mjs -- a hand on the page tears plasticine in two.
// With real sim_node, device_node, viz_node and Chromium. The other hand is a script that rests.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { drawn, openPage, viz } from '../viz/browser.mjs';
import { out, program, runCases, Session, source, until } from '../viz/session.mjs';

const STEP_S = 0.03; // of the scene: where a machine is busy the mouse waits for what it drags
const STEPS = 15; // of the mouse, on each of the ways
const IN_M = 0.115; // from its rest the thimble goes so far into the slab, ...
const ACROSS_M = 0.09; // ... so far across, out of its edge, ...
const BACK_M = 0.09; // ... and back

const pointer = (page) => viz(page, 'pointer');
const placeOf = (page, mat) => page.evaluate((index) => window.viz.project(index), mat);
const pieces = (page) => page.evaluate(() => window.viz.signal('pieces'));

/** The mouse goes from `from` into the slab, out of its edge, and back with what sticks to it. */
async function drag(page, from, metresPerPixel) {
  const way = [[IN_M, 0], [0, -ACROSS_M], [-BACK_M, 0]];
  let [x, y] = [from.x, from.y];
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (const [right, up] of way) {
    for (let n = 0; n < STEPS; ++n) {
      x += right / metresPerPixel / STEPS;
      y -= up / metresPerPixel / STEPS;
      const { simulatedS } = await viz(page, 'lastFrame');
      await page.mouse.move(x, y);
      await until('the scene has followed', async () => (await viz(page, 'lastFrame')).simulatedS > simulatedS + STEP_S);
    }
  }
}

const cases = {
  'the slab is one piece, and stays one without a drag': async (session) => {
    const { page } = session;
    await drawn(page, 3);
    session.ports = await until('two ports are offered', async () => {
      const { ports } = await pointer(page);
      return ports.length === 2 && ports;
    });
    const begin = (await viz(page, 'lastFrame')).simulatedS;
    const seen = new Set();
    await until('two seconds have gone by', async () => {
      seen.add(await pieces(page));
      return (await viz(page, 'lastFrame')).simulatedS > begin + 2;
    });
    seen.delete(null);
    assert.deepEqual([...seen], [1]);
  },

  'the same drag beside the thimble moves the view, and tears nothing': async ({ page, ports }) => {
    const handle = await placeOf(page, ports[0].mat);
    const { metresPerPixel, target } = await viz(page, 'camera');
    await drag(page, { x: handle.x, y: handle.y - 0.05 / metresPerPixel }, metresPerPixel);
    await page.mouse.up();
    assert.notDeepEqual((await viz(page, 'camera')).target, target, 'the view moved');
    assert.equal((await pointer(page)).held.length, 0);
    assert.equal(await pieces(page), 1);
    await page.keyboard.press('f');
  },

  'a thimble that is dragged through the slab tears it': async ({ page, ports }) => {
    // On a busy machine a hand is let go of again and again, and tears on the way after.
    await until('the slab is torn', async () => {
      await page.mouse.up();
      const handle = await placeOf(page, ports[0].mat);
      const { metresPerPixel } = await viz(page, 'camera');
      await drag(page, handle, metresPerPixel);
      // The page may be silent for so long that it has to take hold again.
      await until('this page holds the thimble', async () => (await pointer(page)).held.some(({ byThisPage }) => byThisPage));
      const { simulatedS } = await viz(page, 'lastFrame');
      await until('the scene has followed', async () => (await viz(page, 'lastFrame')).simulatedS > simulatedS + 1);
      return (await pieces(page)) > 1;
    });
    await page.screenshot({ path: join(out, 'plasticine_torn.png') });
    await page.mouse.up();
  },

  'nothing went wrong in the page': async ({ page, pageErrors }) => {
    assert.deepEqual([await viz(page, 'errors'), pageErrors], [[], []]);
  },
};

const LAUNCH = join(source, 'launch_configs/plasticine.yaml');
const RESTS = ['thimbles.driver=script', 'thimbles.script={positions: [{at_s: 0, m: 0}]}'];

async function open() {
  const session = await Session.open();
  const words = ['run', LAUNCH, '--no-color', `domain=${session.domain}`, 'view.port=0', ...RESTS];
  session.launcher = session.start('cordis', program('cordis'), words);
  session.url = await session.launcher.says(/(http:\/\/127\.0\.0\.1:\d+)/);
  await openPage(session, session.url);
  return session;
}

await runCases(cases, open);
