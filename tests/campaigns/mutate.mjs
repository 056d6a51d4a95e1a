// tests/campaigns/mutate.mjs -- puts small faults into sources and counts those that the tests see.
//
// usage: node tests/campaigns/mutate.mjs [options] [AREA|FILE...]
//   --count N      how many faults (20; with --known all)
//   --seed N       which ones (1)
//   --known        the faults of known_faults.txt instead, each of which must be seen
//   --again FILE   those of an earlier --out that were not seen
//   --list         print the faults and try none
//   --build DIR    where ninja has built the tests (build/release)
//   --out FILE     where the results go as well, one JSON object a line
//   AREA           of areas.json; all of them when none is named. FILE: one of their sources
// Exit code: 0 when at least 90 % of the faults were seen, and with --known all; 1 when not; 2 when nothing could be tried.
//
// A fault changes an operator, a constant, a condition, a boundary, or drops a statement. No file of the tree changes: the
// changed source is compiled elsewhere, and the tests of its area are linked with it. equivalent_faults.txt names changes
// that no test can see, and why; they do not count.
import {execFileSync, spawnSync} from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import {fileURLToPath} from 'node:url';
import {parseArgs} from 'node:util';

const here = path.dirname(fileURLToPath(import.meta.url));
const root = path.dirname(path.dirname(here));
const longestTest = 180_000; // [ms]: a fault that makes a test this slow is seen
const enough = 0.9;

const {values: options, positionals: words} = parseArgs({
  allowPositionals: true,
  options: {
    count: {type: 'string'},
    seed: {type: 'string', default: '1'},
    known: {type: 'boolean', default: false},
    again: {type: 'string'},
    list: {type: 'boolean', default: false},
    build: {type: 'string', default: path.join(root, 'build', 'release')},
    out: {type: 'string'},
  },
});
const build = path.resolve(options.build);

function giveUp(why) {
  console.error(`mutate.mjs: ${why}`);
  process.exit(2);
}

// ---- where faults can be ----

