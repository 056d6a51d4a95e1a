// tests/viz/page_parts_test.mjs -- parts of the page without a browser: forces from motion, colours
// against both backgrounds, keys of a keyboard. Random inputs.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { lot, need, runCases, source, web } from './session.mjs';

const RUNS = 300;
const MIN_CONTRAST = 3; // WCAG 2.1, 1.4.11
const ROUNDING = 2 ** -23; // of a float32

/** The modules as a browser gets them. */
async function modules() {
  const { build } = need('esbuild');
  const folder = mkdtempSync(join(tmpdir(), 'cordis-parts-'));
  const names = ['net_forces', 'colouring', 'format', 'colours', 'keyboards', 'key_marks', 'link_groups', 'refusal', 'signal_store', 'slow_motion', 'stale_reply', 'surface_shape'];
  await build({ entryPoints: names.map((name) => join(web, 'page', `${name}.ts`)), outdir: folder, bundle: true, format: 'esm', outExtension: { '.js': '.mjs' } });
  const loaded = await Promise.all(names.map((name) => import(pathToFileURL(join(folder, `${name}.mjs`)))));
  rmSync(folder, { recursive: true });
  return Object.assign({}, ...loaded);
}
const { NetForces, contrast, readable, keyboardsOf, depthOf, halfWidthOf, LinkGroups, BondGroups, SignalStore, canBeSlowed, refusalOf, isStale, timeScaleOf, shapesOf, stateName, percentOf, withUnit, joined } = await modules();
const palettes = JSON.parse(readFileSync(join(source, 'viz_node/colours.json'), 'utf8'));

/** Two times of a frame to the next, as frames come, with some left out. */
const someSteps = (random) => [0.04 * Math.ceil(3 * random()), 0.04 * Math.ceil(3 * random())];

