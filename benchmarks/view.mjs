#!/usr/bin/env node
// How the view feels, measured in a browser: node benchmarks/view.mjs [SCENE], after `make build`.
// Frames that arrive while the robot runs in real time, how long a slider takes to show, and the
// script's part of drawing a frame, apart from drawing itself (there may be no GPU).
import {spawn} from 'node:child_process';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {chromium} from '../web/node_modules/playwright-core/index.mjs';

const root = join(dirname(fileURLToPath(import.meta.url)), '..');
const program = process.env.SINEW_PROGRAM ?? join(root, 'build/release/bin/sinew');
const scene = process.argv[2] ?? join(root, 'examples/trunk/trunk.yaml');
const SECONDS = 10, SLIDES = 60;

const child = spawn(program, ['view', scene, '--no-open', '--port', '0']);
const url = await new Promise((resolve) => child.stdout.on('data', (data) => {
  const found = /http:\S+/.exec(String(data));
  if (found) resolve(found[0]);
}));
const browser = await chromium.launch({executablePath: process.env.SINEW_CHROMIUM ?? '/usr/bin/chromium', args: [
  '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
  '--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run']});

// A page of the same origin that draws nothing: what the server delivers.
const bare = await browser.newPage();
await bare.goto(`${url}app.css`);
const wire = await bare.evaluate(async ({seconds, slides}) => {
  const socket = new WebSocket(`ws://${location.host}/view`);
  socket.binaryType = 'arraybuffer';
  await new Promise((resolve) => { socket.onopen = resolve; });
  let scene = null, arrivals = [], bytes = 0, watch = null, factor = NaN, latest = null;
  socket.onmessage = ({data}) => {
    if (typeof data === 'string') {
      const message = JSON.parse(data);
      if (message.type !== 'scene') return;
      scene = message.scene;
      socket.send(JSON.stringify({type: 'ready', generation: message.generation}));
      return;
    }
    const view = new DataView(data);
    if (view.getUint16(4, true) !== 2) return;
    arrivals.push(performance.now());
    bytes += data.byteLength;
    const signals = new Float64Array(data, 40, view.getUint32(12, true));
    factor = signals[scene.signals.findIndex((s) => s.key === 'real_time_factor')];
    latest = signals;
    watch?.(signals);
  };
  socket.send(JSON.stringify({type: 'hello', protocol: 2}));
  const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
  await wait(1000);
  arrivals = [];
  bytes = 0;
  await wait(1000 * seconds);
  const gaps = arrivals.slice(1).map((t, k) => t - arrivals[k]).sort((a, b) => a - b);
  const result = {frames: arrivals.length / seconds, bytes: bytes / arrivals.length, gap95: gaps[Math.floor(0.95 * gaps.length)],
                  factor, slides: []};
  // Every actuator's first quantity, a hundredth of its range up and down; shown when its own number changes.
  const {actuators} = scene;
  for (let k = 0; k < slides; ++k) {
    const index = k % actuators.length, {name, quantities: [quantity]} = actuators[index];
    const column = index + (quantity.name === 'displacement' ? actuators.length : 0);
    const value = quantity.low + (quantity.high - quantity.low) * (0.3 + 0.01 * (k % 7));
    const before = latest[column], least = 1e-4 * (quantity.high - quantity.low);
    const begin = performance.now();
    const changed = new Promise((resolve) => {
      watch = (signals) => { if (Math.abs(signals[column] - before) > least) resolve(performance.now() - begin); };
    });
    socket.send(JSON.stringify({type: 'command', actuator: name, quantity: quantity.name, value}));
    const shown = await Promise.race([changed, wait(1000).then(() => null)]);
    if (shown !== null) result.slides.push(shown);
    await wait(300);
  }
  socket.close();
  return result;
}, {seconds: SECONDS, slides: SLIDES});
await bare.close();

const page = await browser.newPage({viewport: {width: 1280, height: 800}});
await page.goto(url);
await page.waitForFunction(() => window.sinewView?.state().sequence > 0);
await page.selectOption('[aria-label="Colour by"]', 'von_mises_stress');
await page.waitForTimeout(1000 * SECONDS);
const state = await page.evaluate(() => window.sinewView.state());
await browser.close();
child.kill('SIGINT');

const sorted = wire.slides.sort((a, b) => a - b);
const at = (part) => sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))].toFixed(1);
const rows = [
  ['frames that arrive', `${wire.frames.toFixed(1)} a second`],
  ['95 % of them within', `${wire.gap95.toFixed(1)} ms of the one before`],
  ['bytes of a frame', `${(wire.bytes / 1000).toFixed(1)} kB`],
  ['real-time factor', wire.factor.toFixed(2)],
  ['slider to changed frame', `${at(0.5)} ms (95 %: ${at(0.95)}, longest ${at(1)}; ${sorted.length} of ${SLIDES} moves)`],
  ['script for a frame, coloured', `${state.scriptMs.toFixed(1)} ms (95 %)`],
];
for (const [what, value] of rows) console.log(`${what.padEnd(30)} ${value}`);
