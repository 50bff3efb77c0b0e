// The panel: controls of the run, actuators, targets and the hand, and measured values.
import {ROUNDING, told} from './colours';
import {STATES} from './contacts3d';
import {button, make} from './dom';
import type {JointList} from './joint_list';
import type {Actuator, Effector, Frame, Quantity, Scene, Status, Timeline} from './protocol';

const SPEEDS: [number, string][] = [[0.1, '0.1 x'], [0.25, '0.25 x'], [0.5, '0.5 x'], [1, 'real time'],
                                    [2, '2 x'], [5, '5 x'], [0, 'as fast as it can']];
// Display units of sliders, with their scale; other units are shown unchanged.
const SHOWN: Record<string, [number, string]> = {m: [1e3, 'mm'], Pa: [1e-3, 'kPa'], 'm^3': [1e6, 'ml'], '': [1, '1']};

export type Send = (message: Record<string, unknown>) => void;

interface Row {
  box: HTMLElement; slider: HTMLInputElement; number: HTMLInputElement; reached: HTMLElement; quantity: Quantity;
}

export class Panel {
  private rows = new Map<string, Row>();
  private targets = new Map<string, HTMLInputElement[]>();
  private play = button('Play', 'Play or pause (space)', () => this.toggle());
  private steps = make('input', {type: 'number', min: '1', max: '10000', value: '1', 'aria-label': 'Number of steps'});
  private speed = make('select', {'aria-label': 'Speed'});
  private controller = make('select', {'aria-label': 'Controller'});
  private drive = button('Take over', 'Take over driving', () => this.send({type: 'drive', on: true}));
  private who = make('span', {});
  private time = make('input', {type: 'range', min: '0', step: '1', value: '0', className: 'time',
                                'aria-label': 'Frame of the recorded run'});
  private moments = make('input', {type: 'range', min: '0', step: '1', value: '0', className: 'time',
                                   'aria-label': 'Moment of the run', title: 'Go back; Play goes on from there'});
  private back = make('span', {className: 'recorded'});
  private held = false;  // while the pointer drags the slider of moments
  private signals: Record<string, number> = {};
  private latest: [Scene, Frame] | null = null;
  private recorder = button('Record', 'Record the run from now on', () => this.record());
  private probes: {value: HTMLElement; columns: number[]; unit: string}[] = [];
  private contacts: {value: HTMLElement; columns: number[]}[] = [];
  private recorded = make('span', {className: 'recorded'});
  private status: Status | null = null;
  stiffness = 20;  // N/m, of the spring between the pointer and the robot

  constructor(private root: HTMLElement, private send: Send, private client: () => number, private joints: JointList) {
    this.speed.append(...SPEEDS.map(([value, text]) => new Option(text, String(value))));
    this.speed.value = '1';
    this.speed.onchange = () => this.send({type: 'speed', factor: Number(this.speed.value)});
    this.controller.onchange = () =>
      this.send({type: 'controller', name: this.controller.value === '' ? null : this.controller.value});
    this.steps.style.width = '72px';
    this.moments.oninput = () => this.send({type: 'seek', frame: Number(this.moments.value)});
    this.moments.onpointerdown = () => { this.held = true; };
    addEventListener('pointerup', () => { this.held = false; });
  }

  toggle(): void { this.send({type: this.status?.source.playing ? 'pause' : 'play'}); }
  step(): void { this.send({type: 'step', count: Math.max(1, Math.round(Number(this.steps.value) || 1))}); }
  reset(): void { this.send({type: 'reset'}); }
  record(): void { this.send({type: 'record', on: !this.status?.source.recording?.on}); }

  scene(scene: Scene, mode: string): void {
    this.rows.clear();
    this.targets.clear();
    this.probes = [];
    this.contacts = [];
    this.latest = null;
    if (mode === 'gallery') return this.gallery(scene);
    if (mode === 'replay') return this.replay(scene);
    this.controller.replaceChildren(new Option('none (manual)', ''),
                                    ...scene.controllers.map((c) => new Option(c.name, c.name)));
    const heading = (text: string) => make('h2', {textContent: text});
    const told = scene.actuators.filter((a) => a.quantities.length > 0);  // springs cannot be commanded
    const scripted = mode === 'follow';  // the script resets and chooses the controller
    this.root.replaceChildren(
      heading('Run'),
      make('div', {className: 'line'}, this.play, button('Step', 'Advance by this number of steps (s)', () => this.step()),
           this.steps, ...(scripted ? [] : [button('Reset', 'Back to the start (r)', () => this.reset())])),
      make('div', {className: 'line'}, make('label', {}, 'Speed', this.speed), ...(scripted ? [] : [
           button('Settle', 'Static equilibrium under the current commands and loads', () => this.send({type: 'settle'}))])),
      ...(scripted ? [] : [this.moments, this.back]),
      make('div', {className: 'line'}, this.recorder, this.recorded),
      make('div', {className: 'line'}, this.who, this.drive, ...(scene.gallery ? [
           button('Examples', 'Back to the examples', () => this.send({type: 'gallery'}))] : [])),
      ...(told.length ? [heading('Actuators'), this.actuatorHead(), ...told.map((a) => this.actuator(a))] : []),
      heading('Control'),
      ...(scripted ? [] : [make('div', {className: 'line'}, make('label', {}, 'Controller', this.controller))]),
      ...this.aims(scene),
      ...this.measured(scene), ...this.touching(scene), ...this.joints.rows(scene), heading('Hand'), this.hand(),
    );
  }

