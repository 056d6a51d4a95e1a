#!/usr/bin/env node
// deploy/sbom.mjs -- writes the list of what a build of Cordis is made of (SBOM, SPDX 2.3 in JSON) to stdout.
//
// usage: node deploy/sbom.mjs [BUILD_FOLDER] > cordis.spdx.json       (BUILD_FOLDER: build/release)
//
// It asks the build, not a list: the libraries that the programs load (ldd), the headers that they were compiled with
// (ninja -t deps), and the packages of npm in the page. Versions are those of dpkg and of package-lock.json. A licence is
// the one that a Debian package declares for the whole of it; where it declares none in words of SPDX, it is NOASSERTION,
// and Debian's words stand in `licenseComments`. The time is SOURCE_DATE_EPOCH, else that of the last commit: the same
// build on the same machine has the same document.
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync, realpathSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const SOURCE = dirname(dirname(fileURLToPath(import.meta.url)));
const BUILD = resolve(process.argv[2] ?? join(SOURCE, 'build/release'));
const PROGRAMS = ['cordis', 'sim_node', 'device_node', 'viz_node', 'record_node'];

/** Debian's short names of licences that SPDX calls otherwise. */
const SPDX_NAMES = {
  'expat': 'MIT', 'mit': 'MIT', 'x11': 'X11', 'zlib': 'Zlib', 'libpng': 'Libpng', 'zlib/libpng': 'Zlib', 'boost': 'BSL-1.0',
  'bsl-1.0': 'BSL-1.0', 'ftl': 'FTL', 'bitstream-vera': 'Bitstream-Vera', 'isc': 'ISC', 'bsd-2-clause': 'BSD-2-Clause',
  'bsd-3-clause': 'BSD-3-Clause', 'apache-2': 'Apache-2.0', 'apache-2.0': 'Apache-2.0', 'mpl-2': 'MPL-2.0', 'mpl-2.0': 'MPL-2.0',
};

/** The output of a command; what it prints on stderr, and its exit code, say that some of the words are unknown. */
function output(program, words) {
  try {
    return execFileSync(program, words, { encoding: 'utf8', maxBuffer: 1 << 30, stdio: ['ignore', 'pipe', 'ignore'] });
  } catch (failure) {
    if (failure.stdout === undefined || failure.code === 'ENOENT') throw failure;
    return failure.stdout;
  }
}

const lines = (text) => text.split('\n').filter(Boolean);

/** `GPL-2+` -> `GPL-2.0-or-later`; undefined for what SPDX has no name for. */
function spdxName(word) {
  const gnu = /^(A?L?GPL)-(\d)(?:\.(\d))?(\+?)$/.exec(word);
  if (gnu) return `${gnu[1]}-${gnu[2]}.${gnu[3] ?? 0}-${gnu[4] ? 'or-later' : 'only'}`;
  return SPDX_NAMES[word.toLowerCase()];
}

/** An expression of SPDX for Debian's: names joined by `or` and `and`. */
function spdxExpression(text) {
  const words = text.trim().split(/\s+/);
  const result = words.map((word, i) => (i % 2 === 0 ? spdxName(word) : { or: 'OR', and: 'AND' }[word.toLowerCase()]));
  return words.length % 2 === 1 && result.every(Boolean) ? result.join(' ') : undefined;
}

/** What the copyright file of a Debian package says of `Files: *`. */
function licenceOf(debianPackage) {
  const file = `/usr/share/doc/${debianPackage}/copyright`;
  const whole = existsSync(file) && readFileSync(file, 'utf8').split(/\n\s*\n/).find((paragraph) => /^Files:\s*\*\s*$/m.test(paragraph));
  const words = whole && /^License:[ \t]*(\S.*)$/m.exec(whole)?.[1];
  if (!words) return { licenseDeclared: 'NOASSERTION' };
  return { licenseDeclared: spdxExpression(words) ?? 'NOASSERTION', licenseComments: `Debian's copyright file says: ${words.trim()}` };
}

/** The Debian packages that own some files. A package that names /lib is found there alone, where /lib is a link to /usr/lib. */
function ownersOf(files) {
  const asked = files.flatMap((file) => [file, file.replace(/^\/usr\/lib/, '/lib')]);
  const owners = new Set();
  for (let i = 0; i < asked.length; i += 1000) {
    for (const line of lines(output('dpkg', ['-S', ...new Set(asked.slice(i, i + 1000))]))) {
      if (line.startsWith('diversion by')) continue;
      for (const name of line.slice(0, line.lastIndexOf(': ')).split(', ')) owners.add(name.split(':')[0]);
    }
  }
  return owners;
}

const realFile = (file) => (existsSync(file) ? realpathSync(file) : undefined);