const cases = {
  'the net force on a mass under a constant force is that force, however far apart the frames are': () => {
    const random = lot(1);
    for (let run = 0; run < RUNS; ++run) {
      const mass = Math.fround(0.001 + random());
      const acceleration = [0, 1, 2].map(() => 20 * (random() - 0.5));
      const velocity = [0, 1, 2].map(() => random() - 0.5);
      const [h1, h2] = someSteps(random);
      const forces = new NetForces(Float32Array.of(0, mass));
      const placesAt = (t) => Float32Array.from([0, 0, 0, ...velocity.map((v, k) => v * t + (acceleration[k] * t * t) / 2)]);
      [0, h1, h1 + h2].forEach((t) => forces.append(placesAt(t), t));
      const farthest = Math.max(...[0, h1, h1 + h2].flatMap((t) => [...placesAt(t)].map(Math.abs)));
      forces.of(1).forEach((force, k) => {
        const room = (8 * mass * farthest * ROUNDING) / Math.min(h1, h2) ** 2;
        assert.ok(Math.abs(force - mass * acceleration[k]) <= room, `run ${run}: ${force} N, wanted ${mass * acceleration[k]}`);
      });
      assert.equal(forces.of(0), null, 'what has no mass has no net force');
      const sizes = new Float32Array(2);
      assert.equal(forces.sizesOfAll(sizes), true);
      const wanted = Math.hypot(...forces.of(1));
      assert.ok(Number.isNaN(sizes[0]) && Math.abs(sizes[1] - wanted) <= 1e-5 * wanted, `${sizes}, wanted ${wanted} N`);
    }
  },

  'rows that come at whole steps fill the window, with what was lost as gaps': () => {
    const random = lot(7);
    for (let run = 0; run < 40; ++run) {
      const stepHz = 4000 + 40_000 * random(); // no multiple of the 1000 rows a second
      const timeOf = (row) => Math.ceil((row * stepHz) / 1000) / stepHz;
      const store = new SignalStore(1, 1000);
      let next = 0;
      let lost = 0;
      while (next < 25_000) {
        const rowCount = 2 + Math.floor(random() < 0.1 ? 200 * random() : 40);
        const values = Float32Array.from({ length: rowCount }, (_, n) => next + n);
        const rowPeriodS = (timeOf(next + rowCount - 1) - timeOf(next)) / (rowCount - 1);
        store.append({ signalCount: 1, rowCount, firstS: timeOf(next), rowPeriodS, values });
        next += rowCount;
        const gap = random() < 0.02 ? Math.ceil(50 * random()) : 0;
        next += gap;
        if (next < 25_000) lost += gap;
      }
      assert.equal(store.gaps, lost, `run ${run}, ${stepHz} steps a second`);
      assert.ok(store.rowCount >= 20_000, `run ${run}: ${store.rowCount} rows`);
      for (const [time, value] of store.rows([0], 20, store.newestS, 1e9)) {
        if (!Number.isNaN(value)) assert.ok(Math.abs(time - timeOf(value)) <= 2 / stepHz, `run ${run}: row ${value} at ${time} s, not ${timeOf(value)}`);
      }
    }
  },

  'the reason why a device gets no force is an alarm, and how late its answers are is none': () => {
    const stiff = "port 'key' is as stiff as 3100 N/m, and the device 'hand' supports 1001 N/m: driver kfb1 is given no force";
    const far = "port 'key' needs an answer within 9796 us, and the device 'hand' runs on another host";
    const late = "the answers to the device 'hand' take 1.208 periods, and it supports 703 N/m";
    assert.deepEqual(refusalOf({ state: 'waiting', text: stiff }), ['a device gets no force', `${stiff}.`]);
    assert.deepEqual(refusalOf({ state: 'running', text: `${stiff}; 1/4 of real time` })?.[0], 'a device gets no force', 'another one plays');
    assert.deepEqual(refusalOf({ state: 'waiting', text: far }), ['a device gets no force', `${far}.`]);
    assert.deepEqual(refusalOf({ state: 'disconnected', text: 'the scene makes energy' }), ['the devices are let go of', 'the scene makes energy.']);
    assert.equal(refusalOf({ state: 'running', text: late }), null);
    assert.equal(refusalOf({ state: 'waiting', text: '' }), null);
    assert.equal(refusalOf(undefined), null);
  },

  'a reply that another command has made untrue is stale': () => {
    assert.ok(isStale('paused at step 12', true, false));
    assert.ok(isStale("'wall' restarts, paused", true, false));
    assert.ok(isStale('goes on at step 12', false, true));
    assert.ok(!isStale('paused at step 12', false, true), 'the pause is shown after its reply');
    assert.ok(!isStale('goes on at step 12', true, false));
    assert.ok(!isStale('paused at step 12', true, true));
    assert.ok(!isStale('sim_node does not answer', true, false));
  },

  'of a vibration it is the mean that a triangle weighs': () => {
    const random = lot(2);
    for (let run = 0; run < RUNS; ++run) {
      const pulsation = 0.5 + 30 * random();
      const phase = 6 * random();
      const h = 0.04;
      const forces = new NetForces(Float32Array.of(1));
      [0, h, 2 * h].forEach((t) => forces.append(Float32Array.of(0, Math.cos(pulsation * t + phase), 0), t));
      // The integral of -w^2 cos(w t + p) times the triangle over 0..2h: -w^2 cos(w h + p) sinc(w h / 2)^2.
      const sinc = Math.sin((pulsation * h) / 2) / ((pulsation * h) / 2);
      const wanted = -(pulsation ** 2) * Math.cos(pulsation * h + phase) * sinc ** 2;
      assert.ok(Math.abs(forces.of(0)[1] - wanted) < (8 * ROUNDING) / h ** 2, `run ${run}: ${forces.of(0)[1]} N, wanted ${wanted}`);
    }
  },

  'frames that are single steps apart show no rounding of their places': () => {
    const random = lot(4);
    for (let run = 0; run < RUNS; ++run) {
      const [mass, stepS] = [0.001, 1 / (2000 + 98000 * random())];
      const acceleration = 20 * (random() - 0.5);
      const [place, velocity] = [0.6 * (random() - 0.5), random() - 0.5];
      const forces = new NetForces(Float32Array.of(mass));
      const placesAt = (t) => Float32Array.of(0, place + velocity * t + (acceleration * t * t) / 2, 0);
      for (let step = 0; step * stepS < 0.006; ++step) forces.append(placesAt(step * stepS), step * stepS);
      const force = forces.of(0)?.[1] ?? Number.NaN;
      // Four roundings of places below 0.5 m, over intervals of 1 ms.
      assert.ok(Math.abs(force - mass * acceleration) <= (4 * mass * 0.5 * ROUNDING) / 1e-3 ** 2, `run ${run}: ${force} N, wanted ${mass * acceleration}`);
      assert.ok(forces.spanS >= 2e-3 && forces.spanS < 4e-3, `mean over ${forces.spanS} s`);
    }
  },

  'a page keeps few frames, however near they are': () => {
    const forces = new NetForces(Float32Array.of(1));
    for (let step = 0; step < 5000; ++step) forces.append(new Float32Array(3), step / 44100);
    assert.ok(forces.kept.length <= 12, `${forces.kept.length} frames`);
  },

  'nothing is said of a force before the third frame, nor across a jump back': () => {
    const forces = new NetForces(Float32Array.of(1));
    const frame = Float32Array.of(0, 0, 0);
    for (const [timeS, isKnown] of [[1, false], [1.04, false], [1.08, true], [0.2, false], [0.24, false], [0.28, true]]) {
      forces.append(frame, timeS);
      assert.equal(forces.of(0) !== null, isKnown, `at ${timeS} s`);
    }
  },

  'every colour of a scene is seen on both backgrounds, and one that is seen stays': () => {
    const random = lot(3);
    const anyByte = () => Math.floor(256 * random()).toString(16).padStart(2, '0');
    const colours = ['#000000', '#ffffff', '#ffff00', '#0000ff', ...Array.from({ length: RUNS }, () => `#${anyByte()}${anyByte()}${anyByte()}`)];
    for (const palette of [palettes.dark, palettes.light]) {
      for (const wanted of colours) {
        const shown = readable(wanted, palette);
        assert.ok(contrast(shown, palette.background) >= MIN_CONTRAST, `${wanted} is shown as ${shown}`);
        if (contrast(wanted, palette.background) >= MIN_CONTRAST) assert.equal(shown, wanted);
      }
    }
  },

  'page and renderer show the same colours': () => {
    // tests/render/palette_test.cpp has the same table.
    const { shown } = JSON.parse(readFileSync(join(source, 'tests/golden/readable_colours.json'), 'utf8'));
    for (const { wanted, dark, light } of shown) {
      assert.deepEqual([readable(wanted, palettes.dark), readable(wanted, palettes.light)], [dark, light], wanted);
    }
  },

  'the contrast of black and white is 21': () => {
    assert.ok(Math.abs(contrast('#000000', '#ffffff') - 21) < 1e-9);
    assert.equal(contrast('#123456', '#123456'), 1);
  },

  'slow motion is for realtime sessions that play no real device': () => {
    const sim = { kind: 'sim_node', target_rate_hz: 1000 };
    const scene = { gesture_rate_hz: 1000, ports: [{ device: 'keys' }] };
    const devices = (simulated) => [{ name: 'keys', simulated }, { name: 'faders', simulated: false }];
    assert.ok(canBeSlowed(sim, scene, devices(true)), 'a real device that the scene does not play is no matter');
    assert.ok(!canBeSlowed(sim, scene, devices(false)));
    assert.ok(!canBeSlowed(sim, scene, [...devices(true), { name: 'keys', simulated: false }]), 'nor one on standby');
    assert.ok(!canBeSlowed({ ...sim, target_rate_hz: 0 }, scene, devices(true)), 'lockstep and asap have no pace');
    assert.ok(!canBeSlowed({ ...sim, kind: 'player' }, scene, devices(true)));
    assert.ok(!canBeSlowed(undefined, scene, []) && !canBeSlowed(sim, null, []));
    assert.equal(timeScaleOf({ ...sim, target_rate_hz: 10 }, scene), 0.01);
    for (const other of [undefined, sim, { ...sim, target_rate_hz: 0 }, { ...sim, target_rate_hz: null }]) assert.equal(timeScaleOf(other, scene), 1);
    assert.equal(timeScaleOf(sim, null), 1);
  },

  'a keyboard has the keys of its device, and those that play ports are as deep as their MATs': () => {
    const port = (name, device, axes) => ({ name, device, role: 'mass', mat: 7, axes, rest: [1, 2, 3], direction: [0, 0, 1] });
    const ports = [port('low', 'keys', [1]), port('thimble', 'hand', [0])];
    const devices = [
      { name: 'keys', key_pitch_m: 0.01375, lowest_m: 0, travel_m: [0.02, 0.03, 0] },
      { name: 'hand', key_pitch_m: 0, lowest_m: -0.1, travel_m: [0, 0, 0] },
      { name: 'other', key_pitch_m: 0.02, lowest_m: -0.01, travel_m: [0] },
    ];
    const list = keyboardsOf({ ports }, devices);
    assert.deepEqual(list.map(({ name, pitchM }) => [name, pitchM]), [['keys', 0.01375]], 'thimbles are no keys, nor is what plays nothing');
    const [{ keys }] = list;
    assert.deepEqual(keys.map(({ port: name, wayM }) => [name, wayM]), [['', 0.01], ['low', 0.015], ['', 0.005]]);
    assert.ok(Math.abs(depthOf(keys[1], [9, 9, 2.99]) - 0.01) < 1e-12);
  },

  'one liaison with other parameters for some links looks alike, whatever other liaisons there are': () => {
    const random = lot(6);
    const machine = (name, ...states) => ({ name, states });
    const machines = [machine('copper', 'virgin', 'broken'), machine('glue', 'stuck'), machine('copper', 'virgin', 'broken'), machine('copper', 'other')];
    for (let run = 0; run < RUNS; ++run) {
      const stateMachines = Uint16Array.from({ length: 40 }, () => Math.floor(4 * random()));
      const groups = new LinkGroups({ state_machines: machines }, { stateMachines, linkCount: 40 });
      const kinds = new Set([...stateMachines].map((number) => JSON.stringify(machines[number])));
      assert.equal(groups.list.length, kinds.size, 'a group for each name with its states');
      stateMachines.forEach((number, link) => {
        const { name, states } = groups.of(link);
        assert.deepEqual({ name, states }, machines[number]);
      });
    }
  },

  'bonds of each liaison of sets have a pattern, and no state of the start': () => {
    const machine = (name, ...states) => ({ name, states });
    const machines = [machine('glue', 'apart', 'stuck'), machine('touch', 'apart', 'near'), machine('hook', 'held', 'free', 'gone'), machine('glue', 'apart', 'stuck')];
    const sets = [1, 0, 2, 3, 2].map((number, k) => ({ name: `set ${k}`, state_machine: number, start_state: k === 4 ? 1 : 0 }));
    const groups = new BondGroups({ state_machines: machines, sets });
    assert.deepEqual(groups.list.map(({ name, pattern, shown }) => [name, pattern, shown]), [
      ['touch', 0, [1]],
      ['glue', 1, [1]],
      ['hook', 2, [1, 2, 0]],
    ]);
    assert.deepEqual([0, 1, 2, 3, 4, 5].map((set) => groups.patternOf(set)), [0, 1, 2, 1, 2, 2]);
  },

  'a liaison whose only state has no name is called by its own': () => {
    assert.deepEqual([stateName('glue', 'stuck'), stateName('table', ''), stateName('', 'stuck')], ['glue: stuck', 'table', 'stuck']);
  },

  'a plane with both sides has two faces, or a line without hatches, and no other surface ends there': () => {
    const { Box3, Vector3 } = need('three');
    const home = new Box3(new Vector3(-0.2, -0.2, -0.2), new Vector3(0.2, 0.2, 0.2));
    const plane = (name, centre, axis) => ({ name, mat: 0, kind: 'plane', centre, axis, size: [] });
    const floor = plane('floor', [0, -0.1, 0], [0, 1, 0]);
    const wall = plane('wall', [0, 0, 0], [1, 0, 0]);
    const both = [wall, { ...wall, kind: 'inner_face', axis: [] }, floor];
    const [two, none, ground] = shapesOf(both, home, 3);
    assert.deepEqual(two.faces.map(({ normal }) => normal.x), [1, -1]);
    assert.deepEqual(two.faces[1].corners.map(({ z }) => z), two.faces[0].corners.map(({ z }) => z).reverse());
    assert.equal(none.faces.length + none.edges.length, 0);
    assert.ok(Math.min(...ground.faces[0].corners.map(({ x }) => x)) < -0.2, 'the floor goes on behind the wall');
    const bounded = shapesOf([wall, floor], home, 3)[1];
    assert.equal(Math.min(...bounded.faces[0].corners.map(({ x }) => x)), 0);
    const flat = shapesOf(both, home, 2);
    assert.equal(flat[0].edges.length, 1);
    assert.ok(flat[2].edges.length > 10, 'with hatches');
  },

  'a share is read again from its percent, to two digits': () => {
    const random = lot(6);
    for (let run = 0; run < RUNS; ++run) {
      const share = 10 ** (10 * random() - 8); // from a millionth of a percent to 10,000 %
      const text = percentOf(share);
      assert.match(text, /^[\d.]+(e-\d+)? %$/);
      assert.ok(Math.abs(Number.parseFloat(text) / (100 * share) - 1) <= 0.0501, `${text} of ${share}`);
    }
    assert.deepEqual([0, 0.005, 0.1, 0.26, 2.6].map(percentOf), ['0 %', '0.50 %', '10 %', '26 %', '260 %']);
  },

  'a value with its unit is read again, and what is next to nothing has no sign': () => {
    const factors = { G: 1e9, M: 1e6, k: 1e3, m: 1e-3, µ: 1e-6, n: 1e-9 };
    const random = lot(7);
    for (let run = 0; run < RUNS; ++run) {
      const value = (random() < 0.5 ? -1 : 1) * 10 ** (18 * random() - 8);
      const [, number, letter] = /^(-?[\d.]+)\u202f([GMkmµn]?)N$/.exec(joined(withUnit(value, 'N')));
      assert.ok(Math.abs((Number(number) * (factors[letter] ?? 1)) / value - 1) <= 0.00501, `${number} ${letter} of ${value}`);
    }
    assert.deepEqual([-1e-13, 0, -0, 1e-13].map((value) => withUnit(value, 'm')[0]), ['0.00', '0.00', '0.00', '0.00']);
  },

  'a key is as wide as its pitch, across its way': () => {
    const random = lot(5);
    for (let run = 0; run < RUNS; ++run) {
      const free = [0, 1, 2].map(() => random() - 0.5);
      const up = (run === 0 ? [0, 0, 1] : free).map((value, _, all) => value / Math.hypot(...all));
      const half = halfWidthOf(up, 0.02);
      assert.ok(Math.abs(Math.hypot(...half) - 0.01) < 1e-12, `${half}`);
      assert.ok(Math.abs(half.reduce((sum, value, k) => sum + value * up[k], 0)) < 1e-12, `${half} across ${up}`);
    }
  },
};

await runCases(cases, async () => ({ logs: () => "" }));
