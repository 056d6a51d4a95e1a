// tests/mcap/other_readers_test.mjs -- takes read by the readers of others: the reader of MCAP, and
// the parser and decoder of IDL and CDR that Foxglove has.
//
// usage: node other_readers_test.mjs CONTRACT_TAKE CORDIS FOLDER_WITH_NODE_MODULES
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, truncateSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test from 'node:test';

const SKIPPED = 77;
const [contractTake, cordis, web] = process.argv.slice(2);

let mcap, support, parseIDL, MessageReader;
try {
  const require = createRequire(join(web, 'package.json'));
  mcap = require('@mcap/core');
  support = require('@mcap/support');
  ({ parseIDL } = require('@foxglove/omgidl-parser'));
  ({ MessageReader } = require('@foxglove/omgidl-serialization'));
} catch (error) {
  if (error.code !== 'MODULE_NOT_FOUND') throw error;
  console.log(`skipped: @mcap/core or a package beside it is not installed: run npm ci in ${web}`);
  process.exit(SKIPPED);
}

const SEED = 20;
const folder = mkdtempSync(join(tmpdir(), 'cordis-takes-'));
process.on('exit', () => rmSync(folder, { recursive: true, force: true }));
execFileSync(contractTake, [folder, String(SEED)]);
const decompressHandlers = await support.loadDecompressHandlers();

class Bytes {
  constructor(path) {
    this.bytes = readFileSync(path);
  }
  async size() {
    return BigInt(this.bytes.length);
  }
  async read(offset, size) {
    assert.ok(Number(offset + size) <= this.bytes.length, 'a place in the file');
    return new Uint8Array(this.bytes.subarray(Number(offset), Number(offset + size)));
  }
}

const indexed = (path) =>
  mcap.McapIndexedReader.Initialize({ readable: new Bytes(path), decompressHandlers });

async function messagesOf(reader, filter = {}) {
  const messages = [];
  for await (const message of reader.readMessages(filter)) messages.push(message);
  return messages;
}

/** All records as a reader meets them that knows no index; it checks every CRC. */
function streamed(path) {
  const reader = new mcap.McapStreamReader({ validateCrcs: true, decompressHandlers });
  reader.append(new Uint8Array(readFileSync(path)));
  const records = [];
  for (let record; (record = reader.nextRecord());) records.push(record);
  assert.ok(reader.done(), 'the file ends as it should');
  assert.equal(reader.bytesRemaining(), 0);
  return records;
}

/** What was written, by the program that wrote it. */
const expectedOf = (kind) => JSON.parse(readFileSync(join(folder, `${kind}.json`), 'utf8'));

/** A decoded message with numbers of 64 bits as text and arrays as lists. */
function plain(value) {
  if (typeof value === 'bigint') return String(value);
  if (ArrayBuffer.isView(value) || Array.isArray(value)) return [...value].map(plain);
  if (value === null || typeof value !== 'object') return value;
  return Object.fromEntries(Object.entries(value).map(([key, member]) => [key, plain(member)]));
}

function decoderOf({ schemasById, channelsById }) {
  const readers = new Map();
  return ({ channelId, data }) => {
    if (!readers.has(channelId)) {
      const schema = schemasById.get(channelsById.get(channelId).schemaId);
      assert.equal(schema.encoding, 'omgidl');
      readers.set(channelId, new MessageReader(schema.name, parseIDL(new TextDecoder().decode(schema.data))));
    }
    return plain(readers.get(channelId).readMessage(data));
  };
}

