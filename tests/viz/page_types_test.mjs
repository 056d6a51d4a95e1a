// tests/viz/page_types_test.mjs -- the page's TypeScript has no type errors: esbuild, which bundles
// it, does not look.
import { spawnSync } from 'node:child_process';
import { join } from 'node:path';
import { need, web } from './session.mjs';

const { bin } = need('typescript/package.json');
const words = [join(web, 'node_modules/typescript', bin.tsc), '--noEmit', '-p', web];
const checked = spawnSync(process.execPath, words, { encoding: 'utf8' });
process.stdout.write(checked.stdout + checked.stderr);
process.exit(checked.status ?? 1);
