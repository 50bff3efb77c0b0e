// Tests of the view in a real browser: SINEW_PROGRAM=... SINEW_PYTHON_PATH=... node --test web/test
import assert from 'node:assert/strict';
import {execFileSync, spawn} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {test} from 'node:test';
import validator from 'gltf-validator';
import {ask, drawn, newPage, open, PACKAGE, PROGRAM, ROOT, serve, state, stop, until, watched} from '../testing/page.mjs';

const DIRECT = join(ROOT, 'examples/trunk/trunk.yaml');
const MODULE = join(ROOT, 'examples/finger/module.yaml');
const SQUEEZE = join(ROOT, 'examples/contact/squeeze.yaml');
const CRANK = join(ROOT, 'examples/rigid/slider_crank.yaml');
const STEERED = join(ROOT, 'examples/trunk/circle.yaml');

async function download(page, name) {
  return Buffer.from(await page.evaluate(async (file) => {
    const bytes = new Uint8Array(await (await fetch(`download/${file}`)).arrayBuffer());
    return Array.from(bytes);
  }, name));
}

/** Asserts that the Khronos validator finds no errors or warnings in a GLB file. */
async function valid(bytes) {
  const {issues} = await validator.validateBytes(new Uint8Array(bytes));
  assert.deepEqual(issues.messages.filter((m) => m.severity < 2), []);
}

/** The JSON of a GLB file, the times of its animation, and the largest displacement component of the first mesh at the end. */
function animation(bytes) {
  const length = bytes.readUInt32LE(12);
  const json = JSON.parse(bytes.subarray(20, 20 + length).toString());
  const floats = (index) => {
    const accessor = json.accessors[index], view = json.bufferViews[accessor.bufferView];
    const count = accessor.count * (accessor.type === 'VEC3' ? 3 : 1);
    const at = 28 + length + view.byteOffset;
    return Array.from({length: count}, (_, k) => bytes.readFloatLE(at + 4 * k));
  };
  const {targets} = json.meshes[0].primitives[0];
  const moved = Math.max(...floats(targets.at(-1).POSITION).map(Math.abs));
  return {json, times: floats(json.animations[0].samplers[0].input), moved};
}

function python(code) {
  return JSON.parse(execFileSync('/usr/bin/python3', ['-c', code], {
    env: {...process.env, PYTHONPATH: PACKAGE}, encoding: 'utf8'}));
}

test('the page loads without an error and shows the robot', async () => {
  const served = await serve(STEERED);
  const errors = [];
  const page = await open(served.url, errors);
  await page.selectOption('[aria-label="Colour by"]', 'von_mises_stress');
  await until(page, (s) => s.field === 'von_mises_stress' && s.range[1] > 1000);
  assert.ok(await page.locator('#legend .bar').isVisible());
  assert.match(await page.locator('#legend').innerText(), /Von Mises stress[\s\S]*kPa/);
  // The robot is drawn: the canvas has many colours.
  const colours = await page.evaluate(() => {
    const canvas = document.querySelector('#stage canvas');
    const copy = Object.assign(document.createElement('canvas'), {width: 128, height: 80});
    const context = copy.getContext('2d');
    context.drawImage(canvas, 0, 0, 128, 80);
    const {data} = context.getImageData(0, 0, 128, 80);
    const seen = new Set();
    for (let i = 0; i < data.length; i += 4) seen.add(data[i] << 16 | data[i + 1] << 8 | data[i + 2]);
    return seen.size;
  });
  assert.ok(colours > 40, `only ${colours} colours`);
  const unlabelled = await page.evaluate(() => [...document.querySelectorAll('button, input, select')]
    .filter((e) => !e.getAttribute('aria-label') && !e.closest('label')).length);
  assert.equal(unlabelled, 0);
  await page.keyboard.press('?');
  assert.ok(await page.locator('dialog').isVisible());
  await page.keyboard.press('Escape');
  const [picture] = await Promise.all([page.waitForEvent('download'), page.keyboard.press('p')]);
  assert.deepEqual([...readFileSync(await picture.path()).subarray(0, 4)], [0x89, 0x50, 0x4e, 0x47]);
  // The download of a first visit is small.
  const sizes = await page.evaluate(() => Promise.all(['', 'app.js', 'app.css'].map(async (name) =>
    Number((await fetch(name)).headers.get('content-length')))));
  assert.ok(sizes.every((size) => size > 0) && sizes.reduce((a, b) => a + b) < 1e6, String(sizes));
  assert.deepEqual(errors, []);
  await page.close();
  assert.equal(await stop(served), 0);
});

