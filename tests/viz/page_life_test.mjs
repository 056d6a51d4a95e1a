// tests/viz/page_life_test.mjs -- what becomes of a page in a day: it is reloaded, hidden, frozen,
// stopped with its machine, debugged, loses its graphics, and its session ends and another begins.
// Each ends in a live view, or in a clear sentence on the page.
import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { banner, drawn, isDark, look, openScenePage, textOf, viz } from './browser.mjs';
import { pause, runCases, until } from './session.mjs';

const MIDDLE = 29; // MAT of the string of scene_source.cpp

/** The processes of a browser: those that name its profile, and their descendants. */
function processesOf(profile) {
  const parents = new Map();
  const mine = new Set();
  for (const id of readdirSync('/proc').filter((name) => /^\d+$/.test(name))) {
    try {
      parents.set(id, /\) \S (\d+)/.exec(readFileSync(`/proc/${id}/stat`, 'latin1'))[1]);
      if (readFileSync(`/proc/${id}/cmdline`, 'latin1').includes(profile)) mine.add(id);
    } catch {
      // it has ended meanwhile
    }
  }
  const isMine = (id) => id !== undefined && (mine.has(id) || isMine(parents.get(id)));
  return [...parents.keys()].filter(isMine).map(Number);
}

const framesReceived = (page) => viz(page, 'framesReceived');

const cases = {
  'a page that is reloaded again and again draws': async ({ page }) => {
    for (let i = 0; i < 20; ++i) await page.reload({ waitUntil: i % 3 ? 'commit' : 'load' });
    await until('it draws', async () => page.evaluate(() => (window.viz?.framesDrawn ?? 0) > 5));
    await banner(page, '');
  },

  'of two pages each goes on when it is shown': async ({ browser, page, url }) => {
    const second = await browser.newPage();
    await second.goto(url);
    for (let i = 0; i < 3; ++i) {
      for (const shown of [page, second]) {
        await shown.bringToFront();
        await drawn(shown, 5);
      }
    }
    await second.close();
    await page.bringToFront();
    await drawn(page, 5);
  },

  'a page that was frozen in the background goes on': async ({ browser, page }) => {
    const tools = await browser.newCDPSession(page);
    await tools.send('Page.setWebLifecycleState', { state: 'frozen' });
    await pause(5000);
    await tools.send('Page.setWebLifecycleState', { state: 'active' });
    await tools.detach();
    await drawn(page, 10);
    await banner(page, '');
  },

  'a page that stood in the debugger goes on': async ({ browser, page }) => {
    const tools = await browser.newCDPSession(page);
    await tools.send('Debugger.enable');
    const stopped = new Promise((resolve) => tools.once('Debugger.paused', resolve));
    await tools.send('Debugger.pause');
    await stopped;
    await pause(5000);
    await tools.send('Debugger.resume');
    await tools.detach();
    await drawn(page, 10);
    await banner(page, '');
  },

  'a browser that slept with its machine goes on': async ({ page, profile }) => {
    const processes = processesOf(profile);
    assert.ok(processes.length > 2, `${processes.length} processes of the browser`);
    const signal = (name) => processes.forEach((id) => process.kill(id, name));
    signal('SIGSTOP');
    await pause(Number(process.env.CORDIS_SLEEP_MS ?? 5000));
    signal('SIGCONT');
    await drawn(page, 10);
    await banner(page, '');
  },

  'a page that acknowledges nothing, or nonsense, still gets frames': async ({ page }) => {
    const breakIt = (how) =>
      page.evaluate((word) => {
        const { prototype } = window.WebSocket;
        prototype.realSend ??= prototype.send;
        prototype.send = {
          silent: () => {},
          nonsense(text) {
            this.realSend(text.replace(/"sequence":\d+/, '"sequence":1'));
            this.realSend('{"type":"ack"}');
          },
          healthy: prototype.realSend,
        }[word];
      }, how);
    for (const how of ['silent', 'nonsense', 'healthy']) {
      await breakIt(how);
      const begin = await framesReceived(page);
      await until(`a ${how} page gets frames`, async () => (await framesReceived(page)) > begin + 3);
    }
    await drawn(page, 10);
  },

  'a page that loses its graphics says so, and draws again when it has them back': async ({ page }) => {
    await page.evaluate(() => {
      const canvas = document.querySelector('#stage canvas');
      window.graphics = canvas.getContext('webgl2').getExtension('WEBGL_lose_context');
      window.graphics.loseContext();
    });
    await until('it says so', async () => /stopped drawing/.test(await textOf(page, '#notice')));
    await page.evaluate(() => window.graphics.restoreContext());
    await until('it says so no more', async () => (await textOf(page, '#notice')) === '');
    await until('the string is drawn', async () => !isDark((await look(page, MIDDLE)).colour));
  },

  'another session on the same port is on the page, in the place of the one that ended': async (session) => {
    const { page } = session;
    const { port } = new URL(session.url);
    await session.source.end();
    await banner(page, 'waiting for sim_node');
    assert.equal(await session.view.end(), 0);
    await banner(page, 'viz_node is gone');
    session.view = session.vizOf(session.launchFile(`port: ${port}`, 'another'));
    await banner(page, 'waiting for sim_node');
    session.source = session.scene('--session', 'another', '--scene', 'grid', '--mats', '400');
    await until('its scene is drawn', async () => (await viz(page, 'lastFrame')).matCount === 400);
    await until('its name is shown', async () => (await textOf(page, '#session')) === 'another');
    await drawn(page, 10);
    await banner(page, '');
  },

  'a page of another version says so': async ({ browser, url, page }) => {
    const old = await browser.newPage();
    await old.routeWebSocket(/live/, (socket) => {
      const server = socket.connectToServer();
      server.onMessage((message) => socket.send(typeof message === 'string' ? message.replace(/"protocol":\d+/, '"protocol":0') : message));
    });
    await old.goto(url);
    await banner(old, 'reload this page');
    await old.close();
    await page.bringToFront();
    await drawn(page, 5);
  },

  'nothing went wrong in the page': async ({ page, pageErrors }) => {
    assert.deepEqual([await viz(page, 'errors'), pageErrors], [[], []]);
  },
};

await runCases(cases, () => openScenePage());
