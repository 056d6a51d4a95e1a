// tests/viz/packages_test.mjs -- every npm package that the page or its tests take runs on the
// Node.js of Debian 12.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { web } from './session.mjs';

const debian = 18; // major version of the package nodejs
const { packages } = JSON.parse(readFileSync(join(web, 'package-lock.json'), 'utf8'));
const refused = Object.entries(packages).filter(([, { engines }]) => {
  const least = /^>=\s*(\d+)(\.\d+)*$/.exec(engines?.node ?? '>=0');
  return !least || Number(least[1]) > debian;
});
for (const [path, { version, engines }] of refused)
  console.log(`${path} ${version} asks for Node.js ${engines.node}; Debian 12 has ${debian}`);
process.exit(refused.length ? 1 : 0);
