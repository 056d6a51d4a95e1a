// tests/style/imports_test.mjs -- no source of the page imports itself by way of others.
//
// usage: node imports_test.mjs SOURCE_FOLDER
import fs from 'node:fs';
import path from 'node:path';

const folder = path.join(process.argv[2], 'viz_node/web/page');
const files = fs.readdirSync(folder).filter((name) => name.endsWith('.ts'));
const imports = new Map(files.map((name) => {
  const text = fs.readFileSync(path.join(folder, name), 'utf8');
  return [name, [...text.matchAll(/\b(?:from|import) '\.\/([^']+)'/g)].map(([, imported]) => imported)];
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

const count = [...imports.values()].flat().length;
if (count < 20) {
  console.log(`only ${count} imports found in ${folder}`);
  process.exit(1);
}
console.log(`${files.length} files, ${count} imports`);
