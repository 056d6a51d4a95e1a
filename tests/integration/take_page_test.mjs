// tests/integration/take_page_test.mjs -- the page before a take: real `cordis record` and `cordis
// play`, a viz_node that knows nothing of either, and the bar that moves the take in Chromium.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync } from 'node:fs';
import { join } from 'node:path';
import { banner, drawn, openPage, textOf, viz } from '../viz/browser.mjs';
import { out, pause, program, runCases, Session, source, until } from '../viz/session.mjs';

const LENGTH_S = 6; // of what is recorded, at least
const launch = join(source, 'launch_configs/sounding_string.yaml');
const SLOW_RATE = 0.985; // the page is silent below 0.98

/** The take that the page shows; without a state while the player is silent, as on a busy machine. */
const take = async (page) => (await viz(page, 'take')) ?? {};
const stepOf = async (page) => (await viz(page, 'lastFrame')).step;
/** Simulated time, and that of the page [s]. */
const timesOf = (page) => page.evaluate(() => [window.viz.lastFrame.simulatedS, performance.now() / 1000]);
/** What a take that is still written holds. */
function recorded(file) {
  const { stdout } = spawnSync(program('cordis'), ['info', `${file}.part`, '--json'], { encoding: 'utf8' });
  const { duration_s: lengthS, topics } = stdout.startsWith('{') ? JSON.parse(stdout) : { duration_s: 0, topics: [] };
  return { lengthS, frames: topics.find(({ name }) => name === 'scene/frame')?.messages ?? 0 };
}
const setTo = (page, selector, value, event) =>
  page.evaluate(
    ([where, wanted, name]) => {
      const input = document.querySelector(where);
      input.value = wanted;
      input.dispatchEvent(new Event(name));
    },
    [selector, String(value), event],
  );

