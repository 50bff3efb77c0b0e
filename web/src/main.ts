// The page: connects the WebSocket, the robot, the controls and the plots.
import {Vector3} from 'three';
import 'uplot/dist/uPlot.min.css';
import './style.css';
import {gradient, MAPS, read, ticks, told} from './colours';
import {Connection} from './connection';
import {button, make} from './dom';
import {JointList} from './joint_list';
import {Panel} from './panel';
import {middle, Picked} from './picked';
import {decodeHistory, Plots} from './plots';
import type {Frame, Scene, Status} from './protocol';
import {Robot3d} from './robot3d';
import {Viewbar} from './viewbar';

const SMALLEST: Record<string, number> = {m: 1e-9, Pa: 1e-3, N: 1e-9, 'J/m^3': 1e-6, '': 1e-6};  // smallest range of a field that is shown, by unit
const FROZEN = 2000;  // ms without a frame while playing
const byId = (id: string) => document.getElementById(id)!;

let scene: Scene | null = null;
let mode = '';
let status: Status | null = null;
let latest: Frame | null = null;
let fresh = false;
let frames = 0, framesPerSecond = 0, frameAt = 0, countedAt = performance.now();
let field: string | null = null;
let range: [number, number] | null = null;  // of the colour map if it is fixed; null: that of the values, `seen`
let seen: [number, number] = [0, 0];
let map = MAPS[0];
const costs: number[] = [];  // ms of script time per received frame
let cost = 0;
let pulled: {at: number; message: Record<string, unknown>} | null = null;
let aimed: Record<string, unknown> | null = null;
let drawn = -1;  // generation of the scene whose first frame has been drawn
let stepTimes: number[] = [];  // s, of the steps since show() last reported them

const notices = new Map<string, string>();

function send(message: Record<string, unknown>): void {
  connection.request(message).then(() => { notices.delete('request'); alerts(); },
                                   (e: Error) => { notices.set('request', e.message); alerts(); });
}

const robot = new Robot3d(byId('stage'), {
  pull: (body, vertices, weights, anchor) => {
    pulled = {at: 0, message: {type: 'pull', body: scene!.bodies[body].name, vertices, weights, anchor,
                               stiffness: panel.stiffness}};
  },
  release: () => { pulled = null; send({type: 'release'}); },
  target: (effector, position) => {
    aimed = {type: 'target', effector: scene!.effectors[effector].name, position};
  },
  pick: (spot) => picked.choose(spot),
  inside: (on) => send({type: 'inside', on}),
});
const picked = new Picked(pick);
const viewbar = new Viewbar(robot);

// Requests the values of the picked node or element. It is marked when the first ones arrive.
function pick(): void {
  robot.mark(null);
  const {at} = picked;
  send({type: 'pick', body: at ? scene!.bodies[at.body].name : null, kind: at?.kind ?? 'node', number: at?.number ?? 0});
}

const narrow = matchMedia('(max-width: 900px)');
function cover(): void {
  const side = (id: string) => byId(id).getBoundingClientRect();
  byId('side').style.top = `${side('top').bottom + 8}px`;
  const signals = side('plots');
  const right = side('panel').width, left = signals.width;
  const floor = narrow.matches ? side('panel').top : signals.height > 0 ? signals.top : innerHeight;
  byId('side').style.maxHeight = mode === 'gallery' ? '' : `${Math.max(120, floor - side('top').bottom - 16)}px`;
  if (mode === 'gallery') robot.cover(0, 0, 0, 0);
  else if (narrow.matches) robot.cover(0, 0, side('top').bottom, side('panel').height);
  else robot.cover(innerWidth - left - right > 150 ? left : 0, right, side('top').bottom, 0);
}
const joints = new JointList(robot.joints);
const panel = new Panel(byId('panel'), send, () => connection.client, joints);
const plots = new Plots(byId('plots'));
for (const id of ['panel', 'top', 'plots']) new ResizeObserver(cover).observe(byId(id));
byId('side').append(picked.element);

// ------------------------------------------------------------------------------------------ top bar

