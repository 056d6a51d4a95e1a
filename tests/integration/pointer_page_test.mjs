// tests/integration/pointer_page_test.mjs -- a thimble dragged on the page tears plasticine.
// With real sim_node, device_node, viz_node and Chromium. The other hand is a script that rests.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { drawn, openPage, textOf, viz } from '../viz/browser.mjs';
import { out, program, runCases, Session, source, until } from '../viz/session.mjs';

const STEP_MS = 12;

const pointer = (page) => viz(page, 'pointer');
const pieces = async (page) => Number((await textOf(page, '.series:has-text("pieces") b')).trim());
const stateOf = async (page, name) => (await viz(page, 'nodes')).find((node) => node.name === name)?.state;

/** Moves the mouse along a line of the page, about as fast as a hand does. */
async function moveTo(page, from, to, steps) {
  for (let n = 1; n <= steps; ++n) {
    await page.mouse.move(from.x + ((to.x - from.x) * n) / steps, from.y + ((to.y - from.y) * n) / steps);
    await page.waitForTimeout(STEP_MS);
  }
}

/** Pixels of the page per metre, and where a place of the scene is. */
const mapOf = (page) =>
  page.evaluate(() => {
    const scale = 1 / window.viz.camera.metresPerPixel;
    const [x, y] = window.viz.camera.target;
    const box = document.querySelector('#stage canvas').getBoundingClientRect();
    return { scale, x0: box.left + box.width / 2 - x * scale, y0: box.top + box.height / 2 + y * scale };
  });
const onPage = ({ scale, x0, y0 }, x, y) => ({ x: x0 + x * scale, y: y0 - y * scale });

