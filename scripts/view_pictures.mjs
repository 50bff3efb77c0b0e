#!/usr/bin/env node
// Draws the pictures of docs/view.md (docs/images/view*.png) and the examples' thumbnails. With words, it draws only
// those whose file names contain one of them: node scripts/view_pictures.mjs [WORD ...], after `make build`.
import {execFileSync, spawn} from 'node:child_process';
import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {chromium} from '../web/node_modules/playwright-core/index.mjs';

const root = join(dirname(fileURLToPath(import.meta.url)), '..');
const program = process.env.SINEW_PROGRAM ?? join(root, 'build/release/bin/sinew');
const circle = join(root, 'examples/trunk/circle.yaml');
// Scene, step at which it is drawn, and whether it is coloured by von Mises stress (default true).
const EXAMPLES = [['trunk/circle', 320], ['trunk/trunk', 250], ['arm/square', 420], ['beam/swing', 60], ['arm/conical', 25],
                  ['finger/module', 190], ['ring/sma', 300], ['roll/roll', 60], ['arm/curl', 540], ['arm/underwater', 400],
                  ['contact/incline', 120], ['contact/lift', 300], ['contact/soft_lift', 300], ['contact/squeeze', 500],
                  ['finger/sensors', 150], ['finger/hold', 80], ['finger/push', 150], ['finger/ribbed', 50], ['fluidic_arm/arm', 500, false], ['fluidic_arm/brace', 0, false], ['joints/two_segments', 120],
                  ['rigid/bounce', 60, false], ['rigid/hand', 100], ['rigid/slider_crank', 120, false],
                  ['rigid/urdf_arm', 300, false]];
const words = process.argv.slice(2);
const browser = await chromium.launch({executablePath: '/usr/bin/chromium', args: [
  '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
  '--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run']});

/** Saves a picture of the page of `sinew view SCENE`. @param act prepares the page. */
async function draw(file, scene, size = {}, act = async () => undefined) {
  await drawPage(file, () => spawn(program, ['view', ...scene, '--no-open', '--port', '0', '--paused']), size, act);
}

/** The same of the page of a Python script. */
async function drawScript(file, script, act) {
  const env = {...process.env, PYTHONPATH: join(root, 'build/release/python')};
  await drawPage(file, () => spawn('/usr/bin/python3', ['-u', join(root, script[0]), ...script.slice(1)], {env}), {}, act);
}

async function drawPage(file, start, {width = 1280, height = 800}, act) {
  if (words.length > 0 && !words.some((word) => file.includes(word))) return;
  const child = start();
  const url = await new Promise((resolve) => child.stdout.on('data', (data) => {
    const found = /http:\S+/.exec(String(data));
    if (found) resolve(found[0]);
  }));
  const page = await browser.newPage({viewport: {width, height}});
  page.setDefaultTimeout(300e3);  // ms; a busy machine without a GPU is slow
  await page.goto(url);
  await page.waitForFunction(() => window.sinewView?.state().connected && window.sinewView.scene());
  await act(page);
  await page.waitForTimeout(600);
  await drawn(page);
  await page.screenshot({path: join(root, file)});
  await page.close();
  child.kill('SIGINT');
}

/** Waits until the last frame has been drawn. */
const drawn = (page) => page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
const ask = (page, message) => page.evaluate((m) => window.sinewView.request(m), message);

async function step(page, count) {
  for (let done = 0; done < count; done += 20) await ask(page, {type: 'step', count: 20});
  await page.waitForFunction((least) => window.sinewView.state().step >= least, count);
  await drawn(page);
}

async function colour(page, field) {
  await page.selectOption('[aria-label="Colour by"]', field);
}

