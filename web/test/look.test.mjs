// Tests of the view's directions, sections, picked nodes and elements, and return to earlier moments. Run like view.test.mjs.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {test} from 'node:test';
import {build} from 'esbuild';
import {ask, drawn, open, PACKAGE, PROGRAM, ROOT, serve, state, stop, until} from '../testing/page.mjs';

const DIRECT = join(ROOT, 'examples/trunk/trunk.yaml');
const STEERED = join(ROOT, 'examples/trunk/circle.yaml');
const MODULE = join(ROOT, 'examples/finger/module.yaml');
const SENSORS = join(ROOT, 'examples/finger/sensors.yaml');
const SQUEEZE = join(ROOT, 'examples/contact/squeeze.yaml');

function python(code) {
  return JSON.parse(execFileSync('/usr/bin/python3', ['-c', code], {
    env: {...process.env, PYTHONPATH: PACKAGE}, encoding: 'utf8'}));
}

/** Serves a scene and opens a page of it. Both are closed after the test. */
async function shown(t, scene, ...more) {
  const served = await serve(scene, 0, ...more);
  t.after(() => stop(served));
  const errors = [];
  const page = await open(served.url, errors);
  t.after(() => {
    assert.deepEqual(errors, []);
    return page.close();
  });
  return page;
}

const near = (a, b, least) => Math.abs(a - b) <= least;

test('a run begins when it is seen', async (t) => {
  const served = await serve(DIRECT);
  t.after(() => stop(served));
  await new Promise((resolve) => setTimeout(resolve, 1000));
  const page = await open(served.url);
  t.after(() => page.close());
  await until(page, (s) => s.step > 30);
  const [plot] = await page.evaluate(() => window.sinewView.plots());
  assert.equal(plot.from, 0, 'the plot has its beginning');
  assert.ok(plot.samples > 3);
  assert.ok((await state(page)).time < 5, 'it did not run before');
  assert.doesNotMatch(await page.locator('#top .numbers').last().innerText(), /0\.00 x/);
});

test('controls say what was reached, in what unit, and which cables are equal', async (t) => {
  const page = await shown(t, DIRECT, '--paused');
  const reached = (name, quantity) => page.locator(`output[aria-label="${name}: ${quantity} reached"]`).innerText();
  await ask(page, {type: 'step', count: 100});
  await until(page, (s) => s.step === 100);
  const now = await state(page);
  const told = await drawn(page, () => document.querySelector('output[aria-label="long_0: displacement reached"]').textContent);
  assert.ok(near(parseFloat(told), 1e3 * now.signals['long_0.displacement'], 0.01), told);
  assert.match(told, / mm$/);
  await page.selectOption('[aria-label="long_0: commanded quantity"]', {label: 'N'});
  await until(page, () => true);
  assert.match(await drawn(page, () => document.querySelector('output[aria-label="long_0: tension reached"]').textContent), / m?N$/);
  assert.match(await reached('long_1', 'tension'), /^0 N$/);
  // Cables without a command are slack, which is not reported. Their equal curves share one line in several colours.
  assert.equal(await page.getByText('slack:').count(), 0);
  const [plot] = await page.evaluate(() => window.sinewView.plots());
  assert.deepEqual(plot.equal, [['long_1', 'long_2', 'long_3', 'short_0', 'short_1', 'short_2', 'short_3']]);
  // A target with one coordinate typed takes the others from the tip.
  const before = await state(page);
  await page.fill('[aria-label="tip: target x in mm"]', '-12.25');
  await page.keyboard.press('Enter');
  const {status} = await until(page, (s) => s.status.targets.tip);
  assert.ok(near(status.targets.tip[0], -0.01225, 1e-9));
  assert.ok(near(status.targets.tip[1], before.signals['tip.y'], 1e-5) && near(status.targets.tip[2], before.signals['tip.z'], 1e-5));
  const cut = await page.evaluate(() => [...document.querySelectorAll('.xyz input')].filter((e) => e.scrollWidth > e.clientWidth).length);
  assert.equal(cut, 0, 'numbers are shown whole');
});

test('sensors are listed as such', async (t) => {
  const page = await shown(t, SENSORS, '--paused');
  const titles = await page.locator('#panel h2').allInnerTexts();
  assert.ok(titles.some((text) => /^sensors$/i.test(text)) && !titles.some((text) => /^probes$/i.test(text)), String(titles));
});

