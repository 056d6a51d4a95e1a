// The first thing a person does: ./cordis run launch_configs/plucked_string.yaml with the page open. Real sim_node, device_node,
// viz_node and Chromium; the simulated hand presses the key, the drawn string follows it, and swings on when it is let go.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { drawn, isDark, look, openPage, textOf, viz } from '../viz/browser.mjs';
import { out, program, runCases, Session, source, until } from '../viz/session.mjs';

// MATs of launch_configs/scenes/plucked_string.yaml
const [PLUCKED, MIDDLE, KEY] = [13, 20, 40];
const BESIDE = 9; // a mass so far from a place does not cover it [pixels]

/** Height of a MAT in the newest frame [m]. */
const height = async (page, mat) => (await page.evaluate((index) => window.viz.position(index), mat))[1];

const cases = {
  'the scene of the launch file is on the page': async ({ page }) => {
    const scene = await viz(page, 'scene');
    assert.deepEqual([scene.name, scene.space, scene.matCount, scene.linkCount], ['plucked_string', 2, 41, 40]);
    await drawn(page, 10);
  },

  'the hand presses the key, and the string is drawn where it was pulled to': async ({ page }) => {
    // An earlier stroke may have left the string swinging.
    const before = await until('the key is up, the string not below its rest', async () => {
      const seen = await look(page, PLUCKED);
      return (await height(page, KEY)) > -0.102 && (await height(page, PLUCKED)) > -0.001 && seen;
    });
    const pulled = await until('the key is 10 mm down, and the string 4 mm', async () => {
      const down = (await height(page, KEY)) < -0.11 && (await height(page, PLUCKED)) < -0.004;
      const seen = down && (await look(page, PLUCKED, [before.at]));
      return seen && seen.at.y > before.at.y + BESIDE && seen;
    });
    assert.ok(!isDark(pulled.colour), `a mass is drawn at its new place: ${pulled.colour}`);
    assert.ok(isDark(pulled.others[0]), `and no longer at the old one: ${pulled.others[0]}`);
    await page.screenshot({ path: join(out, 'whole_pulled.png') });
  },

  'let go, the string swings to both sides while the key rests': async ({ page }) => {
    await until('the key is up again', async () => (await height(page, KEY)) > -0.102);
    for (const [side, there] of [['above', (y) => y > 0.001], ['below', (y) => y < -0.003], ['above', (y) => y > 0.001]]) {
      await until(`the middle is ${side} its rest`, async () => there(await height(page, MIDDLE)));
    }
    assert.ok((await height(page, KEY)) > -0.105, 'the key does not follow');
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
    const running = 'keyboard device_node running, sim sim_node running, view viz_node running';
    await until('all three nodes run', async () => {
      const nodes = (await viz(page, 'nodes')).map(({ name, kind, state }) => `${name} ${kind} ${state}`);
      return nodes.sort().join(', ') === running;
    });
    const energies = new Set();
    await until('the energy changes', async () => energies.add(await textOf(page, '#energy')).size > 1);
    assert.equal(await page.locator('#plots canvas').count(), 3, 'position, force, energy');
    await page.screenshot({ path: join(out, 'whole_swinging.png') });
  },

  'the buttons of the page pause the scene, do a step, begin it anew and let it go on': async ({ page }) => {
    const click = (verb) => page.click(`#control button[data-verb="${verb}"]`);
    const replied = (pattern) =>
      until(`the reply reads ${pattern}`, async () => pattern.exec(await textOf(page, '#reply')));
    await click('pause');
    const step = Number((await replied(/^paused at step (\d+)$/))[1]);
    await until('the banner says so', async () => (await textOf(page, '#banner-title')) === 'paused');
    await click('step');
    await replied(new RegExp(`^paused at step ${step + 1}$`));
    await until('the step is shown', async () => (await viz(page, 'lastFrame')).step === step + 1);
    await click('reset');
    await replied(/^'plucked_string' begins anew, paused/);
    await until('the beginning is shown', async () => (await viz(page, 'lastFrame')).step === 0);
    await click('pause');
    await replied(/^goes on at step 0$/);
    await until('it goes on', async () => (await viz(page, 'lastFrame')).step > 1000);
    await until('the key is down', async () => (await height(page, KEY)) < -0.11);
  },

  'Ctrl-C ends every process, and the launcher tells how it went': async ({ page, launcher, pageErrors }) => {
    assert.deepEqual([await viz(page, 'errors'), pageErrors], [[], []]);
    assert.equal(await launcher.end('SIGINT'), 0);
    for (const [node, row] of Object.entries({ sim: /^sim +[\d.]+ +1000 /m, keyboard: /^keyboard +[\d.]+ +1000 /m })) {
      assert.match(launcher.log, row, `${node} has a row in the table`);
    }
    await until('the page says so', async () => (await textOf(page, '#banner-title')) === 'viz_node does not answer');
  },
};

async function open() {
  const session = await Session.open();
  const words = ['run', join(source, 'launch_configs/plucked_string.yaml'), '--no-color', `domain=${session.domain}`];
  session.launcher = session.start('cordis', program('cordis'), [...words, 'view.port=0']);
  await openPage(session, await session.launcher.says(/(http:\/\/127\.0\.0\.1:\d+)/));
  return session;
}

await runCases(cases, open, 170_000);