const cases = {
  'the page offers both thimbles, and the other hand plays meanwhile': async (session) => {
    const { page } = session;
    await drawn(page, 5);
    session.ports = await until('two ports are offered', async () => {
      const { ports } = await pointer(page);
      return ports.length === 2 && ports;
    });
    assert.deepEqual(session.ports.map(({ name }) => name), ['left', 'right']);
    await until('the pointer stands by', async () => (await stateOf(page, 'pointer')) === 'standby');
    await until('the script plays', async () => (await stateOf(page, 'thimbles')) === 'running');
    assert.match(await textOf(page, '#hand'), /^Drag a ringed port/);
    await until('it is one piece', async () => (await pieces(page)) === 1);
  },

  'a thimble that is dragged through the slab tears it': async (session) => {
    const { page } = session;
    const left = session.ports[0];
    const map = await mapOf(page);
    const camera = await viz(page, 'camera');
    await page.mouse.move(...Object.values(await page.evaluate((mat) => window.viz.project(mat), left.mat)));
    await page.mouse.down();
    await until('the page holds it', async () => {
      const { held } = await pointer(page);
      return held.length === 1 && held[0].port === left.port && held[0].byThisPage;
    });
    await until('the pointer plays', async () => (await stateOf(page, 'pointer')) === 'running');
    await until('the script stands by', async () => (await stateOf(page, 'thimbles')) === 'standby');

    const [start, above, below] = [onPage(map, -0.09, 0), onPage(map, -0.02, 0.07), onPage(map, -0.02, -0.07)];
    const corner = onPage(map, -0.09, 0.07);
    await moveTo(page, start, corner, 40);
    await moveTo(page, corner, above, 40);
    let felt = 0;
    for (let n = 0; n < 4 && (await pieces(page)) < 2; ++n) {
      const [from, to] = n % 2 === 0 ? [above, below] : [below, above];
      await moveTo(page, from, to, 90);
      felt = Math.max(felt, (await pointer(page)).held[0]?.forceN ?? 0);
      if (n === 0) await page.screenshot({ path: join(out, 'pointer_plasticine.png') });
    }
    await until('the slab is torn', async () => (await pieces(page)) >= 2);
    assert.deepEqual((await viz(page, 'camera')).target, camera.target, 'the view did not move under the hand');
    const { delays, delayS } = await pointer(page);
    assert.ok(delays > 10 && delayS > 0, `${delays} delays were measured`);
    assert.match(await textOf(page, '#hand'), /ms from pointer to force/);
    console.log(`  ${(1000 * delayS).toFixed(0)} ms from pointer to force, ${delays} measured`);
  },

  'a second page sees who holds it, and cannot take it': async (session) => {
    const { page, browser, url } = session;
    const other = await browser.newPage();
    await other.goto(url);
    await until('it sees the hand', async () => {
      const { held } = await pointer(other);
      return held.length === 1 && !held[0].byThisPage;
    });
    await until('it says so', async () => /^Held on page \d+$/.test(await textOf(other, '#hand')));
    const place = await other.evaluate((mat) => window.viz.project(mat), session.ports[1].mat);
    await other.mouse.move(place.x, place.y);
    await other.mouse.down();
    await other.mouse.move(place.x + 30, place.y);
    const before = (await pointer(page)).delays;
    await until('the first page goes on', async () => {
      await page.mouse.move(300 + 5 * Math.random(), 300);
      return (await pointer(page)).delays > before + 3;
    });
    assert.equal((await pointer(other)).held.filter(({ byThisPage }) => byThisPage).length, 0);
    await other.mouse.up();
    await other.close();
  },

  'the mouse is let go, and the script plays again': async ({ page }) => {
    await page.mouse.up();
    await until('the script plays', async () => (await stateOf(page, 'thimbles')) === 'running');
    await until('the pointer stands by', async () => (await stateOf(page, 'pointer')) === 'standby');
    assert.deepEqual((await pointer(page)).held, []);
  },

  'a page that closes lets go': async ({ browser, page, url, ports }) => {
    const other = await browser.newPage();
    await other.goto(url);
    await until('it is offered the port', async () => (await pointer(other)).ports.length === 2);
    await until('it draws', async () => (await viz(other, 'framesDrawn')) > 3);
    const place = await other.evaluate((mat) => window.viz.project(mat), ports[0].mat);
    await other.mouse.move(place.x, place.y);
    await other.mouse.down();
    await until('it holds', async () => (await stateOf(page, 'pointer')) === 'running');
    await other.close();
    await until('the script plays', async () => (await stateOf(page, 'thimbles')) === 'running');
  },

  'viz_node is killed under the hand, and the hand lets go': async (session) => {
    const { page, ports } = session;
    const place = await page.evaluate((mat) => window.viz.project(mat), ports[0].mat);
    await page.mouse.move(place.x, place.y);
    await page.mouse.down();
    await until('it holds', async () => (await stateOf(page, 'pointer')) === 'running');
    await session.view.end('SIGKILL');
    await until('the page knows', async () => !(await viz(page, 'connected')));
    await page.mouse.up();
    session.view = startView(session, new URL(session.url).port);
    await until('the page is connected again', () => viz(page, 'connected'));
    await until('the script plays', async () => (await stateOf(page, 'thimbles')) === 'running');
    await until('the port is offered again', async () => (await pointer(page)).ports.length === 2);
  },

  'nothing went wrong in the page': async ({ page, pageErrors }) => {
    assert.deepEqual([await viz(page, 'errors'), pageErrors], [[], []]);
  },
};

const LAUNCH = join(source, 'launch_configs/plasticine.yaml');
const RESTS = ['thimbles.driver=script', 'thimbles.script={positions: [{at_s: 0, m: 0}]}'];

const startView = (session, port) =>
  session.vizOf(LAUNCH, '--name', 'view', `domain=${session.domain}`, `view.port=${port}`, ...RESTS);

async function open() {
  const session = await Session.open();
  const words = ['run', LAUNCH, '--no-color', '--only', 'sim,thimbles,pointer', `domain=${session.domain}`];
  session.launcher = session.start('cordis', program('cordis'), [...words, ...RESTS]);
  session.view = startView(session, 0);
  session.url = await session.view.says(/(http:\/\/127\.0\.0\.1:\d+)/);
  await openPage(session, session.url);
  return session;
}

await runCases(cases, open);