  private actuatorHead(): HTMLElement {
    return make('div', {className: 'row head'}, ...['reached', '', 'command', ''].map((text) => make('span', {textContent: text})));
  }

  private gallery(scene: Scene): void {
    const cards = (scene.examples ?? []).map((example) => {
      const card = make('button', {type: 'button', className: 'example', 'aria-label': `Open ${example.name}`,
                                   onclick: () => this.send({type: 'open', name: example.name})});
      if (example.thumbnail) card.append(make('img', {src: example.thumbnail + location.search, alt: ''}));
      card.append(make('b', {textContent: example.name}), make('span', {textContent: example.title}));
      return card;
    });
    this.root.replaceChildren(make('h2', {textContent: 'Examples'}), make('div', {className: 'examples'}, ...cards),
                              make('div', {className: 'line'}, this.who, this.drive));
  }

  private replay(scene: Scene): void {
    this.time.max = String((scene.frames ?? 1) - 1);
    this.time.oninput = () => this.send({type: 'seek', frame: Number(this.time.value)});
    this.root.replaceChildren(
      make('h2', {textContent: 'Recorded run'}),
      make('div', {className: 'line'}, this.play, button('Step', 'Advance by this number of frames (s)', () => this.step()),
           this.steps, button('Reset', 'Back to the start (r)', () => this.reset())),
      make('div', {className: 'line'}, make('label', {}, 'Speed', this.speed)), this.time,
      make('div', {className: 'line'}, this.who, this.drive,
           ...this.files()),
      ...this.measured(scene), ...this.touching(scene), ...this.joints.rows(scene));
  }

  /** Rows of the probes and sensors, with values that show() updates. */
  private measured(scene: Scene): HTMLElement[] {
    this.probes = scene.probes.map((probe) => {
      const columns = probe.signals.map((key) => scene.signals.findIndex((s) => s.key === key));
      return {value: make('output', {'aria-label': `${probe.name}: ${probe.kind}`}), columns,
              unit: scene.signals[columns[0]].unit};
    });
    const rows = scene.probes.map((probe, k) => make('div', {className: 'measured', title: probe.kind},
      make('span', {className: 'name', textContent: probe.name}), this.probes[k].value));
    const list = (title: string, sensor: boolean) => {
      const own = rows.filter((_, k) => scene.probes[k].sensor === sensor);
      return own.length === 0 ? [] : [make('h2', {textContent: title}), ...own];
    };
    return [...list('Probes', false), ...list('Sensors', true)];
  }

  /** Rows of the contacts, with forces and states that show() updates, and the key of the points' colours. */
  private touching(scene: Scene): HTMLElement[] {
    this.contacts = scene.contacts.map((contact) => ({
      value: make('output', {'aria-label': `${contact.name}: contact`}),
      columns: contact.signals.map((key) => scene.signals.findIndex((s) => s.key === key)),
    }));
    if (scene.contacts.length === 0) return [];
    const key = STATES.map(([state, color]) => {
      const dot = make('i', {className: 'dot'});
      dot.style.background = `#${color.toString(16).padStart(6, '0')}`;
      return make('span', {}, dot, state);
    });
    const rows = scene.contacts.map((contact, k) => make('div', {
      className: 'measured', title: `${contact.points} points of ${contact.body} and a ${contact.surface.kind}; friction ${contact.friction}`},
      make('span', {className: 'name', textContent: contact.name}), this.contacts[k].value));
    return [make('h2', {textContent: 'Contacts'}), make('div', {className: 'line key'}, ...key), ...rows];
  }

