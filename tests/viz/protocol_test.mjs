// tests/viz/protocol_test.mjs -- a client that draws nothing speaks with a real viz_node: what it
// sends, to whom, and what a stalled client costs the others.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { request } from 'node:http';
import { connect } from 'node:net';
import { hostname } from 'node:os';
import { need, runCases, Session, until } from './session.mjs';

const WebSocket = need('ws');

const MAGIC = 'CDS1';
const [FRAME, SIGNALS, TOPOLOGY] = [1, 2, 3];
const MATS = 60;
const ACK_TIMEOUT_NSEC = 3e9; // flow_credit.h

/** Status, headers and text of one request, its path sent as it stands. */
function ask(url, path, { method = 'GET', headers = {}, body } = {}) {
  return new Promise((resolve, reject) => {
    const { hostname, port } = new URL(url);
    const asked = request({ hostname, port, path, method, headers, agent: false }, (answer) => {
      let text = '';
      answer.on('data', (part) => (text += part));
      answer.on('end', () => resolve({ status: answer.statusCode, headers: answer.headers, text }));
    });
    asked.on('error', reject);
    asked.end(body);
  });
}

/** Status of an upgrade that is refused, or 101. */
function upgrade(url, path, headers) {
  return new Promise((resolve, reject) => {
    const socket = new WebSocket(url.replace('http', 'ws') + path, { headers });
    socket.on('open', () => {
      socket.terminate();
      resolve(101);
    });
    socket.on('unexpected-response', (_request, answer) => {
      answer.destroy();
      resolve(answer.statusCode);
    });
    socket.on('error', reject);
  });
}

class Client {
  texts = [];
  frames = []; // {sequence, scene, frame, mats, links, dropped, bytes, buffer}
  signals = [];
  topologies = [];
  acknowledging = true;
  closeCode = null;

  constructor(url, query = '') {
    this.socket = new WebSocket(url.replace('http', 'ws') + `/live${query}`);
    this.socket.on('message', (data, isBinary) => this.take(data, isBinary));
    this.socket.on('close', (code) => (this.closeCode = code));
    this.socket.on('error', () => {});
  }

  take(data, isBinary) {
    if (!isBinary) return void this.texts.push(JSON.parse(data.toString()));
    assert.equal(data.toString('latin1', 0, 4), MAGIC);
    assert.equal(data[4], 4);
    const header = data.readUInt16LE(6);
    if (data[5] === FRAME) this.takeFrame(data, header);
    else if (data[5] === SIGNALS) this.takeSignals(data, header);
    else if (data[5] === TOPOLOGY) this.takeTopology(data, header);
    else assert.fail(`type ${data[5]}`);
  }

  takeFrame(data, header) {
    const frame = {
      sequence: data.readUInt32LE(8),
      scene: data.readUInt32LE(12),
      frame: Number(data.readBigUInt64LE(16)),
      step: Number(data.readBigUInt64LE(24)),
      taken: data.readBigInt64LE(32),
      sent: data.readBigInt64LE(40),
      simulated: data.readDoubleLE(48),
      mats: data.readUInt32LE(56),
      linkStates: data.readUInt32LE(60),
      dropped: data.readUInt32LE(64),
    };
    assert.equal(header, 88);
    const [bonds, , sets, ports] = [68, 72, 76, 80].map((offset) => data.readUInt32LE(offset));
    assert.equal(data.length, header + 12 * frame.mats + 9 * bonds + 4 * sets + 12 * ports + frame.linkStates);
    frame.xyz = (i) => [0, 4, 8].map((offset) => data.readFloatLE(header + 12 * i + offset));
    this.frames.push(frame);
    if (this.acknowledging) this.acknowledge(frame.sequence);
  }

  takeSignals(data, header) {
    const batch = {
      scene: data.readUInt32LE(8),
      columns: data.readUInt32LE(12),
      rows: data.readUInt32LE(16),
      firstStep: Number(data.readBigUInt64LE(24)),
      firstS: data.readDoubleLE(32),
      periodS: data.readDoubleLE(40),
    };
    assert.equal(header, 48);
    assert.equal(data.length, header + 4 * batch.columns * batch.rows);
    this.signals.push(batch);
  }

