// Type-checks and bundles the page: node build.mjs FOLDER writes index.html, app.js and app.css into FOLDER, and
// each of them compressed (.gz).
import {execFileSync} from 'node:child_process';
import {mkdirSync, readFileSync, writeFileSync} from 'node:fs';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {gzipSync} from 'node:zlib';
import {build} from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2] ?? join(here, 'dist');
mkdirSync(out, {recursive: true});
execFileSync(process.execPath, [join(here, 'node_modules/typescript/bin/tsc'), '--noEmit', '-p', here],
             {stdio: 'inherit'});
await build({
  entryPoints: {app: join(here, 'src/main.ts')},
  bundle: true, minify: true, format: 'esm', target: 'es2020', outdir: out, legalComments: 'none',
});
writeFileSync(join(out, 'index.html'), readFileSync(join(here, 'src/index.html')));
let total = 0;
for (const name of ['index.html', 'app.js', 'app.css']) {
  // mtime 0 makes the output reproducible.
  const packed = gzipSync(readFileSync(join(out, name)), {level: 9});
  writeFileSync(join(out, `${name}.gz`), packed);
  total += packed.length;
}
console.log(`page: ${(total / 1024).toFixed(0)} KiB compressed`);
