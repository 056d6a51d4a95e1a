// tests/viz/sound_test.mjs -- the sound of the page without a browser: interpolation against closed
// forms, and a stream whose blocks arrive late, early, in bursts or never.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { lot, need, runCases, web } from './session.mjs';

const OUT_HZ = 48_000;
const QUANTUM = 128; // samples of one turn of an AudioWorklet
const AMPLITUDE = 0.5;
const FADE_SAMPLES = 0.005 * OUT_HZ;

/** The modules as a browser gets them. */
async function modules() {
  const { build } = need('esbuild');
  const folder = mkdtempSync(join(tmpdir(), 'cordis-sound-'));
  const page = join(web, 'page');
  const names = ['sound/resampler', 'sound/sound_stream', 'sound/mix'];
  await build({ entryPoints: names.map((name) => join(page, `${name}.ts`)), outdir: folder, bundle: true, format: 'esm', outExtension: { '.js': '.mjs' } });
  const load = (name) => import(pathToFileURL(join(folder, `${name.split('/')[1]}.mjs`)));
  const [resampler, stream, mix] = await Promise.all(names.map(load));
  rmSync(folder, { recursive: true });
  return { ...resampler, ...stream, ...mix };
}
const { Resampler, SoundStream, limited, mixed } = await modules();

const sine = (hz, rateHz, step) => AMPLITUDE * Math.sin((2 * Math.PI * hz * step) / rateHz);

/** Largest difference between a sine and what is read of its samples [dB of its amplitude]. */
function error_db(hz, inHz, outHz, expected = (timeS) => AMPLITUDE * Math.sin(2 * Math.PI * hz * timeS)) {
  const resampler = new Resampler(inHz, outHz);
  const ring = Float32Array.from({ length: 2 ** 15 }, (_, step) => sine(hz, inHz, step));
  let largest = 0;
  for (let i = 0; i < 4000; ++i) {
    const place = resampler.reach + 1 + (i * inHz) / outHz;
    if (place > ring.length - resampler.reach - 2) break;
    const first = Math.floor(place);
    largest = Math.max(largest, Math.abs(resampler.valueAt(ring, first, place - first) - expected(place / inHz)));
  }
  return 20 * Math.log10(largest / AMPLITUDE);
}

/**
 * Plays blocks into a stream. blocks: {atS, firstStep, samples, rateHz} in the order of their arrival, by the clock of the listener.
 * Gives all that was heard, and the figures after each turn.
 */
function play(blocks, lengthS) {
  const stream = new SoundStream(OUT_HZ);
  const heard = new Float32Array(Math.floor((lengthS * OUT_HZ) / QUANTUM) * QUANTUM);
  const figures = [];
  let next = 0;
  for (let i = 0; i < heard.length; i += QUANTUM) {
    const nowS = i / OUT_HZ;
    while (next < blocks.length && blocks[next].atS <= nowS) stream.push(blocks[next++], nowS);
    stream.read(heard.subarray(i, i + QUANTUM), nowS);
    figures.push({ nowS, ...stream.figures });
  }
  return { heard, figures, last: figures.at(-1) };
}

/** A sine in blocks of 8 ms, sent on time by a clock that is `drift` too fast, arriving `delay()` later, never out of order. */
function sent({ hz = 440, rateHz = 44_100, drift = 0, delay = () => 0, fromS = 0, toS, firstStep = 0, speed = 1 }) {
  const length = Math.round(0.008 * rateHz);
  const blocks = [];
  for (let atS = fromS, step = firstStep, arrivedS = 0; atS < toS; atS += length / rateHz / (1 + drift) / speed, step += length) {
    arrivedS = Math.max(arrivedS, atS + delay());
    blocks.push({ atS: arrivedS, firstStep: step, rateHz, samples: Float32Array.from({ length }, (_, i) => sine(hz, rateHz, step + i)) });
  }
  return blocks;
}

/** The largest second difference of a sine of 440 Hz that fades in 5 ms; the least click has one ten times as large. */
const omega = (2 * Math.PI * 440 * 1.003) / OUT_HZ;
const slope = Math.PI / 2 / FADE_SAMPLES;
const SMOOTH = 1.05 * AMPLITUDE * (omega ** 2 + 2 * omega * slope + Math.PI * slope / FADE_SAMPLES) + 1e-4;

function roughness(heard) {
  let largest = 0;
  for (let i = 2; i < heard.length; ++i) largest = Math.max(largest, Math.abs(heard[i] - 2 * heard[i - 1] + heard[i - 2]));
  return largest;
}