test('a slider does what Python does', async () => {
  const served = await serve(DIRECT, 0, '--paused');
  const page = await open(served.url);
  await page.fill('input[type=number][aria-label^="long_2: tension"]', '1.5');
  await page.keyboard.press('Enter');
  await until(page, (s) => s.status.commands.long_2.value === 1.5);
  await ask(page, {type: 'step', count: 120});
  const here = await until(page, (s) => s.step === 120);
  const there = python(`
import json, sinew
sim = sinew.load(${JSON.stringify(DIRECT)})
sim.follow()  # as the view does
sim.actuator("long_2").tension = 1.5
sim.step(120)
print(json.dumps({"tip": list(sim.effector("tip").position), "hash": f"{sim.state_hash:016x}"}))`);
  ['x', 'y', 'z'].forEach((axis, k) => {
    assert.ok(Math.abs(here.signals[`tip.${axis}`] - there.tip[k]) < 1e-6, `tip.${axis}`);
  });
  assert.ok(Math.abs(here.signals['tip.x']) + Math.abs(here.signals['tip.y']) > 1e-3, 'it has moved');
  assert.equal(here.hash, there.hash);
  await page.close();
  await stop(served);
});

test('pause and step count exactly, and reset restores the start bit for bit', async () => {
  const served = await serve(STEERED, 0, '--paused');
  const page = await open(served.url);
  const start = await state(page);
  assert.equal(start.step, 0);
  await ask(page, {type: 'step', count: 37});
  const later = await until(page, (s) => s.step === 37);
  assert.notEqual(later.hash, start.hash);
  await page.keyboard.press(' ');
  await until(page, (s) => s.step > 60);
  await page.keyboard.press(' ');
  const paused = await until(page, (s) => !s.status.playing);
  await new Promise((resolve) => setTimeout(resolve, 400));
  const still = await state(page);
  assert.ok(still.step - paused.step <= 3, 'a pause holds');
  await page.getByRole('button', {name: 'Back to the start (r)'}).click();
  const again = await until(page, (s) => s.step === 0);
  assert.equal(again.hash, start.hash);
  await ask(page, {type: 'step', count: 37});
  assert.equal((await until(page, (s) => s.step === 37)).hash, later.hash);
  await page.close();
  await stop(served);
});

/** Steps a scene in Python. Returns the range of every field on the surface, and the values of the probes. */
function measured(scene, steps) {
  return python(`
import json, sys
import numpy as np
import sinew
sim = sinew.load(${JSON.stringify(scene)})
sim.step(${steps})
body = next(iter(sim.bodies.values()))
faces = np.array([[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])
sides = np.array(body.hexahedra)[:, faces].reshape(-1, 4)
_, first, count = np.unique(np.sort(sides, axis=1), axis=0, return_index=True, return_counts=True)
seen = np.unique(sides[first[count == 1]])
fields = {name: body.nodal_field(name)[seen] for name in sinew.fields.FIELDS}
fields["displacement"] = np.linalg.norm(body.positions - body.rest_positions, axis=1)[seen]
print(json.dumps({"fields": {name: [v.min(), v.max()] for name, v in fields.items()},
                  "probes": {name: probe.value for name, probe in sim.probes.items()}}))`);
}

