// tests/viz/foxglove_test.mjs -- Foxglove's own client reads the topics of a session: what it is
// offered, what the messages say, who is refused, and what a stalled client costs.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { need, program, runCases, Session, source, until } from './session.mjs';

const WebSocket = need('ws');
const { FoxgloveClient } = need('@foxglove/ws-protocol');
const { parseIDL } = need('@foxglove/omgidl-parser');
const { MessageReader } = need('@foxglove/omgidl-serialization');
const { McapIndexedReader } = need('@mcap/core');
const { loadDecompressHandlers } = need('@mcap/support');

const PROTOCOL = FoxgloveClient.SUPPORTED_SUBPROTOCOL;
const APP = 'https://app.foxglove.dev';

/** The client of Foxglove, with all that it was sent. */
class Reader {
  info = null;
  channels = new Map(); // by topic
  offered = new Map(); // likewise, those that have ended too
  ended = []; // topics that were unadvertised
  statuses = [];
  messages = []; // {topic, time, value}
  errors = [];
  #topics = new Map(); // by subscription

  constructor(url, options = {}) {
    this.socket = new WebSocket(url, [PROTOCOL], options);
    this.client = new FoxgloveClient({ ws: this.socket });
    this.client.on('error', (error) => this.errors.push(error));
    this.client.on('serverInfo', (info) => (this.info = info));
    this.client.on('status', (status) => this.statuses.push(status));
    this.client.on('advertise', (channels) => {
      for (const channel of channels) {
        this.channels.set(channel.topic, channel);
        this.offered.set(channel.topic, channel);
      }
    });
    this.client.on('unadvertise', (ids) => {
      for (const [topic, { id }] of this.channels) if (ids.includes(id) && this.channels.delete(topic)) this.ended.push(topic);
    });
    this.client.on('message', ({ subscriptionId, timestamp, data }) => {
      const { topic, decoder } = this.#topics.get(subscriptionId);
      this.messages.push({ topic, time: timestamp, value: decoder.readMessage(data) });
    });
  }

  async subscribe(topic) {
    const channel = await until(`${topic} is offered`, () => this.channels.get(topic));
    assert.deepEqual([channel.encoding, channel.schemaEncoding], ['cdr', 'omgidl']);
    const id = this.client.subscribe(channel.id);
    this.#topics.set(id, { topic, decoder: new MessageReader(channel.schemaName, parseIDL(channel.schema)) });
    return id;
  }

  of(topic) {
    return this.messages.filter((message) => message.topic === topic);
  }

  close() {
    this.socket.terminate();
  }
}

/** Status and text of an upgrade that is refused, or 101 and the subprotocol. */
function upgrade(url, protocols, headers = {}) {
  return new Promise((resolve, reject) => {
    const socket = new WebSocket(url, protocols, { headers });
    socket.on('open', () => {
      resolve([101, socket.protocol]);
      socket.terminate();
    });
    socket.on('unexpected-response', (_request, answer) => {
      let text = '';
      answer.on('data', (part) => (text += part));
      answer.on('end', () => resolve([answer.statusCode, text]));
    });
    socket.on('error', reject);
  });
}

async function openTake(path) {
  const bytes = readFileSync(path);
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + size))),
  };
  return McapIndexedReader.Initialize({ readable, decompressHandlers: await loadDecompressHandlers() });
}

/** The channels and the messages of a reader are those of a take, but for `lost` that the take lacks. */
async function compareWithTake(reader, path, lost) {
  const take = await openTake(path);
  const recorded = new Map([...take.channelsById.values()].map((channel) => [channel.topic, channel]));
  for (const topic of recorded.keys()) assert.ok(reader.offered.has(topic), `${topic} is in the take alone`);
  for (const [topic, { messageEncoding, schemaId }] of recorded) {
    const { encoding, schemaName, schemaEncoding, schema } = reader.offered.get(topic);
    const inTake = take.schemasById.get(schemaId);
    assert.deepEqual([encoding, schemaName, schemaEncoding], [messageEncoding, inTake.name, inTake.encoding], topic);
    assert.equal(schema, new TextDecoder().decode(inTake.data), topic);
  }
  const times = new Map(); // when each sample was written, by the take: several times until it is answered
  const { id, schemaId } = recorded.get('gesture/positions');
  const schema = take.schemasById.get(schemaId);
  const decoder = new MessageReader(schema.name, parseIDL(new TextDecoder().decode(schema.data)));
  for await (const message of take.readMessages({ topics: ['gesture/positions'] })) {
    assert.equal(message.channelId, id);
    const { sample } = decoder.readMessage(message.data);
    times.set(sample, [...(times.get(sample) ?? []), message.logTime]);
  }
  let compared = 0;
  const others = []; // a sample is sent again until it is answered; a lost copy is not counted, for its number has come
  for (const { value, time } of reader.of('gesture/positions')) {
    if (!times.has(value.sample)) continue;
    if (!times.get(value.sample).includes(time)) others.push(`sample ${value.sample} of ${time}, in the take ${times.get(value.sample)}`);
    ++compared;
  }
  assert.ok(others.length <= lost + compared / 100, `the take lost ${lost}: ${others.join('; ')}`);
  assert.ok(compared > 500, `${compared} times of samples are compared`);
}