const title = make('h1', {textContent: 'Sinew'});
const numbers = make('span', {className: 'numbers'});
const fields = make('select', {'aria-label': 'Colour by'});
const maps = make('select', {'aria-label': 'Colour map'}, ...MAPS.map((m) => new Option(m, m)));
const wire = button('Wire', 'Wireframe (w)', () => { robot.bodies.wireframe = wire.classList.toggle('on'); fresh = true; });
const follow = button('Follow', 'Follow the effector (o)', () => { robot.follow = follow.classList.toggle('on'); });
const hands = button('Hand', 'Drag the robot itself, without Shift (h)', () => { robot.hands = hands.classList.toggle('on'); });
const theme = button('Dark', 'Light or dark (d)', () => setTheme(document.documentElement.dataset.theme !== 'dark'));
fields.onchange = () => chooseField(fields.value === '' ? null : fields.value);
maps.onchange = () => { map = maps.value; robot.bodies.map(map); fresh = true; legend(); };
byId('top').append(title, make('label', {}, 'Colour ', fields), maps, wire, follow, hands,
                   button('Fit', 'See the whole robot (f)', () => robot.fit()),
                   button('Picture', 'Save a picture (p)', picture), theme,
                   button('?', 'Keyboard shortcuts (?)', help), make('span', {className: 'line'}, ...viewbar.parts()), numbers);

function setTheme(dark: boolean): void {
  document.documentElement.dataset.theme = dark ? 'dark' : 'light';
  theme.classList.toggle('on', dark);
  robot.theme();
  if (scene) plots.setScene(scene, mode === 'replay');
}

function chooseField(name: string | null): void {
  field = name;
  seen = [NaN, NaN];  // until values arrive
  latest?.fields.clear();
  latest?.innerFields.clear();
  fields.value = name ?? '';
  robot.bodies.coloured = name !== null;
  keepRange(null);
  connection.request({type: 'field', name}).catch(() => undefined);
  fresh = true;
  legend();
}

function picture(): void {
  robot.touch();
  robot.draw();
  const link = make('a', {href: robot.renderer.domElement.toDataURL('image/png'),
                          download: `${scene?.name ?? 'sinew'}.png`});
  link.click();
}

// ------------------------------------------------------------------------------------------- legend

const TICKS = 5;
const marks = Array.from({length: TICKS}, () => make('span', {})), bar = make('span', {className: 'bar'});
const fixed = make('input', {type: 'checkbox', 'aria-label': 'Keep the range'});
const ends = ['Lowest', 'Highest'].map((end) => make('input', {type: 'text', 'aria-label': `${end} value of the range`}));
fixed.onchange = () => keepRange(fixed.checked ? [...seen] : null);
ends.forEach((end) => { end.onchange = typedRange; });
const name = make('div', {});
const typed = make('div', {className: 'line', hidden: true}, ends[0], 'to', ends[1]);
byId('legend').append(name, bar, make('span', {className: 'ends'}, ...marks),
                      make('label', {className: 'line'}, fixed, 'keep the range'), typed);

function keepRange(next: [number, number] | null): void {
  range = next;
  fixed.checked = next !== null;
  typed.hidden = next === null;
  const unit = scene?.fields.find((f) => f.name === field)?.unit ?? '';
  next?.forEach((value, k) => { ends[k].value = told(value, unit, 4); });
  fresh = true;
}

function typedRange(): void {
  const [a, b] = ends.map((end) => read(end.value));
  if (a < b) keepRange([a, b]);
  else keepRange(range);
}

function legend(): void {
  const info = scene?.fields.find((f) => f.name === field);
  byId('legend').style.display = info ? 'block' : 'none';
  if (!info) return;
  const [a, b] = range ?? seen;
  name.textContent = info.label;
  byId('legend').title = info.description;
  bar.style.background = gradient(map);
  ticks(a, b, TICKS, info.unit).forEach((text, k) => { marks[k].textContent = text; });
}

function measure(frame: Frame): void {
  let a = Infinity, b = -Infinity;
  for (const values of [...[...frame.fields.values()].map((f) => f.values), ...frame.innerFields.values()]) {
    for (const value of values) {
      if (!Number.isFinite(value)) continue;
      if (value < a) a = value;
      if (value > b) b = value;
    }
  }
  if (!(a <= b)) return;
  // A field that is uniform to rounding gets a single colour.
  const unit = scene?.fields.find((f) => f.name === field)?.unit ?? '';
  const size = Math.max(Math.abs(a), Math.abs(b));
  if (b - a <= Math.max(1e-6 * size, SMALLEST[unit] ?? 0)) b = a = size <= (SMALLEST[unit] ?? 0) ? 0 : a;
  seen = [a, b];
}