/** Chooses every field in turn, and compares the range and legend on the page with Python's values. */
async function compareFields(page, expected) {
  const close = (a, b, size) => Math.abs(a - b) <= 1e-5 * size;
  const choices = await page.evaluate(() => window.sinewView.scene().fields);
  assert.deepEqual(new Set(choices.map((f) => f.name)), new Set([...Object.keys(expected), 'actuator_force']));
  for (const {name, label, unit} of choices) {
    await page.selectOption('[aria-label="Colour by"]', name);
    if (!expected[name]) continue;
    const [low, high] = expected[name];
    const size = Math.max(Math.abs(low), Math.abs(high));
    await until(page, (s) => s.field === name && close(s.range[0], low, size) && close(s.range[1], high, size));
    const legend = await drawn(page, () => document.getElementById('legend').innerText);
    assert.ok(legend.startsWith(label), legend);
    if (unit !== '') assert.match(legend, new RegExp(`[mk]?${unit.replace('^3', '\u00b3')}`));
  }
}

test('every field has the colours and the legend of what Python finds', async () => {
  const served = await serve(MODULE, 0, '--paused');
  const errors = [];
  const page = await open(served.url, errors);
  await ask(page, {type: 'step', count: 60});
  const expected = measured(MODULE, 60);
  await compareFields(page, expected.fields);
  // A typed range stays while the robot moves.
  await page.selectOption('[aria-label="Colour by"]', 'max_stretch');
  await page.locator('[aria-label="Keep the range"]').check();
  await page.locator('[aria-label="Lowest value of the range"]').fill('1');
  await page.locator('[aria-label="Lowest value of the range"]').press('Enter');
  await page.locator('[aria-label="Highest value of the range"]').fill('1.5');
  await page.locator('[aria-label="Highest value of the range"]').press('Enter');
  await ask(page, {type: 'step', count: 3});
  await until(page, (s) => s.step === 63 && s.range[0] === 1 && s.range[1] === 1.5);
  assert.match(await drawn(page, () => document.getElementById('legend').innerText), /1\.500\s+1\.375\s+1\.250\s+1\.125\s+1\.000/);
  assert.deepEqual(errors, []);
  await page.close();
  await stop(served);
});

test('a recorded run has the same fields and probes', async () => {
  const folder = mkdtempSync(join(tmpdir(), 'sinew-view-'));
  execFileSync(PROGRAM, ['run', MODULE, '--duration', '0.3s', '--out', folder, '--quiet']);
  const served = await serve(folder, 0, '--paused');
  const page = await open(served.url);
  await page.locator('[aria-label="Frame of the recorded run"]').fill('25');
  await until(page, (s) => s.status.frame === 25 && s.step === 25);
  const expected = measured(MODULE, 25);
  await compareFields(page, expected.fields);
  assert.equal((await state(page)).signals['probe.bending'], expected.probes.bending);
  await page.close();
  await stop(served);
  rmSync(folder, {recursive: true});
});

test('probes are told as numbers and plotted', async () => {
  const served = await serve(MODULE, 0, '--paused');
  const page = await open(served.url);
  await ask(page, {type: 'step', count: 40});
  const {probes} = measured(MODULE, 40);
  const now = await until(page, (s) => s.step === 40);
  for (const [name, value] of Object.entries(probes)) {
    assert.equal(now.signals[`probe.${name}`], value, name);
  }
  const told = (name) => page.locator(`output[aria-label^="${name}:"]`).innerText();
  assert.equal(await told('bending'), `${Number((probes.bending * 180 / Math.PI).toPrecision(3))}\u00b0`);
  assert.equal(await told('axis'), `${Number((1e3 * probes.axis).toPrecision(3))} mm`);
  await page.selectOption('[aria-label="Signals to plot"]', 'angle');
  assert.match(await page.locator('#plots .u-legend').first().innerText(), /bending/);
  await page.close();
  await stop(served);
});

