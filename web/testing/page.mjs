// Serves the view and opens its pages in a real browser, for tests. Importing this file starts and stops the browser.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {dirname, join} from 'node:path';
import {after, before} from 'node:test';
import {fileURLToPath} from 'node:url';
import {chromium} from 'playwright-core';

export const ROOT = join(dirname(fileURLToPath(import.meta.url)), '../..');
export const PROGRAM = process.env.SINEW_PROGRAM ?? join(ROOT, 'build/release/bin/sinew');
export const PACKAGE = process.env.SINEW_PYTHON_PATH ?? join(ROOT, 'build/release/python');
const CHROMIUM = process.env.SINEW_CHROMIUM ?? '/usr/bin/chromium';

let browser;
const programs = new Set();

before(async () => {
  browser = await chromium.launch({executablePath: CHROMIUM, args: [
    '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
    '--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run']});
});
after(async () => {
  for (const program of programs) program.kill('SIGKILL');
  await browser?.close();
});

/** Registers a program, which is killed after the tests if it still runs. */
export function watched(program) {
  programs.add(program);
  program.on('exit', () => programs.delete(program));
  return program;
}

export async function newPage() {
  const page = await browser.newPage({viewport: {width: 1280, height: 800}});
  page.setDefaultTimeout(120e3);  // ms; a busy machine without a GPU is slow
  return page;
}

/** Starts `sinew view`. Resolves with the process, its URL and its port. */
export async function serve(scene, port = 0, ...more) {
  const program = watched(spawn(PROGRAM, ['view', scene, '--no-open', '--port', String(port), ...more]));
  const url = await new Promise((resolve, reject) => {
    let text = '', errors = '';
    program.stderr.on('data', (data) => { errors += data; });
    program.stdout.on('data', (data) => {
      text += data;
      const found = /http:\S+/.exec(text);
      if (found) resolve(found[0]);
    });
    program.on('exit', (code) => reject(new Error(`sinew view ended with ${code}: ${errors}`)));
  });
  return {program, url, port: Number(new URL(url).port)};
}

export async function stop({program}) {
  const ended = new Promise((resolve) => program.on('exit', resolve));
  program.kill('SIGINT');
  return ended;
}

/** Opens a page of the view and waits for its first frame. @param errors receives the errors of the page and its console. */
export async function open(url, errors = []) {
  const page = await newPage();
  page.on('console', (message) => { if (message.type() === 'error') errors.push(message.text()); });
  page.on('pageerror', (error) => errors.push(error.message));
  await page.goto(url);
  await until(page, (s) => s.connected && s.sequence > 0 && s.status?.commands);
  return page;
}

export const state = (page) => page.evaluate(() => window.sinewView.state());
export const ask = (page, message) => page.evaluate((m) => window.sinewView.request(m), message);

/** Evaluates a function in the page after the last frame has been drawn, which may take a while without a GPU. */
export async function drawn(page, what) {
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
  return page.evaluate(what);
}

/** Waits until the state of a page satisfies a condition, and resolves with the state. */
export async function until(page, holds, seconds = 20) {
  for (let tries = 0; tries < 20 * seconds; ++tries) {
    const now = await state(page).catch(() => null);
    if (now && holds(now)) return now;
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  assert.fail(`waited in vain; the page says ${JSON.stringify(await state(page))}`);
}