const operators = [
  [/ < /g, [' <= ', ' > ']],
  [/ <= /g, [' < ']],
  [/ > /g, [' >= ', ' < ']],
  [/ >= /g, [' > ']],
  [/ == /g, [' != ']],
  [/ != /g, [' == ']],
  [/ && /g, [' || ']],
  [/ \|\| /g, [' && ']],
  [/ \+ /g, [' - ']],
  [/ - /g, [' + ']],
  [/ \* /g, [' / ']],
  [/ \/ /g, [' * ']],
  [/ \+= /g, [' -= ']],
  [/ -= /g, [' += ']],
  [/\+\+/g, ['--']],
  [/std::min\(/g, ['std::max(']],
  [/std::max\(/g, ['std::min(']],
  [/(?<=[(&| ])!(?=[a-z])/g, ['']],
  [/\btrue\b/g, ['false']],
  [/\bfalse\b/g, ['true']],
];
const number = /(?<![\w.'"])(\d+\.\d+(?:e-?\d+)?|\d+)(?=[uU]?[\s;,)}\]])/g;
const statement = /^\s+(?:[\w.:>\-[\]*]+(?:\([^{}]*\))?(?: (?:=|\+=|-=|\*=) [^{}]*)?|\+\+\w+|return);$/;
const untouched = /^\s*(#|for \(|\/\/|namespace|using|template|static_assert|CORDIS_ASSERT|throw|case |friend|typedef)|spdlog::|"|operator|concept/;

function numbersLike(text) {
  if (!text.includes('.')) return [String(Number(text) + 1)];
  return [String(Number(text) === 0 ? 1 : 1.25 * Number(text))].map((n) => (/[.e]/.test(n) ? n : `${n}.0`));
}

/** @returns every fault that this file can have: {file, line (1-based), before, after} */
function faultsOf(file) {
  const lines = fs.readFileSync(path.join(root, file), 'utf8').split('\n');
  const faults = [];
  const add = (index, after) => faults.push({file, line: index + 1, before: lines[index], after});
  lines.forEach((line, index) => {
    if (untouched.test(line)) return;
    const code = line.split(' // ')[0];
    for (const [pattern, replacements] of operators) {
      for (const found of code.matchAll(pattern)) {
        for (const other of replacements) add(index, line.slice(0, found.index) + other + line.slice(found.index + found[0].length));
      }
    }
    for (const found of code.matchAll(number)) {
      for (const other of numbersLike(found[1])) add(index, line.slice(0, found.index) + other + line.slice(found.index + found[1].length));
    }
    const begins = index === 0 || /[;{}:]$|^\s*$/.test(lines[index - 1].split(' // ')[0].trimEnd());
    if (begins && statement.test(code) && !/^\s+(const|auto|double|int|bool|std::\w+<|return \w)/.test(code)) add(index, `${line.match(/^\s*/)[0]};`);
  });
  return faults;
}

// ---- which ones ----

/** mulberry32: the same numbers for the same seed. */
function generator(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let mixed = Math.imul(state ^ (state >>> 15), 1 | state);
    mixed = (mixed + Math.imul(mixed ^ (mixed >>> 7), 61 | mixed)) ^ mixed;
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32;
  };
}

function shuffled(items, seed) {
  const random = generator(seed);
  const result = [...items];
  for (let i = result.length - 1; i > 0; --i) {
    const j = Math.floor(random() * (i + 1));
    [result[i], result[j]] = [result[j], result[i]];
  }
  return result;
}

function tableOf(name) {
  return fs
    .readFileSync(path.join(here, name), 'utf8')
    .split('\n')
    .filter((line) => line !== '' && !line.startsWith('#'))
    .map((line) => {
      const [file, before, after, reason] = line.split(' | ').map((word) => word.trim());
      return {file, before, after, reason};
    });
}

const trimmed = ({file, before, after}) => ({file, before: before.trim(), after: after.trim()});
const isSame = (fault, other) =>
  fault.file === other.file && fault.before.trim() === other.before && fault.after.trim() === other.after;

const areas = JSON.parse(fs.readFileSync(path.join(here, 'areas.json'), 'utf8'));
const filesOf = (area) => area.sources.flatMap(sourcesIn).sort();

/** A source, or all sources of a folder. */
function sourcesIn(name) {
  if (name.endsWith('.cpp')) return [name];
  return fs.readdirSync(path.join(root, name)).filter((file) => file.endsWith('.cpp')).map((file) => `${name}/${file}`);
}

function areaOf(file) {
  const area = Object.values(areas).find((one) => filesOf(one).includes(file));
  return area ?? giveUp(`no area of areas.json has ${file}`);
}

function chosenFaults() {
  if (options.known) {
    const known = tableOf('known_faults.txt').map((one) => faultAt(one) ?? giveUp(`${one.file} has no line '${one.before}': known_faults.txt is out of date`));
    return shuffled(known, Number(options.seed)).slice(0, Number(options.count ?? known.length));
  }
  const equivalent = tableOf('equivalent_faults.txt');
  const counts = (fault) => !equivalent.some((other) => isSame(fault, other));
  if (options.again) {
    const lines = fs.readFileSync(options.again, 'utf8').trim().split('\n').map((line) => JSON.parse(line));
    const seen = lines.filter((line) => line.outcome === 'seen');
    const open = lines.filter((line) => line.outcome === 'NOT SEEN' && !seen.some((other) => other.line === line.line && isSame(line, trimmed(other))));
    return open.map((line) => faultAt({...trimmed(line), after: line.after, line: line.line})).filter((fault) => fault !== undefined && counts(fault));
  }
  const files = words.length === 0 ? Object.values(areas).flatMap(filesOf)
    : words.flatMap((word) => (areas[word] ? filesOf(areas[word]) : [word]));
  const all = [...new Set(files)].sort().flatMap(faultsOf).filter(counts);
  return shuffled(all, Number(options.seed)).slice(0, Number(options.count ?? 20));
}

/** The fault in the line that reads so; of several such lines in that of this number, if it is one of them. */
function faultAt({file, before, after, line: number}) {
  const lines = fs.readFileSync(path.join(root, file), 'utf8').split('\n');
  const index = lines[number - 1]?.trim() === before ? number - 1 : lines.findIndex((line) => line.trim() === before);
  return index < 0 ? undefined : {file, line: index + 1, before: lines[index], after};
}

// ---- trying one ----

const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'cordis-mutate-'));
process.on('exit', () => fs.rmSync(folder, {recursive: true, force: true}));
for (const signal of ['SIGINT', 'SIGTERM']) process.on(signal, () => process.exit(2));

const commandsOf = (() => {
  const known = new Map();
  return (target) => {
    if (!known.has(target)) {
      const text = execFileSync('ninja', ['-C', build, '-t', 'commands', target], {maxBuffer: 1 << 28, encoding: 'utf8'});
      known.set(target, text.trim().split('\n'));
    }
    return known.get(target);
  };
})();

const inShell = (command, milliseconds) =>
  spawnSync('bash', ['-c', command], {cwd: build, encoding: 'utf8', timeout: milliseconds, maxBuffer: 1 << 28, killSignal: 'SIGKILL'});

/** The command that compiles this file of the tree, alone or in a batch: {command, object, source, batch}. */
function compilation(file, commands) {
  const absolute = path.join(root, file);
  for (const command of commands) {
    const found = command.match(/ -o (\S+\.o) -c (\S+\.(?:cxx|cpp))$/);
    if (!found) continue;
    const [, object, source] = found;
    if (source === absolute) return {command, object, source};
    if (!source.includes('/Unity/')) continue;
    if (fs.readFileSync(source, 'utf8').includes(`#include "${absolute}"`)) return {command, object, source, batch: true};
  }
  return undefined;
}

/** Compiles the file with the fault. @returns the object file, or none when it does not compile */
function compiled(fault, found) {
  const lines = fs.readFileSync(path.join(root, fault.file), 'utf8').split('\n');
  lines[fault.line - 1] = fault.after;
  const changed = path.join(folder, path.basename(fault.file));
  fs.writeFileSync(changed, lines.join('\n'));
  let source = changed;
  if (found.batch) {
    source = path.join(folder, 'batch.cxx');
    const batch = fs.readFileSync(found.source, 'utf8');
    fs.writeFileSync(source, batch.replace(`#include "${path.join(root, fault.file)}"`, `#include "${changed}"`));
  }
  const object = path.join(folder, 'changed.o');
  const command = found.command
    .replace(/^\S*ccache /, '')
    .replace(/ -MD -MT \S+ -MF \S+/, '')
    .replace(/ -o \S+ -c \S+$/, ` -w -o ${object} -c ${source}`);
  return inShell(command).status === 0 ? object : undefined;
}

/** Links the test with the changed object in place of its own. @returns the program */
function linked(test, found, object) {
  const commands = commandsOf(test);
  const libraries = commands.filter((command) => / qc \S+\.a /.test(command) && command.split(' ').includes(found.object));
  const program = path.join(folder, test);
  let link = commands.at(-1).replace(/ -o \S+ /, ` -o ${program} `);
  for (const command of libraries) {
    const library = command.match(/ qc (\S+\.a) /)[1];
    const copy = path.join(folder, path.basename(library));
    const words = command.split(' ').map((word) => (word === library ? copy : word === found.object ? object : word));
    if (inShell(words.join(' ')).status !== 0) giveUp(`cannot make ${copy}`);
    link = link.split(' ').map((word) => (word === library ? copy : word)).join(' ');
  }
  const tried = inShell(link.split(' ').map((word) => (word === found.object ? object : word)).join(' '));
  if (tried.status !== 0) giveUp(`cannot link ${test}: ${tried.stderr.slice(-1000)}`);
  return program;
}

/** @returns 'seen', 'NOT SEEN' or 'no program', and by which test */
function tryFault(fault) {
  for (const test of areaOf(fault.file).tests) {
    const found = compilation(fault.file, commandsOf(test));
    if (!found) continue;
    const object = compiled(fault, found);
    if (!object) return {outcome: 'no program'};
    const program = linked(test, found, object);
    const ran = inShell(`exec ${program} --gtest_fail_fast --gtest_brief=1`, longestTest);
    if (ran.status === 0) continue;
    const failed = ran.stdout.match(/\[ {2}FAILED {2}\] (\S+?),? /);
    return {outcome: 'seen', by: failed ? failed[1] : `${test}: ${ran.signal ?? ran.status}`};
  }
  return {outcome: 'NOT SEEN'};
}

const textOf = (fault) => `${fault.file}:${fault.line}: ${fault.before.trim()}  ->  ${fault.after.trim()}`;

const faults = chosenFaults();
if (options.list) {
  for (const fault of faults) console.log(textOf(fault));
  process.exit(0);
}
const unbuilt = [...new Set(faults.flatMap((fault) => areaOf(fault.file).tests))].filter((test) => !fs.existsSync(path.join(build, 'bin', test)));
if (unbuilt.length > 0) giveUp(`${unbuilt.join(', ')} is not built in ${build}`);
let seen = 0;
let tried = 0;
for (const fault of faults) {
  const {outcome, by} = tryFault(fault);
  console.log(`${outcome.padEnd(10)} ${textOf(fault)}${by ? `  [${by}]` : ''}`);
  if (options.out) fs.appendFileSync(options.out, `${JSON.stringify({...fault, outcome, by})}\n`);
  if (outcome === 'no program') continue;
  ++tried;
  if (outcome === 'seen') ++seen;
}
console.log(`${seen} of ${tried} faults seen, ${faults.length - tried} did not compile`);
if (tried === 0) giveUp('no fault could be tried');
process.exit(seen >= (options.known ? 1 : enough) * tried ? 0 : 1);