test('joints are drawn, chosen and hidden, live and as they were recorded', async () => {
  const folder = mkdtempSync(join(tmpdir(), 'sinew-view-'));
  execFileSync(PROGRAM, ['run', CRANK, '--duration', '0.1s', '--out', folder, '--quiet']);
  const expected = python(`
import json, numpy as np, sinew
sim = sinew.load(${JSON.stringify(CRANK)})
sim.step(100)
knee, guide = sim.joint("knee"), sim.joint("guide")
print(json.dumps({"point": (sim.body("piston").position).tolist(), "angle": knee.angle, "displacement": guide.displacement,
                  "force": float(np.linalg.norm(guide.force))}))`);
  const near = (a, b) => a.forEach((x, k) => assert.ok(Math.abs(x - b[k]) < 1e-6, `${a} and ${b}`));
  const check = async (page) => {
    const now = await until(page, (s) => s.step === 100);
    const told = () => drawn(page, () => window.sinewView.joints());
    const [shaft, knee, pin, guide] = await told();
    near(shaft.axis, [0, 0, 1]);
    near(pin.axis, [0, 0, 0]);
    near(guide.axis, [1, 0, 0]);
    near(guide.position, [0.2 + expected.displacement, 0, 0]);
    assert.ok(Math.abs(now.signals['knee.angle'] - expected.angle) < 1e-12);
    const text = await page.locator('output[aria-label="guide: joint"]').innerText();
    assert.ok(text.startsWith(`${Number((1e3 * expected.displacement).toPrecision(3))} mm, `), text);
    assert.ok(text.includes(`, ${Number((1e3 * expected.force).toPrecision(3))} mN, 0 N m`), text);
    // A click on the marker selects the joint and shows its label.
    const [x, y] = await page.evaluate((at) => window.sinewView.screen(...at), knee.position);
    await page.locator('#stage canvas').click({position: {x, y}});
    assert.deepEqual((await told()).map((joint) => joint.chosen), [false, true, false, false]);
    assert.ok((await told())[1].arrow, 'its force is drawn');
    const label = page.locator('#stage .told');
    assert.match(await label.innerText(), /^knee \(hinge\): -?[\d.]+\u00b0, [\d.]+ m?N, /);
    await page.keyboard.press('j');
    assert.ok((await told()).every((joint) => !joint.drawn) && !(await label.isVisible()));
    await page.keyboard.press('j');
    assert.ok(await drawn(page, () => window.sinewView.joints()[0].drawn) && await label.isVisible());
  };
  const errors = [];
  const live = await serve(CRANK, 0, '--paused');
  const page = await open(live.url, errors);
  await ask(page, {type: 'step', count: 100});
  await check(page);
  await page.selectOption('[aria-label="Signals to plot"]', 'joint rad');
  assert.match(await page.locator('#plots .u-legend').first().innerText(), /knee\.angle/);
  await page.close();
  await stop(live);
  const replayed = await serve(folder, 0, '--paused');
  const again = await open(replayed.url, errors);
  await again.locator('[aria-label="Frame of the recorded run"]').fill('100');
  await check(again);
  assert.deepEqual(errors, []);
  await again.close();
  await stop(replayed);
  rmSync(folder, {recursive: true});
});

