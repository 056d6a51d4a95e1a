// tests/integration/pointer_page_test.mjs -- a key is dragged on the page, felt, and handed back.
// With real sim_node, device_node, viz_node and Chromium. The other hand is a script that rests.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { drawn, openPage, textOf, viz } from '../viz/browser.mjs';
import { out, program, runCases, Session, source, until } from '../viz/session.mjs';

const STEP_MS = 12;
const PRESS_M = 0.02; // the string is touched on the way

const pointer = (page) => viz(page, 'pointer');
const stateOf = async (page, name) => (await viz(page, 'nodes')).find((node) => node.name === name)?.state;
const placeOf = (page, mat) => page.evaluate((index) => window.viz.project(index), mat);
const press = async (page, mat) => {
  const { x, y } = await placeOf(page, mat);
  await page.mouse.move(x, y);
  await page.mouse.down();
};
const cursorOf = (page) => page.evaluate(() => getComputedStyle(document.querySelector('#stage canvas')).cursor);
/** Moves the hand that holds `mat` until the force of a new event is drawn. */
const feels = async (page, mat) => {
  const { x, y } = await placeOf(page, mat);
  const { delays } = await pointer(page);
  await until('the hand is felt', async () => {
    await page.mouse.move(x + 5 * Math.random(), y + 5);
    return (await isHeld(page, true)) && (await pointer(page)).delays > delays;
  });
};
/** True if one port is held, by this page or by another one. */
const isHeld = async (page, byThisPage) => {
  const { held } = await pointer(page);
  return held.length === 1 && held[0].byThisPage === byThisPage;
};