const loudness = (heard, fromS, toS) => {
  const part = heard.subarray(Math.floor(fromS * OUT_HZ), Math.floor(toS * OUT_HZ));
  return Math.sqrt(part.reduce((sum, x) => sum + x * x, 0) / part.length);
};
const LOUD = AMPLITUDE / Math.SQRT2;

/** Frequency of a sound near `hz` between two times, by its phase in windows of 0.1 s. */
function frequency(heard, hz, fromS, toS) {
  const window = 0.1 * OUT_HZ;
  const phases = [];
  for (let begin = Math.floor(fromS * OUT_HZ); begin + window <= toS * OUT_HZ; begin += window) {
    let [re, im] = [0, 0];
    for (let i = 0; i < window; ++i) {
      const hann = 0.5 - 0.5 * Math.cos((2 * Math.PI * i) / window);
      re += hann * heard[begin + i] * Math.cos((2 * Math.PI * hz * (begin + i)) / OUT_HZ);
      im -= hann * heard[begin + i] * Math.sin((2 * Math.PI * hz * (begin + i)) / OUT_HZ);
    }
    const phase = Math.atan2(im, re);
    const last = phases.at(-1) ?? phase;
    phases.push(phase - 2 * Math.PI * Math.round((phase - last) / (2 * Math.PI)));
  }
  return hz + (phases.at(-1) - phases[0]) / (2 * Math.PI) / (0.1 * (phases.length - 1));
}
const cents = (a, b) => 1200 * Math.log2(a / b);