test('contacts are drawn, live and as they were recorded', async () => {
  const folder = mkdtempSync(join(tmpdir(), 'sinew-view-'));
  execFileSync(PROGRAM, ['run', SQUEEZE, '--duration', '0.1s', '--out', folder, '--quiet']);
  const expected = python(`
import json, sinew
sim = sinew.load(${JSON.stringify(SQUEEZE)})
sim.step(80)
left = sim.contact("left")
print(json.dumps({"force": left.normal_force, "states": list(left.states), "forces": left.normal_forces.tolist()}))`);
  const count = (state) => expected.states.filter((s) => s === state).length;
  assert.ok(count('stick') + count('slip') > 3, 'it is held');
  const shown = async (page) => {
    await until(page, (s) => s.step === 80);
    return (await drawn(page, () => window.sinewView.contacts()))[0];
  };
  const check = async (page) => {
    const left = await shown(page);
    assert.deepEqual(left.points, ['open', 'stick', 'slip'].map(count));
    assert.ok(left.arrows > 0 && left.arrows <= count('stick') + count('slip'));
    assert.ok(Math.abs(left.position[0] - 0.005) < 1e-6, 'the rod has closed');
    assert.ok(Math.abs((await state(page)).signals['left.normal_force'] - expected.force) < 1e-9);
    assert.match(await page.locator('output[aria-label="left: contact"]').innerText(), / N, \d+ stick, \d+ slip/);
  };
  const live = await serve(SQUEEZE, 0, '--paused');
  const errors = [];
  const page = await open(live.url, errors);
  await ask(page, {type: 'step', count: 80});
  await check(page);
  await page.close();
  await stop(live);
  const replayed = await serve(folder, 0, '--paused');
  const again = await open(replayed.url, errors);
  await again.locator('[aria-label="Frame of the recorded run"]').fill('80');
  await check(again);
  assert.deepEqual(errors, []);
  await again.close();
  await stop(replayed);
  rmSync(folder, {recursive: true});
});

test('the robot goes where its target is put', async () => {
  const served = await serve(STEERED);
  const page = await open(served.url);
  for (const [axis, value] of [['x', 20], ['y', -10], ['z', 180]]) {
    await page.fill(`[aria-label="tip: target ${axis} in mm"]`, String(value));
    await page.keyboard.press('Tab');
  }
  // Each typed coordinate sets a target; the robot goes to the last one.
  const there = await until(page, (s) => Math.abs((s.status.targets.tip?.[1] ?? 0) + 0.01) < 1e-9
    && Math.abs(s.status.targets.tip[2] - 0.18) < 1e-9 && s.signals['tip.error'] < 1e-4 && Math.abs(s.signals['tip.y'] + 0.01) < 2e-4);
  assert.ok(Math.abs(there.signals['tip.x'] - 0.02) < 2e-4 && Math.abs(there.signals['tip.z'] - 0.18) < 2e-4);
  // The mouse drags the target down by its z arrow.
  const [x, y] = await drawn(page, () => window.sinewView.arrows()[2]);
  await page.mouse.move(x, y, {steps: 4});
  await drawn(page, () => 0);
  await page.mouse.down();
  await page.mouse.move(x, y + 40, {steps: 12});
  await page.mouse.up();
  const down = await until(page, (s) => s.status.targets.tip[2] < 0.175);
  assert.ok(Math.abs(down.status.targets.tip[0] - 0.02) < 1e-6, 'along the arrow only');
  // The distance per pixel depends on the picture, so the target is then set to a position that the robot can reach.
  await page.fill('[aria-label="tip: target z in mm"]', '174');
  await page.keyboard.press('Tab');
  await until(page, (s) => Math.abs(s.status.targets.tip[2] - 0.174) < 1e-6 && s.signals['tip.error'] < 1e-4
    && Math.abs(s.signals['tip.z'] - 0.174) < 2e-4);
  // A target out of reach is reported as such.
  await page.fill('[aria-label="tip: target x in mm"]', '400');
  await page.keyboard.press('Tab');
  await until(page, (s) => s.status.troubles.some((t) => t.kind === 'out-of-reach'));
  await page.getByText('out of reach').first().waitFor({timeout: 5000});
  await page.close();
  await stop(served);
});

