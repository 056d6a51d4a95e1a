// tests/viz/command_key_test.mjs -- the page commands a session that has a key, and shows the
// refusals of one that has another. The page of a secured session shows it, and commands it where
// its key lets it. Real launcher, sim_node and viz_node, and a client that draws
// nothing.
import assert from 'node:assert/strict';
import { randomBytes } from 'node:crypto';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { need, program, runCases, Session, source, until } from './session.mjs';

const WebSocket = need('ws');

const FRAME = 1; // type of a binary message
const SHIPPED = join(source, 'launch_configs/plucked_string.yaml');

const SCENE = `cordis: 1
name: free
space: 1
step: {rate_hz: 1000}
matter:
  bob: {kind: mass, mass_kg: 1, at_m: 0}
`;

/** A page that receives texts and sends commands. */
class Page {
  status = null;
  hello = null;
  frames = 0;

  constructor(url) {
    this.socket = new WebSocket(`${url.replace('http', 'ws')}/live`);
    this.socket.on('message', (data, isBinary) => {
      if (isBinary && data[5] === FRAME) {
        ++this.frames;
        this.socket.send(JSON.stringify({ type: 'ack', sequence: data.readUInt32LE(8), drawn: true }));
      }
      const text = isBinary ? null : JSON.parse(data.toString());
      if (text?.type === 'status') this.status = text;
      if (text?.type === 'hello') this.hello = text;
    });
    this.socket.on('error', () => {});
  }

  command(verb) {
    this.socket.send(JSON.stringify({ type: 'command', verb }));
  }

  phase() {
    return this.status?.nodes.find(({ kind }) => kind === 'sim_node')?.state;
  }
}

function launchFile(session, name) {
  writeFileSync(join(session.folder, 'free.yaml'), SCENE);
  const file = join(session.folder, `${name}.yaml`);
  const nodes = 'nodes:\n  sim: {node: sim_node, scene: free.yaml}\n  view: {node: viz_node, port: 0}\n';
  writeFileSync(file, `cordis: 1\nsession: ${name}\ndomain: ${session.domain}\nclock: realtime\n${nodes}`);
  return file;
}

async function pageOf(launcher) {
  const page = new Page(await launcher.says(/page of view: (http:\/\/\S+)/));
  await until('the scene runs', () => page.phase() === 'running');
  return page;
}

const cases = {
  'the page of the launcher pauses the scene and lets it go on': async (session) => {
    const launcher = session.start('cordis', program('cordis'), ['run', launchFile(session, 'keyed'), '--no-color']);
    const page = await pageOf(launcher);
    page.command('pause');
    await until('it is paused', () => page.phase() === 'paused');
    page.command('resume');
    await until('it goes on', () => page.phase() === 'running');
    assert.ok(page.status.replies.every(({ accepted }) => accepted), JSON.stringify(page.status.replies));
    page.socket.terminate();
    assert.equal(await launcher.end('SIGINT'), 0);
  },

  'the page of a view with another key shows why nothing happens': async (session) => {
    const file = launchFile(session, 'two_keys');
    const first = session.start('first', program('cordis'), ['run', file, '--no-color', '--only', 'sim']);
    await first.says(/sim.*scene 'free'/);
    const key = join(session.folder, 'other_key');
    writeFileSync(key, `${randomBytes(16).toString('hex')}\n`, { mode: 0o600 });
    process.env.CORDIS_SESSION_KEY_FILE = key;
    const view = session.vizOf(file);
    delete process.env.CORDIS_SESSION_KEY_FILE;
    const page = new Page(await view.says(/page at (http:\/\/\S+)/));
    await until('the scene runs', () => page.phase() === 'running');
    page.command('pause');
    await until('it is refused', () => page.status.replies.some(({ accepted, text }) => !accepted && /another key/.test(text)));
    assert.equal(page.phase(), 'running');
    page.socket.terminate();
    assert.equal(await view.end(), 0);
    assert.equal(await first.end('SIGINT'), 0);
  },

  'the page of a secured session shows a shipped scene, and commands it if its key grants that': async (session) => {
    for (const [folder, ...granted] of [['keys_that_grant', '--view-commands'], ['keys']]) {
      const ring = join(session.folder, folder);
      assert.equal(await session.start('keys', program('cordis'), ['keys', 'new', ring, ...granted]).ended, 0);
      const words = ['run', SHIPPED, '--no-color', `domain=${session.domain}`, 'session=secured', 'view.port=0', `security=${ring}`];
      const launcher = session.start('cordis', program('cordis'), words);
      await launcher.says(/in DDS domain \d+, secured/);
      const page = await pageOf(launcher);
      await until('the page has frames', () => page.frames > 3);
      page.command('pause');
      if (granted.length > 0) {
        await until('it is paused', () => page.phase() === 'paused');
      } else {
        const shown = page.frames;
        await until('the scene runs on', () => page.frames > shown + 50);
        assert.equal(page.phase(), 'running');
        assert.equal(page.hello.may_command, false);
      }
      page.socket.terminate();
      assert.equal(await launcher.end('SIGINT'), 0);
    }
  },
};

await runCases(cases, () => Session.open());
