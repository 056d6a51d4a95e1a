// tests/style/docs_test.mjs -- what the documents name exists: files they link to and their
// headings, paths, programs, benchmarks and tests.
//
// usage: node docs_test.mjs SOURCE_FOLDER
import assert from 'node:assert/strict';
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { basename, dirname, join, relative } from 'node:path';
import test from 'node:test';

const root = process.argv[2];
const LEFT_OUT = new Set(['node_modules', 'build', '.git']);

function filesBelow(folder, wanted) {
  return readdirSync(folder, { withFileTypes: true }).flatMap((entry) => {
    const path = join(folder, entry.name);
    if (entry.isDirectory()) return LEFT_OUT.has(entry.name) ? [] : filesBelow(path, wanted);
    return wanted.test(entry.name) ? [path] : [];
  });
}

const read = (path) => readFileSync(path, 'utf8');
const documents = filesBelow(root, /\.md$/).map((path) => ({ path, name: relative(root, path), text: read(path) }));
const outsideCode = (text) => text.replace(/^```.*?^```/gms, '');
const folders = readdirSync(root, { withFileTypes: true }).filter((entry) => entry.isDirectory()).map((entry) => entry.name);

/** As GitHub makes the anchor of a heading. */
const anchorOf = (heading) => heading.toLowerCase().replace(/[^\p{L}\p{N} _-]/gu, '').trim().replaceAll(' ', '-');
const anchorsOf = (path) => [...outsideCode(read(path)).matchAll(/^#+ (.*)$/gm)].map(([, heading]) => anchorOf(heading));

test('links lead to a file and a heading', () => {
  let links = 0;
  for (const { path, name, text } of documents) {
    for (const [, target] of outsideCode(text).matchAll(/\]\(([^)\s]+)\)/g)) {
      if (/^[a-z]+:/.test(target)) continue;
      const [file, anchor] = target.split('#');
      const there = file === '' ? path : join(dirname(path), file);
      assert.ok(existsSync(there), `${name} links to ${target}`);
      if (anchor) assert.ok(anchorsOf(there).includes(anchor), `${name}: no heading for ${target}`);
      links += 1;
    }
  }
  assert.ok(links > 20, `${links} links found`);
});

test('paths in documents exist', () => {
  let paths = 0;
  for (const { path, name, text } of documents) {
    if (basename(path) === 'tutorial.md') continue;  // whose files the reader writes
    for (const [, word] of text.matchAll(/`([\w.-]+\/[\w./-]*)`/g)) {
      const [first] = word.split('/');
      if (!folders.includes(first) || first === 'build' || word.includes('NAME')) continue;  // which the reader fills in
      const endings = ['', '.h', '.cpp'];
      assert.ok(endings.some((ending) => existsSync(join(root, word + ending))), `${name}: ${word}`);
      paths += 1;
    }
  }
  assert.ok(paths > 30, `${paths} paths found`);
});

test('documents that the code, the scenes and the programs name exist', () => {
  const files = ['cli', 'cmake', 'device_node', 'docs', 'idl', 'launch_configs', 'node', 'record_node', 'sim_node', 'tests', 'viz_node']
    .filter((folder) => existsSync(join(root, folder)))
    .flatMap((folder) => filesBelow(join(root, folder), /\.(h|cpp|c|idl|yaml|txt|mjs|ts|md)$/));
  for (const file of [...files, join(root, 'README.md'), join(root, 'CHANGELOG.md')]) {
    for (const [document] of read(file).matchAll(/\bdocs\/\w+\.md\b/g)) {
      assert.ok(existsSync(join(root, document)), `${relative(root, file)} names ${document}`);
    }
  }
});