const addressOf = async (view) => (await view.says(/page at (\S+)/)).replace('http', 'ws');
const residentMB = (id) => (Number(readFileSync(`/proc/${id}/statm`, 'utf8').split(' ')[1]) * 4096) / 1e6;

const SPEED = 0.25; // of the free mass [m/s]
const SCENE = `cordis: 1
name: coasting
space: 1
step: {rate_hz: 1000}
matter:
  bob: {kind: mass, mass_kg: 1, at_m: 0, velocity_m_per_s: ${SPEED}}
ports:
  key: {device: hand, axes: [0], role: mass}
signals:
  place: {of: bob, quantity: position}
`;
const WAY = 0.03; // of the hand, each second [m]
const LAUNCH = `
clock: lockstep
nodes:
  sim: {node: sim_node, scene: coasting.yaml}
  hand:
    node: device_node
    device: ${source}/launch_configs/devices/single_key.yaml
    driver: script
    script:
      interpolation: linear
      repeat_s: 2
      positions: [{at_s: 0, m: 0}, {at_s: 1, m: ${-WAY}}, {at_s: 2, m: 0}]
  view: {node: viz_node, port: 0, foxglove: true}
`;

const cases = {
  'without the key Foxglove is refused in a sentence that names it': async (session) => {
    const view = session.vizOf(session.launchFile('port: 0', 'closed'));
    const url = await addressOf(view);
    for (const headers of [{}, { Origin: APP }]) {
      const [status, text] = await upgrade(url, [PROTOCOL], headers);
      assert.equal(status, 403);
      assert.match(text, /^Foxglove reads this session if the viz_node .* 'foxglove: true'\n$/);
    }
    assert.doesNotMatch(view.log, /Foxglove reads/);
    assert.equal(await view.end(), 0);
  },

  'the apps of Foxglove may connect, other sites may not': async ({ url }) => {
    for (const protocol of ['foxglove.websocket.v1', 'foxglove.sdk.v1']) {
      for (const headers of [{}, { Origin: APP }, { Origin: 'file://' }])
        assert.deepEqual(await upgrade(url, [protocol], headers), [101, protocol]);
      for (const origin of ['null', 'https://elsewhere.example', 'https://foxglove.dev'])
        assert.equal((await upgrade(url, [protocol], { Origin: origin }))[0], 403, origin);
      assert.equal((await upgrade(url, [protocol], { Host: 'elsewhere.example' }))[0], 403);
    }
    assert.equal((await upgrade(`${url}/live`, [], { Origin: APP }))[0], 403, 'the page is not for them');
    assert.equal((await upgrade(url, [], {}))[0], 404);
  },

  'a session is read as it is: positions of the hand, signals of the scene, what is kept': async (session) => {
    writeFileSync(join(session.folder, 'coasting.yaml'), SCENE);
    const file = join(session.folder, 'lockstep.yaml');
    const take = join(session.folder, 'take.mcap');
    writeFileSync(file, `cordis: 1\nsession: lockstep\ndomain: ${session.domain}\nrecord: ${take}${LAUNCH}`);
    const launcher = session.start('cordis', program('cordis'), ['run', file, '--no-color']);
    const url = (await launcher.says(/page of view: (http:\/\/\S+)/)).replace('http', 'ws');
    const [reader, late] = [new Reader(url), new Reader(url)];
    const begin = BigInt(Date.now()) * 1_000_000n;

    const signals = await reader.subscribe('scene/signals');
    await reader.subscribe('gesture/positions');
    await reader.subscribe('scene/description');
    await until('positions and signals came', () => reader.of('gesture/positions').length > 500 && reader.of('scene/signals').length > 10);
    assert.equal(reader.info.name, 'Cordis session lockstep');
    assert.deepEqual(reader.info.capabilities, []);
    for (const topic of ['gesture/forces', 'scene/frame', 'scene/events', 'device/description', 'node/status'])
      assert.ok(reader.channels.has(topic), topic);

    const positions = reader.of('gesture/positions');
    let turns = 0;
    positions.slice(1).forEach(({ value, time }, i) => {
      const before = positions[i];
      if (value.sample === before.value.sample) return; // repeated until it is answered
      assert.equal(value.sample, before.value.sample + 1n, `no sample is lost: ${value.sample} after ${before.value.sample}`);
      assert.ok(time >= before.time);
      const moved = value.position_m[0] - before.value.position_m[0];
      if (Math.abs(Math.abs(moved) - WAY / 1000) > 1e-12) ++turns;
    });
    assert.ok(turns <= 2 + positions.length / 1000, `the hand moves by ${WAY / 1000} m a sample but where it turns: ${turns}`);
    assert.ok(positions[0].time > begin - 60_000_000_000n && positions[0].time < begin + 600_000_000_000n, 'UTC');

    let next = null;
    for (const { value } of reader.of('scene/signals')) {
      assert.equal(value.signal_count, 1);
      assert.equal(Number(value.first_step), next ?? Number(value.first_step), 'no row is lost');
      value.value.forEach((place, row) => {
        const step = Number(value.first_step) + row * value.stride_steps;
        assert.ok(Math.abs(place - SPEED * step * 0.001) < 1e-9, `step ${step}: ${place}`);
        next = step + value.stride_steps;
      });
    }

    await late.subscribe('scene/description');
    await until('both have the description', () => reader.of('scene/description').length > 0 && late.of('scene/description').length > 0);
    for (const each of [reader, late])
      for (const { value } of each.of('scene/description')) assert.equal(value.name, 'coasting');

    reader.client.unsubscribe(signals);
    const last = await until('the end of the subscription is understood', async () => {
      const count = reader.of('scene/signals').length;
      const positionsSoFar = reader.of('gesture/positions').length;
      await until('half a second passes', () => reader.of('gesture/positions').length > positionsSoFar + 500);
      return reader.of('scene/signals').length === count && count;
    });
    const positionsSoFar = reader.of('gesture/positions').length;
    await until('a second passes', () => reader.of('gesture/positions').length > positionsSoFar + 1000);
    assert.equal(reader.of('scene/signals').length, last);

    reader.client.advertise({ topic: 'control/command', encoding: 'cdr', schemaName: 'cordis::msg::ControlCommand' });
    reader.client.sendMessage(1, new Uint8Array(8));
    await until('it is refused', () => reader.statuses.some(({ level, message }) => level === 2 && /to read from/.test(message)));
    assert.deepEqual([...reader.errors, ...late.errors], []);
    assert.equal(await launcher.end('SIGINT'), 0);
    for (const each of [reader, late]) each.close();
    const lost = Number(/(\d+) lost on the way/.exec(launcher.log)?.[1] ?? 0);
    await compareWithTake(reader, take, lost);
  },

  'a channel ends with its writer, and comes again as the same': async (session) => {
    const reader = new Reader(session.url);
    await reader.subscribe('scene/signals');
    const { id } = reader.channels.get('scene/signals');
    await until('signals came', () => reader.messages.length > 3);
    await session.source.end('SIGKILL');
    await until('it has ended', () => reader.ended.includes('scene/signals'));
    session.source = session.scene();
    await until('it is back', () => reader.channels.has('scene/signals'));
    assert.equal(reader.channels.get('scene/signals').id, id);
    const count = reader.messages.length;
    await reader.subscribe('scene/signals');
    await until('signals come again', () => reader.messages.length > count + 3);
    assert.deepEqual([reader.errors, reader.statuses], [[], []]);
    reader.close();
  },

  'a client that stops reading slows no other, memory stays flat, and it learns what it missed': async (session) => {
    await session.source.end();
    session.source = session.scene('--scene', 'grid', '--mats', '100000');
    const [stalled, reading] = [new Reader(session.url), new Reader(session.url)];
    for (const reader of [stalled, reading]) {
      await reader.subscribe('scene/frame');
      await reader.subscribe('scene/signals');
    }
    const large = (reader) => reader.of('scene/frame').filter(({ value }) => value.position_m.length > 250_000).length;
    await until('large frames came to both', () => large(stalled) > 1 && large(reading) > 1);
    stalled.socket._socket.pause();
    const before = residentMB(session.view.id);
    const counts = ['scene/frame', 'scene/signals'].map((topic) => [topic, reading.of(topic).length]);
    for (const [topic, count] of counts) await until(`75 more of ${topic} were read`, () => reading.of(topic).length > count + 75);
    const grown = residentMB(session.view.id) - before;
    console.log(`${grown.toFixed(1)} MB more after 75 frames of 1.2 MB`);
    assert.ok(grown < 30, `${grown} MB more after 75 frames of 1.2 MB`);
    stalled.socket._socket.resume();
    const warning = await until('it learns of it', () => stalled.statuses[0]);
    assert.equal(warning.level, 1);
    assert.match(warning.message, /^\d+ messages were left out: this connection is too slow/);
    for (const reader of [stalled, reading]) reader.close();
  },
};

async function open() {
  const session = await Session.open();
  session.source = session.scene();
  session.view = session.vizOf(session.launchFile('port: 0, foxglove: true'));
  session.url = await addressOf(session.view);
  assert.match(session.view.log + (await session.view.says(/Foxglove reads ws:\/\/\S+/)), /Foxglove reads ws:\/\/127\.0\.0\.1:\d+/);
  return session;
}

await runCases(cases, open);
