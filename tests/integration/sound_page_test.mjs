// tests/integration/sound_page_test.mjs -- the page plays the sound of a scene: the string of
// launch_configs/sounding_string.yaml in real Chromium, with real sim_node, device_node and viz_node.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { drawn, openPage, ownName, replied, textOf, viz } from '../viz/browser.mjs';
import { need, out, program, runCases, Session, source, until } from '../viz/session.mjs';

const WebSocket = need('ws');

// The lowest mode of 100 masses between two fixed ends, under the scheme: launch_configs/scenes/sounding_string.yaml
const [STEP_HZ, STIFFNESS, MASS, MASSES] = [44_100, 24_687, 5e-5, 100];
const natural = 2 * Math.sqrt(STIFFNESS / MASS) * Math.sin(Math.PI / (2 * (MASSES + 1))); // [rad/s]
const NOTE_HZ = (STEP_HZ / Math.PI) * Math.asin(natural / (2 * STEP_HZ));
const QUIET_DB = -100;
const GESTURE_S = 6.5; // a little more than `repeat_s` of the launch file
const KEPT_S = 0.2; // sim_node keeps blocks of 0.25 s on their way
const LATE_S = 0.025; // the buffer holds 60 ms; what is later than this may empty it
const STALLED_S = 1; // no page plays sound that comes this late

/** A second listener, in a process of its own: what came, and how late it was at worst. */
class Listener {
  blocks = [];
  latestS = 0;
  #leastS = Number.POSITIVE_INFINITY;

  constructor(url) {
    this.socket = new WebSocket(url.replace('http', 'ws').replace('/?', '/live?'));
    this.opened = new Promise((resolve) => this.socket.on('open', resolve));
    this.socket.on('message', (data, isBinary) => {
      if (isBinary && data[5] === 4) this.#take(data);
    });
  }

  #take(data) {
    const [sounds, steps] = [data.readUInt32LE(12), data.readUInt32LE(16)];
    assert.deepEqual([data.length, sounds, data.readDoubleLE(32)], [48 + 4 * sounds * steps, 1, STEP_HZ]);
    const firstStep = Number(data.readBigUInt64LE(24));
    this.blocks.push({ firstStep, steps });
    const delayS = performance.now() / 1000 - (firstStep + steps) / STEP_HZ;
    this.#leastS = Math.min(this.#leastS, delayS);
    this.latestS = Math.max(this.latestS, delayS - this.#leastS);
  }

  listen(on) {
    this.socket.send(JSON.stringify({ type: 'sound', on }));
  }
}

const playing = (page) => until('sound is played', async () => (await viz(page, 'sound')).figures?.state === 'playing');
const spectrum = (page) => page.evaluate(() => window.viz.soundSpectrum());

/** What `wait` finds; nothing, and why, when the sound came too late to this process as well: by so much that no page plays it. */
async function unlessStalled(control, wait, tooLateS = STALLED_S) {
  try {
    return await wait();
  } catch (error) {
    if (control.latestS < tooLateS) throw error;
    console.log(`  skipped: this machine brings sound up to ${control.latestS.toFixed(1)} s late`);
    return null;
  }
}

/**
 * A spectrum of sound that was heard without a gap: two strokes of a tone with a dropout between them have the phase of two tones, and
 * a spectrum of both has its peak as much as two bins beside either. Null when there was a gap.
 */
async function wholeSpectrum(page) {
  const seen = await spectrum(page);
  const figures = async () => (await viz(page, 'sound')).figures;
  // Only figures of a later time say what was in the middle of the spectrum.
  const { nowS, steadyS } = await until('later figures come', async () => (await figures()).nowS >= seen.nowS && (await figures()));
  return steadyS >= seen.lengthS + nowS - seen.nowS ? seen : null;
}

/** Where the spectrum is highest between two frequencies [Hz, dB]. */
function peak({ binHz, levels }, fromHz, toHz) {
  let best = Math.ceil(fromHz / binHz);
  for (let bin = best; bin * binHz <= toHz; ++bin) if (levels[bin] > levels[best]) best = bin;
  return { hz: best * binHz, level: levels[best] };
}