function loadedLibraries() {
  const files = PROGRAMS.flatMap((name) => lines(output('ldd', [join(BUILD, 'bin', name)])).map((line) => /(\/\S+) \(0x/.exec(line)?.[1]));
  return new Set(files.filter(Boolean).map(realFile).filter(Boolean));
}

/** Headers outside the sources that any object file but those of tests was compiled with. */
function usedHeaders() {
  const headers = new Set();
  let counts = false;
  for (const line of lines(output('ninja', ['-C', BUILD, '-t', 'deps']))) {
    if (!line.startsWith(' ')) counts = !line.startsWith('tests/');
    else if (counts && line.startsWith('    /usr/')) headers.add(realFile(line.trim()));
  }
  headers.delete(undefined);
  return headers;
}

const id = (text) => `SPDXRef-${text.replace(/[^A-Za-z0-9.-]/g, '-')}`;

function debianPackages(names) {
  const format = '${Package}\t${Version}\t${source:Package}\t${source:Version}\t${Homepage}\n';
  const known = new Map(lines(output('dpkg-query', ['-W', '-f', format, ...names])).map((line) => [line.split('\t')[0], line.split('\t')]));
  return [...names].sort().map((name) => {
    const [, version, source, sourceVersion, homepage] = known.get(name);
    return {
      SPDXID: id(`deb-${name}`), name, versionInfo: version, downloadLocation: 'NOASSERTION', filesAnalyzed: false,
      supplier: 'Organization: Debian', ...(homepage ? { homepage } : {}), licenseConcluded: 'NOASSERTION', ...licenceOf(name),
      copyrightText: 'NOASSERTION', sourceInfo: `built from the Debian source package ${source} ${sourceVersion}`,
      externalRefs: [{ referenceCategory: 'PACKAGE-MANAGER', referenceType: 'purl', referenceLocator: `pkg:deb/debian/${name}@${encodeURIComponent(version)}` }],
    };
  });
}

function pagePackages() {
  const { packages } = JSON.parse(readFileSync(join(SOURCE, 'viz_node/web/package-lock.json'), 'utf8'));
  return Object.entries(packages).filter(([path, { dev }]) => path !== '' && !dev).map(([path, { version, license }]) => {
    const name = path.slice(path.lastIndexOf('node_modules/') + 'node_modules/'.length);
    return {
      SPDXID: id(`npm-${name}`), name, versionInfo: version, downloadLocation: 'NOASSERTION', filesAnalyzed: false,
      licenseConcluded: 'NOASSERTION', licenseDeclared: license ?? 'NOASSERTION', copyrightText: 'NOASSERTION',
      externalRefs: [{ referenceCategory: 'PACKAGE-MANAGER', referenceType: 'purl', referenceLocator: `pkg:npm/${name.replace('@', '%40')}@${version}` }],
    };
  });
}

function document() {
  const version = /project\(cordis VERSION (\S+)/.exec(readFileSync(join(SOURCE, 'CMakeLists.txt'), 'utf8'))[1];
  const commit = output('git', ['-C', SOURCE, 'log', '-1', '--format=%H %ct']).trim().split(' ');
  const seconds = Number(process.env.SOURCE_DATE_EPOCH ?? commit[1] ?? 0);
  const loaded = ownersOf([...loadedLibraries()]);
  const compiledWith = [...ownersOf([...usedHeaders()])].filter((name) => !loaded.has(name));
  const libraries = debianPackages(loaded);
  const headers = debianPackages(compiledWith);
  const page = pagePackages();
  const cordis = {
    SPDXID: 'SPDXRef-cordis', name: 'cordis', versionInfo: version, downloadLocation: 'NOASSERTION', filesAnalyzed: false,
    licenseConcluded: 'MIT', licenseDeclared: 'MIT', copyrightText: /^Copyright.*$/m.exec(readFileSync(join(SOURCE, 'LICENSE'), 'utf8'))[0],
    primaryPackagePurpose: 'APPLICATION',
  };
  const relation = (from, relationshipType, to) => ({ spdxElementId: from, relationshipType, relatedSpdxElement: to });
  return {
    spdxVersion: 'SPDX-2.3', dataLicense: 'CC0-1.0', SPDXID: 'SPDXRef-DOCUMENT', name: `cordis-${version}`,
    documentNamespace: `urn:cordis:sbom:${version}:${commit[0] || 'unknown'}`,
    creationInfo: { created: new Date(seconds * 1000).toISOString().replace('.000', ''), creators: ['Tool: deploy/sbom.mjs'] },
    packages: [cordis, ...libraries, ...headers, ...page],
    relationships: [
      relation('SPDXRef-DOCUMENT', 'DESCRIBES', cordis.SPDXID),
      ...libraries.map((library) => relation(cordis.SPDXID, 'DEPENDS_ON', library.SPDXID)),
      ...headers.map((header) => relation(header.SPDXID, 'BUILD_DEPENDENCY_OF', cordis.SPDXID)),
      ...page.map((part) => relation(cordis.SPDXID, 'CONTAINS', part.SPDXID)),
    ],
  };
}

try {
  for (const name of PROGRAMS) {
    if (!existsSync(join(BUILD, 'bin', name))) throw new Error(`${join(BUILD, 'bin', name)} is missing: build Cordis first, or name its build folder`);
  }
  process.stdout.write(`${JSON.stringify(document(), null, 2)}\n`);
} catch (failure) {
  process.stderr.write(`sbom: ${failure.message}\n`);
  process.exitCode = 1;
}
