// tests/style/imports_test.mjs -- no source of the page imports itself by way of others.
//
// usage: node imports_test.mjs SOURCE_FOLDER
import fs from 'node:fs';
import path from 'node:path';

const folder = path.join(process.argv[2], 'viz_node/web/page');
const files = fs.readdirSync(folder, { recursive: true }).filter((name) => name.endsWith('.ts'));
const imports = new Map(files.map((name) => {
  const text = fs.readFileSync(path.join(folder, name), 'utf8');
  const found = [...text.matchAll(/\b(?:from |import |import\(|new URL\()'(\.\.?\/[^'?]+)/g)].map(([, imported]) => path.join(path.dirname(name), imported));
  return [name, found.filter((imported) => imported.endsWith('.ts'))];
}));

const sound = new Set();
function follow(name, trail) {
  if (sound.has(name)) return;
  const begin = trail.indexOf(name);
  if (begin >= 0) {
    console.log(`a cycle of imports in viz_node/web/page: ${[...trail.slice(begin), name].join(' -> ')}`);
    process.exit(1);
  }
  for (const imported of imports.get(name) ?? []) follow(imported, [...trail, name]);
  sound.add(name);
}
for (const name of files) follow(name, []);
for (const [name, found] of imports) {
  const missing = found.find((imported) => !imports.has(imported));
  if (missing) {
    console.log(`${name} imports ${missing}, which this test does not see`);
    process.exit(1);
  }
}

const count = [...imports.values()].flat().length;
if (count < 20) {
  console.log(`only ${count} imports found in ${folder}`);
  process.exit(1);
}
console.log(`${files.length} files, ${count} imports`);
