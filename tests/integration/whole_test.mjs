// tests/integration/whole_test.mjs -- the first thing a person does: ./cordis run
// launch_configs/plucked_string.yaml with the page open. Real sim_node, device_node, viz_node and
// Chromium; the simulated hand presses the key, the drawn string follows it, and swings on when it
// is let go.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { banner, drawn, isDark, openPage, replied, textOf, viz } from '../viz/browser.mjs';
import { out, program, runCases, Session, source, until } from '../viz/session.mjs';

// MATs of launch_configs/scenes/plucked_string.yaml
const [PLUCKED, MIDDLE, KEY] = [13, 20, 40];
const BESIDE = 9; // a mass so far from a place does not cover it [pixels]

/** Height of a MAT in the newest frame [m]. */
const height = async (page, mat) => (await page.evaluate((index) => window.viz.position(index), mat))[1];

/** Heights of the key and the plucked mass [m], where that is drawn, and the colours there and at another place: of one frame. */
const seeStroke = (page, other = null) =>
  page.evaluate(
    ([keyMat, mat, place]) => {
      const { position, project, pixelAt } = window.viz;
      const point = project(mat);
      const colours = { colour: pixelAt(point.x, point.y), other: place && pixelAt(place.x, place.y) };
      return { key: position(keyMat)[1], string: position(mat)[1], point, ...colours };
    },
    [KEY, PLUCKED, other],
  );

const cases = {
  'the scene of the launch file is on the page': async ({ page }) => {
    const scene = await viz(page, 'scene');
    assert.deepEqual([scene.name, scene.space, scene.matCount, scene.linkCount], ['plucked_string', 2, 41, 40]);
    await drawn(page, 10);
  },

  'the hand presses the key, and the string is drawn where it was pulled to': async ({ page }) => {
    // An earlier stroke may have left the string swinging.
    const before = await until('the key is up, the string not below its rest', async () => {
      const seen = await seeStroke(page);
      return seen.key > -0.102 && seen.string > -0.001 && seen;
    });
    const pulled = await until('the key is 10 mm down, and the string 4 mm', async () => {
      const seen = await seeStroke(page, before.point);
      return seen.key < -0.11 && seen.string < -0.004 && seen.point.y > before.point.y + BESIDE && seen;
    });
    assert.ok(!isDark(pulled.colour), `a mass is drawn at its new place: ${pulled.colour}`);
    assert.ok(isDark(pulled.other), `and no longer at the old one: ${pulled.other}`);
    await page.screenshot({ path: join(out, 'whole_pulled.png') });
  },

  'let go, the string swings to both sides while the key rests': async ({ page }) => {
    // The hand presses again later: key and string are looked at in one frame.
    const both = () => page.evaluate((mats) => mats.map((mat) => window.viz.position(mat)[1]), [KEY, MIDDLE]);
    for (const [side, there] of [['above', (y) => y > 0.001], ['below', (y) => y < -0.003], ['above', (y) => y > 0.001]]) {
      await until(`the middle is ${side} its rest while the key rests`, async () => {
        const [key, middle] = await both();
        return key > -0.102 && there(middle);
      });
    }
  },

  'rate, overruns, latency of the force and energy are measured and shown': async ({ page }) => {
    const figures = {
      session: /^plucked_string$/,
      loop: /^\d+\.\d$/,
      'loop-more': /^\/ 1000 Hz$/,
      overruns: /^[\d,\s]+$/,
      'overruns-more': /^\d+\.\d{3} %$/,
      latency: /^\d[\d.]*\s(µs|ms)$/,
      'latency-device': /keyboard/,
      energy: /^\d[\d.]*\s[µm]?J$/,
      'energy-more': /^drift -?\d/,
      time: /^\d+\.\d\d$/,
    };
    for (const [id, pattern] of Object.entries(figures)) {
      await until(`#${id} reads ${pattern}`, async () => pattern.test(await textOf(page, `#${id}`)));
    }
    const running =
      'keyboard device_node running, pointer device_node standby, sim sim_node running, view viz_node running';
    await until('all four nodes run, the pointer as a standby', async () => {
      const nodes = (await viz(page, 'nodes')).map(({ name, kind, state }) => `${name} ${kind} ${state}`);
      return nodes.sort().join(', ') === running;
    });
    const energies = new Set();
    await until('the energy changes', async () => energies.add(await textOf(page, '#energy')).size > 1);
    assert.equal(await page.locator('#plots canvas').count(), 3, 'position, force, energy');
    await page.screenshot({ path: join(out, 'whole_swinging.png') });
  },

  'the buttons of the page pause the scene, do a step, restart it and let it go on': async ({ page }) => {
    const click = (verb) => page.click(`#control button[data-verb="${verb}"]`);
    await click('pause');
    const step = Number((await replied(page, /^paused at step (\d+)$/))[1]);
    await banner(page, 'paused');
    await click('step');
    await replied(page, new RegExp(`^paused at step ${step + 1}$`));
    await until('the step is shown', async () => (await viz(page, 'lastFrame')).step === step + 1);
    await click('reset');
    await replied(page, /^'plucked_string' restarts, paused/);
    await until('the beginning is shown', async () => (await viz(page, 'lastFrame')).step === 0);
    await click('pause');
    await replied(page, /^goes on at step 0$/);
    await until('it goes on', async () => (await viz(page, 'lastFrame')).step > 1000);
    await until('the key is down', async () => (await height(page, KEY)) < -0.11);
  },

  'a reply goes when a command from a terminal makes it untrue': async (session) => {
    const { page } = session;
    await page.evaluate(() => {
      window.setTimeoutBefore = window.setTimeout;
      window.setTimeout = () => 0; // nothing takes a reply away after a while
    });
    await page.click('#control button[data-verb="pause"]');
    await banner(page, 'paused');
    await until('the reply is shown', async () => /^paused at step/.test(await textOf(page, '#reply')));
    const ctl = session.start('ctl', program('cordis'), ['ctl', join(source, 'launch_configs/plucked_string.yaml'), 'resume', '--domain', session.domain, '--timeout', '60s']);
    assert.equal(await ctl.ended, 0, ctl.log);
    await until('the reply has gone', async () => (await textOf(page, '#reply')) === '');
    await page.evaluate(() => (window.setTimeout = window.setTimeoutBefore));
  },

  'Ctrl-C ends every process, and the launcher reports how it went': async ({ page, launcher, pageErrors }) => {
    assert.deepEqual([await viz(page, 'errors'), pageErrors], [[], []]);
    assert.equal(await launcher.end('SIGINT'), 0);
    for (const [node, row] of Object.entries({ sim: /^sim +[\d.]+ +1000 /m, keyboard: /^keyboard +[\d.]+ +1000 /m })) {
      assert.match(launcher.log, row, `${node} has a row in the table`);
    }
    await banner(page, 'viz_node is gone');
  },
};

async function open() {
  const session = await Session.open();
  const words = ['run', join(source, 'launch_configs/plucked_string.yaml'), '--no-color', `domain=${session.domain}`];
  session.launcher = session.start('cordis', program('cordis'), [...words, 'view.port=0']);
  await openPage(session, await session.launcher.says(/(http:\/\/127\.0\.0\.1:\d+)/));
  return session;
}

await runCases(cases, open);
