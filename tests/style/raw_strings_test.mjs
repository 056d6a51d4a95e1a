// tests/style/raw_strings_test.mjs -- YAML of several lines in a test is one raw string.
//
// Refused is YAML in adjacent "...\n" literals, and more than two lines of it in one. A literal is
// YAML if a line of it begins with a key or a dash.
//
// usage: node raw_strings_test.mjs SOURCE_FOLDER
import fs from 'node:fs';
import path from 'node:path';

const root = process.argv[2];
const MAX_LINES = 2;
const TOKEN = /\/\/[^\n]*|\/\*.*?\*\/|R"([^()\\ \n]{0,16})\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])+'|[\w']+|\s+|./gsu;
const KEY = /^\s*(- )?["\w.\-[\]^*]+:( |$)|^\s*- [{["\w]/m;

/** The literals of a source that the compiler or a + joins to one text, run by run. */
function runsOf(source) {
  const runs = [];
  let run = null;
  for (const { 0: token, index } of source.matchAll(TOKEN)) {
    if (/^\s|^\/[/*]|^\+$/.test(token)) continue;
    const isRaw = token.startsWith('R"');
    if (!isRaw && token[0] !== '"') run = null;
    else if (run) run.push({ token, index, isRaw });
    else runs.push(run = [{ token, index, isRaw }]);
  }
  return runs;
}

const textOf = ({ token, isRaw }) => (isRaw ? token.slice(token.indexOf('(') + 1, token.lastIndexOf(')'))
  : token.slice(1, -1).replace(/\\(n|r|.)/gs, (_, of) => ({ n: '\n', r: '\r' })[of] ?? of));

function isRefused(run) {
  const text = run.map(textOf).join('');
  if (!run.some(({ token, isRaw }) => !isRaw && token.includes('\\n'))) return false;
  if (text.includes('\r') || /\\[xtu0]/.test(run.map(({ token }) => token).join('')) || !KEY.test(text)) return false;
  const lines = text.replace(/^\n|\n+$/g, '').split('\n').length;
  return lines > (run.length > 1 ? 1 : MAX_LINES);
}

const sources = fs.readdirSync(path.join(root, 'tests'), { recursive: true }).filter((name) => /\.(cpp|h)$/.test(name));
let refused = 0;
for (const name of sources) {
  const source = fs.readFileSync(path.join(root, 'tests', name), 'utf8');
  for (const run of runsOf(source).filter(isRefused)) {
    const line = source.slice(0, run[0].index).split('\n').length;
    console.log(`tests/${name}:${line}: YAML of several lines is a raw string: R"(...)"; values go into it by tests/support/filled.h`);
    refused += 1;
  }
}
console.log(`${sources.length} sources, ${refused} texts refused`);
process.exit(refused > 0 || sources.length < 100 ? 1 : 0);