// ------------------------------------------------------------------------------------------- alerts

function alerts(): void {
  const list: [string, string, HTMLElement?][] = [];
  const source = status?.source;
  if (!connection.open) list.push(['error', notices.get('connection') || 'The program is not there; trying again.']);
  if (source?.stopped) {
    const {step, message, remedy, free_motion: free} = source.stopped;
    list.push(['error', `The run stopped at step ${step}: ${message}${remedy && !message.includes(remedy) ? `; ${remedy}` : ''}. `
               + (free.length > 0 ? 'Arrows show the motion that nothing resists. ' : '')
               + 'The robot shows its last solved state: change a command and play on, or go back in time.',
               button('Reset', 'Back to the start', () => panel.reset())]);
  }
  if (isFrozen()) list.push(mode === 'follow' ? ['info', 'The script has not stepped for two seconds.']
                                             : ['error', 'No frames for two seconds. A step takes longer, or the program does not respond.']);
  for (const [key, text] of notices) if (key !== 'connection') list.push(['warning', text]);
  for (const n of scene?.notices ?? []) {
    list.push([n.level === 'remark' ? 'info' : 'warning', `${n.subject}: ${n.text}${n.remedy ? `; ${n.remedy}` : ''}`,
               button('Dismiss', 'Do not show this again', () => { scene!.notices = scene!.notices!.filter((x) => x !== n); alerts(); })]);
  }
  const troubles = source?.troubles ?? [];
  for (const t of troubles.filter((x) => x.level !== 'info' && !(source?.stopped && x.subject === 'step')).slice(0, 5)) list.push([t.level, `${t.subject}: ${t.text}`]);
  const slack = troubles.filter((t) => t.kind === 'slack').map((t) => t.subject);
  if (slack.length > 0 && source?.controller === null) list.push(['info', `slack: ${slack.join(', ')}`]);
  if (source?.slow) list.push(['warning', 'The simulation cannot keep up with real time.']);
  const text = JSON.stringify(list.map(([level, what]) => [level, what]));
  if (byId('alerts').dataset.text === text) return;
  byId('alerts').dataset.text = text;
  byId('alerts').replaceChildren(...list.map(([level, what, extra]) =>
    make('div', {className: `alert ${level}`}, what + ' ', ...(extra ? [extra] : []))));
}

function isFrozen(): boolean {
  return connection.open && !!status?.source.playing && performance.now() - frameAt > FROZEN;
}

// ----------------------------------------------------------------------------------------- keyboard

const KEYS: [string, string, () => void][] = [
  [' ', 'play or pause', () => panel.toggle()], ['s', 'step', () => panel.step()],
  ['r', 'reset', () => panel.reset()], ['f', 'fit the robot to the window', () => robot.fit()],
  ['w', 'wireframe', () => wire.click()], ['o', 'follow the effector', () => follow.click()],
  ['h', 'drag the robot itself', () => hands.click()], ['c', 'next field', nextField], ['d', 'light or dark', () => theme.click()],
  ['j', 'show or hide joints', () => joints.toggle()],
  ['n', 'values of the node or of the element', () => picked.show(picked.kind === 'node' ? 'element' : 'node')],
  ['x', 'look along the x axis', () => robot.look('x')], ['y', 'look along the y axis', () => robot.look('y')],
  ['z', 'look down along the z axis', () => robot.look('z')], ['i', 'look from the front, the right and above', () => robot.look('iso')],
  ['q', 'parallel projection', () => viewbar.parallel.click()],
  ['p', 'save a picture', picture], ['e', 'record, or end the recording', () => panel.record()], ['?', 'this list', help],
];
const dialog = make('dialog', {'aria-label': 'Keyboard shortcuts'});
document.body.append(dialog);

function nextField(): void {
  const names = [null, ...(scene?.fields ?? []).map((f) => f.name)];
  chooseField(names[(names.indexOf(field) + 1) % names.length]);
}