const cases = {
  'a live session has no bar': async (session) => {
    const { page } = session;
    await drawn(page, 5);
    assert.equal(await viz(page, 'take'), null);
    assert.equal(await page.locator('#take').isVisible(), false);
    const [simulatedS, beginS] = await timesOf(page);
    await until('enough is recorded', () => {
      const { lengthS, frames } = recorded(session.file);
      return lengthS > LENGTH_S && frames > 100;
    });
    const [simulatedEndS, endS] = await timesOf(page);
    session.sceneRate = (simulatedEndS - simulatedS) / (endS - beginS);
    assert.ok([0, 3].includes(await session.recorder.end('SIGINT')), 'done, or done with loss on a busy machine');
    await session.launcher.end('SIGINT');
    assert.ok(existsSync(session.file));
  },

  'a take that is played has a bar, its name and its length': async (session) => {
    const words = ['play', session.file, '--loop', '--session', 'sounding_string', '--domain', session.domain];
    session.player = session.start('play', program('cordis'), words);
    await session.player.says(/session '(\w+)' in DDS domain/); // a view that begins before it has the name
    session.view = session.vizOf(launch, 'view.port=0', `domain=${session.domain}`);
    await session.page.goto(await session.view.says(/(http:\/\/127\.0\.0\.1:\d+)/));
    const { page } = session;
    await page.waitForSelector('#take:not([hidden])');
    await drawn(page, 5);
    const { lengthS } = await until('the player says how long it is', async () => {
      const played = await take(page);
      return played.file === 'take.mcap' && played;
    });
    assert.ok(lengthS >= LENGTH_S, `${lengthS} s`);
    assert.equal(await textOf(page, '#take-file'), 'take.mcap');
    assert.match(await textOf(page, '#take-time'), /^\d:\d\d\.\d \/ \d:\d\d\.\d$/);
    assert.equal((await viz(page, 'scene')).name, 'sounding_string');
    await banner(page, '');
    assert.doesNotMatch(session.player.log + session.view.log, /warning/);
    await page.screenshot({ path: join(out, 'take.png') });
  },

  'space pauses it, and lets it go on': async ({ page }) => {
    await page.keyboard.press(' ');
    await until('it is paused', async () => (await take(page)).state === 'paused');
    await banner(page, 'take paused');
    assert.equal(await textOf(page, '#control button[data-verb="pause"]'), 'Resume');
    await until('what was on its way has come, and no more does', async () => {
      const step = await stepOf(page);
      await pause(500);
      return (await stepOf(page)) === step;
    });
    await page.keyboard.press(' ');
    await until('it goes on', async () => (await take(page)).state === 'playing');
    await drawn(page, 3);
    await banner(page, '');
  },

  'the bar moves it, forth and back': async ({ page }) => {
    await page.keyboard.press(' ');
    await until('it is paused', async () => (await take(page)).state === 'paused');
    for (const atS of [4, 1, 3]) {
      await setTo(page, '#seek', atS, 'change');
      await until(`it is at ${atS} s`, async () => Math.abs((await take(page)).positionS - atS) < 0.01);
    }
    await page.keyboard.press(' ');
    await until('it goes on from there', async () => (await take(page)).positionS > 3.2);
    // Simulated time runs as the take does: the same difference at two places of it.
    await page.keyboard.press('Home');
    await until('it is at its beginning', async () => (await take(page)).positionS < 1);
    await drawn(page, 3);
  },

  'its sound is heard at its own speed, and at no other': async ({ page, sceneRate }) => {
    if (sceneRate < SLOW_RATE) return console.log(`skipped: this machine ran the scene at ${sceneRate.toFixed(3)} of real time`);
    const state = async () => (await viz(page, 'sound')).figures?.state;
    await page.click('#sound-on');
    await until('sound is played', async () => (await state()) === 'playing');
    await page.selectOption('#take-rate', '0.5');
    await until('half the speed is silent', async () => (await state()) === 'off rate');
    await until('the page says so', async () => /^silent: the scene runs at ×0\.\d/.test(await textOf(page, '#sound-text')));
    await page.screenshot({ path: join(out, 'take_sound.png') });
    await page.click('#sound-on');
  },

  'its speed is chosen': async ({ page }) => {
    await page.selectOption('#take-rate', '0.25');
    await until('it plays at a quarter', async () => (await take(page)).rate === 0.25);
    await page.keyboard.press(']');
    await until('it plays at a half', async () => (await take(page)).rate === 0.5);
    await until('the page says so', async () => (await page.locator('#take-rate').inputValue()) === '0.5');
    await page.selectOption('#take-rate', '4');
    await until('it plays four times as fast', async () => (await take(page)).rate === 4);
    await drawn(page, 3);
  },

  'in narrow windows the bar and the sound stay within them, and over nothing': async ({ page }) => {
    for (const width of [1280, 800, 420]) {
      await page.setViewportSize({ width, height: 720 });
      const faults = await until('the page has this width', () =>
        page.evaluate((wanted) => {
          if (window.innerWidth !== wanted) return null;
          const names = ['#take', '#sound', '#tools', '#control', '#legend', '#ruler'];
          const boxes = names.map((one) => [one, document.querySelector(one).getBoundingClientRect()]);
          const found = boxes.filter(([, { left, right }]) => left < 0 || right > wanted).map(([name]) => `${name} is beyond`);
          for (const [first, bar] of boxes.slice(0, 2)) {
            for (const [name, box] of boxes) {
              const apart = box.right <= bar.left || bar.right <= box.left || box.bottom <= bar.top || bar.bottom <= box.top;
              if (name !== first && !apart) found.push(`${name} is under ${first}`);
            }
          }
          return found;
        }, width),
      );
      assert.deepEqual(faults, [], `${width} pixels`);
      await page.screenshot({ path: join(out, `take_${width}.png`) });
    }
    await page.setViewportSize({ width: 1280, height: 720 });
  },

  'a player that is killed leaves a page that says so': async ({ page, player, pageErrors }) => {
    await player.end('SIGKILL');
    await page.waitForSelector('#take', { state: 'hidden' });
    await banner(page, 'waiting for sim_node');
    assert.deepEqual([await viz(page, 'errors'), pageErrors], [[], []]);
  },
};

async function open() {
  const session = await Session.open();
  session.launcher = session.start('cordis', program('cordis'), ['run', launch, '--no-color', `domain=${session.domain}`, 'view.port=0']);
  await openPage(session, await session.launcher.says(/(http:\/\/127\.0\.0\.1:\d+)/));
  session.file = join(session.folder, 'take.mcap');
  session.recorder = session.start('record', program('cordis'), ['record', 'sounding_string', '-o', session.file, '--domain', session.domain]);
  return session;
}

await runCases(cases, open);