  takeTopology(data, header) {
    const [mats, links] = [data.readUInt32LE(12), data.readUInt32LE(16)];
    assert.equal(header, 24);
    const machines = data.readUInt32LE(20);
    assert.equal(data.length, header + 9 * mats + 8 * links + 2 * machines);
    const kinds = [...data.subarray(header + 8 * mats + 8 * links + 2 * machines)];
    const masses = Array.from({ length: mats }, (_, i) => data.readFloatLE(header + 4 * mats + 4 * i));
    const ends = Array.from({ length: 2 * links }, (_, i) => data.readUInt32LE(header + 8 * mats + 4 * i));
    this.topologies.push({ scene: data.readUInt32LE(8), mats, links, kinds, masses, ends });
  }

  acknowledge(sequence, drawn = true) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify({ type: 'ack', sequence, drawn }));
  }

  newest(type) {
    return this.texts.findLast((text) => text.type === type);
  }

  close() {
    this.socket.terminate();
  }
}

async function withClients(url, count, use) {
  const clients = Array.from({ length: count }, () => new Client(url));
  try {
    await use(...clients);
  } finally {
    for (const client of clients) client.close();
  }
}

const residentMB = (id) => (Number(readFileSync(`/proc/${id}/statm`, 'utf8').split(' ')[1]) * 4096) / 1e6;