/** The corners of the robot's bounding box, and the edges of the area between the panels, px. */
const places = (page) => drawn(page, () => {
  const {min, max} = window.sinewView.box();
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((k) => window.sinewView.screen(k & 1 ? max.x : min.x, k & 2 ? max.y : min.y, k & 4 ? max.z : min.z));
  const side = (id) => document.getElementById(id).getBoundingClientRect();
  return {corners, left: side('plots').right, right: side('panel').left, top: side('top').bottom, bottom: innerHeight};
});

test('fitted views hide nothing behind panels, from every side, in both projections', async (t) => {
  const page = await shown(t, STEERED, '--paused');
  await ask(page, {type: 'target', effector: 'tip', position: [0.16, 0.02, 0.1]});
  await ask(page, {type: 'step', count: 1});
  await until(page, (s) => s.step === 1 && s.status.targets.tip);
  const names = {x: 'Look along the x axis (x)', y: 'Look along the y axis (y)', z: 'Look down along the z axis (z)',
                 iso: 'Look from the front, the right and above (i)'};
  for (const parallel of [false, true]) {
    if (parallel) await page.keyboard.press('q');
    for (const name of Object.values(names)) {
      await page.getByRole('button', {name, exact: true}).click();
      const {corners, left, right, top, bottom} = await places(page);
      for (const [x, y] of corners) {
        assert.ok(x > left && x < right && y > top && y < bottom, `${name}: a corner at ${x}, ${y} of ${left} to ${right}, ${top} to ${bottom}`);
      }
    }
  }
  // In parallel projection, each view is along its axis, with the other axes to the right and up.
  const at = (x, y, z) => page.evaluate((p) => window.sinewView.screen(...p), [x, y, z]);
  const [o, dx, dy, dz] = [[0, 0, 0.1], [0.02, 0, 0.1], [0, 0.02, 0.1], [0, 0, 0.12]];
  for (const [key, depth, right, up] of [['x', dx, dy, dz], ['y', dy, dx, dz], ['z', dz, dx, dy]]) {
    await page.keyboard.press(key);
    await drawn(page, () => 0);
    const [middle, along, side, above] = [await at(...o), await at(...depth), await at(...right), await at(...up)];
    assert.ok(near(along[0], middle[0], 0.1) && near(along[1], middle[1], 0.1), `${key}: depth is not seen`);
    assert.ok(side[0] > middle[0] + 5 && near(side[1], middle[1], 0.1), `${key}: right`);
    assert.ok(above[1] < middle[1] - 5 && near(above[0], middle[0], 0.1), `${key}: up`);
  }
});

test('a node and an element tell their values, live and in a recorded run', async (t) => {
  const folder = mkdtempSync(join(tmpdir(), 'sinew-view-'));
  t.after(() => rmSync(folder, {recursive: true}));
  execFileSync(PROGRAM, ['run', MODULE, '--duration', '0.1s', '--out', folder, '--quiet']);
  for (const scene of [MODULE, folder]) {
    const page = await shown(t, scene, '--paused');
    if (scene === MODULE) await ask(page, {type: 'step', count: 10});
    else await ask(page, {type: 'seek', frame: 10});
    await until(page, (s) => s.step === 10);
    await page.keyboard.press('y');
    const [x, y] = await drawn(page, () => {
      const {min, max} = window.sinewView.box();
      return window.sinewView.screen((min.x + max.x) / 2, (min.y + max.y) / 2, (min.z + max.z) / 2);
    });
    await page.mouse.click(x, y);
    await page.locator('#picked').waitFor();
    const picked = await drawn(page, () => window.sinewView.picked());
    const there = python(`
import json, sinew
sim = sinew.load(${JSON.stringify(MODULE)})
sim.step(10)
body = next(iter(sim.bodies.values()))
node = ${picked.number}
print(json.dumps({"position": body.positions[node].tolist(), "rest": body.rest_positions[node].tolist(),
                  **{name: body.nodal_field(name)[node] for name in sinew.fields.FIELDS}}))`);
    ['x', 'y', 'z'].forEach((axis, k) => assert.ok(near(picked.position[axis], there.position[k], 1e-7), axis));
    const fields = await page.evaluate(() => window.sinewView.scene().fields.map((f) => f.name));
    fields.forEach((name, k) => {
      if (there[name] !== undefined) assert.ok(near(picked.fields[k], there[name], 1e-5 * Math.abs(there[name]) + 1e-9), name);
    });
    const card = await page.locator('#picked').innerText();
    assert.match(card, new RegExp(`node ${picked.number}`));
    assert.match(card, /Position[\s\S]*mm[\s\S]*Von Mises stress[\s\S]*Pa/);
    await page.keyboard.press('n');
    await page.locator('#picked').getByText(', element ').waitFor();
    const part = await drawn(page, () => window.sinewView.picked());
    const own = python(`
import json, sinew
sim = sinew.load(${JSON.stringify(MODULE)})
sim.step(10)
body = next(iter(sim.bodies.values()))
element = ${part.number}
nodes = body.hexahedra[element]
print(json.dumps({"nodes": nodes.tolist(), "position": body.positions[nodes].mean(axis=0).tolist(),
                  **{name: body.element_field(name)[element] for name in sinew.fields.FIELDS}}))`);
    assert.equal(part.kind, 'element');
    assert.ok(own.nodes.includes(picked.number), 'the nearest node is one of its nodes');
    ['x', 'y', 'z'].forEach((axis, k) => assert.ok(near(part.position[axis], own.position[k], 1e-7), axis));
    fields.forEach((name, k) => {
      if (own[name] !== undefined) assert.ok(near(part.fields[k], own[name], 1e-5 * Math.abs(own[name]) + 1e-9), name);
    });
    assert.match(await page.locator('#picked').innerText(), /Material\s+hyperelastic, E = [\d.]+ kPa[\s\S]*Volume at rest\s+[\d.]+ \S*l/);
    await page.mouse.click((await places(page)).right - 12, y);  // beside the robot
    await page.locator('#picked').waitFor({state: 'hidden'});
  }
});

