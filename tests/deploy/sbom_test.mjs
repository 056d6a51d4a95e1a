// tests/deploy/sbom_test.mjs -- the list of what a build is made of is whole.
//
// It names every library, header and page package, with versions of dpkg and licences that the parser of SPDX accepts.
// usage: sbom_test.mjs SOURCE_FOLDER BUILD_FOLDER
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';

const [source, build] = process.argv.slice(2);
const web = join(source, 'viz_node/web');
const script = join(source, 'deploy/sbom.mjs');
const run = (folder) => execFileSync('node', [script, folder], { encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'], maxBuffer: 1 << 26 });

let parseLicence;
try {
  execFileSync('dpkg-query', ['--version'], { stdio: 'ignore' });
  parseLicence = createRequire(join(web, 'package.json'))('spdx-expression-parse');
} catch {
  console.log(`skipped: dpkg or spdx-expression-parse is missing: run npm ci in ${web}`);
  process.exit(77);
}

const text = run(build);
assert.equal(run(build), text, 'the same build has the same list');
const list = JSON.parse(text);

// SPDX 2.3, clauses 6 and 7: what a document and each package must have.
assert.deepEqual([list.spdxVersion, list.dataLicense, list.SPDXID], ['SPDX-2.3', 'CC0-1.0', 'SPDXRef-DOCUMENT']);
assert.match(list.creationInfo.created, /^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$/);
assert.ok(list.creationInfo.creators.every((creator) => /^(Person|Organization|Tool): ./.test(creator)));
assert.match(list.documentNamespace, /^[a-z]+:[^#\s]+$/);
const ids = list.packages.map((entry) => entry.SPDXID);
assert.equal(new Set(ids).size, ids.length, 'no identifier twice');
for (const entry of list.packages) {
  assert.match(entry.SPDXID, /^SPDXRef-[A-Za-z0-9.-]+$/);
  assert.ok(entry.name && entry.downloadLocation && entry.versionInfo, entry.SPDXID);
  for (const licence of [entry.licenseDeclared, entry.licenseConcluded]) {
    if (licence !== 'NOASSERTION') assert.doesNotThrow(() => parseLicence(licence), `${entry.name}: ${licence}`);
  }
}
const known = new Set([...ids, 'SPDXRef-DOCUMENT']);
for (const { spdxElementId, relatedSpdxElement } of list.relationships) {
  assert.ok(known.has(spdxElementId) && known.has(relatedSpdxElement));
}
assert.deepEqual(list.relationships.filter(({ relationshipType }) => relationshipType === 'DESCRIBES').map((entry) => entry.relatedSpdxElement), ['SPDXRef-cordis']);

const parts = (type) => list.relationships.filter(({ relationshipType }) => relationshipType === type)
  .map(({ spdxElementId, relatedSpdxElement }) => list.packages.find(({ SPDXID }) => SPDXID === (type === 'BUILD_DEPENDENCY_OF' ? spdxElementId : relatedSpdxElement)));
const names = (type) => parts(type).map(({ name }) => name);

// Libraries: each that readelf names in a program comes from a package of the list.
const packageOf = (file) => {
  for (const path of [file, file.replace(/^\/usr/, '')]) {
    try {
      return execFileSync('dpkg', ['-S', path], { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] }).split(':')[0];
    } catch { /* dpkg knows the other path */ }
  }
  return undefined;
};
const cache = execFileSync('/sbin/ldconfig', ['-p'], { encoding: 'utf8' });
let libraries = 0;
for (const program of ['cordis', 'sim_node', 'device_node', 'viz_node', 'record_node']) {
  const header = execFileSync('readelf', ['-d', join(build, 'bin', program)], { encoding: 'utf8' });
  for (const [, library] of header.matchAll(/NEEDED.*\[(.*)\]/g)) {
    const line = cache.split('\n').find((entry) => entry.trim().startsWith(`${library} `));
    const owner = line && packageOf(execFileSync('readlink', ['-f', line.split('=> ')[1]], { encoding: 'utf8' }).trim());
    if (!owner) continue; // of no Debian package
    ++libraries;
    assert.ok(names('DEPENDS_ON').includes(owner), `${program} loads ${library} of ${owner}`);
  }
}
assert.ok(libraries >= 10, `${libraries} libraries`);

// Headers, with what has no library: Eigen and CLI11 are headers alone; GoogleTest is for tests.
for (const name of ['libeigen3-dev', 'libcli11-dev', 'nlohmann-json3-dev']) assert.ok(names('BUILD_DEPENDENCY_OF').includes(name), name);
assert.ok(!names('BUILD_DEPENDENCY_OF').some((name) => /gtest|gmock|benchmark/.test(name)), 'what tests alone need is not in the programs');

for (const entry of [...parts('DEPENDS_ON'), ...parts('BUILD_DEPENDENCY_OF')]) {
  const version = execFileSync('dpkg-query', ['-W', '-f', '${Version}', entry.name], { encoding: 'utf8' });
  assert.equal(entry.versionInfo, version, entry.name);
}
assert.equal(list.packages.find(({ name }) => name === 'libyaml-cpp-dev').licenseDeclared, 'X11');

// The page: what its package.json wants, at the version that is installed.
for (const name of Object.keys(JSON.parse(readFileSync(join(web, 'package.json'), 'utf8')).dependencies)) {
  const installed = JSON.parse(readFileSync(join(web, 'node_modules', name, 'package.json'), 'utf8'));
  const entry = parts('CONTAINS').find((part) => part.name === name);
  assert.deepEqual([entry?.versionInfo, entry?.licenseDeclared], [installed.version, installed.license], name);
}

// A folder without programs: one sentence, and no list.
assert.throws(() => run(source), (failure) => failure.status === 1 && failure.stdout === '' && /^sbom: \S+ is missing: build Cordis first/.test(failure.stderr));
console.log(`${list.packages.length} packages`);
