// Shows scenes that combine features: a sample of those that the combination tests step, save and load in C++.
// SINEW_PROGRAM=... SINEW_COMBINATIONS=build/release/bin/combinations node --test web/test
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {existsSync, mkdtempSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {test} from 'node:test';
import {ask, drawn, open, ROOT, serve, state, stop, until} from '../testing/page.mjs';

const COMBINATIONS = process.env.SINEW_COMBINATIONS ?? join(ROOT, 'build/release/bin/combinations');
const SAMPLE = [2, 20, 38, 56]; // from the set of scenes that covers all pairs of features
const STEPS = 6;

/** Advances by STEPS steps. Resolves with the state of the page after them, or when the run has stopped with an error. */
async function play(page) {
  const {step} = await state(page);
  try {
    await ask(page, {type: 'step', count: STEPS});
  } catch (error) {
    if (!/the run has stopped/.test(error.message)) throw error;
  }
  return until(page, (s) => s.step === step + STEPS || s.status.stopped);
}

for (const number of SAMPLE) {
  test(`scene ${number} opens, plays, is coloured, recorded and played again`, {skip: !existsSync(COMBINATIONS)}, async (t) => {
    const folder = mkdtempSync(join(tmpdir(), 'sinew-view-'));
    t.after(() => rmSync(folder, {recursive: true}));
    const scene = join(folder, 'scene.yaml');
    writeFileSync(scene, execFileSync(COMBINATIONS, ['--pairs', '--known', '--print', String(number)]));
    const served = await serve(scene, 0, '--paused');
    t.after(() => stop(served));
    const errors = [];
    const page = await open(served.url, errors);
    t.after(() => page.close());
    const start = await state(page);
    await ask(page, {type: 'record', on: true});
    await until(page, (s) => s.status.recording?.on);
    await play(page);
    for (const {name} of await page.evaluate(() => window.sinewView.scene().fields)) {
      await page.selectOption('[aria-label="Colour by"]', name);
      await until(page, (s) => s.field === name && s.range.every(Number.isFinite));
    }
    await ask(page, {type: 'record', on: false});
    await until(page, (s) => s.status.recording?.on === false);
    const after = await drawn(page, () => window.sinewView.state());
    for (const [name, value] of Object.entries(after.signals)) {
      // These are NaN without a command, a target, a delivered sample, enough run time to measure the speed, or, in
      // dynamic steps, a bound of the distance to the solution.
      if (/_command$|\.error$|^sensor\..*\.measured|^real_time_factor$|^distance$/.test(name)) continue;
      const contact = /^(.*)\.gap(_above)?$/.exec(name)?.[1];
      const above = after.signals[`${contact}.gap_above`];
      if (above !== undefined) {  // a gap is measured, or it is known to be larger than another number
        assert.notEqual(Number.isFinite(after.signals[`${contact}.gap`]), Number.isFinite(above), name);
        continue;
      }
      assert.ok(Number.isFinite(value), `${name}: ${value}`);
    }
    await ask(page, {type: 'reset'});
    const again = await until(page, (s) => s.step === 0);
    assert.equal(again.hash, start.hash);
    await play(page);
    assert.equal((await state(page)).hash, after.hash, 'the second time is the first');
    assert.deepEqual(errors, []);
  });
}