  private show(signals: Float64Array): void {
    this.joints.show();
    for (const {value, columns} of this.contacts) {
      const [normal, , gap, above, sticking, slipping] = columns.map((k) => signals[k]);
      const text = sticking + slipping > 0 ? `${told(normal, 'N')}, ${sticking} stick, ${slipping} slip`
        : Number.isFinite(gap) ? `open, ${told(gap, 'm')} away` : `open, more than ${told(above, 'm')} away`;
      if (value.textContent !== text) value.textContent = text;
    }
    for (const {value, columns, unit} of this.probes) {
      const text = columns.map((k) => told(signals[k], unit)).join(', ');
      if (value.textContent !== text) value.textContent = text;
    }
  }

  private files(): HTMLElement[] {
    return ['run.csv', 'motion.glb'].map((name) =>
      make('a', {href: `download/${name}${location.search}`, textContent: name, download: name}));
  }

  private showRecording(): void {
    const {recording} = this.status!.source;
    this.recorder.textContent = recording?.on ? 'Stop' : 'Record';
    this.recorder.classList.toggle('on', !!recording?.on);
    const text = !recording ? '' : `${recording.frames} steps, ${told(recording.seconds, 's')}, ${told(recording.bytes, 'B')}`
      + (recording.full ? '; full' : '');
    const key = text + recording?.on;
    if (this.recorded.dataset.key === key) return;
    this.recorded.dataset.key = key;
    this.recorded.replaceChildren(...(recording && !recording.on ? this.files() : []), ' ', text);
  }

  // An actuator that can be commanded in several quantities has a choice of units.
  private actuator(actuator: Actuator, way = 0): HTMLElement {
    const quantity = actuator.quantities[way];
    const [scale, unit] = SHOWN[quantity.unit] ?? [1, quantity.unit];
    const label = `${actuator.name}: ${quantity.name} in ${unit}`;
    const range = {min: String(scale * quantity.low), max: String(scale * quantity.high), step: 'any'};
    const slider = make('input', {type: 'range', ...range, value: '0', 'aria-label': label});
    const number = make('input', {type: 'number', ...range, value: '0', 'aria-label': label});
    const change = (input: HTMLInputElement) => {
      const value = Math.min(Math.max(Number(input.value), scale * quantity.low), scale * quantity.high);
      slider.value = number.value = String(Number(value.toPrecision(4)));
      this.send({type: 'command', actuator: actuator.name, quantity: quantity.name, value: value / scale});
    };
    slider.oninput = () => change(slider);
    number.onchange = () => change(number);
    const limits = `${label}, ${range.min} to ${range.max}`;
    const mode = make('select', {className: 'unit', title: `what ${actuator.name} is commanded by`, 'aria-label': `${actuator.name}: commanded quantity`},
      ...actuator.quantities.map((q, k) => make('option', {value: String(k), title: q.name, textContent: SHOWN[q.unit]?.[1] ?? q.unit, selected: k === way})));
    mode.onchange = () => {
      box.replaceWith(this.actuator(actuator, Number(mode.value)));
      if (this.status) this.update(this.status);
      if (this.latest) this.follow(...this.latest);
    };
    slider.title = number.title = limits;
    const reached = make('output', {title: `${quantity.name} reached`, 'aria-label': `${actuator.name}: ${quantity.name} reached`});
    const name = make('span', {className: 'name', title: limits}, make('span', {textContent: actuator.name}), reached);
    const box = make('div', {className: 'row'}, name, slider, number,
                     actuator.quantities.length > 1 ? mode : make('span', {className: 'unit', textContent: unit}));
    this.rows.set(actuator.name, {box, slider, number, reached, quantity});
    return box;
  }

  private aims(scene: Scene): HTMLElement[] {
    const points = scene.effectors.filter((e) => e.kind === 'point');
    if (points.length === 0) return [];
    const head = ['x (mm)', 'y (mm)', 'z (mm)'].map((text) => make('span', {textContent: text}));
    return [make('div', {className: 'xyz head'}, make('span', {textContent: 'Target'}), ...head), ...points.map((e) => this.target(e))];
  }

  private target(effector: Effector): HTMLElement {
    const inputs = ['x', 'y', 'z'].map((axis) =>
      make('input', {type: 'number', step: 'any', 'aria-label': `${effector.name}: target ${axis} in mm`,
                     placeholder: axis}));
    // A coordinate left empty is filled with the effector's own.
    const send = () => {
      if (inputs.every((input) => input.value === '')) return;
      inputs.forEach((input, k) => {
        if (input.value === '') input.value = (1e3 * this.signals[`${effector.name}.${'xyz'[k]}`]).toFixed(2);
      });
      this.send({type: 'target', effector: effector.name, position: inputs.map((i) => Number(i.value) / 1e3)});
    };
    inputs.forEach((input) => { input.onchange = send; });
    this.targets.set(effector.name, inputs);
    const home = button(effector.name, `${effector.name}: back to the scene's own target`, () => {
      inputs.forEach((input) => { input.value = ''; });
      this.send({type: 'target', effector: effector.name, position: null});
    });
    return make('div', {className: 'xyz'}, home, ...inputs);
  }