test('a hand pulls the robot and lets go of it', async () => {
  const served = await serve(DIRECT, 0, '--paused');
  const page = await open(served.url);
  const start = await state(page);
  const [x, y] = await page.evaluate(() => window.sinewView.screen(0, 0, 0.1));
  await page.mouse.move(x, y);
  await page.keyboard.down('Shift');
  await page.mouse.down();
  await page.mouse.move(x + 120, y, {steps: 5});
  await page.waitForTimeout(200);
  await ask(page, {type: 'step', count: 20});
  const pulled = await until(page, (s) => s.step === 20);
  assert.match(await page.locator('#force').innerText(), /^[\d.]+ m?N$/);
  assert.ok(Math.abs(pulled.signals['tip.x'] - start.signals['tip.x']) > 1e-3, 'the tip follows the hand');
  await page.mouse.up();
  await page.keyboard.up('Shift');
  await ask(page, {type: 'reset'});
  await ask(page, {type: 'step', count: 20});
  const free = await until(page, (s) => s.step === 20);
  assert.ok(Math.abs(free.signals['tip.x'] - pulled.signals['tip.x']) > 1e-3, 'the hand let go');
  await page.close();
  await stop(served);
});

test('two browsers see the same, and one drives', async () => {
  const served = await serve(STEERED);
  const first = await open(served.url), second = await open(served.url);
  await assert.rejects(ask(second, {type: 'pause'}), /another browser drives/);
  await second.getByRole('button', {name: 'Take over driving'}).click();
  await until(second, (s) => s.driver === s.client);
  await ask(second, {type: 'pause'});
  const here = await until(second, (s) => !s.status.playing);
  await ask(second, {type: 'step', count: 3});
  const [a, b] = [await until(first, (s) => s.step >= here.step + 3), await until(second, (s) => s.step >= here.step + 3)];
  assert.equal(a.step, b.step);
  assert.equal(a.hash, b.hash);
  await first.close();
  await second.close();
  await stop(served);
});

test('frozen frames are noticed, and a restarted program is found again', async () => {
  const served = await serve(STEERED);
  const page = await open(served.url);
  const {instance} = await state(page);
  served.program.kill('SIGSTOP');
  await until(page, (s) => s.frozen, 10);
  await page.getByText('No frames').waitFor({timeout: 5000});
  served.program.kill('SIGCONT');
  await until(page, (s) => !s.frozen);
  served.program.kill('SIGKILL');
  await until(page, (s) => !s.connected);
  const again = await serve(STEERED, served.port);
  const back = await until(page, (s) => s.connected && s.instance !== instance && s.sequence > 0);
  assert.ok(back.step >= 0);
  await until(page, (s) => s.step > back.step);
  await page.close();
  await stop(again);
});

test('a recorded run is played again, and sought', async () => {
  const folder = mkdtempSync(join(tmpdir(), 'sinew-view-'));
  execFileSync(PROGRAM, ['run', STEERED, '--duration', '1s', '--out', folder, '--quiet']);
  const served = await serve(folder, 0, '--paused');
  const page = await open(served.url);
  const rows = readFileSync(join(folder, 'run.csv'), 'utf8').trim().split('\n').map((row) => row.split(','));
  const column = rows[0].indexOf('"tip.x [m]"');
  await page.locator('[aria-label="Frame of the recorded run"]').fill('60');
  const there = await until(page, (s) => s.status.frame === 60 && s.step === 60);
  assert.equal(there.mode, 'replay');
  assert.ok(Math.abs(there.signals['tip.x'] - Number(rows[61][column])) < 1e-12);
  await page.keyboard.press(' ');
  await until(page, (s) => s.status.frame === 100 && !s.status.playing);
  await assert.rejects(ask(page, {type: 'settle'}), /cannot be changed/);
  assert.match(await page.locator('#top .numbers').last().innerText(), /steps of 10 ms/);
  assert.ok((await page.evaluate(() => window.sinewView.targets()))[0], 'its target is shown');
  const csv = await page.evaluate(() => fetch('download/run.csv').then((r) => r.text()));
  assert.equal(csv.trim().split('\n').length, 102);
  const motion = await download(page, 'motion.glb');
  await valid(motion);
  assert.equal(animation(motion).times.length, 26);  // at most thirty per second, from steps of 10 ms
  await page.close();
  await stop(served);
  rmSync(folder, {recursive: true});
});

