// tests/style/tidy_test.mjs -- clang-tidy has nothing to say about the programs and their
// libraries. Sources that are compiled alike are read together, so that their headers are read
// once; those that may not stand in one text are read apart. What was found clean is looked at
// again when one of its sources was compiled again, or when the rules have changed. Tests are left
// out: that would take as long again.
//
// usage: node tidy_test.mjs SOURCE_FOLDER BUILD_FOLDER [beginning of a path]
import { execFile } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { promisify } from 'node:util';

const MAX_TOGETHER = 24;
const [source, build] = process.argv.slice(2, 4).map((folder) => fs.realpathSync(folder));
const beginning = process.argv[4] ?? '';
const clean = path.join(build, 'clang-tidy');

/// The options that clang-tidy has to know, of one command of g++.
function optionsOf(command) {
  const words = command.match(/(?:[^\s"\\]|\\.|"(?:[^"\\]|\\.)*")+/g).map((word) => word.replace(/\\(.)/g, '$1'));
  return words.flatMap((word, i) =>
    word === '-isystem' ? [word, words[i + 1]] : /^-([ID]|std=|m)/.test(word) ? [word] : []);
}

/// What CMake has put together to be compiled at once, or the file itself.
function sourcesIn(file) {
  if (!/\/Unity\/unity_\d+_cxx\.cxx$/.test(file)) return [file];
  return [...fs.readFileSync(file, 'utf8').matchAll(/^#include "(.*)"$/gm)].map((match) => match[1]);
}

/// The folder whose sources are read together. The verbs of `cli` have a folder each, and mostly one source.
const folderOf = (name) => path.dirname(name).split('/').slice(0, name.startsWith('cli/') ? 1 : 2).join('/');

/// The sources that the tree compiles, each once, in groups of the same folder and the same options.
function groups() {
  const groups = new Map();
  const seen = new Set();
  for (const { file, command } of JSON.parse(fs.readFileSync(path.join(build, 'compile_commands.json')))) {
    const object = path.join(build, command.match(/ -o (\S+)/)[1]);
    const options = optionsOf(command);
    for (const member of sourcesIn(file)) {
      const name = path.relative(source, member);
      if (name.startsWith('..') || member.startsWith(build + path.sep) || name.startsWith('tests/')) continue;
      if (!name.startsWith(beginning) || !name.endsWith('.cpp') || seen.has(name)) continue;
      seen.add(name);
      const key = JSON.stringify([folderOf(name), options]);
      if (!groups.has(key)) groups.set(key, { options, members: [] });
      groups.get(key).members.push({ file: member, object });
    }
  }
  return [...groups.values()].flatMap(({ options, members }) => {
    members.sort((a, b) => (a.file < b.file ? -1 : 1));
    const parts = Math.ceil(members.length / MAX_TOGETHER);
    return Array.from({ length: parts }, (_, i) =>
      ({ options, members: members.filter((_, m) => m % parts === i) }));
  });
}

const changed = (file) => fs.statSync(file, { throwIfNoEntry: false })?.mtimeMs ?? 0;

/// What clang-tidy says of a source; nothing when it is content.
async function complaint(file, options) {
  try {
    await promisify(execFile)('clang-tidy', ['--quiet', `--config-file=${source}/.clang-tidy`, file, '--', ...options],
      { maxBuffer: 1 << 26 });
    return '';
  } catch (fault) {
    return `${fault.stdout ?? ''}${fault.stderr ?? fault}`;
  }
}

/// Says what is wrong with a group; whether nothing is.
/// Two sources may use one name, each in its own anonymous namespace: such a group is halved.
async function check({ options, members }) {
  const name = path.relative(source, members[0].file).replaceAll('/', ',');
  const together = path.join(clean, name);
  const stamp = `${together}.clean`;
  const text = members.map(({ file }) => `#include "${file}"\n`).join('');
  const same = fs.existsSync(together) && fs.readFileSync(together, 'utf8') === text;
  const newest = Math.max(changed(path.join(source, '.clang-tidy')), ...members.map(({ object }) => changed(object) || Infinity));
  if (same && changed(stamp) > newest) return true;
  fs.writeFileSync(together, text);
  const said = await complaint(together, options);
  if (said === '') {
    fs.writeFileSync(stamp, '');
    return true;
  }
  if (said.includes('clang-diagnostic-error') && members.length > 1) {
    const half = Math.ceil(members.length / 2);
    const first = await check({ options, members: members.slice(0, half) });
    return (await check({ options, members: members.slice(half) })) && first;
  }
  console.log(`${said}\nclang-tidy is not content with these, or one of them`);
  return false;
}

fs.mkdirSync(clean, { recursive: true });
const waiting = groups().sort((a, b) => b.members.length - a.members.length);
if (waiting.length === 0) throw new Error(`no source of ${source} is compiled in ${build}`);
let sound = true;
let files = 0;
await Promise.all(Array.from({ length: os.cpus().length }, async () => {
  for (let group = waiting.shift(); group !== undefined; group = waiting.shift()) {
    files += group.members.length;
    if (!(await check(group))) sound = false;
  }
}));
console.log(`${files} files`);
process.exitCode = sound ? 0 : 1;