/** The paragraphs and items of a document, without headings, tables and code. */
function paragraphsOf(text) {
  const paragraphs = [''];
  const prose = text.replace(/^ *```.*?^ *```/gms, '\n').replace(/<!--.*?-->/gs, '');
  for (const line of prose.split('\n')) {
    if (line.trim() === '' || /^(#|\s*\|)/.test(line)) paragraphs.push('');
    else if (/^\s*([-*]|\d+\.) /.test(line)) paragraphs.push(line.replace(/^\s*\S+ /, ''));
    else paragraphs.push(`${paragraphs.pop()} ${line.trim()}`);
  }
  return paragraphs;
}

/** Words between full stops. A piece of code is one word, the target of a link none, and a colon ends no sentence. */
function sentencesOf(text) {
  const words = (paragraph) => paragraph.replace(/`[^`]*`/g, 'X').replace(/\]\([^)]*\)/g, ']');
  return paragraphsOf(text).flatMap((paragraph) => words(paragraph).split(/(?<=[.!?]) +(?=[A-Z[*])/));
}

test('the sentences of the documents have at most 25 words', () => {
  const MAX_WORDS = 25;
  const long = [];
  let count = 0;
  for (const { name, text } of documents.filter((document) => document.name !== 'CHANGELOG.md')) {
    for (const sentence of sentencesOf(text)) {
      const words = sentence.split(/\s+/).filter((word) => /\w/.test(word)).length;
      if (words > MAX_WORDS) long.push(`${name}, ${words} words: ${sentence.trim()}`);
      count += 1;
    }
  }
  assert.ok(count > 1000, `${count} sentences`);
  assert.deepEqual(long, []);
});

test('a warning ends no build of ./cordis unless CORDIS_WERROR asks for it', () => {
  const { configurePresets } = JSON.parse(read(join(root, 'CMakePresets.json')));
  for (const { name, cacheVariables } of configurePresets.filter((preset) => ['release', 'asan', 'tsan'].includes(preset.name))) {
    assert.equal(cacheVariables.CORDIS_WERROR, undefined, name);
  }
});

test('programs, benchmarks and suites that documents name exist', () => {
  const lists = filesBelow(root, /^CMakeLists\.txt$/).map(read).join('\n');  // of programs and of their sources
  const sources = filesBelow(join(root, 'tests'), /\.cpp$/).map(read).join('\n');
  for (const { name, text } of documents) {
    for (const [program] of text.matchAll(/(?<=`)\w+_(bench|test)(?=[` ])/g)) {
      assert.ok(new RegExp(`\\b${program}\\b`).test(lists), `${name}: no program ${program}`);
    }
    for (const [, bench] of text.matchAll(/--benchmark_filter=(\w+)/g)) {
      assert.ok(new RegExp(`(BENCHMARK\\(|RegisterBenchmark\\(")\\w*${bench}`).test(sources), `${name}: no benchmark ${bench}`);
    }
    for (const [, suite] of text.matchAll(/--gtest_filter=(\w+)\./g)) {
      assert.ok(sources.includes(`TEST(${suite},`), `${name}: no tests ${suite}`);
    }
  }
});

test('the functions of classes that documents name exist', () => {
  const headers = ['cli', 'device_node', 'node', 'record_node', 'sim_node', 'viz_node'].flatMap((folder) => filesBelow(join(root, folder), /\.h$/)).map(read);
  let functions = 0;
  for (const { name, text } of documents) {
    if (name === 'CHANGELOG.md') continue; // of versions before
    for (const [, type, called] of text.matchAll(/`([A-Z]\w+)::([a-z]\w+)/g)) {
      const own = headers.filter((header) => new RegExp(`\\b(class|struct) ${type}\\b[^;]*\\{`).test(header));
      assert.ok(own.some((header) => new RegExp(`\\b${called}\\b`).test(header)), `${name}: ${type}::${called}`);
      functions += 1;
    }
  }
  assert.ok(functions > 10, `${functions} functions found`);
});

test('docs/device.md names the functions that a driver of hardware has to write', () => {
  const [, table] = read(join(root, 'docs/device.md')).match(/functions are left to write:\n\n(.*?)\n\n/s);
  const named = [...table.matchAll(/^\| `(\w+)`/gm)].map(([, called]) => called);
  const header = read(join(root, 'device_node/drivers/hardware.h'));
  const pure = [...header.matchAll(/\bvirtual [^;{]*?\b(\w+)\([^;{]*= 0;/g)].map(([, called]) => called);
  assert.deepEqual(named.sort(), pure.sort());
});