function help(): void {
  if (dialog.open) return dialog.close();
  const rows = KEYS.map(([key, what]) => make('tr', {}, make('td', {}, make('kbd', {textContent: key === ' ' ? 'space' : key})),
                                              make('td', {textContent: what})));
  const mouse = [['click on the robot', 'the values of a node or of an element'], ['drag', 'rotate'], ['right drag', 'pan (on the robot: pull)'], ['wheel', 'zoom'],
                 ['Shift drag', 'pull the robot'], ['drag the arrows', 'move the target'],
                 ['click a ball', 'move the arrows to this target'], ['click a joint', 'its displacement, force and moment']];
  rows.push(...mouse.map(([key, what]) => make('tr', {}, make('td', {}, make('kbd', {textContent: key})), make('td', {textContent: what}))));
  dialog.replaceChildren(make('table', {}, ...rows), button('Close', 'Close', () => dialog.close()));
  dialog.showModal();
}

addEventListener('keydown', (event) => {
  const target = event.target as HTMLElement;
  const typing = /INPUT|SELECT|TEXTAREA/.test(target.tagName) && (target as HTMLInputElement).type !== 'range';
  if (event.ctrlKey || event.metaKey || event.altKey || typing) return;
  const found = KEYS.find(([key]) => key === event.key);
  if (!found || (event.key === ' ' && target.tagName === 'BUTTON')) return;
  event.preventDefault();
  found[2]();
});

// --------------------------------------------------------------------------------------- connection

/** Draws the curves of a recorded run. */
async function fetchHistory(of: typeof scene): Promise<void> {
  try {
    const answer = await fetch(`download/history.bin${location.search}`);
    if (!answer.ok) throw new Error(`${answer.status}`);
    const recorded = decodeHistory(await answer.arrayBuffer());
    if (scene === of) plots.take(recorded);
  } catch (error) {
    notices.set('history', `The recorded curves cannot be read: ${error}`);
    alerts();
  }
}

const connection = new Connection({
  scene: (next, what) => {
    scene = next;
    mode = what;
    latest = null;
    title.textContent = next.name;
    title.title = Panel.size(next);
    document.title = `${next.name} - Sinew`;
    fields.replaceChildren(new Option('plain', ''), ...next.fields.map((f) => {
      const option = new Option(f.label, f.name);
      option.title = f.description;
      return option;
    }));
    document.body.classList.toggle('gallery', what === 'gallery');
    drawn = -1;
    stepTimes = [];
    picked.choose(null);
    viewbar.scene();
    robot.scene(next);
    panel.scene(next, what);
    cover();
    byId('scale').textContent = what === 'gallery' ? '' : `grid ${byId('stage').dataset.cell}`;
    plots.setScene(next, what === 'replay');
    if (what === 'replay') void fetchHistory(next);
    if (field !== null) chooseField(field);
  },
  surface: (surface) => robot.bodies.surface(surface),
  interior: (interior) => robot.bodies.interior(interior),
  frame: (frame) => {
    const begin = performance.now();
    ++frames;
    frameAt = begin;
    // A frame replaces one that was not drawn yet, which may have had parts that this one lacks.
    if (fresh && latest) {
      for (const [k, v] of latest.positions) if (!frame.positions.has(k)) frame.positions.set(k, v);
      for (const [k, v] of latest.inner) if (!frame.inner.has(k)) frame.inner.set(k, v);
      frame.cables ??= latest.cables;
      frame.effectors ??= latest.effectors;
      frame.probes ??= latest.probes;
      frame.joints ??= latest.joints;
      for (const [k, v] of latest.contacts) if (!frame.contacts.has(k)) frame.contacts.set(k, v);
    }
    // Drops values of another field, sent before this one was chosen.
    for (const [body, {field: shown}] of frame.fields) {
      if (scene?.fields[shown]?.name === field) continue;
      frame.fields.delete(body);
      frame.innerFields.delete(body);
    }
    if (frame.step !== latest?.step) stepTimes.push(signal('time.step', frame));
    latest = frame;
    fresh = true;
    plots.add(frame);
    cost += performance.now() - begin;
  },
  status: (next) => {
    if (status?.source.stopped?.step !== next.source.stopped?.step) robot.showFree(next.source.stopped?.free_motion ?? []);
    status = next;
    panel.update(next);
    robot.steerable(next.driver === connection.client && mode !== 'replay');
    alerts();
  },
  connected: (yes, why) => {
    if (yes) notices.delete('connection');
    else notices.set('connection', why ? `Disconnected: ${why}` : 'The program is not there; trying again.');
    alerts();
  },
  notice: (_, text) => { notices.set('notice', text); alerts(); },
});