const cases = {
  'a sine is read between its samples, at any pair of rates': () => {
    for (const [hz, inHz, outHz] of [[110, 44_100, 48_000], [440, 44_100, 48_000], [15_000, 44_100, 48_000], [440, 48_000, 44_100], [7_000, 20_000, 48_000], [300, 1_000, 48_000], [15_000, 100_000, 48_000]]) {
      const error = error_db(hz, inHz, outHz);
      console.log(`  ${hz} Hz, ${inHz} to ${outHz}: ${error.toFixed(1)} dB`);
      assert.ok(error < -80, `${hz} Hz, ${inHz} to ${outHz}: ${error} dB`);
    }
  },

  'what is above hearing at the lower rate is not heard as another tone': () => {
    for (const hz of [24_500, 30_000, 45_000]) {
      const left = error_db(hz, 100_000, 48_000, () => 0);
      console.log(`  ${hz} Hz: ${left.toFixed(1)} dB`);
      assert.ok(left < -80, `${hz} Hz: ${left} dB`);
    }
  },

  'blocks that arrive up to 25 ms late make a steady tone, by a clock that is right or 300 ppm off': () => {
    for (const drift of [0, 3e-4, -3e-4]) {
      const draw = lot(7);
      const { heard, figures, last } = play(sent({ toS: 61, drift, delay: () => 0.025 * draw() }), 60);
      assert.equal(last.dropouts, 0);
      assert.ok(roughness(heard) < SMOOTH, `rough: ${roughness(heard)}, of ${SMOOTH}`);
      const buffers = figures.filter(({ nowS }) => nowS > 1).map(({ bufferS }) => bufferS);
      assert.ok(Math.min(...buffers) > 0.02 && Math.max(...buffers) < 0.1, `buffer ${Math.min(...buffers)} to ${Math.max(...buffers)} s`);
      // Second for second, as an ear hears it.
      const off = [];
      for (let s = 40; s < 60; ++s) off.push(Math.abs(cents(frequency(heard, 440, s, s + 1), 440 * (1 + drift))));
      console.log(`  drift ${drift * 1e6} ppm: ${Math.max(...off).toFixed(3)} cents, ${(1e6 * (last.ratio - 1)).toFixed(0)} ppm, roughness ${roughness(heard).toFixed(5)} of ${SMOOTH.toFixed(5)}`);
      assert.ok(Math.max(...off) < 1, `${Math.max(...off)} cents off`);
      assert.ok(Math.abs(last.ratio - 1 - drift) < 1e-4, `followed to ${last.ratio}`);
    }
  },

  'a machine that stops for 0.3 s costs one dropout, which fades': () => {
    const late = sent({ toS: 8 }).map((block) => (block.atS > 4 && block.atS < 4.3 ? { ...block, atS: 4.3 } : block));
    const { heard, last } = play(late, 8);
    assert.equal(last.dropouts, 1);
    assert.equal(last.state, 'playing');
    assert.ok(roughness(heard) < SMOOTH, `rough: ${roughness(heard)}`);
    assert.ok(last.targetS > 0.06 && last.targetS <= 0.18, 'the next stop finds a fuller buffer');
    assert.ok(loudness(heard, 6, 8) > 0.99 * LOUD);
  },

  'after a stop of 0.6 s the delay is bounded': () => {
    const late = sent({ toS: 12 }).map((block) => (block.atS > 4 && block.atS < 4.6 ? { ...block, atS: 4.6 } : block));
    const { heard, figures } = play(late, 12);
    assert.ok(roughness(heard) < SMOOTH);
    assert.ok(figures.filter(({ nowS }) => nowS > 5).every(({ bufferS }) => bufferS < 0.06 + 0.25 + 0.02));
  },

  'on a machine that stops again and again the pitch stays within 5 cents wherever it is heard without a gap': () => {
    for (const longestS of [0.05, 0.1, 0.3]) {
      const draw = lot(11);
      const stops = []; // half of the time
      for (let atS = 0; atS < 20; atS += 2 * longestS) stops.push([atS + longestS * draw(), atS + longestS * (1 + draw())]);
      const arrival = (atS) => stops.find(([from, to]) => from <= atS && atS < to)?.[1] ?? atS;
      const { heard, figures, last } = play(sent({ toS: 20 }).map((block) => ({ ...block, atS: arrival(block.atS) })), 20);
      assert.ok(roughness(heard) < SMOOTH, `rough: ${roughness(heard)}`);
      let [stretches, worst] = [0, 0];
      figures.forEach(({ nowS, steadyS }, i) => {
        if (steadyS < 0.3 || i % 30 !== 0) return;
        ++stretches;
        worst = Math.max(worst, Math.abs(cents(frequency(heard, 440, nowS - 0.3, nowS), 440)));
      });
      console.log(`  stops of up to ${longestS} s: ${last.dropouts} dropouts, ${stretches} stretches, ${worst.toFixed(2)} cents at worst`);
      assert.ok(worst < 5.3, `${worst} cents`);
      assert.ok(longestS > 0.1 || stretches > 50, `${stretches} stretches`);
    }
  },

  'a pause is silent, fades, and is no dropout': () => {
    const { heard, figures, last } = play([...sent({ toS: 3 }), ...sent({ fromS: 5, toS: 8, firstStep: 132_385 })], 8);
    assert.equal(last.dropouts, 0);
    assert.ok(roughness(heard) < SMOOTH, `rough: ${roughness(heard)}`);
    assert.equal(loudness(heard, 3.2, 5), 0);
    assert.equal(figures.find(({ nowS }) => nowS > 4.5).state, 'paused');
    assert.ok(loudness(heard, 5.2, 8) > 0.99 * LOUD);
  },

  'a take that is moved forth and back is heard at once, and nothing counts as lost': () => {
    const blocks = [...sent({ toS: 3 }), ...sent({ fromS: 3, toS: 5, firstStep: 2_000_000 }), ...sent({ fromS: 5, toS: 7, firstStep: 900 })];
    const { heard, last } = play(blocks, 7);
    assert.deepEqual([last.dropouts, last.lostS], [0, 0]);
    assert.ok(roughness(heard) < SMOOTH, `rough: ${roughness(heard)}`);
    for (let s = 0.5; s < 6.5; s += 0.25) assert.ok(loudness(heard, s, s + 0.25) > 0.9 * LOUD, `from ${s} s`);
  },

  'how long it is heard without a gap begins again with each dropout, each lost block and each pause': () => {
    const gapS = { dropout: 4, loss: 6, pause: 8 };
    const late = sent({ toS: 8 }).map((block) => (block.atS > gapS.dropout && block.atS < 4.3 ? { ...block, atS: 4.3 } : block));
    const blocks = [...late.filter(({ atS }) => atS < 6 || atS > 6.04), ...sent({ fromS: 9, toS: 11, firstStep: 8 * 44_100 + 211 })];
    const { heard, figures } = play(blocks, 11);
    // Against what is heard: where it was loud all the time.
    const isLoud = Array.from({ length: heard.length / QUANTUM }, (_, i) => loudness(heard, (i * QUANTUM - 400) / OUT_HZ, ((i + 1) * QUANTUM) / OUT_HZ) > 0.8 * LOUD);
    const breaks = [];
    figures.forEach(({ steadyS, nowS }, i) => {
      const turns = Math.round((steadyS * OUT_HZ) / QUANTUM);
      for (let k = 4; k < turns; ++k) assert.ok(isLoud[i - turns + 1 + k], `at ${nowS} s it says ${steadyS} s, but there is a gap`);
      if (i > 0 && steadyS === 0 && figures[i - 1].steadyS > 0) breaks.push(nowS);
    });
    assert.equal(breaks.length, 3, `${breaks}`);
    Object.values(gapS).forEach((s, i) => assert.ok(breaks[i] > s - 0.01 && breaks[i] < s + 0.4, `${breaks}`));
    assert.ok(figures.at(-1).steadyS > 1.7, `${figures.at(-1).steadyS}`);
    assert.ok(figures.find(({ nowS }) => nowS > 3.9).steadyS > 3.6);
  },

  'a listener that stops for two seconds goes on with what is left, as after a gap': () => {
    const stream = new SoundStream(OUT_HZ);
    const turn = new Float32Array(QUANTUM);
    let nowS = 0;
    for (const block of sent({ toS: 4 })) {
      for (; nowS < block.atS; nowS += QUANTUM / OUT_HZ) if (block.atS < 1 || block.atS > 3) stream.read(turn, nowS);
      if (block.atS > 3 && block.atS < 3.01) assert.ok(stream.figures.steadyS < 0.1, `${stream.figures.steadyS} s without a gap`);
      if (block.atS > 0.9 && block.atS < 1) assert.ok(stream.figures.steadyS > 0.7);
      stream.push(block, nowS);
    }
    assert.equal(stream.figures.state, 'playing');
  },

  'lost blocks fade out and in, and are counted': () => {
    const blocks = sent({ toS: 4 }).filter((_, i) => i < 200 || i >= 205);
    const { heard, last } = play(blocks, 4);
    assert.equal(last.dropouts, 0);
    assert.ok(Math.abs(last.lostS - (5 * 353) / 44_100) < 1e-9, `${last.lostS} s`);
    assert.ok(roughness(heard) < SMOOTH, `rough: ${roughness(heard)}`);
  },

  'a scene that restarts, and another one with another rate, begin without a click': () => {
    const blocks = [...sent({ toS: 2 }), ...sent({ fromS: 2, toS: 4 }), ...sent({ fromS: 4.01, toS: 7, rateHz: 20_000 }), ...sent({ fromS: 7.01, toS: 9, rateHz: 96_000 })];
    const { heard, last } = play(blocks, 9);
    assert.ok(roughness(heard) < SMOOTH, `rough: ${roughness(heard)}`);
    assert.equal(last.state, 'playing');
    for (const [fromS, toS] of [[1, 1.9], [3, 3.9], [5, 6.9], [8, 8.9]]) assert.ok(loudness(heard, fromS, toS) > 0.99 * LOUD, `from ${fromS} s`);
    assert.ok(Math.abs(cents(frequency(heard, 440, 8, 8.9), 440)) < 6, 'within what the clock follower may bend');
  },

  'a slow step rate plays as well': () => {
    const { heard, last } = play(sent({ hz: 20, rateHz: 300, toS: 6 }), 6);
    assert.deepEqual([last.dropouts, last.state], [0, 'playing']);
    assert.ok(loudness(heard, 1, 6) > 0.99 * LOUD);
    assert.ok(roughness(heard) < SMOOTH);
  },

  'a scene slower or faster than real time is silent, not noise': () => {
    for (const speed of [0.5, 0.9, 2]) {
      const { heard, last } = play(sent({ toS: 8, speed }), 8);
      assert.equal(last.state, 'off rate');
      assert.ok(Math.abs(last.sceneRate - speed) < 0.01, `${last.sceneRate}`);
      assert.equal(loudness(heard, 3, 8), 0);
      assert.ok(roughness(heard) < SMOOTH, `rough: ${roughness(heard)}`);
    }
  },

  'values that are not numbers are silence, and loud ones stay below 1': () => {
    const bad = sent({ toS: 2 });
    for (const block of bad) block.samples[5] = Number.NaN;
    assert.ok(play(bad, 2).heard.every(Number.isFinite));
    assert.equal(limited(0.7), 0.7);
    assert.equal(limited(-0.3), -0.3);
    for (let x = 0; x < 50; x += 0.1) assert.ok(limited(x) <= 1 && limited(-x) >= -1 && limited(x + 0.1) >= limited(x), `${x}`);
  },

  'all sounds are mixed, each by its full scale': () => {
    const sound = { firstStep: 7, stepRateHz: 1000, soundCount: 2, stepCount: 3, values: Float32Array.of(1, 10, 2, 20, 3, -30) };
    const block = mixed(sound, [4, 100]);
    assert.deepEqual([block.firstStep, block.rateHz], [7, 1000]);
    assert.deepEqual([...block.samples], [0.35, 0.7, 0.45].map(Math.fround));
  },
};

await runCases(cases, async () => ({ logs: () => '' }));