  private hand(): HTMLElement {
    const input = make('input', {type: 'number', min: '0.1', max: '10000', value: String(this.stiffness),
                                 'aria-label': 'Stiffness of the hand in N/m'});
    input.style.width = '80px';
    input.onchange = () => { this.stiffness = Math.max(Number(input.value) || 20, 0.1); };
    return make('div', {className: 'line'}, make('label', {}, 'Spring', input, 'N/m'),
                make('span', {textContent: 'Shift and drag on the robot'}));
  }

  update(status: Status): void {
    this.status = status;
    const {source} = status;
    const mine = status.driver === this.client();
    this.play.textContent = source.playing ? 'Pause' : 'Play';
    this.play.classList.toggle('on', source.playing);
    this.speed.value = String(source.speed ?? 1);
    if (source.controller !== null && ![...this.controller.options].some((o) => o.value === source.controller)) {
      this.controller.append(new Option(source.controller, source.controller));
    }
    this.controller.value = source.controller ?? '';
    if (source.frame !== undefined && document.activeElement !== this.time) this.time.value = String(source.frame);
    this.showRecording();
    this.who.textContent = mine ? `You drive; ${status.clients} connected`
      : status.driver === null ? 'Nobody drives' : 'Another browser drives';
    this.drive.hidden = mine;
    for (const element of this.root.querySelectorAll<HTMLInputElement>('button, input, select')) {
      if (element !== this.drive as unknown && !element.classList.contains('unit')) element.disabled = !mine;
    }
    for (const [name, row] of this.rows) {
      const command = source.commands?.[name];
      if (!command) continue;
      const limited = source.troubles.some((t) => t.subject === name && t.kind.endsWith('limit'));
      row.box.classList.toggle('limit', limited);
      row.slider.disabled = row.number.disabled = !mine || command.owned;
      row.box.title = command.owned ? `controller ${source.controller} drives ${name}` : '';
    }
    for (const [name, inputs] of this.targets) {
      const position = source.targets?.[name];
      if (position && !inputs.includes(document.activeElement as HTMLInputElement)) {
        inputs.forEach((input, k) => { input.value = (1e3 * position[k]).toFixed(2); });
      }
    }
  }

  /** Shows the values that actuators have reached, and their commands, whether from the user or a controller. */
  follow(scene: Scene, frame: Frame): void {
    this.latest = [scene, frame];
    this.show(frame.signals);
    scene.signals.forEach((s, k) => { this.signals[s.key] = frame.signals[k]; });
    if (frame.timeline) this.followTime(frame.timeline, frame.time);
    scene.actuators.forEach((actuator) => {
      const row = this.rows.get(actuator.name);
      const command = this.status?.source.commands?.[actuator.name];
      if (!row || !command) return;
      const done = this.signals[`${actuator.name}.${row.quantity.name}`];  // there is none for the input of a drive
      const reached = done === undefined ? '' : told(done, row.quantity.unit);
      if (row.reached.textContent !== reached) row.reached.textContent = reached;
      if (document.activeElement === row.slider || document.activeElement === row.number) return;
      const own = command.quantity === row.quantity.name && !command.owned;
      if (done === undefined && !own) return;
      const [scale] = SHOWN[row.quantity.unit] ?? [1];
      const now = own ? command.value : done;
      const text = String(Number((Math.abs(now) < ROUNDING ? 0 : scale * now).toPrecision(4)));
      if (row.number.value !== text) row.number.value = row.slider.value = text;
    });
  }

  private followTime({oldest, latest, shown, oldestTime, latestTime}: Timeline, time: number): void {
    this.moments.min = String(oldest);
    this.moments.max = String(latest);
    if (!this.held) this.moments.value = String(shown);
    const text = shown < latest ? `${told(latestTime - time, 's')} back; Play goes on from here`
      : `the last ${told(latestTime - oldestTime, 's')}`;
    if (this.back.textContent !== text) this.back.textContent = text;
  }

  /** Describes the size of a scene: nodes and elements of each body, and the time step. */
  static size(scene: Scene): string {
    return scene.bodies.map((b) => `${b.nodes} nodes, ${b.elements} elements`).join('; ')
      + `, ${told(scene.time_step, 's')} a step`;
  }
}