const cases = {
  'the page offers the key, and the other hand plays meanwhile': async (session) => {
    const { page } = session;
    await drawn(page, 3);
    session.ports = await until('a port is offered', async () => {
      const { ports } = await pointer(page);
      return ports.length === 1 && ports;
    });
    assert.equal(session.ports[0].name, 'key');
    await until('the pointer stands by', async () => (await stateOf(page, 'pointer')) === 'standby');
    await until('the script plays', async () => (await stateOf(page, 'keyboard')) === 'running');
    await until('the page says so', async () => /^Drag a ringed port/.test(await textOf(page, '#hand')));
  },

  'a key that is dragged down is pressed, and the string is felt': async (session) => {
    const { page } = session;
    const { port, mat } = session.ports[0];
    const camera = await viz(page, 'camera');
    const start = await placeOf(page, mat);
    await page.mouse.move(start.x, start.y);
    await until('the pointer shows that it can take hold', async () => (await cursorOf(page)) === 'grab');
    await page.mouse.down();
    await until('the page holds it', async () => {
      const { held } = await pointer(page);
      return held.length === 1 && held[0].port === port && held[0].byThisPage;
    });
    assert.equal(await cursorOf(page), 'grabbing');
    const below = PRESS_M / camera.metresPerPixel;
    for (let n = 1; n <= 40; ++n) {
      await page.mouse.move(start.x, start.y + (below * n) / 40);
      await page.waitForTimeout(STEP_MS);
    }
    await until('the string is felt', async () => ((await pointer(page)).held[0]?.forceN ?? 0) > 0.5);
    await until('the key is down', async () => (await placeOf(page, mat)).y > start.y + below / 2);
    await page.screenshot({ path: join(out, 'pointer_key.png') });
    assert.deepEqual((await viz(page, 'camera')).target, camera.target, 'the view did not move under the hand');
    await until('delays are measured', async () => {
      const { delays, delayS } = await pointer(page);
      return delays > 3 && delayS > 0;
    });
    await until('the page says so', async () => /^Your hand.*ms from pointer to force/.test(await textOf(page, '#hand')));
    console.log(`  ${(1000 * (await pointer(page)).delayS).toFixed(0)} ms from pointer to force`);
  },

  'a second page sees who holds it, and cannot take it': async (session) => {
    const { page, browser, url } = session;
    const { mat } = session.ports[0];
    const other = await browser.newPage();
    await other.goto(url);
    // A browser that sends nothing for long lets go, and then the other page may take the port: that is tried again.
    const goesOn = async () => {
      await until('it sees the hand', () => isHeld(other, false));
      await until('it says so', async () => /^Held on page \d+$/.test(await textOf(other, '#hand')));
      await press(other, mat);
      const before = (await pointer(page)).delays;
      const end = await until('the first page goes on', async () => {
        if (await isHeld(other, true)) return 'taken';
        const { x, y } = await placeOf(page, mat);
        await page.mouse.move(x + 5 * Math.random(), y + 5);
        return (await pointer(page)).delays > before + 3 && 'held';
      });
      await other.mouse.up();
      return end === 'held';
    };
    const pressAgain = async () => {
      await page.mouse.up();
      await press(page, mat);
      await until('the first page holds it again', () => isHeld(page, true));
    };
    let held = await goesOn();
    for (let times = 0; !held && times < 3; ++times) {
      await pressAgain();
      held = await goesOn();
    }
    assert.ok(held, 'the second page took it each time');
    await other.close();
  },

  'the mouse is let go, and the script plays again': async ({ page }) => {
    await page.mouse.up();
    await until('the script plays', async () => (await stateOf(page, 'keyboard')) === 'running');
    await until('the pointer stands by', async () => (await stateOf(page, 'pointer')) === 'standby');
    await until('no page holds it', async () => (await pointer(page)).held.length === 0);
  },

  'a page that closes lets go': async ({ browser, page, url, ports }) => {
    const other = await browser.newPage();
    await other.goto(url);
    await until('it is offered the port', async () => (await pointer(other)).ports.length === 1);
    await until('it draws', async () => (await viz(other, 'framesDrawn')) > 3);
    await press(other, ports[0].mat);
    await until('it holds', async () => (await stateOf(page, 'pointer')) === 'running');
    await other.close();
    await until('the script plays', async () => (await stateOf(page, 'keyboard')) === 'running');
  },

  'a page that stalled under the hand holds on': async ({ page, ports }) => {
    await press(page, ports[0].mat);
    await until('it holds', () => isHeld(page, true));
    await page.evaluate(() => {
      for (const end = performance.now() + 1500; performance.now() < end; );
    });
    await page.waitForTimeout(700); // what the page knows is new again, and its hand has not moved
    await until('it holds', () => isHeld(page, true));
    await feels(page, ports[0].mat);
    await page.mouse.up();
    await until('the script plays', async () => (await stateOf(page, 'keyboard')) === 'running');
  },

  'viz_node is killed under the hand, which takes hold again': async (session) => {
    const { page, ports } = session;
    await press(page, ports[0].mat);
    await until('it holds', async () => (await stateOf(page, 'pointer')) === 'running');
    await session.view.end('SIGKILL');
    await until('the page knows', async () => !(await viz(page, 'connected')));
    session.view = startView(session, new URL(session.url).port);
    await feels(page, ports[0].mat);
    assert.equal(await cursorOf(page), 'grabbing');
    await page.mouse.up();
    assert.notEqual(await cursorOf(page), 'grabbing');
    await until('the script plays', async () => (await stateOf(page, 'keyboard')) === 'running');
    await until('the port is offered again', async () => (await pointer(page)).ports.length === 1);
  },

  'nothing went wrong in the page': async ({ page, pageErrors }) => {
    assert.deepEqual([await viz(page, 'errors'), pageErrors], [[], []]);
  },
};

const LAUNCH = join(source, 'launch_configs/plucked_string.yaml');
const RESTS = ['keyboard.driver=script', 'keyboard.script={positions: [{at_s: 0, m: 0}]}'];

const startView = (session, port) =>
  session.vizOf(LAUNCH, '--name', 'view', `domain=${session.domain}`, `view.port=${port}`, ...RESTS);

async function open() {
  const session = await Session.open();
  const words = ['run', LAUNCH, '--no-color', '--only', 'sim,keyboard,pointer', `domain=${session.domain}`];
  session.launcher = session.start('cordis', program('cordis'), [...words, ...RESTS]);
  session.view = startView(session, 0);
  session.url = await session.view.says(/(http:\/\/127\.0\.0\.1:\d+)/);
  await openPage(session, session.url);
  return session;
}

await runCases(cases, open);