test('a node in contact tells the force on it', async (t) => {
  const page = await shown(t, SQUEEZE, '--paused');
  await ask(page, {type: 'step', count: 80});
  await until(page, (s) => s.step === 80);
  const forces = await drawn(page, () => {
    const {vertices} = window.sinewView.scene().bodies[0];
    return Array.from({length: vertices}, (_, k) => window.sinewView.force(0, k)).filter((f) => f > 0).sort((a, b) => a - b);
  });
  const there = python(`
import json, sinew
import numpy as np
sim = sinew.load(${JSON.stringify(SQUEEZE)})
sim.step(80)
forces = np.concatenate([np.hypot(c.normal_forces, np.linalg.norm(c.friction_forces, axis=-1)) for c in sim.contacts.values()])
print(json.dumps(sorted(forces[forces > 0].tolist())))`);
  assert.equal(forces.length, there.length);
  forces.forEach((force, k) => assert.ok(near(force, there[k], 1e-5 * there[k]), `${force} ${there[k]}`));
});

/** Finds the colour of a map nearest to a pixel: `at`, its position in the map, 0 to 1; `distance`, the largest difference of a
 *  channel, of 255. */
async function onMap(map, pixel) {
  const {outputFiles: [{text}]} = await build({entryPoints: [join(ROOT, 'web/src/colours.ts')], bundle: true, format: 'esm', write: false});
  const {linearTable} = await import(`data:text/javascript;base64,${Buffer.from(text).toString('base64')}`);
  const table = [...linearTable(map)].map((x) => 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055));
  let best = {at: 0, distance: Infinity};
  for (let k = 0; 3 * k < table.length; ++k) {
    const distance = Math.max(...[0, 1, 2].map((c) => Math.abs(table[3 * k + c] - pixel[c])));
    if (distance < best.distance) best = {at: k / (table.length / 3 - 1), distance};
  }
  return best;
}

