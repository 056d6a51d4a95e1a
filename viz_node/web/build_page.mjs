// viz_node/web/build_page.mjs -- bundles the page into the folder given: node build_page.mjs
// OUT_FOLDER
import { build } from 'esbuild';
import { copyFile, mkdir, readFile, writeFile } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { brotliCompressSync, gzipSync } from 'node:zlib';

const sources = join(dirname(fileURLToPath(import.meta.url)), 'page');
const out = process.argv[2];
if (!out) {
  console.error('usage: node build_page.mjs OUT_FOLDER');
  process.exit(2);
}

/** three.js in single modules: only what the page imports is bundled. It draws by gl_canvas.ts, so no renderer of three.js is. */
const threeInModules = {
  name: 'three-in-modules',
  setup({ onResolve }) {
    const core = join(sources, '../node_modules/three/src/Three.Core.js');
    onResolve({ filter: /^three$/ }, () => ({ path: core, sideEffects: false }));
  },
};

await mkdir(out, { recursive: true });
await build({
  entryPoints: [
    { in: join(sources, 'main.ts'), out: 'page' },
    { in: join(sources, 'page.css'), out: 'page' },
    { in: join(sources, 'sound/worklet.ts'), out: 'sound' }, // runs in the audio thread
  ],
  outdir: out,
  bundle: true,
  minify: true,
  format: 'esm',
  target: 'es2022',
  plugins: [threeInModules],
  legalComments: 'inline',
  logLevel: 'warning',
});
await copyFile(join(sources, 'index.html'), join(out, 'index.html'));

// viz_node sends these to browsers that take them: a third of the bytes.
for (const name of ['index.html', 'page.js', 'page.css', 'sound.js']) {
  const content = await readFile(join(out, name));
  await writeFile(join(out, `${name}.gz`), gzipSync(content, { level: 9 }));
  await writeFile(join(out, `${name}.br`), brotliCompressSync(content));
}