await drawScript('docs/images/view_wall.png', ['examples/high_rate/wall.py', '--view'], async (page) => {
  await page.waitForFunction(() => window.sinewView.state().time > 4 && window.sinewView.state().signals['felt.force'] > 7.5);
  await ask(page, {type: 'pause'});
});
await draw('docs/images/view.png', [circle], {}, async (page) => {
  await colour(page, 'von_mises_stress');
  await step(page, 620);
});
await draw('docs/images/view_dark.png', [circle], {}, async (page) => {
  await page.keyboard.press('d');
  await colour(page, 'displacement');
  await page.getByRole('button', {name: 'Another plot'}).click();
  await page.selectOption('[aria-label="Signals to plot"] >> nth=1', 'error');
  await page.keyboard.press('e');
  await step(page, 500);
  await page.check('[aria-label="Keep the range"]');
});
await draw('docs/images/view_reach.png', [circle], {}, async (page) => {
  for (const [axis, value] of [['x', 100], ['y', 0], ['z', 160]]) {
    await page.fill(`[aria-label="tip: target ${axis} in mm"]`, String(value));
  }
  await page.keyboard.press('Tab');
  await step(page, 260);
});
await draw('docs/images/view_fields.png', [join(root, 'examples/ring/sma.yaml')], {}, async (page) => {
  await colour(page, 'max_stretch');
  await page.selectOption('[aria-label="Signals to plot"]', 'probe');
  await step(page, 400);
});
await draw('docs/images/view_contact.png', [join(root, 'examples/contact/squeeze.yaml')], {}, async (page) => {
  await page.selectOption('[aria-label="Signals to plot"]', 'contact');
  await step(page, 500);
});
await draw('docs/images/view_joints.png', [join(root, 'examples/rigid/slider_crank.yaml')], {}, async (page) => {
  await page.selectOption('[aria-label="Signals to plot"]', 'joint rad');
  await step(page, 140);
  await page.waitForFunction(() => window.sinewView.state().step === 140);
  await page.getByText('knee', {exact: true}).click();
});
await draw('docs/images/view_section.png', [join(root, 'examples/finger/module.yaml')], {}, async (page) => {
  await colour(page, 'von_mises_stress');
  await step(page, 260);
  await page.selectOption('[aria-label="Section across"]', {label: 'section at y'});
  await page.getByRole('button', {name: 'Show the other side of the section'}).click();
  await page.waitForFunction(() => window.sinewView.section(0)?.triangles > 0);
  await page.keyboard.press('w');
  await drawn(page);
  const [x, y] = await page.evaluate(() => {
    const {min, max} = window.sinewView.box();
    return window.sinewView.screen(min.x + 0.3 * (max.x - min.x), (min.y + max.y) / 2, min.z + 0.55 * (max.z - min.z));
  });
  await page.mouse.click(x, y);
  await page.locator('#picked').waitFor({timeout: 60e3});
  await page.locator('#picked').getByRole('button', {name: 'Values of the element (n)'}).click();
  await page.locator('#picked').getByText(', element ').waitFor();
});
await draw('docs/images/contact_lift.png', [join(root, 'examples/contact/lift.yaml')], {}, async (page) => {
  await page.selectOption('[aria-label="Signals to plot"]', 'contact');
  await step(page, 300);
});
await draw('docs/images/contact_soft_lift.png', [join(root, 'examples/contact/soft_lift.yaml')], {}, async (page) => {
  await page.selectOption('[aria-label="Signals to plot"]', 'contact');
  await colour(page, 'von_mises_stress');
  await step(page, 300);
});
const folder = mkdtempSync(join(tmpdir(), 'sinew-pictures-'));
execFileSync(program, ['run', circle, '--duration', '4s', '--out', folder, '--quiet']);
await draw('docs/images/view_replay.png', [folder], {}, async (page) => {
  await colour(page, 'max_stretch');
  for (let frame = 0; frame <= 250; frame += 10) await ask(page, {type: 'seek', frame});
});
rmSync(folder, {recursive: true});
await draw('docs/images/view_tablet.png', [circle], {width: 820, height: 1100}, async (page) => {
  await colour(page, 'von_mises_stress');
  await step(page, 300);
});
for (const [scene, count, coloured = true] of EXAMPLES) {
  await draw(`examples/${scene}.png`, [join(root, 'examples', `${scene}.yaml`)], {width: 600, height: 400}, async (page) => {
    if (coloured) await colour(page, 'von_mises_stress');
    await step(page, count);
    await page.addStyleTag({content: '#top, #panel, #plots, #side, #scale { display: none !important; }'});
    await page.evaluate(() => window.sinewView.plain());
  });
}
await draw('docs/images/view_gallery.png', [], {}, async (page) => {
  await page.waitForFunction(() => [...document.querySelectorAll('.example img')].every((image) => image.complete));
});
await browser.close();
