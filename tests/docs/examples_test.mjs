// tests/docs/examples_test.mjs -- every example of the documents and of the help texts
// (docs/cli.md) works: commands run, scenes, launch files and devices load.
//
// The first words after ``` say what a block is:
//   sh             commands of `cordis`, one per line; they run in a copy of launch_configs
//   sh by hand     commands for another machine or another right; only their syntax is checked
//   yaml scene     a whole scene         yaml scene part   top level keys, laid on the scene below
//   yaml launch    a whole launch file   yaml nodes        its nodes        yaml device   a device file
//   yaml change    what the tutorial changes in the scene before; tests/scene/tutorial_test.cpp plays it
//   sh foreign     commands that build the programs of examples/foreign_device and play a session with one, the last until it is stopped
//   c              a program for a board
//   python         a program that reads a take, or a table of it
//   text           a drawing or the words of a program
// A path after it is where the reader writes the file.
//
// usage: node examples_test.mjs SOURCE_FOLDER PROGRAM_FOLDER
import assert from 'node:assert/strict';
import { execFile, execFileSync, spawn } from 'node:child_process';
import { cpSync, mkdtempSync, readdirSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import test from 'node:test';

const [, , root, programs] = process.argv;
const LONGEST_MS = 120_000;
const LONGEST_BUILD_MS = 600_000; // of a few files in C, on a machine that is shared with others

const folder = mkdtempSync(join(tmpdir(), 'cordis-examples-'));
process.on('exit', () => rmSync(folder, { recursive: true, force: true }));
cpSync(join(root, 'launch_configs'), join(folder, 'launch_configs'), { recursive: true });
symlinkSync(join(programs, 'cordis'), join(folder, 'cordis'));
// A take for the examples that read one.
execFileSync(join(programs, 'contract_take'), [folder, '1']);
cpSync(join(folder, 'zstd.mcap'), join(folder, 'take.mcap'));
const environment = {
  ...process.env, PATH: `${programs}:${process.env.PATH}`, CORDIS_RUNTIME_DIR: join(folder, 'sessions'), NO_COLOR: '1',
};

/** Runs a line of a shell in the copy. @return its exit code and all it said. */
function shell(line, timeout = LONGEST_MS) {
  return new Promise((resolve) => {
    const options = { cwd: folder, env: environment, timeout, maxBuffer: 1 << 26 };
    execFile('bash', ['-c', line], options, (error, out, complaints) =>
      resolve({ code: error ? error.code ?? error.signal : 0, text: out + complaints }));
  });
}

async function runs(line, origin, codes = [0], timeout = LONGEST_MS) {
  const { code, text } = await shell(line, timeout);
  assert.ok(codes.includes(code), `${origin}: '${line}' ends with ${code}\n${text}`);
  return text;
}

/** Calls `use` with each item, four at a time. */
async function someAtOnce(items, use) {
  const left = [...items];
  const work = async () => { while (left.length > 0) await use(left.shift()); };
  await Promise.all([work(), work(), work(), work()]);
}

const documents = [
  ...readdirSync(join(root, 'docs')).filter((name) => name.endsWith('.md')).map((name) => join('docs', name)),
  'README.md', 'CONTRIBUTING.md', join('idl', 'README.md'), join('examples', 'foreign_device', 'README.md'),
].map((name) => ({ name, text: readFileSync(join(root, name), 'utf8') }));

/** All blocks of code: where, of what kind, the path that is written to, the text. */
const blocks = documents.flatMap(({ name, text }) =>
  [...text.matchAll(/^```(.*)\n([^]*?)^```$/gm)].map(([, info, code]) => {
    const [, kind, path = ''] = /^(.*?)(?: ([\w./]+\.yaml))?$/.exec(info);
    return { name, kind, path, code };
  }));
const blocksOf = (kind) => blocks.filter((block) => block.kind === kind);
const prose = ({ text }) => text.replace(/^```.*?^```$/gms, '');

/** Commands of documents: those of blocks, and in the prose those between backticks that name a file. */
function commands() {
  const found = new Map(); // line: where it stands
  const take = (line, origin) => found.set(line.replace(/\s+#.*$/, '').replace(/^\.\//, '').trim(), origin);
  for (const { name, code } of blocksOf('sh')) {
    for (const line of code.split('\n')) if (line.trim() && !line.startsWith('#')) take(line, name);
  }
  for (const document of documents) {
    for (const [, words] of prose(document).matchAll(/`((?:\.\/)?cordis [^`]+)`/g)) {
      const line = words.replace(/\s+/g, ' ');
      if (isMention(line)) mentions.set(line, document.name);
      else take(line, document.name);
    }
  }
  return found;
}
const mentions = new Map(); // of a verb or with words that the reader fills in
const isMention = (line) => !/^(\.\/)?cordis (test|doctor)$/.test(line) &&
  (!line.includes('launch_configs/') || /\b[A-Z]{2,}\b/.test(line));

const all = commands();
const isOfTake = (line) => line.includes('.mcap') && !line.startsWith('cordis record ');
const ofVerb = (verb) => [...all].filter(([line]) => line.split(' ')[1] === verb);

test('every block of code says what it is', () => {
  const KINDS = ['sh', 'sh by hand', 'sh foreign', 'yaml scene', 'yaml scene part', 'yaml launch', 'yaml nodes', 'yaml device', 'yaml change', 'c', 'python', 'text'];
  for (const { name, kind } of blocks) assert.ok(KINDS.includes(kind), `${name}: a block of '${kind}'`);
  for (const { name } of blocksOf('yaml change')) assert.equal(name, 'docs/tutorial.md');
  for (const document of documents) {
    const bare = /^ {4}(\.\/)?cordis .*$/m.exec(prose(document));
    assert.equal(bare, null, `${document.name}: '${bare}' stands outside of a block`);
  }
  for (const [line, origin] of all) assert.match(line, /^cordis [a-z]/, origin);
  assert.ok(all.size > 25, `${all.size} commands found`);
});

test('verbs and options that documents mention exist', async () => {
  const help = new Map();
  for (const [line, origin] of mentions) {
    const verb = line.split(' ')[1];
    if (verb === 'VERB') continue;
    if (!help.has(verb)) help.set(verb, await runs(`cordis ${verb} --help`, origin));
    for (const [option] of line.matchAll(/--[a-z-]+/g)) assert.ok(help.get(verb).includes(option), `${origin}: '${line}'`);
  }
  assert.ok(mentions.size > 10, `${mentions.size} mentions found`);
});

// A scene on which the fragments of the documents are laid: what they name is there.
const HOST = {
  cordis: '1', name: 'host', space: '2', step: '{rate_hz: 8000}',
  matter: `
  bow: {kind: mass, mass_kg: 0.1, at_m: [0.1, 0.1]}
  string: {kind: string, count: 42, mass_kg: 0.01, from_m: [0, 0], to_m: [0.5, 0], ends: fixed, stiffness_n_per_m: 100}
  hand: {kind: mass, at_m: [0, 0.2], ball: {mass_kg: 0.1, radius_m: 0.01}}
  paste: {kind: disc, structure: triangular, center_m: [0.2, 0.3], radius_m: 0.03, spacing_m: 0.009,
          ball: {mass_kg: 0.01, radius_m: 0.004}}`,
  liaisons: `
  include: [../liaisons/standard.yaml]
  spoke: {kind: spring, stiffness_n_per_m: 100}
  rosin: {like: collophane, parameters: {hold_m: 0.003}}
  clay: {viscosity_n_s_per_m: 0.02, elasticity: {kind: lennard_jones, depth_j: 1.0e-5, diameter_m: 0.008, cut_m: 0.02}}`,
};

/** The top level keys of a text, each with all that belongs to it. */
function sectionsOf(text) {
  const sections = {};
  for (const section of text.split(/^(?=\w+:)/m)) {
    const key = /^(\w+):/.exec(section)?.[1];
    if (key) sections[key] = section.slice(key.length + 1).trimEnd();
  }
  return sections;
}

let written = 0;
/** Writes a file of an example where it belongs, or beside the shipped ones. */
function write(below, path, text) {
  const file = path || join('launch_configs', below, `example_${(written += 1)}.yaml`);
  writeFileSync(join(folder, file), text);
  return file;
}

test('scenes load, are stable, and fragments fit into a scene', async () => {
  for (const { name, path, code } of blocksOf('yaml scene')) await runs(`cordis check ${write('scenes', path, code)}`, name);
  for (const { name, code } of blocksOf('yaml scene part')) {
    const sections = { ...HOST, ...sectionsOf(code) };
    const text = Object.entries(sections).map(([key, value]) => `${key}: ${value}\n`).join('');
    await runs(`cordis check ${write('scenes', '', text)}`, `${name}\n${text}`);
  }
  assert.ok(blocksOf('yaml scene').length >= 2 && blocksOf('yaml scene part').length >= 5);
});

/** Every node of a launch file reads all that it would use. */
async function checkNodes(file, origin) {
  const nodes = (await runs(`cordis run ${file} --dry-run`, origin)).trim().split('\n');
  for (const node of nodes) await runs(`${node} --check`, origin);
  return nodes.length;
}

test('launch files, nodes and device files load', async () => {
  for (const { name, path, code } of blocksOf('yaml launch')) await checkNodes(write('', path, code), name);
  for (const { name, code } of blocksOf('yaml nodes')) await checkNodes(write('', '', `cordis: 1\n${code}`), name);
  for (const { name, code } of blocksOf('yaml device')) {
    const device = write('devices', '', code);
    const launch = `cordis: 1\nnodes: {device: {node: device_node, device: devices/${basename(device)}}}\n`;
    await checkNodes(write('', '', launch), name);
  }
});

test('the launch files that ship load, as their first lines say', async () => {
  let count = 0;
  for (const file of readdirSync(join(root, 'launch_configs')).filter((name) => name.endsWith('.yaml'))) {
    const path = join('launch_configs', file);
    const [, example] = /^#\s+\.\/cordis run (\S+)$/m.exec(readFileSync(join(root, path), 'utf8')) ?? [];
    assert.equal(example, path, `${path} says how it is started`);
    await checkNodes(path, path);
    count += 1;
  }
  assert.ok(count > 10, `${count} launch files`);
});

test('the example of a board compiles', async () => {
  for (const { name, code } of blocksOf('c')) {
    writeFileSync(join(folder, 'board.c'), code);
    await runs(`cc -std=c99 -Wall -Wextra -Werror -fsyntax-only -I '${root}' board.c`, name);
  }
  for (const { name, code } of blocksOf('sh by hand')) {
    writeFileSync(join(folder, 'by_hand.sh'), code);
    await runs('bash -n by_hand.sh', name);
  }
});

test('a program of another vendor is built and plays a session, as far as this machine has CycloneDDS', async (context) => {
  const [block, ...others] = blocksOf('sh foreign');
  assert.ok(block && others.length === 0);
  if ((await shell('command -v idlc && command -v cmake')).code !== 0) return context.skip('no CycloneDDS here (Debian: cyclonedds-dev, cyclonedds-tools)');
  for (const below of ['examples', 'idl']) cpSync(join(root, below), join(folder, below), { recursive: true });
  const [build, ...lines] = block.code.trim().split('\n');
  await runs(build, block.name, [0], LONGEST_BUILD_MS);
  // A sample of the device has reached the session: its program runs, and has found the scene.
  const sample = 'timeout 20 cordis echo foreign gesture/positions -n 1';
  await duringProgram('bash', ['-c', lines.join('\n')], { detached: true }, sample, async () => {});
});

test('cordis run', async () => {
  for (const [line, origin] of ofVerb('run')) await runs(line.includes('--duration') ? line : `${line} --duration 300ms`, origin);
});

/** Starts a program, waits until a line works, does what is wanted, and ends it. @param options  `detached`: with all that it has started */
async function duringProgram(path, words, options, ready, use) {
  const program = spawn(path, words, { cwd: folder, env: environment, stdio: ['ignore', 'pipe', 'pipe'], ...options });
  let said = '';
  for (const stream of [program.stdout, program.stderr]) stream.on('data', (text) => (said += text));
  const ended = new Promise((resolve) => program.on('close', resolve));
  try {
    const end = Date.now() + LONGEST_MS;
    while ((await shell(ready)).code !== 0) assert.ok(Date.now() < end, `'${words.join(' ')}' does not start\n${said}`);
    await use();
  } finally {
    if (options.detached) process.kill(-program.pid, 'SIGTERM');
    else program.kill('SIGINT');
    await ended;
  }
}

/** Likewise `cordis` with these words. */
const during = (words, ready, use) => duringProgram(join(programs, 'cordis'), words, {}, ready, use);

const isForPlayer = (line) => / (seek|rate) /.test(line); // what a player alone understands

test('cordis ctl', async () => {
  const sessions = new Map(); // name: lines
  for (const [line, origin] of ofVerb('ctl').filter(([text]) => !isForPlayer(text))) {
    const session = basename(line.split(' ')[2], '.yaml');
    sessions.set(session, [...(sessions.get(session) ?? []), [line, origin]]);
  }
  for (const [session, lines] of sessions) {
    lines.sort(([a], [b]) => a.includes(' load ') - b.includes(' load ')); // another scene has other links
    await during(['run', `launch_configs/${session}.yaml`], `cordis ctl ${session} pause`, async () => {
      for (const [line, origin] of lines) await runs(`${line} --timeout 60s`, origin);
    });
  }
  assert.ok(sessions.size >= 2, 'sessions of examples');
});

test('cordis record, list, echo, hz, get and info of a session that runs', async () => {
  writeFileSync(join(folder, 'msgs.idl'), 'struct Note { long pitch; };\n');
  const SHORT = { record: ['--max-duration', '1s'], echo: ['-n', '1'], hz: ['--duration', '2s'] };
  await during(['run', 'launch_configs/plucked_string.yaml'], 'cordis get plucked_string finger', async () => {
    for (const verb of ['record', 'list', 'echo', 'hz', 'get', 'info']) {
      const [option, value] = SHORT[verb] ?? [];
      const examples = ofVerb(verb).filter(([text]) => !isOfTake(text));
      await someAtOnce(examples, async ([line, origin]) => { // most of their time they wait
        const quick = option ? `${line.replace(new RegExp(` ${option} \\S+`), '')} ${option} ${value}` : line;
        const codes = quick.includes(' --domain ') ? [0, 1, 3] : [0, 3]; // 3: done with loss; 1: nothing was there
        const text = await runs(quick, origin, verb === 'record' ? codes : [0]);
        assert.notEqual(text.trim(), '', `${origin}: '${quick}' says nothing`);
      });
    }
  });
});

test('cordis play', async () => {
  cpSync(join(root, 'tests', 'golden', 'realtime_key.mcap'), join(folder, 'take.mcap'));
  const quick = (line) => line.replace(/\b10s\b/, '1s'); // the take has 2.8 s
  for (const [line, origin] of ofVerb('play').filter(([text]) => !text.includes('--loop'))) {
    await runs(`${quick(line)} --playback-duration 500ms`, origin);
  }
  const asked = ofVerb('ctl').filter(([text]) => isForPlayer(text));
  const endless = ofVerb('play').filter(([text]) => text.includes('--loop'));
  for (const [line] of endless) {
    const words = [...quick(line).split(' ').slice(1), '--session', 'plucked_string'];
    await during(words, 'cordis ctl plucked_string resume', async () => {
      for (const [order, origin] of asked) await runs(quick(order), origin);
    });
  }
  assert.ok(endless.length > 0 && asked.length > 0);
});

test('cordis check', async () => {
  const lines = ofVerb('check');
  for (const [line, origin] of lines) await runs(line, origin);
  assert.ok(lines.length >= 3);
});

test('cordis new and schema', async () => {
  for (const verb of ['new', 'schema']) {
    for (const [line, origin] of ofVerb(verb)) await runs(line, origin);
  }
});

test('cordis keys', async () => {
  for (const [line, origin] of ofVerb('keys')) await runs(line, origin); // in their order: one is made before it is listed
});

test('cordis cut, merge, info, echo and recover', async () => {
  for (const verb of ['cut', 'merge', 'info', 'echo', 'recover']) {  // a merge takes what a cut has made
    for (const [line, origin] of ofVerb(verb).filter(([text]) => isOfTake(text))) await runs(line, origin);
  }
});

test('cordis lab', async () => {
  for (const [line, origin] of ofVerb('lab')) {
    const quick = line.includes('--quick') ? line : `${line} --quick --duration 400ms`;
    await runs(`${quick} --out lab_${(written += 1)}`, origin);
  }
});

test('cordis resim', async () => {
  cpSync(join(root, 'tests', 'golden'), join(folder, 'tests', 'golden'), { recursive: true });
  cpSync(join(root, 'tests', 'golden', 'realtime_key.mcap'), join(folder, 'take.mcap'));
  const lines = ofVerb('resim');
  for (const [line, origin] of lines) await runs(line, origin);
  assert.ok(lines.length >= 4);
});

test('cordis simulate', async () => {
  for (const [line, origin] of ofVerb('simulate')) {
    await runs(line, origin);
    for (const [, file] of line.matchAll(/--(?:csv|npz|wav|events|summary) (\w\S*)/g)) {
      assert.ok(readFileSync(join(folder, file)).length > 0, `${origin}: ${file}`);
    }
  }
});

test('cordis film, chronogram and plot', async () => {
  rmSync(join(folder, 'take.mcap'), { force: true });
  await runs('cordis run launch_configs/plucked_string.yaml clock=lockstep --only sim,keyboard,record --record take.mcap --duration 2s',
    'a take with frames and signals');
  for (const verb of ['film', 'chronogram', 'plot']) {
    await someAtOnce(ofVerb(verb), async ([line, origin]) => {
      const quick = isOfTake(line) ? line : line.replace(/--duration \S+/, '--duration 300ms');
      await runs(quick, origin);
      const [, out] = / -o (\S+)/.exec(line);
      const first = out.endsWith('/') ? join(out, 'frame_00001.png') : out;
      assert.ok(readFileSync(join(folder, first)).length > 0, `${origin}: ${out}`);
    });
  }
});

test('cordis export', async () => {
  const take = join(folder, 'take.mcap');
  rmSync(take, { force: true });
  await runs('cordis run launch_configs/sounding_string.yaml clock=lockstep --only sim,hand,record --record take.mcap --duration 1s',
    'a take with signals and sound');
  for (const [line, origin] of ofVerb('export')) {
    const text = await runs(line, origin, [0, 3]); // 3: a recorder may miss messages without queue
    assert.equal(text.includes('lost: the take has no'), false, text);
    for (const [, file] of line.matchAll(/--(?:csv|npz|wav|events) (\w\S*)/g)) {
      assert.ok(readFileSync(join(folder, file)).length > 0, `${origin}: ${file}`);
    }
  }
});

test('Python reads a take, as far as this machine has its packages', async () => {
  await runs('cordis export take.mcap --npz take.npz', 'a table for Python', [0, 3]);
  const programs = blocksOf('python');
  for (const [i, { name, code }] of programs.entries()) {
    const file = `example_${i}.py`;
    writeFileSync(join(folder, file), code);
    const packages = [...code.matchAll(/^(?:import|from) (\w+)/gm)].map(([, word]) => `import ${word}`).join('; ');
    if ((await shell(`/usr/bin/python3 -c '${packages}'`)).code === 0) {
      assert.notEqual((await runs(`/usr/bin/python3 ${file}`, name)).trim(), '', `${name}: '${code}' says nothing`);
    } else if ((await shell('/usr/bin/python3 --version')).code === 0) {
      await runs(`/usr/bin/python3 -m py_compile ${file}`, name);
    }
  }
  assert.ok(programs.length >= 3);
});

test('cordis doctor', async () => {
  for (const [line, origin] of ofVerb('doctor')) {
    const text = await runs(`${line} --duration 200ms`, origin, [0, 1]); // 1: no force loop works on this machine
    assert.match(text, /force_loop_at_1_khz|A force loop at 1 kHz /, origin);
  }
});

test('cordis bench', async () => {
  for (const [line, origin] of ofVerb('bench')) {
    const quick = line.includes('--quick') ? line : `${line} --quick`;
    assert.match(await runs(quick, origin), /exchanges\/s/, origin);
    for (const [, file] of line.matchAll(/--(?:json|chart) (\S+)/g)) {
      assert.ok(readFileSync(join(folder, file)).length > 0, `${origin}: ${file}`);
    }
  }
});

test('cordis test lists what it would run', async () => {
  for (const [line, origin] of ofVerb('test')) {
    assert.match(await runs(`${line} -N`, origin), /Total Tests: [1-9]/, `${origin}: ${line}`);
  }
});

test('no verb has examples that nothing runs', () => {
  const RUN = [
    'run', 'ctl', 'check', 'lab', 'simulate', 'doctor', 'bench', 'resim', 'test', 'cut', 'merge', 'info', 'recover',
    'export', 'record', 'play', 'list', 'echo', 'hz', 'get', 'film', 'chronogram', 'plot', 'new', 'schema', 'keys',
  ];
  for (const [line, origin] of all) assert.ok(RUN.includes(line.split(' ')[1]), `${origin}: ${line}`);
  for (const verb of RUN) assert.ok(ofVerb(verb).length > 0, verb);
});