test('the gallery shows the examples and opens one', async () => {
  const program = watched(spawn(PROGRAM, ['view', '--no-open', '--port', '0']));
  const url = await new Promise((resolve) => program.stdout.on('data', (data) => {
    const found = /http:\S+/.exec(String(data));
    if (found) resolve(found[0]);
  }));
  const page = await newPage();
  await page.goto(url);
  await page.getByRole('button', {name: 'Open arm/square'}).waitFor();
  const cards = await page.evaluate(async () => {
    const list = [...document.querySelectorAll('.example')];
    await Promise.all(list.map((card) => card.querySelector('img')?.decode()));
    return list.map((card) => ({name: card.innerText, width: card.querySelector('img')?.naturalWidth ?? 0}));
  });
  for (const {name, width} of cards) {
    assert.ok(width > 100, `no picture: ${name}`);
    assert.match(name, /[.?!]$/, 'whole sentences');
  }
  await assert.rejects(ask(page, {type: 'open', name: '../../etc/passwd'}), /no example/);
  await page.getByRole('button', {name: 'Open arm/square'}).click();
  const opened = await until(page, (s) => s.mode === 'live' && s.step > 20);
  assert.ok('cable_2.tension' in opened.signals);
  await page.getByRole('button', {name: 'Back to the examples'}).click();
  await until(page, (s) => s.mode === 'gallery');
  await page.getByRole('button', {name: 'Open trunk/trunk'}).click();
  await until(page, (s) => s.mode === 'live' && 'long_0.tension' in s.signals && s.step > 5);
  await page.close();
  await stop({program});
});

test('what the page records can be saved', async () => {
  const served = await serve(DIRECT, 0, '--paused');
  const page = await open(served.url);
  assert.equal((await page.evaluate(() => fetch('download/run.csv').then((r) => r.status))), 404);
  await page.keyboard.press('e');
  await until(page, (s) => s.status.recording?.on);
  await ask(page, {type: 'step', count: 90});
  await page.getByRole('button', {name: 'Record the run from now on'}).click();
  const ended = await until(page, (s) => s.status.recording?.on === false);
  assert.equal(ended.status.recording.frames, 91);
  await page.getByRole('link', {name: 'motion.glb'}).waitFor();
  const [saved] = await Promise.all([page.waitForEvent('download'), page.getByRole('link', {name: 'run.csv'}).click()]);
  const rows = readFileSync(await saved.path(), 'utf8').trim().split('\n').map((row) => row.split(','));
  assert.equal(rows.length, 92);
  const last = (name) => Number(rows[91][rows[0].indexOf(`"${name}"`)]);
  assert.equal(last('time [s]'), 0.9);
  assert.equal(last('tip.x [m]'), ended.signals['tip.x']);
  assert.equal(last('long_0.displacement [m]'), ended.signals['long_0.displacement']);
  const motion = await download(page, 'motion.glb');
  await valid(motion);
  const {json, times, moved} = animation(motion);
  assert.equal(json.meshes.length, 1 + 8);  // the trunk and its cables
  assert.ok(Math.abs(times.at(-1) - 0.88) < 1e-6 && times.length === 23);
  assert.ok(moved > 1e-3, `the trunk moves by ${moved} m`);
  await page.close();
  await stop(served);
});

test('a motion that nothing resists is shown', async () => {
  const folder = mkdtempSync(join(tmpdir(), 'sinew-view-'));
  const scene = join(folder, 'free.yaml');
  writeFileSync(scene, `sinew: 1
gravity: 0 0 -9.81 m/s^2
bodies:
  post: {type: rigid, shape: {box: 10 10 10 mm}, density: 1000 kg/m^3, fixed: true}
  arm: {type: rigid, shape: {box: 60 20 10 mm}, density: 1000 kg/m^3, pose: {position: 30 0 0 mm}}
joints:
  door: {type: hinge, bodies: [post, arm], point: 0 0 0 mm, axis: 0 0 1}
`);
  const served = await serve(scene);
  const page = await open(served.url);
  await until(page, (s) => s.status.stopped);
  await page.getByText('Arrows show the motion that nothing resists').waitFor();
  assert.ok(await page.evaluate(() => window.sinewView.free()) > 3);
  await page.screenshot({path: process.env.SINEW_SHOT ?? join(folder, 'free.png')});
  await ask(page, {type: 'reset'});
  await page.close();
  await stop(served);
  rmSync(folder, {recursive: true});
});

