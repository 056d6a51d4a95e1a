// tests/viz/session.mjs -- what the page and protocol tests share: programs started and ended by
// id, their logs, checks, and the reason to skip.
import { spawn } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';

const SKIPPED = 77;
// Sessions of this test are recorded there, where no other test finds them.
if (process.env.CORDIS_RUNTIME_DIR === undefined) {
  const folder = (process.env.CORDIS_RUNTIME_DIR = mkdtempSync(join(tmpdir(), 'cordis-tests-')));
  process.on('exit', () => rmSync(folder, { recursive: true, force: true }));
}

const { values: options } = parseArgs({
  options: {
    'viz-node': { type: 'string' },
    'scene-source': { type: 'string' },
    web: { type: 'string' }, // the folder with node_modules
    out: { type: 'string' }, // where images and launch files go
  },
});
mkdirSync(options.out, { recursive: true });
export const { out, web } = options;
export const source = join(dirname(fileURLToPath(import.meta.url)), '../..');

/** Path of a program of this build. */
export const program = (name) => join(dirname(options['viz-node']), name);

/** A package of the page's node_modules; the test is skipped when they are not installed. */
export function need(name) {
  try {
    return createRequire(join(options.web, 'package.json'))(name);
  } catch (error) {
    if (error.code !== 'MODULE_NOT_FOUND') throw error;
    return skip(`${name} is not installed: run npm ci in ${options.web}`);
  }
}

export function skip(reason) {
  console.log(`skipped: ${reason}`);
  process.exit(SKIPPED);
}

/** Numbers from 0 to below 1, the same for the same seed (mulberry32). */
export function lot(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), state | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}

export const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** What any one thing may take, on however busy a machine. */
export const LONGEST_MS = 120_000;
/** What all cases of a test may take. */
export const TEST_MS = 570_000;

/** Waits until `condition` gives something true, and gives that back; an Error with `what` when it takes too long. */
export async function until(what, condition, atMostMs = LONGEST_MS) {
  const end = Date.now() + atMostMs;
  for (;;) {
    const value = await condition();
    if (value) return value;
    if (Date.now() > end) throw new Error(`waited ${atMostMs / 1000} s in vain until ${what}`);
    await pause(30);
  }
}

class Program {
  constructor(name, file, words) {
    this.name = name;
    this.log = '';
    this.child = spawn(file, words, { stdio: ['ignore', 'pipe', 'pipe'], env: { ...process.env, NO_COLOR: '1' } });
    for (const stream of [this.child.stdout, this.child.stderr]) stream.on('data', (text) => (this.log += text));
    this.ended = new Promise((resolve) => {
      this.child.on('error', (error) => resolve(`not started: ${error.message}`));
      this.child.on('close', (code, signal) => resolve(signal ?? code)); // after 'exit', when all it said has been read
    });
    this.running = true;
    void this.ended.then(() => (this.running = false));
  }

  get id() {
    return this.child.pid;
  }

  /** Exit code, or the name of the signal that ended it. */
  async end(signal = 'SIGTERM') {
    if (this.running) this.child.kill(signal);
    const late = setTimeout(() => this.child.kill('SIGKILL'), 60_000);
    const result = await this.ended;
    clearTimeout(late);
    return result;
  }

  /** The first group of `pattern` in its output. */
  async says(pattern) {
    return until(`${this.name} says ${pattern}`, () => {
      const found = pattern.exec(this.log);
      if (!found && !this.running) throw new Error(`${this.name} ended without saying ${pattern}`);
      return found && (found[1] ?? found[0]);
    });
  }
}

/** The programs of one test, in a DDS domain of their own. */
export class Session {
  programs = [];
  pageState = ''; // of the page, as it was when a case failed
  folder = mkdtempSync(join(tmpdir(), 'cordis-viz-'));

  static opened = null; // the one of this process

  static async open() {
    const session = (Session.opened = new Session());
    const holder = session.start('domain', options['scene-source'], ['--hold-domain']);
    session.domain = await holder.says(/^(\d+)\n/);
    return session;
  }

  start(name, file, words) {
    const program = new Program(name, file, words);
    this.programs.push(program);
    return program;
  }

  scene(...words) {
    return this.start('scene_source', options['scene-source'], ['--domain', this.domain, ...words]);
  }

  launchFile(section = 'port: 0', name = 'viz_test') {
    const file = join(this.folder, `${name}.yaml`);
    const nodes = `nodes:\n  view: {node: viz_node, ${section}}\n`;
    writeFileSync(file, `cordis: 1\nsession: ${name}\ndomain: ${this.domain}\nclock: realtime\n${nodes}`);
    return file;
  }

  viz(...words) {
    return this.start('viz_node', options['viz-node'], [this.launchFile(), ...words]);
  }

  vizOf(file, ...words) {
    return this.start('viz_node', options['viz-node'], [file, ...words]);
  }

  async close() {
    for (const program of this.programs.reverse()) await program.end();
    rmSync(this.folder, { recursive: true, force: true });
  }

  logs() {
    const errors = (this.pageErrors ?? []).map((error) => `--- error in the page: ${error}\n`).join('');
    return errors + this.pageState + this.programs.map((p) => `--- ${p.name} (${p.running ? 'running' : 'ended'})\n${p.log}`).join('\n');
  }
}

/** Runs the cases one after the other; ends the process with 0 or 1. A case that fails prints the log of every program. */
export async function runCases(cases, openSession, atMostMs = TEST_MS) {
  let failed = 0;
  const watchdog = setTimeout(() => {
    console.error(`the test took longer than ${atMostMs / 1000} s\n${Session.opened?.logs() ?? ''}`);
    for (const program of Session.opened?.programs ?? []) program.child.kill('SIGKILL');
    process.exit(1);
  }, atMostMs);
  try {
    const session = await openSession();
    for (const [name, run] of Object.entries(cases)) {
      const begin = Date.now();
      try {
        await run(session);
        console.log(`ok      ${name} (${Date.now() - begin} ms)`);
      } catch (error) {
        ++failed;
        await session.askPage?.();
        console.error(`FAILED  ${name}\n${error.stack}\n${session.logs()}`);
        await session.recover?.(); // for the cases that follow
      }
    }
  } catch (error) {
    ++failed;
    console.error(`${error.stack}\n${Session.opened?.logs() ?? ''}`);
  } finally {
    await Session.opened?.close();
    clearTimeout(watchdog);
  }
  console.log(`${Object.keys(cases).length} cases, ${failed} failed`);
  process.exit(failed === 0 ? 0 : 1);
}

export const pageIsBuilt = () => existsSync(join(options['viz-node'], '../../share/cordis/page/index.html'));