const cases = {
  'a page is served, with what a browser needs to be careful': async ({ url }) => {
    const { status, headers } = await ask(url, '/');
    assert.equal(status, 200);
    assert.match(headers['content-type'], /^text\/html/);
    assert.match(headers['content-security-policy'], /default-src 'self'/);
    assert.equal((await ask(url, '/?a=b')).status, 200);
    assert.equal((await ask(url, '/none.js')).status, 404);
  },

  'no path leads out of the page': async ({ url }) => {
    const paths = ['/../../../../etc/passwd', '/..%2f..%2fetc/passwd', '/%2e%2e/etc/passwd', '/..\\etc', '//etc/passwd', '/./etc/passwd'];
    for (const path of paths) {
      const { status, text } = await ask(url, path);
      assert.ok(status === 403 || status === 404, `${path}: ${status}`);
      assert.doesNotMatch(text, /root:/);
    }
  },

  'HEAD has the fields of GET, and no text': async ({ url }) => {
    const [got, headed] = [await ask(url, '/page.js'), await ask(url, '/page.js', { method: 'HEAD' })];
    assert.deepEqual([headed.status, headed.text], [200, '']);
    for (const field of ['content-length', 'content-type']) assert.equal(headed.headers[field], got.headers[field]);
    assert.equal((await ask(url, '/none.js', { method: 'HEAD' })).status, 404);
  },

  'the page takes less than 120 kB on the wire, with its sound': async ({ url }) => {
    const { text } = await ask(url, '/');
    const named = [...text.matchAll(/(?:src|href)="(\/[^"]+)"/g)].map(([, path]) => path);
    assert.deepEqual(named.sort(), ['/page.css', '/page.js']);
    assert.doesNotMatch((await ask(url, '/page.js')).text, /(?:from|import) ?\(?["']/, 'the bundle imports another file');
    for (const [accepted, encoding] of [['gzip, deflate, br', 'br'], ['gzip', 'gzip']]) {
      let bytes = 0;
      for (const path of ['/', ...named, '/sound.js']) {
        const { headers } = await ask(url, path, { method: 'HEAD', headers: { 'Accept-Encoding': accepted } });
        assert.equal(headers['content-encoding'], encoding);
        bytes += Number(headers['content-length']);
      }
      console.log(`the page with its sound, ${encoding}: ${bytes} bytes`);
      assert.ok(bytes > 50_000 && bytes < 120_000, `${encoding}: ${bytes} bytes`);
    }
    const plain = await ask(url, '/page.css', { headers: { 'Accept-Encoding': 'br;q=0, identity' } });
    assert.equal(plain.headers['content-encoding'], undefined);
    assert.match(plain.text, /#stage/);
  },

  'a body of a GET is passed over, and the connection goes on': async ({ url }) => {
    const { hostname, port, host } = new URL(url);
    const socket = connect(Number(port), hostname);
    let text = '';
    socket.on('data', (part) => (text += part));
    const get = `HEAD / HTTP/1.1\r\nHost: ${host}\r\n`;
    socket.write(`${get}Content-Length: 5\r\n\r\nhello${get}\r\n`);
    await until('both are answered', () => text.match(/HTTP\/1.1 200/g)?.length === 2);
    socket.destroy();
  },

  'nothing but GET and HEAD is answered': async ({ url }) => {
    for (const method of ['POST', 'PUT', 'DELETE', 'OPTIONS']) {
      const { status, headers } = await ask(url, '/', { method, body: 'x'.repeat(3000) });
      assert.equal(status, 405, method);
      assert.equal(headers.allow, 'GET, HEAD');
    }
  },

  'a page of another site gets nothing': async ({ url }) => {
    const { host } = new URL(url);
    assert.equal(await upgrade(url, '/live', { Origin: 'http://elsewhere.example' }), 403);
    assert.equal(await upgrade(url, '/live', { Origin: 'null' }), 403);
    assert.equal(await upgrade(url, '/live', { Origin: 'http://127.0.0.1:1' }), 403);
    assert.equal(await upgrade(url, '/live', { Origin: 'http://elsewhere.example', Host: 'elsewhere.example' }), 403);
    assert.equal(await upgrade(url, '/live', { Origin: `http://${host}` }), 101);
    assert.equal((await ask(url, '/', { headers: { Host: 'elsewhere.example' } })).status, 403);
    assert.equal(await upgrade(url, '/other', {}), 404);
    assert.equal((await ask(url, '/live')).status, 426);
  },

  'open to other machines: names of others get nothing, and only the token lets a page command': async (session) => {
    const open = session.vizOf(session.launchFile('port: 0, address: 0.0.0.0', 'open'));
    const { port, search } = new URL(await open.says(/page at (\S+)/));
    assert.match(search, /^\?token=[0-9a-f]{32}$/);
    assert.match(open.log, /0\.0\.0\.0 is open to other machines/);
    const url = `http://127.0.0.1:${port}`;
    for (const host of ['elsewhere.example', `elsewhere.example:${port}`, `127.0.0.1.elsewhere.example:${port}`])
      assert.equal((await ask(url, '/', { headers: { Host: host } })).status, 403, host);
    for (const host of [`${hostname()}:${port}`, '192.0.2.7', '[2001:db8::7]:80', 'localhost'])
      assert.equal((await ask(url, '/', { headers: { Host: host } })).status, 200, host);
    for (const [query, mayCommand] of [['', false], ['?token=wrong', false], [search, true]]) {
      const client = new Client(url, query);
      await until('it is greeted', () => client.newest('hello'));
      assert.equal(client.newest('hello').may_command, mayCommand, query);
      await until('the status comes', () => client.newest('status')?.nodes.some(({ text }) => text.endsWith(`:${port}`)));
      for (const text of client.texts) assert.doesNotMatch(JSON.stringify(text), /[0-9a-f]{32}/, 'no page receives the token');
      client.close();
    }
    assert.equal(await open.end(), 0);
  },

  'a client receives the scene, then every frame and every row of the signals': async ({ url }) => {
    await withClients(url, 1, async (client) => {
      await until('20 frames came', () => client.frames.length >= 20);
      assert.equal(client.texts[0].type, 'hello');
      assert.equal(client.texts[0].session, 'viz_test');
      const description = client.newest('description');
      assert.equal(description.name, 'string');
      assert.equal(description.mat_count, MATS);
      assert.deepEqual(description.surfaces, []);
      assert.deepEqual(description.signals[0], { name: 'finger position', unit: 'm', sound: false, full_scale: 0 });
      const topology = client.topologies[0];
      assert.equal(topology.links, MATS - 1);
      assert.deepEqual(topology.ends.slice(0, 4), [0, 1, 1, 2]);
      assert.deepEqual([topology.masses[0], topology.masses[1], topology.masses[12]], [0, Math.fround(0.001), 0]);
      assert.deepEqual(description.colours, []);
      assert.deepEqual([topology.kinds[0], topology.kinds[1], topology.kinds[12]], [1, 0, 2]);
      checkFrames(client.frames, description.scene);
      checkSignals(client.signals);
    });
  },

  'a client that asks for each fifth frame gets those alone, and every row of the signals': async ({ url }) => {
    const client = new Client(url, '?every=5');
    await withClients(url, 1, async (other) => {
      await until('8 frames came', () => client.frames.length >= 8 && other.frames.length >= 8);
      client.close();
      for (const [i, { sequence, dropped }] of client.frames.slice(1).entries()) {
        const before = client.frames[i];
        assert.ok(sequence - before.sequence >= 5, `${sequence} after ${before.sequence}`);
        assert.equal(dropped - before.dropped, sequence - before.sequence - 5);
      }
      checkSignals(client.signals);
      assert.ok(other.frames.some(({ sequence }, i) => i > 0 && sequence - other.frames[i - 1].sequence < 5), 'the other one gets more of them');
    });
    for (const every of ['0', '-3', '1.5', 'two', '']) {
      assert.equal(await upgrade(url, `/live?every=${every}`, {}), 400, every);
      assert.equal((await ask(url, `/?every=${every}`)).text, 'every=N sends each N-th frame: N is a whole number from 1 up\n');
    }
  },

  'the status names every node, and viz_node says where its page is': async ({ url }) => {
    await withClients(url, 1, async (client) => {
      const status = await until('three nodes are heard', () => {
        const newest = client.newest('status');
        return newest?.nodes.length === 3 && newest;
      });
      const by = Object.fromEntries(status.nodes.map((node) => [node.kind, node]));
      assert.equal(by.sim_node.state, 'running');
      assert.equal(by.sim_node.target_rate_hz, 1000);
      assert.equal(by.device_node.name, 'keyboard');
      assert.ok(by.device_node.latency_p50_s > 0);
      assert.equal(by.viz_node.text, url);
      await until('drawn frames are counted', () => {
        const viz = client.newest('status').nodes.find((node) => node.kind === 'viz_node');
        return viz.latency_count > 0 && viz.latency_p50_s > 0 && viz.latency_p50_s < 5;
      });
    });
  },

  'a client that acknowledges nothing gets two frames, then one per time-out; and the newest as soon as it does': async ({ url }) => {
    await withClients(url, 1, async (client) => {
      client.acknowledging = false;
      await until('five frames came', () => client.frames.length >= 5);
      const [, ...gaps] = gapsOf(client.frames);
      for (const gap of gaps) assert.ok(gap >= ACK_TIMEOUT_NSEC, `one frame ${gap} ns after the last`);
      const last = client.frames.at(-1);
      await until('it is a second behind', () => client.signals.at(-1).firstStep > last.step + 1000);
      client.acknowledging = true;
      const count = client.frames.length;
      client.acknowledge(last.sequence, false);
      await until('frames come again', () => client.frames.length >= count + 25);
      const next = client.frames[count];
      assert.ok(next.step > last.step + 600, `step ${next.step} is old news after ${last.step}`);
      assert.equal(next.dropped - last.dropped, next.sequence - last.sequence - 1);
    });
  },

  'nothing that a client acknowledges makes it deaf': async ({ url }) => {
    await withClients(url, 1, async (client) => {
      client.acknowledging = false;
      await until('frames came', () => client.frames.length >= 2);
      const odd = [0, client.frames[0].sequence, client.frames[0].sequence, 4_000_000_000];
      for (const sequence of odd) {
        const count = client.frames.length;
        for (let i = 0; i < 3; ++i) client.acknowledge(sequence, true);
        await until(`frames come after an acknowledgement of ${sequence}`, () => client.frames.length > count);
      }
    });
  },

  'what is no acknowledgement is ignored, what is too long ends that client alone': async ({ url }) => {
    await withClients(url, 2, async (odd, other) => {
      await until('frames came', () => odd.frames.length > 3);
      const words = ['', 'ack', '[]', '{"type":"ack"}', '{"type":"ack","sequence":-1,"drawn":true}', '{"type":"ack","sequence":1e30,"drawn":1}'];
      for (const text of words) odd.socket.send(text);
      odd.socket.send(Buffer.from([1, 2, 3]));
      const count = odd.frames.length;
      await until('it goes on', () => odd.frames.length > count + 5);
      odd.socket.send('x'.repeat(5000));
      await until('it is closed', () => odd.closeCode !== null);
      assert.equal(odd.closeCode, 1009);
      const others = other.frames.length;
      await until('the other goes on', () => other.frames.length > others + 5);
    });
  },

  'half-open requests shut out no newcomer': async ({ url }) => {
    const { hostname, port } = new URL(url);
    const idle = Array.from({ length: 200 }, () => connect(Number(port), hostname).on('error', () => {}));
    try {
      for (const socket of idle) socket.write('GET / HTTP/1.1\r\nHo');
      assert.equal((await ask(url, '/')).status, 200);
      await until('the oldest are closed', () => idle.filter((socket) => socket.readableEnded || socket.destroyed).length >= 136);
      assert.equal((await ask(url, '/')).status, 200);
    } finally {
      for (const socket of idle) socket.destroy();
    }
    await until('there is room again', async () => (await ask(url, '/').catch(() => ({}))).status === 200);
  },

  'frames that do not fit their scene are counted and not shown': async (session) => {
    await session.source.end();
    session.source = session.scene('--bad-frames');
    await withClients(session.url, 1, async (client) => {
      await until('something was refused', () => client.newest('status')?.viz.refused > 2);
      for (const frame of client.frames) assert.equal(frame.mats, MATS);
    });
    assert.match(session.view.log, /refused coordinates in a frame: 179, expected 180/);
  },

  'surfaces come as the scene has them': async (session) => {
    await session.source.end();
    session.source = session.scene('--surfaces'); // those of tests/support/surfaces.h
    await withClients(session.url, 1, async (client) => {
      const { surfaces } = await until('they came', () => client.newest('description')?.surfaces.length > 0 && client.newest('description'));
      assert.deepEqual(surfaces.map(({ name }) => name), ['floor', 'wall', 'step[0]', 'step[1]', 'step[2]', 'post']);
      assert.deepEqual(surfaces[1], { name: 'wall', mat: null, kind: 'plane', centre: [-0.4, 0, 0], axis: [1, 0, 0], size: [] });
      assert.deepEqual(surfaces[2], { name: 'step[0]', mat: null, kind: 'box', centre: [0.27, -0.125, 0], axis: [], size: [0.06, 0.05, 0.2] });
      assert.deepEqual(surfaces[5], { name: 'post', mat: null, kind: 'cylinder', centre: [0, -0.05, 0.27], axis: [0, 1, 0], size: [0.03, 0.2] });
    });
  },

  'another scene comes with all the credit': async (session) => {
    await withClients(session.url, 1, async (client) => {
      client.acknowledging = false;
      await until('two frames came', () => client.frames.length >= 2);
      const before = client.newest('description').scene;
      await session.source.end('SIGKILL');
      session.source = session.scene();
      const ofIt = await until('two frames of it came', () => {
        const frames = client.frames.filter(({ scene }) => scene > before);
        return frames.length >= 2 && frames;
      });
      assert.ok(gapsOf(ofIt)[0] < ACK_TIMEOUT_NSEC || ofIt[0].scene !== ofIt[1].scene, 'the second waits for no time-out');
    });
  },

  'another life of sim_node is another scene': async (session) => {
    await withClients(session.url, 1, async (client) => {
      await until('frames came', () => client.frames.length > 3);
      const before = client.newest('description').scene;
      await session.source.end('SIGKILL');
      await until('sim_node is lost', () => client.newest('status').nodes.find((n) => n.name === 'sim').state === 'lost');
      session.source = session.scene();
      await until('its frames came', () => client.frames.at(-1).scene > before);
      assert.equal(client.newest('description').scene, client.frames.at(-1).scene);
      assert.equal(client.topologies.at(-1).scene, client.frames.at(-1).scene);
      await until('sim_node is back', () => client.newest('status').nodes.find((n) => n.name === 'sim').state === 'running');
    });
  },

  'a client that stops reading large frames slows no other, and memory stays flat': async (session) => {
    await session.source.end();
    session.source = session.scene('--scene', 'grid', '--mats', '100000');
    await withClients(session.url, 3, async (stalled, deaf, reading) => {
      deaf.acknowledging = false;
      await until('large frames came to all', () => [stalled, deaf, reading].every((c) => c.frames.at(-1)?.mats > 90_000));
      stalled.acknowledging = false;
      stalled.socket._socket.pause();
      const before = residentMB(session.view.id);
      const first = reading.frames.at(-1);
      const count = reading.frames.length;
      await until('75 frames were taken', () => reading.frames.at(-1).sequence >= first.sequence + 75);
      await until('25 of them were read', () => reading.frames.length >= count + 25);
      const [, ...gaps] = gapsOf(deaf.frames.filter((f) => f.mats > 90_000));
      for (const gap of gaps) assert.ok(gap >= ACK_TIMEOUT_NSEC, `a frame ${gap} ns after the last`);
      const grown = residentMB(session.view.id) - before;
      assert.ok(grown < 30, `${grown} MB more after 75 frames of 1.2 MB`);
    });
  },

  'an occupied port is no end: the next free one is taken, and reported in log and status': async (session) => {
    const { port } = new URL(session.url);
    const second = session.vizOf(session.launchFile(`port: ${port}`, 'other'));
    const url = await second.says(/page at (\S+)/);
    assert.match(second.log, new RegExp(`port ${port} on 127.0.0.1 is occupied.*the page is at port ${new URL(url).port};.*view.port=N`));
    assert.notEqual(new URL(url).port, port);
    assert.equal((await ask(url, '/')).status, 200);
    await withClients(url, 1, async (client) => {
      await until('its status names the port', () => client.newest('status')?.nodes.some((node) => node.text === url));
    });
    assert.equal(await second.end(), 0);
  },

  'a name taken, an address of elsewhere and a wrong key each end in one clear line': async (session) => {
    const elsewhere = session.vizOf(session.launchFile('port: 0, address: 192.0.2.1', 'elsewhere'));
    assert.equal(await elsewhere.ended, 2);
    assert.match(elsewhere.log, /elsewhere\.yaml:\d+:\d+: error: .*192\.0\.2\.1/);

    const twin = session.viz();
    assert.equal(await twin.ended, 1);
    assert.match(twin.log, /already runs in DDS domain \d+ with a node named 'view'/);

    const wrong = session.vizOf(session.launchFile('prt: 1, address: here, rate_hz: 0', 'wrong'));
    assert.equal(await wrong.ended, 2);
    for (const place of [/wrong\.yaml:6:\d+.*prt/, /wrong\.yaml:6:\d+.*IP address/, /wrong\.yaml:6:\d+.*rate_hz/]) {
      assert.match(wrong.log, place);
    }

    const checked = session.vizOf(session.launchFile(), '--check');
    assert.equal(await checked.ended, 0);
  },

  'it stops when asked, with clients connected': async (session) => {
    await withClients(session.url, 1, async (client) => {
      await until('it is connected', () => client.texts.length > 0);
      assert.equal(await session.view.end('SIGINT'), 0);
    });
    session.view = session.viz();
    const url = await session.view.says(/page at (\S+)/);
    await until('it serves the page', async () => (await ask(url, '/')).status === 200);
    assert.equal(await session.view.end('SIGTERM'), 0);
  },
};

/** Nanoseconds between a frame and the next, by the clock of viz_node. */
const gapsOf = (frames) => frames.slice(1).map(({ sent }, i) => Number(sent - frames[i].sent));

/** How scene_source.cpp moves MAT `i` of its string. */
function heightOf(i, t) {
  const u = (Math.PI * i) / (MATS - 1);
  const [first, second] = [Math.cos(2 * Math.PI * 0.9 * t), Math.sin(2 * Math.PI * 1.7 * t)];
  return 0.03 * (Math.sin(u) * first + 0.4 * Math.sin(2 * u) * second);
}

function checkFrames(frames, scene) {
  for (let i = 0; i < frames.length; ++i) {
    const frame = frames[i];
    assert.equal(frame.scene, scene);
    assert.equal(frame.mats, MATS);
    assert.equal(frame.linkStates, 0);
    assert.ok(frame.sent >= frame.taken);
    assert.equal(frame.simulated, frame.step / 1000);
    const [x, y, z] = frame.xyz(0);
    assert.ok(Math.abs(x + 0.325) < 1e-6 && Math.abs(y) < 1e-6 && z === 0, 'the fixed end stays');
    assert.ok(Math.abs(frame.xyz(29)[1] - heightOf(29, frame.simulated)) < 1e-6, 'as scene_source moves it');
    if (i === 0) continue;
    assert.ok(frame.sequence > frames[i - 1].sequence);
    assert.ok(frame.step > frames[i - 1].step);
    assert.equal(frame.dropped - frames[i - 1].dropped, frame.sequence - frames[i - 1].sequence - 1);
  }
}

function checkSignals(signals) {
  for (let i = 0; i < signals.length; ++i) {
    const batch = signals[i];
    assert.deepEqual([batch.columns, batch.rows, batch.periodS], [3, 40, 0.001]);
    assert.ok(Math.abs(batch.firstS - batch.firstStep / 1000) < 1e-9);
    if (i > 0) assert.equal(batch.firstStep, signals[i - 1].firstStep + 40, 'no row is lost');
  }
}

async function open() {
  const session = await Session.open();
  session.source = session.scene();
  session.view = session.viz();
  session.url = await session.view.says(/page at (\S+)/);
  return session;
}

await runCases(cases, open);
