#!/usr/bin/env node
// Draws docs/images/view.png and the examples' thumbnails: node scripts/view_pictures.mjs, after
// `make build`.
import {spawn} from 'node:child_process';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {chromium} from '../web/node_modules/playwright-core/index.mjs';

const root = join(dirname(fileURLToPath(import.meta.url)), '..');
const program = process.env.SINEW_PROGRAM ?? join(root, 'build/release/bin/sinew');
// Scene, the step at which it is drawn.
const EXAMPLES = [['trunk/circle', 320], ['trunk/trunk', 250], ['arm/square', 420], ['beam/swing', 60]];
const browser = await chromium.launch({executablePath: '/usr/bin/chromium', args: [
  '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
  '--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run']});

/** A page of a scene at a step, coloured by stress. */
async function open(scene, step, width, height) {
  const child = spawn(program, ['view', join(root, 'examples', `${scene}.yaml`), '--no-open', '--port', '0', '--paused']);
  const url = await new Promise((resolve) => child.stdout.on('data', (data) => {
    const found = /http:\S+/.exec(String(data));
    if (found) resolve(found[0]);
  }));
  const page = await browser.newPage({viewport: {width, height}});
  await page.goto(url);
  await page.waitForFunction(() => window.sinewView?.state().sequence > 0);
  await page.selectOption('[aria-label="Colour by"]', 'stress');
  for (let done = 0; done < step; done += 20) await page.evaluate(() => window.sinewView.request({type: 'step', count: 20}));
  await page.waitForTimeout(500);
  return {page, close: async () => { await page.close(); child.kill('SIGINT'); }};
}

const view = await open('trunk/circle', 620, 1280, 800);
await view.page.screenshot({path: join(root, 'docs/images/view.png')});
await view.close();
for (const [scene, step] of EXAMPLES) {
  const {page, close} = await open(scene, step, 360, 240);
  await page.addStyleTag({content: '#top, #panel, #plots, #legend, #alerts { display: none !important; }'});
  await page.waitForTimeout(300);
  await page.screenshot({path: join(root, 'examples', `${scene}.png`)});
  await close();
}
await browser.close();
