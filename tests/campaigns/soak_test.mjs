// tests/campaigns/soak_test.mjs -- a session with recorder and page runs for long, while guests
// come and go: each process keeps its memory, files and threads, and the loops keep their time.
//
// CORDIS_SOAK_S seconds (30), CORDIS_SOAK_GUESTS_S from one round of guests to the next (5), CORDIS_SOAK_KEYS=1 with keys,
// CORDIS_SOAK_TABLE FILE for what was measured, one JSON object a line. The numbers of the samples of the devices pass 2^32 at half time.
import assert from 'node:assert/strict';
import { readdirSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { need, pause, program, runCases, Session, source, until } from '../viz/session.mjs';

const WebSocket = need('ws');

const SOAK_S = Number(process.env.CORDIS_SOAK_S ?? 30);
const HAS_KEYS = process.env.CORDIS_SOAK_KEYS === '1';
const TABLE = process.env.CORDIS_SOAK_TABLE;
const LAUNCH = join(source, 'launch_configs/plucked_string.yaml');
const NODES = ['sim', 'keyboard', 'pointer', 'view', 'record'];
const SAMPLES = 180; // of each process
const STEP_RATE_HZ = 4000; // of the scene
const SAMPLE_RATE_HZ = 1000; // of the devices
process.env.CORDIS_SAMPLES_BEFORE = String(2 ** 32 - Math.round((SAMPLE_RATE_HZ * SOAK_S) / 2));
// What a process may have taken in the meantime: pages that it touches for the first time, and per second the index of a take.
const FIRST_KIB = SOAK_S < 240 ? 3072 : 512; // most of them in the first minute
const KIB_PER_S = (name) => (name === 'record' ? 5 : 0.1);
const KIB_PER_GUEST = HAS_KEYS ? 80 : 1; // Fast DDS keeps this of each that had keys: docs/security.md
const GUESTS = 3; // in a round, each a participant
const GUESTS_S = Number(process.env.CORDIS_SOAK_GUESTS_S ?? 5); // from one round of guests to the next

/** The processes that the launcher started, by the name of their node. */
function processesOf(launcher) {
  const tasks = readdirSync(`/proc/${launcher}/task`);
  const children = tasks.flatMap((task) => readFileSync(`/proc/${launcher}/task/${task}/children`, 'utf8').split(' ').filter(Boolean));
  return Object.fromEntries(
    children.map((id) => [/\0--name\0([^\0]*)/.exec(readFileSync(`/proc/${id}/cmdline`, 'utf8'))?.[1], Number(id)]),
  );
}

/** What a process holds now. */
function held(id) {
  const status = readFileSync(`/proc/${id}/status`, 'utf8');
  const figure = (name) => Number(new RegExp(`^${name}:\\s*(\\d+)`, 'm').exec(status)[1]);
  return { kib: figure('VmRSS'), threads: figure('Threads'), files: readdirSync(`/proc/${id}/fd`).length };
}

/** A page that takes frames, and draws nothing. */
class Page {
  frames = 0;

  constructor(url) {
    this.socket = new WebSocket(`${url.replace('http', 'ws')}/live`);
    this.socket.on('error', () => {});
    this.socket.on('message', (data, isBinary) => {
      if (!isBinary || data[5] !== 1) return;
      ++this.frames;
      this.socket.send(JSON.stringify({ type: 'ack', sequence: data.readUInt32LE(8), drawn: true }));
    });
  }
}

/** The first message that `cordis echo` wrote. */
function messageOf(lines) {
  const all = JSON.parse(lines.split('\n').find((line) => line.startsWith('{')));
  return all.message ?? all.value ?? all;
}

/** A verb that joins the session, does one thing, and leaves. @returns what it wrote */
async function visit(session, ...words) {
  const guest = session.start(words.join(' '), program('cordis'), words);
  const code = await guest.ended;
  session.programs.splice(session.programs.indexOf(guest), 1);
  assert.equal(code, 0, `${words.join(' ')}\n${guest.log}`);
  return guest.log;
}

async function receiveGuests(session) {
  const { name, url } = session;
  while (!session.isOver) {
    const page = new Page(url);
    await visit(session, 'get', name, 'finger.stiffness_n_per_m', '--timeout', '60s');
    await visit(session, 'ctl', name, 'set', `finger.stiffness_n_per_m=${490 + (session.visits % 2)}`, '--timeout', '60s');
    await visit(session, 'echo', name, 'scene/frame', '-n', '1', '--format', 'ndjson');
    await until('a guest gets frames', () => page.frames > 5);
    page.socket.terminate();
    ++session.visits;
    await Promise.race([pause(GUESTS_S * 1000), session.end]);
  }
}

async function open() {
  const session = await Session.open();
  session.name = `soak-${session.domain}`;
  session.take = join(session.folder, 'take.mcap');
  const words = ['run', LAUNCH, '--no-color', `domain=${session.domain}`, `session=${session.name}`, 'view.port=0', '--record', session.take];
  if (HAS_KEYS) {
    const keys = join(session.folder, 'keys');
    await visit(session, 'keys', 'new', keys);
    words.push(`security=${keys}`);
  }
  session.launcher = session.start('cordis', program('cordis'), words);
  session.url = await session.launcher.says(/(http:\/\/127\.0\.0\.1:\d+)/);
  session.newest = {};
  session.echo = session.start('echo', program('cordis'), ['echo', session.name, 'node/status', '--format', 'ndjson']);
  createInterface({ input: session.echo.child.stdout }).on('line', (line) => {
    const said = messageOf(line);
    session.newest[said.node] = said;
    session.echo.log = '';
  });
  session.page = new Page(session.url);
  await until('every node has said that it runs', () => NODES.every((name) => name in session.newest));
  session.visits = 0;
  return session;
}

/** What was measured of each process, by its name, without the first quarter. */
function histories({ rows }) {
  const names = [...new Set(rows.map(({ name }) => name))];
  return names.map((name) => [name, rows.filter((row) => row.name === name && row.s > SOAK_S / 4)]);
}

const thirds = (rows, of) => [rows.slice(0, rows.length / 3), rows.slice((-rows.length / 3) | 0)].map((part) => part.map(of));

const cases = {
  'the session runs on with guests': async (session) => {
    session.end = pause(SOAK_S * 1000).then(() => (session.isOver = true));
    const guests = receiveGuests(session);
    guests.catch(() => (session.isOver = true)); // it is awaited below
    session.rows = [];
    const begin = Date.now();
    while (!session.isOver) {
      const processes = { ...processesOf(session.launcher.id), launcher: session.launcher.id, echo: session.echo.id };
      for (const [name, id] of Object.entries(processes)) {
        const { ticks, time_nsec, step, dropped, overruns } = session.newest[name] ?? {};
        session.rows.push({ s: (Date.now() - begin) / 1000, name, id, ...held(id), ticks, time_nsec, step, dropped, overruns });
      }
      if (TABLE) writeFileSync(TABLE, session.rows.map((row) => JSON.stringify(row)).join('\n') + '\n');
      await Promise.race([pause((SOAK_S * 1000) / SAMPLES), session.end]);
    }
    await guests;
    console.log(`  ${session.visits} rounds of guests, ${session.page.frames} frames at the page`);
    assert.ok(session.visits > 0);
  },

  'every process is the same, with as many threads and open files, and no more memory': async (session) => {
    const visits = session.visits * GUESTS;
    for (const [name, rows] of histories(session)) {
      const grown = rows.at(-1).kib - rows[0].kib;
      const files = thirds(rows, (row) => row.files);
      console.log(`  ${name}: ${rows.at(-1).kib} KiB, ${grown} more than at a quarter; ${rows.at(-1).threads} threads, ${rows.at(-1).files} files`);
      assert.equal(new Set(rows.map(({ id }) => id)).size, 1, `${name} is one process`);
      assert.equal(new Set(rows.map(({ threads }) => threads)).size, 1, `threads of ${name}`);
      assert.ok(Math.min(...files[1]) <= Math.max(...files[0]), `files of ${name}: ${files}`);
      const most = FIRST_KIB + KIB_PER_S(name) * SOAK_S + KIB_PER_GUEST * visits;
      assert.ok(grown < most, `${name} has grown by ${grown} KiB, more than ${most}`);
    }
  },

  'the loops go on': async (session) => {
    for (const [name, rows] of histories(session)) {
      const [first, last] = [rows[0], rows.at(-1)];
      if (first.ticks === undefined) continue;
      assert.ok(last.ticks > first.ticks, name);
      const wall = (last.time_nsec - first.time_nsec) / 1e9;
      const behind = name === 'sim' ? `, ${(wall - (last.step - first.step) / STEP_RATE_HZ).toFixed(3)} s of simulated time behind` : '';
      console.log(`  ${name}: ${last.ticks} ticks, ${last.dropped} dropped, ${last.overruns} late; in ${wall.toFixed(0)} s${behind}`);
    }
  },

  'a sample beyond 2^32 is answered': async (session) => {
    const forces = ['echo', session.name, 'gesture/forces', '-n', '1', '--format', 'ndjson'];
    await until('one is', async () => messageOf(await visit(session, ...forces)).answered_sample > 2 ** 32);
  },

  'Ctrl-C ends it, and the take is whole': async (session) => {
    assert.equal(await session.launcher.end('SIGINT'), 0);
    await visit(session, 'info', session.take);
    console.log(`  a take of ${(statSync(session.take).size / 1e6).toFixed(1)} MB`);
  },
};

await runCases(cases, open, 570_000 + SOAK_S * 1000);