const cases = {
  'sound comes to who asks for it, every block, and to no one else': async ({ url }) => {
    const listener = new Listener(url);
    await listener.opened;
    // Each block goes to all who asked before: what another one gets, this one would have got as well.
    const other = new Listener(url);
    await other.opened;
    other.listen(true);
    await until('20 blocks came to who asked', () => other.blocks.length >= 20);
    assert.equal(listener.blocks.length, 0);
    listener.listen(true);
    await until('100 blocks came', () => listener.blocks.length >= 100);
    listener.listen(false);
    for (const [i, block] of listener.blocks.slice(1).entries()) {
      const last = listener.blocks[i];
      const missing = block.firstStep - last.firstStep - last.steps;
      assert.ok(missing === 0 || (missing > 0 && listener.latestS > KEPT_S), `${missing} steps are missing`);
    }
    await until('what was on its way has come, and no more does', async () => {
      const [count, begin] = [listener.blocks.length, other.blocks.length];
      await until('20 more came to who listens still', () => other.blocks.length >= begin + 20);
      return listener.blocks.length === count;
    });
    for (const { socket } of [listener, other]) socket.terminate();
  },

  'a click plays the note of the string': async (session) => {
    const { page, url } = session;
    await page.waitForSelector('#sound:not([hidden])');
    assert.deepEqual([await viz(page, 'sound'), await spectrum(page)], [{ on: false, figures: null }, null]);
    await page.evaluate(() => {
      window.latestMs = 0;
      let last = performance.now();
      setInterval(() => {
        const now = performance.now();
        window.latestMs = Math.max(window.latestMs, now - last);
        last = now;
      }, 4);
    });
    session.control = new Listener(url);
    await session.control.opened;
    session.control.listen(true);

    await page.click('#sound-on');
    const found = await unlessStalled(session.control, async () => {
      await playing(page);
      return until('the note stands out in a stretch without a gap', async () => {
        const seen = await wholeSpectrum(page);
        if (seen === null) return false;
        const note = peak(seen, 80, 150);
        const beside = Math.max(peak(seen, 60, 95).level, peak(seen, 125, 150).level);
        return note.level > -60 && note.level > beside + 15 && { ...note, binHz: seen.binHz };
      });
    }, LATE_S);
    if (!found) return;
    console.log(`  ${found.hz.toFixed(2)} Hz seen, ${NOTE_HZ.toFixed(2)} Hz expected, ${found.binHz.toFixed(2)} Hz a bin, ${found.level.toFixed(0)} dB`);
    assert.ok(Math.abs(found.hz - NOTE_HZ) <= found.binHz);
    await page.screenshot({ path: join(out, 'sound.png') });
  },

  'no sound is lost but where the machine stopped': async ({ page, control }) => {
    const begin = control.blocks.at(-1).firstStep;
    await until('the gesture was played once', () => control.blocks.at(-1).firstStep >= begin + GESTURE_S * STEP_HZ);
    const { dropouts, lostS, ratio, bufferS } = (await viz(page, 'sound')).figures;
    const lateS = Math.max(control.latestS, (await page.evaluate(() => window.latestMs)) / 1000);
    console.log(`  ${dropouts} dropouts, ${lostS} s lost, ${(1e6 * (ratio - 1)).toFixed(0)} ppm, buffer ${bufferS.toFixed(3)} s; the control was ${lateS.toFixed(3)} s late at worst`);
    assert.ok(dropouts === 0 || lateS > LATE_S, `${dropouts} dropouts, and the control was ${lateS} s late at worst`);
    assert.match(await textOf(page, '#sound-text'), /dropout|waiting|silent/);
    control.socket.terminate();
  },

  'a pause is silent, and what comes after it is heard': async ({ page, control }) => {
    const press = () => page.click('#control button[data-verb="pause"]');
    await press();
    await replied(page, /^paused at step \d+$/);
    await until('it says that no sound comes', async () => (await viz(page, 'sound')).figures.state === 'paused');
    await until('it is silent', async () => Math.max(...(await spectrum(page)).levels) < QUIET_DB);
    await press();
    await unlessStalled(control, async () => {
      await playing(page);
      await until('it is heard', async () => Math.max(...(await spectrum(page)).levels) > -60);
    });
  },

  'a scene that begins again is heard, and one more click ends it': async ({ page, control }) => {
    await page.click('#control button[data-verb="reset"]');
    await drawn(page, 5);
    await unlessStalled(control, () => playing(page));
    await page.click('#sound-on');
    await until('it is off', async () => !(await viz(page, 'sound')).on);
    await until('no sound comes', async () => (await viz(page, 'sound')).figures.state === 'paused');
  },

  'a page from elsewhere without https says why it is silent': async ({ browser, url }) => {
    const other = await browser.newPage();
    await other.goto(url.replace('127.0.0.1', ownName));
    await other.waitForSelector('#sound:not([hidden])');
    assert.equal(await other.evaluate(() => window.isSecureContext), false);
    await other.click('#sound-on');
    assert.match(await textOf(other, '#sound-text'), /localhost or over https only/);
    assert.equal((await viz(other, 'sound')).on, false);
    await other.close();
  },

  'nothing went wrong in the page': async ({ page, pageErrors }) => {
    assert.deepEqual([await viz(page, 'errors'), pageErrors], [[], []]);
  },
};

async function open() {
  const session = await Session.open();
  const words = ['run', join(source, 'launch_configs/sounding_string.yaml'), '--no-color', `domain=${session.domain}`];
  session.launcher = session.start('cordis', program('cordis'), [...words, 'view.port=0', 'view.address=0.0.0.0']);
  session.url = `http://127.0.0.1:${await session.launcher.says(/page of view: http:\/\/[^:\s]+:(\d+\/\?token=\S+)/)}`;
  await openPage(session, session.url);
  return session;
}

await runCases(cases, open);