test('a section cuts the robot open, and its faces have elements and colours', async (t) => {
  const page = await shown(t, MODULE, '--paused');
  const choose = async (label) => {
    await page.selectOption('[aria-label="Section across"]', {label});
    await page.waitForFunction(() => window.sinewView.section(0)?.triangles > 0);
  };
  // At rest, the section is a circle with a circular hole, both meshed as polygons of the circles' areas.
  await choose('section at z');
  const {area} = await page.evaluate(() => window.sinewView.section(0));
  assert.ok(near(area, Math.PI * (0.0125 ** 2 - 0.0037 ** 2), 1e-9), String(area));
  await page.selectOption('[aria-label="Section across"]', '');
  assert.equal(await page.locator('[aria-label="Where the section is"]').isVisible(), false);

  await ask(page, {type: 'step', count: 60});
  await until(page, (s) => s.step === 60);
  await page.keyboard.press('q');
  await page.keyboard.press('y');
  const [x, y, middle] = await drawn(page, () => {
    const {min, max} = window.sinewView.box();
    const centre = [(min.x + max.x) / 2, (min.y + max.y) / 2, (min.z + max.z) / 2];
    return [...window.sinewView.screen(centre[0] - 0.15 * (max.x - min.x), centre[1], centre[2]), centre[1]];  // beside the chamber
  });
  const pick = async () => {
    await page.mouse.click(x, y);
    await page.locator('#picked').waitFor();
    return drawn(page, () => window.sinewView.picked());
  };
  assert.ok((await pick()).position.y < middle, 'the near side is seen from y');
  await choose('section at y');
  await page.getByRole('button', {name: 'Show the other side of the section'}).click();
  await page.selectOption('[aria-label="Colour by"]', 'max_stretch');
  const {range} = await until(page, (s) => s.range[1] > 1);
  await page.locator('#picked').getByRole('button', {name: 'Values of the element (n)'}).click();
  const picked = await pick();
  await page.getByRole('button', {name: 'Close the values'}).click();  // which removes the marks as well
  await drawn(page, () => 0);
  const pixel = await page.evaluate(([px, py]) => {
    const canvas = document.querySelector('#stage canvas'), scale = canvas.width / canvas.clientWidth;
    const copy = Object.assign(document.createElement('canvas'), {width: canvas.width, height: canvas.height});
    const context = copy.getContext('2d');
    context.drawImage(canvas, 0, 0);
    return [...context.getImageData(px * scale, py * scale, 1, 1).data];
  }, [x, y]);
  const there = python(`
import json, sinew
sim = sinew.load(${JSON.stringify(MODULE)})
sim.step(60)
body = next(iter(sim.bodies.values()))
nodes = body.hexahedra[${picked.number}]
values = body.nodal_field("max_stretch")
print(json.dumps({"y": body.positions[nodes, 1].tolist(), "values": values[nodes].tolist(), "all": [values.min(), values.max()]}))`);
  assert.equal(picked.kind, 'element');
  assert.ok(Math.min(...there.y) < middle + 1e-6 && Math.max(...there.y) > middle - 1e-6, 'the plane cuts the element');
  there.all.forEach((value, k) => assert.ok(near(range[k], value, 1e-5), 'the legend includes the inside'));
  const {at, distance} = await onMap('viridis', pixel);
  assert.ok(distance <= 2, `a colour of the legend: ${pixel}`);
  const value = range[0] + at * (range[1] - range[0]), step = (range[1] - range[0]) / 100;
  assert.ok(value > Math.min(...there.values) - step && value < Math.max(...there.values) + step, `${value} of ${there.values}`);
  await page.locator('[aria-label="Where the section is"]').fill('0');
  await page.waitForFunction(() => window.sinewView.section(0).triangles < 20);
  assert.ok((await pick()).position.y < middle, 'all of it is seen again');
});

test('a run goes back, and takes another way from there', async (t) => {
  const page = await shown(t, STEERED, '--paused');
  for (let k = 0; k < 5; ++k) await ask(page, {type: 'step', count: 20});
  const end = await until(page, (s) => s.step === 100);
  const line = await page.evaluate(() => window.sinewView.timeline());
  assert.ok(line.shown === line.latest && line.oldest === 0);
  const slider = page.locator('[aria-label="Moment of the run"]');
  // The page may be drawn later than the frame arrives; until then, the slider ends earlier.
  await page.waitForFunction((latest) => document.querySelector('[aria-label="Moment of the run"]').max === String(latest), line.latest);
  await slider.fill('10');
  const back = await until(page, (s) => s.step === 40);
  assert.equal(back.time, 0.4);
  await page.getByText('back; Play goes on from here').waitFor();
  const [marked] = await page.evaluate(() => window.sinewView.plots());
  assert.ok(near(marked.marker, 0.4, 1e-9) && near(marked.to, 1.0, 1e-9), 'the plot keeps what came after');
  await slider.fill(String(line.latest));
  assert.equal((await until(page, (s) => s.step === 100)).hash, end.hash);
  await slider.fill('10');
  await until(page, (s) => s.step === 40);
  await ask(page, {type: 'step', count: 60});
  assert.equal((await until(page, (s) => s.step === 100)).hash, end.hash, 'the same way, bit for bit');
  await slider.fill('10');
  await until(page, (s) => s.step === 40);
  await ask(page, {type: 'controller', name: null});
  await ask(page, {type: 'step', count: 30});
  const other = await until(page, (s) => s.step === 70);
  assert.equal(other.status.controller, null);
  const [plot] = await page.evaluate(() => window.sinewView.plots());
  assert.ok(near(plot.to, 0.7, 1e-9), 'what came after is gone from the plot');
});