for (const kind of ['none', 'lz4', 'zstd']) {
  const path = join(folder, `${kind}.mcap`);

  test(`${kind}: read by its indexes, every value is what was written`, async () => {
    const reader = await indexed(path);
    const decode = decoderOf(reader);
    const messages = await messagesOf(reader);
    const expected = expectedOf(kind);
    assert.equal(messages.length, expected.length);
    messages.forEach((message, i) => {
      const { topic, sequence, log_time, publish_time, value } = expected[i];
      assert.equal(reader.channelsById.get(message.channelId).topic, topic);
      assert.equal(message.sequence, sequence);
      assert.equal(String(message.logTime), log_time);
      assert.equal(String(message.publishTime), publish_time);
      assert.deepEqual(decode(message), value);
    });
    assert.equal(reader.statistics.messageCount, BigInt(expected.length));
    assert.ok(reader.chunkIndexes.length > 3);
    for (const chunk of reader.chunkIndexes) assert.equal(chunk.compression, kind === 'none' ? '' : kind);
  });

  test(`${kind}: topics and times are found by its indexes`, async () => {
    const reader = await indexed(path);
    const expected = expectedOf(kind);
    const [startTime, endTime] = [expected[100].log_time, expected[300].log_time].map(BigInt);
    const topics = ['scene/frame', 'scene/events'];
    const wanted = expected.filter(({ topic, log_time }) =>
      topics.includes(topic) && BigInt(log_time) >= startTime && BigInt(log_time) <= endTime);
    const messages = await messagesOf(reader, { topics, startTime, endTime });
    assert.deepEqual(messages.map(({ sequence }) => sequence), wanted.map(({ sequence }) => sequence));
    const [attachment] = await all(reader.readAttachments());
    assert.equal(attachment.name, 'scene.yaml');
    assert.equal(new TextDecoder().decode(attachment.data), 'cordis: 1\n');
    const [metadata] = await all(reader.readMetadata());
    assert.deepEqual([...metadata.metadata], [['seed', '7']]);
  });

  test(`${kind}: read from its start to its end, every CRC fits`, () => {
    const messages = streamed(path).filter(({ type }) => type === 'Message');
    assert.deepEqual(messages.map(({ sequence }) => sequence), expectedOf(kind).map(({ sequence }) => sequence));
  });

  test(`${kind}: a take that was recovered reads as one that was closed`, async () => {
    const whole = readFileSync(path);
    const chunks = (await indexed(path)).chunkIndexes;
    const { chunkStartOffset, chunkLength } = chunks[Math.floor(chunks.length * 0.4)];
    for (const [name, damage] of [
      ['cut', (file) => truncateSync(file, Math.floor(whole.length * 0.6))],
      ['flipped', (file) => {
        const bytes = Buffer.from(whole);
        bytes[Number(chunkStartOffset + chunkLength / 2n)] ^= 16; // of its messages
        writeFileSync(file, bytes);
      }],
    ]) {
      const file = join(folder, `${kind}_${name}.mcap`);
      writeFileSync(file, whole);
      damage(file);
      const { status, stdout, stderr } = spawnSync(cordis, ['recover', file], { encoding: 'utf8' });
      const isBetweenMessages = /the file ends in the middle of a record \(nothing lost\)/.test(stdout);
      assert.equal(status, isBetweenMessages ? 0 : 3, stdout + stderr);
      const reader = await indexed(file);
      const decode = decoderOf(reader);
      const messages = await messagesOf(reader);
      const expected = new Map(expectedOf(kind).map((entry) => [entry.sequence, entry]));
      assert.ok(messages.length > 100 && messages.length < expected.size, `${messages.length} kept`);
      for (const message of messages) assert.deepEqual(decode(message), expected.get(message.sequence).value);
      assert.equal(streamed(file).filter(({ type }) => type === 'Message').length, messages.length);
    }
  });
}

test('the schema of every message is parsed, and defines what it needs', () => {
  const schemas = JSON.parse(readFileSync(join(folder, 'schemas.json'), 'utf8'));
  assert.ok(Object.keys(schemas).length > 20, Object.keys(schemas).join());
  for (const [name, text] of Object.entries(schemas)) {
    const definitions = parseIDL(text);
    assert.ok(definitions.some((definition) => definition.name === name), name);
    new MessageReader(name, definitions); // throws where a type is missing
  }
});

async function all(iterable) {
  const list = [];
  for await (const each of iterable) list.push(each);
  return list;
}