function tick(now: number): void {
  requestAnimationFrame(tick);
  const begin = performance.now();
  if (fresh && latest && scene) {
    fresh = false;
    measure(latest);
    robot.update(latest, ...(range ?? seen));
    panel.follow(scene, latest);
    if (picked.is(latest.pick)) {
      robot.mark(latest.pick);
      picked.update(scene, latest, robot.pressingOn(latest.pick));
    }
    legend();
  }
  plots.draw(now);
  if (pulled && now - pulled.at > 16) { send(pulled.message); pulled.at = now; }
  if (aimed) { send(aimed); aimed = null; }
  if (now - countedAt > 500) {
    framesPerSecond = 1000 * frames / (now - countedAt);
    frames = 0;
    countedAt = now;
    show();
    alerts();
  }
  if (cost > 0) costs.push(cost + performance.now() - begin);
  cost = 0;
  if (costs.length > 600) costs.splice(0, 300);
  robot.draw();
  if (latest && drawn !== connection.generation) {
    drawn = connection.generation;
    connection.request({type: 'ready', generation: drawn}).catch(() => undefined);
  }
}

function signal(key: string, frame: Frame): number {
  const k = scene?.signals.findIndex((s) => s.key === key) ?? -1;
  return k >= 0 ? frame.signals[k] : NaN;
}

// Shows times, averaged over the last half second. A recorded run has no wall times of its steps, so their simulated length is shown.
function show(): void {
  if (!latest || !scene) return;
  const factor = signal('real_time_factor', latest);
  const parts = [`t = ${latest.time.toFixed(2)} s`, `step ${latest.step}`];
  if (Number.isFinite(factor)) parts.push(`${factor.toFixed(2)} x real time`);
  if (mode === 'replay') parts.push(`steps of ${told(scene.time_step, 's')}`);
  else if (stepTimes.length > 0 && latest.step > 0) parts.push(`${told(stepTimes.reduce((a, b) => a + b) / stepTimes.length, 's')} a step`);
  if (status?.source.playing) stepTimes = [];
  numbers.textContent = [...parts, `${framesPerSecond.toFixed(0)} frames/s`].join(', ');
}

requestAnimationFrame(tick);
setTheme(matchMedia('(prefers-color-scheme: dark)').matches);

/** The interface for tests and scripts, which stays stable. */
const view = {
  state: () => ({
    connected: connection.open, client: connection.client, instance: connection.instance, mode,
    driver: status?.driver ?? null, clients: status?.clients ?? 0, status: status?.source ?? null,
    step: latest?.step ?? -1, time: latest?.time ?? NaN, hash: latest?.hash ?? '', sequence: latest?.sequence ?? -1,
    signals: Object.fromEntries((scene?.signals ?? []).map((s, k) => [s.key, latest?.signals[k] ?? NaN])),
    field, range: range ?? seen, framesPerSecond, frozen: isFrozen(),
    scriptMs: costs.length ? [...costs].sort((a, b) => a - b)[Math.floor(0.95 * costs.length)] : NaN,  // 95th percentile
  }),
  scene: () => scene,
  request: (message: Record<string, unknown>) => connection.request(message),
  colour: chooseField,
  arrows: () => robot.arrows(),
  contacts: () => robot.contacts.told(),
  joints: () => robot.joints.told(),
  free: () => robot.free.told(),
  plots: () => plots.told(),
  timeline: () => latest?.timeline ?? null,
  box: () => robot.box(),
  targets: () => robot.targetsShown(),
  picked: () => {
    const pick = latest?.pick;
    return pick && {...pick, fields: [...pick.fields], position: middle(pick.positions), nodes: pick.positions.length / 3};
  },
  section: (body: number) => robot.bodies.cutTold(body),
  force: (body: number, vertex: number) => robot.pressing(body, vertex)?.length() ?? 0,
  screen: (x: number, y: number, z: number) => robot.screen(new Vector3(x, y, z)),
  plain: () => robot.plain(),
};
declare global { interface Window { sinewView: typeof view } }
window.sinewView = view;