test('a run that stopped says why, and starts anew', async () => {
  const folder = mkdtempSync(join(tmpdir(), 'sinew-view-'));
  const scene = join(folder, 'pushed.yaml');
  writeFileSync(scene, `sinew: 1
time_step: 10 ms
bodies:
  beam:
    type: fem
    mesh: {shape: block, length: 60 mm, width: 20 mm, height: 20 mm, element_size: 10 mm}
    material: {model: corotational, young_modulus: 200 kPa, poisson_ratio: 0.4}
    density: 1070 kg/m^3
    fixed: [{set: x_min}]
actuators:
  up: {type: cable, body: beam, points: [0 10 16 mm, 30 10 16 mm, 58 10 16 mm], command: {displacement: -1 mm}}
  push: {type: force, body: beam, point: 60 10 10 mm, direction: 1 0 0}
effectors:
  tip: {body: beam, point: 60 10 10 mm}
`);
  const served = await serve(scene);
  const page = await open(served.url);
  await page.getByText('slack: up').waitFor();
  await ask(page, {type: 'command', actuator: 'push', quantity: 'force', value: -1e6});
  const stopped = await until(page, (s) => s.status.stopped);
  await page.getByText(`The run stopped at step ${stopped.status.stopped.step}`).waitFor();
  await page.locator('.alert').getByRole('button', {name: 'Back to the start'}).click();
  await until(page, (s) => !s.status.stopped);
  assert.equal(await page.locator('.alert.error').count(), 0);
  await page.close();
  await stop(served);
  rmSync(folder, {recursive: true});
});

test('a script of Python is watched, paused and helped', async () => {
  const program = watched(spawn('/usr/bin/python3', ['-u', '-c', `
import sinew
sim = sinew.load(${JSON.stringify(DIRECT)})
with sinew.view(sim, block=False, port=0, open_browser=False, paused=True) as view:
    while view.update() and sim.steps < 100000:
        sim.step()
        print(sim.steps, f"{sim.state_hash:016x}", sim.actuator("long_2").tension)
`], {env: {...process.env, PYTHONPATH: PACKAGE}}));
  const lines = [];
  const url = await new Promise((resolve, reject) => {
    let text = '';
    program.stdout.on('data', (data) => {
      text += data;
      lines.splice(0, lines.length, ...text.trim().split('\n').slice(1).map((line) => line.split(' ')));
      const found = /http:\S+/.exec(text);
      if (found) resolve(found[0]);
    });
    program.stderr.on('data', (data) => reject(new Error(String(data))));
  });
  const page = await open(url);
  assert.equal((await state(page)).mode, 'follow');
  await ask(page, {type: 'step', count: 7});
  const here = await until(page, (s) => s.step === 7);
  assert.deepEqual(lines.at(-1).slice(0, 2), ['7', here.hash]);
  await ask(page, {type: 'command', actuator: 'long_2', quantity: 'tension', value: 0.25});
  await ask(page, {type: 'step', count: 1});
  await until(page, (s) => s.step === 8 && s.signals['long_2.tension'] === 0.25);
  assert.equal(lines.at(-1)[2], '0.25');
  await assert.rejects(ask(page, {type: 'reset'}), /script steps/);
  await page.keyboard.press(' ');
  await until(page, (s) => s.step > 40);
  await page.close();
  program.kill('SIGKILL');
});
