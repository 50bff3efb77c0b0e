#!/usr/bin/env node
// Draws docs/images/view.png: node scripts/view_pictures.mjs, after `make build`.
import {spawn} from 'node:child_process';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {chromium} from '../web/node_modules/playwright-core/index.mjs';

const root = join(dirname(fileURLToPath(import.meta.url)), '..');
const program = spawn(join(root, 'build/release/bin/sinew'),
                      ['view', join(root, 'examples/trunk/circle.yaml'), '--no-open', '--port', '0']);
const url = await new Promise((resolve) => program.stdout.on('data', (data) => {
  const found = /http:\S+/.exec(String(data));
  if (found) resolve(found[0]);
}));
const browser = await chromium.launch({executablePath: '/usr/bin/chromium', args: [
  '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
  '--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run']});
const page = await browser.newPage({viewport: {width: 1280, height: 800}});
await page.goto(url);
await page.waitForFunction(() => window.sinewView?.state().step > 100);
await page.selectOption('[aria-label="Colour by"]', 'stress');
await page.waitForFunction(() => window.sinewView.state().step > 620);
await page.screenshot({path: join(root, 'docs/images/view.png')});
await browser.close();
program.kill('SIGINT');
