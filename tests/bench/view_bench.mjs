// tests/bench/view_bench.mjs -- what a view costs: viz_node with large scenes, and the tick of a
// sim_node before and after it attaches. node tests/bench/view_bench.mjs
// --viz-node build/release/bin/viz_node --scene-source build/release/bin/scene_source
// --web "$PWD/viz_node/web" --out /tmp/view_bench
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { need, pause, program, Session, until } from '../viz/session.mjs';

const WebSocket = need('ws');
const TICKS_PER_S = 100; // of /proc
const MEASURED_S = 10;
const FRAME = 1; // kind of a message, in its sixth byte
const TURNS = 4;

/** A client of the page's protocol that draws nothing. */
class Client {
  frames = 0;

  /** @param isStalled  it acknowledges nothing */
  constructor(url, isStalled = false) {
    this.socket = new WebSocket(`${url.replace('http', 'ws')}/live`);
    this.socket.on('error', () => {});
    this.socket.on('message', (data, isBinary) => {
      if (!isBinary || data[5] !== FRAME) return;
      ++this.frames;
      if (!isStalled) this.socket.send(JSON.stringify({ type: 'ack', sequence: data.readUInt32LE(8), drawn: true }));
    });
  }

  close() {
    this.socket.terminate();
  }
}

/** Processor time of a process or thread so far [s]: user and system. */
function processorTime(path) {
  const fields = readFileSync(join(path, 'stat'), 'utf8').replace(/^.*\) /, '').split(' ');
  return (Number(fields[11]) + Number(fields[12])) / TICKS_PER_S;
}

const memoryMb = (id) => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${id}/status`, 'utf8'))[1]) / 1024;

/** Share of a core that a process takes. */
async function share(id) {
  const [begin, at] = [processorTime(`/proc/${id}`), performance.now()];
  await pause(1000 * MEASURED_S);
  return (processorTime(`/proc/${id}`) - begin) / ((performance.now() - at) / 1000);
}

const percent = (value) => `${(100 * value).toFixed(1)} %`;

async function costOfFrames(mats) {
  const session = await Session.open();
  session.scene('--scene', 'grid', '--mats', String(mats));
  const view = session.viz();
  const url = await view.says(/page at (\S+)/);
  await pause(3000);
  const alone = await share(view.id);
  const client = new Client(url);
  await until('frames come', () => client.frames > 25);
  const begin = client.frames;
  const withOne = await share(view.id);
  const rate = (client.frames - begin) / MEASURED_S;
  const memory = memoryMb(view.id);
  const stalled = new Client(url, true);
  await pause(3000);
  const withStalled = await share(view.id);
  const after = memoryMb(view.id);
  console.log(`${mats} balls: without a page ${percent(alone)} of a core, one page at ${rate.toFixed(1)} frames/s ${percent(withOne)}`);
  console.log(`${mats} balls: with a stalled page beside it ${percent(withStalled)}, memory ${memory.toFixed(1)} MB before it and ${after.toFixed(1)} MB after ${MEASURED_S + 3} s`);
  client.close();
  stalled.close();
  await session.close();
}

/** The thread of a process that worked most since `before`, and for how long [s]. */
function loopTime(id, before) {
  const times = readdirSync(`/proc/${id}/task`).map((thread) => [thread, processorTime(`/proc/${id}/task/${thread}`)]);
  return times.map(([thread, time]) => [thread, time - (before?.get(thread) ?? 0)]).sort((a, b) => b[1] - a[1])[0];
}

async function costOfATick() {
  const session = await Session.open();
  const scene = join(session.folder, 'net.yaml');
  const matter =
    'net: {kind: grid, rows: 100, columns: 100, corner_m: [0, 0, 0], spacing_m: 0.01, plane: xz, border: fixed, mass_kg: 0.001, stiffness_n_per_m: 100, viscosity_n_s_per_m: 0.01}';
  writeFileSync(scene, `cordis: 1\nname: net\nspace: 3\nstep: {rate_hz: 1000, gesture_rate_hz: 1000}\nmatter:\n  ${matter}\n`);
  const file = join(session.folder, 'net_launch.yaml');
  writeFileSync(file, `cordis: 1\nsession: view_bench\ndomain: ${session.domain}\nclock: realtime\nnodes:\n  sim: {node: sim_node, scene: net.yaml, threads: 1}\n  view: {node: viz_node, port: 0}\n`);
  const sim = session.start('sim', program('sim_node'), [file, '--name', 'sim']);
  await pause(4000);
  const measure = async () => {
    const before = new Map(readdirSync(`/proc/${sim.id}/task`).map((thread) => [thread, processorTime(`/proc/${sim.id}/task/${thread}`)]));
    await pause(1000 * MEASURED_S);
    return loopTime(sim.id, before)[1] / MEASURED_S;
  };
  const rows = { without: [], with: [] };
  for (let turn = 0; turn < TURNS; ++turn) {
    rows.without.push(await measure());
    const view = session.vizOf(file);
    const client = new Client(await view.says(/page at (\S+)/));
    await until('frames come', () => client.frames > 5);
    rows.with.push(await measure());
    client.close();
    await view.end();
  }
  const text = (values) => values.map((value) => `${(1000 * value).toFixed(0)} us`).join(', ');
  const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;
  console.log(`a tick of 10,000 masses at 1 kHz, processor time of the loop: without a view ${text(rows.without)}; with one ${text(rows.with)}`);
  console.log(`ratio of the means ${(mean(rows.with) / mean(rows.without)).toFixed(3)}`);
  await session.close();
}

const wanted = process.env.CORDIS_VIEW_BENCH ?? 'frames tick';
if (wanted.includes('frames')) for (const mats of [10_000, 100_000]) await costOfFrames(mats);
if (wanted.includes('tick')) await costOfATick();
