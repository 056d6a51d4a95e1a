// tests/integration/view_test.mjs -- the view goes on, whatever a person presses: every
// button of the page and scenes loaded from a shell while frames are on their way. Real sim_node,
// device_node, viz_node, launcher and Chromium. What is asked next is drawn by lot; the seed is
// printed.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { drawn, openPage, textOf, viz } from '../viz/browser.mjs';
import { lot, pause, program, runCases, Session, source, until } from '../viz/session.mjs';

const ACTIONS = 50;
const LAUNCH = join(source, 'launch_configs/plucked_string.yaml');
const SCENES = ['membrane', 'hanging_chain', 'plucked_string'].map((name) => join(source, `launch_configs/scenes/${name}.yaml`));

/** Presses a button at once, wherever the page is in drawing. */
const press = (page, selector) => page.evaluate((one) => document.querySelector(one).click(), selector);

/** Does something that describes the scene again, and waits until the page has the new description. */
async function describeAnew(page, what, action) {
  const before = (await viz(page, 'scene')).number;
  await action();
  await until(`the page has the scene after ${what}`, async () => (await viz(page, 'scene')).number > before);
}

async function load(session, file) {
  const words = ['ctl', LAUNCH, 'load', file, '--domain', session.domain, '--timeout', '60s'];
  assert.equal(await session.start('ctl', program('cordis'), words).ended, 0, `load ${file}`);
}

async function answered(page, verb, action) {
  const newest = async () => (await viz(page, 'replies')).at(-1)?.number ?? 0;
  const before = await newest();
  await action();
  await until(`${verb} is answered`, async () => (await newest()) > before);
}

/** What a person can do, by name. */
function actionsOf(session, draw) {
  const { page } = session;
  const verb = (name) => async () => {
    const button = `#control button[data-verb="${name}"]`;
    if (name === 'reset') return describeAnew(page, name, () => press(page, button));
    return answered(page, name, () => press(page, button));
  };
  const tool = (key) => () => press(page, `#tools button[data-key="${key}"]`);
  const colours = () => page.keyboard.press('c');
  const motion = () => page.keyboard.press('m');
  const window = (seconds) => () => press(page, `#windows button[data-window="${seconds}"]`);
  const scene = () => {
    const file = SCENES[Math.floor(draw() * SCENES.length)];
    return describeAnew(page, `load ${file}`, () => load(session, file));
  };
  return {
    pause: verb('pause'),
    step: verb('step'),
    reset: verb('reset'),
    load: scene,
    colours,
    motion,
    ...Object.fromEntries(['f', '1', '2', '3', '4', 'o', 'r', 't', 'g', 'n', 'h', 'l', 's', '?'].map((key) => [`tool '${key}'`, tool(key)])),
    ...Object.fromEntries([1, 5, 20].map((seconds) => [`window ${seconds} s`, window(seconds)])),
  };
}

/** Three frames more are drawn, or come while the view is frozen. */
async function goesOn(page) {
  const name = (await viz(page, 'frozen')) ? 'framesReceived' : 'framesDrawn';
  const begin = await viz(page, name);
  await until(`${name} grows by 3`, async () => (await viz(page, name)) >= begin + 3);
}

const phaseOf = async (page) => (await viz(page, 'nodes')).find(({ kind }) => kind === 'sim_node')?.state;

const cases = {
  'space pauses the simulation and lets it go on, the right arrow does one step': async ({ page }) => {
    await page.keyboard.press(' ');
    await until('it is paused', async () => (await phaseOf(page)) === 'paused');
    const stepOf = async () => (await viz(page, 'nodes')).find(({ kind }) => kind === 'sim_node').step;
    const before = await stepOf();
    await page.keyboard.press('ArrowRight');
    await until('it has done one step', async () => (await stepOf()) === before + 1);
    await page.keyboard.press(' ');
    await until('it goes on', async () => (await phaseOf(page)) === 'running');
    await drawn(page, 3);
  },

  'the view goes on after every button and every scene': async (session) => {
    const { page } = session;
    const seed = Number(process.env.CORDIS_SEED ?? Date.now() % 100_000);
    console.log(`CORDIS_SEED=${seed}`);
    const draw = lot(seed);
    const actions = actionsOf(session, draw);
    const names = Object.keys(actions);
    const describing = ['reset', 'load'];
    for (let i = 0; i < ACTIONS; ++i) {
      const name = i < names.length ? names[i] : i % 2 ? describing[i % 4 >> 1] : names[Math.floor(draw() * names.length)];
      await pause(draw() * 80); // anywhere between two frames
      const begin = Date.now();
      await actions[name]();
      try {
        await goesOn(page);
      } catch (error) {
        const seen = await page.evaluate(() => [window.viz.lastFrame, window.viz.scene, window.viz.errors]);
        throw new Error(`after '${name}' (${i + 1} of ${ACTIONS}): ${error.message}; ${JSON.stringify(seen)}`);
      }
      console.log(`  ${i + 1}. ${name}: ${Date.now() - begin} ms`);
    }
  },

  'nothing went wrong in the page': async ({ page, pageErrors }) => {
    assert.deepEqual([await viz(page, 'errors'), pageErrors], [[], []]);
  },
};

async function open() {
  const session = await Session.open();
  const words = ['run', LAUNCH, '--no-color', `domain=${session.domain}`, 'view.port=0'];
  session.launcher = session.start('cordis', program('cordis'), words);
  await openPage(session, await session.launcher.says(/(http:\/\/127\.0\.0\.1:\d+)/));
  await drawn(session.page, 3);
  return session;
}

await runCases(cases, open);
