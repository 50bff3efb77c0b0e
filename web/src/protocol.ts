// The messages that the program sends, as docs/view_protocol.md defines them. All numbers are in SI units.

export interface Quantity {
  name: string; unit: string; min: number | null; max: number | null; rate: number | null;
  low: number; high: number;
}
export interface Actuator {name: string; type: string; body: string; quantities: Quantity[]; points: number}
export interface Effector {name: string; kind: 'point' | 'orientation'; directions: number[][]}
/** `marks`: number of its points in a frame's `probes`; `signals`: keys of its signals. */
export interface Probe {name: string; kind: string; sensor: boolean; marks: number; signals: string[]}
export type ContactSurface = {kind: 'plane'; point: number[]; normal: number[]}
  | {kind: 'sphere'; centre: number[]; radius: number} | {kind: 'capsule'; ends: number[][]; radius: number}
  | {kind: 'body'};  // drawn with its body
/** A contact of a body's points with a surface; `signals`: keys of its signals. */
export interface Contact {
  name: string; body: string; surface: ContactSurface; friction: number; points: number; signals: string[];
}
/** `signals`: keys of its signals, which start with the joint's name. */
export interface Joint {name: string; type: string; bodies: string[]; signals: string[]}
export interface Controller {name: string; type: string; effectors: string[]}
export interface Signal {key: string; label: string; unit: string; group: string}
export interface FieldInfo {name: string; label: string; unit: string; description: string}
export interface Scene {
  name: string; time_step: number; gravity: number[]; bounds: number[][];
  bodies: {name: string; vertices: number; triangles: number; nodes: number; elements: number; materials: string[]}[];
  fields: FieldInfo[]; actuators: Actuator[]; effectors: Effector[]; probes: Probe[]; contacts: Contact[];
  joints: Joint[];
  controllers: Controller[];
  signals: Signal[];
  notices?: {level: 'remark' | 'warning'; kind: string; subject: string; text: string; remedy: string}[];
  frames?: number; duration?: number; gallery?: boolean;
  examples?: {name: string; title: string; thumbnail: string | null}[];
}
export interface Trouble {level: 'info' | 'warning' | 'error'; kind: string; subject: string; text: string}
export interface SourceStatus {
  playing: boolean; speed: number; slow: boolean; controller: string | null;
  commands: Record<string, {quantity: string; value: number; owned: boolean}>;
  targets: Record<string, number[]>; troubles: Trouble[];
  /** `free_motion`: places and displacements of nodes (x, y, z, dx, dy, dz), m. */
  stopped: {step: number; kind: string; message: string; remedy: string; free_motion: number[][]} | null;
  frame?: number;
  recording?: {on: boolean; frames: number; seconds: number; bytes: number; full: boolean} | null;
}
export interface Status {clients: number; driver: number | null; source: SourceStatus}

/** `nodes`: the mesh node of each vertex; `elements`: the element behind each triangle, or NONE. */
export interface Surface {body: number; rest: Float32Array; triangles: Uint32Array; nodes: Uint32Array; elements: Uint32Array}
/** The interior of a body, split into tetrahedra (4 s,). Vertices are numbered from those of the surface on to the inner ones.
 *  `nodes`: the mesh node of each inner vertex, NONE for the middle of an element; `elements` (s,): that of each tetrahedron. */
export interface Interior {body: number; nodes: Uint32Array; tetrahedra: Uint32Array; elements: Uint32Array}
export const NONE = 0xffffffff;
/** The moments of a live run to which it can return: numbers, and times in s. `shown` equals `latest` unless the run was set back. */
export interface Timeline {oldest: number; latest: number; shown: number; oldestTime: number; latestTime: number}
export type PickKind = 'node' | 'element';
/** Values at a node or element: `fields` in the scene's order, NaN if undefined; `positions` and `rest` of the node or of the
 *  element's nodes (3 k,), m; for an element, its `volume` at rest, m^3, and its `material`, an index into those of the body. */
export interface Pick {
  body: number; kind: PickKind; number: number; material: number; volume: number;
  positions: Float32Array; rest: Float32Array; fields: Float32Array;
}
export interface Frame {
  sequence: number; step: number; time: number; hash: string; signals: Float64Array;
  positions: Map<number, Float32Array>; fields: Map<number, {field: number; values: Float32Array}>;
  cables?: Float32Array; effectors?: Float32Array; targets?: Float32Array; pull?: Float32Array;
  /** Positions and field values of inner vertices, if they were requested. */
  inner: Map<number, Float32Array>; innerFields: Map<number, Float32Array>;
  probes?: Float32Array; pick?: Pick; timeline?: Timeline;
  /** By contact: position (3) and quaternion (4) of the surface, then position (3), force (3) and state of each point. */
  contacts: Map<number, Float32Array>;
  /** Per joint: the points on its bodies (3), (3), its axis (3) and its second axis (3), zero if there is none. */
  joints?: Float32Array;
}

const MAGIC = 0x31574e53;
const SURFACE = 1, FRAME = 2, INTERIOR = 3;

/** Decodes a binary message. The arrays are views of its bytes. Throws an Error if it is none of Sinew's. */
export function decode(buffer: ArrayBuffer): {generation: number; surface?: Surface; frame?: Frame; interior?: Interior} {
  const view = new DataView(buffer);
  if (buffer.byteLength < 8 || view.getUint32(0, true) !== MAGIC) throw new Error('no message of Sinew');
  const kind = view.getUint16(4, true), generation = view.getUint16(6, true);
  if (kind === SURFACE) return {generation, surface: decodeSurface(buffer, view)};
  if (kind === FRAME) return {generation, frame: decodeFrame(buffer, view)};
  if (kind === INTERIOR) return {generation, interior: decodeInterior(buffer, view)};
  throw new Error(`message of kind ${kind}`);
}

function decodeSurface(buffer: ArrayBuffer, view: DataView): Surface {
  const vertices = view.getUint32(12, true), triangles = view.getUint32(16, true);
  return {
    body: view.getUint32(8, true),
    rest: new Float32Array(buffer, 24, 3 * vertices),
    triangles: new Uint32Array(buffer, 24 + 12 * vertices, 3 * triangles),
    nodes: new Uint32Array(buffer, 24 + 12 * (vertices + triangles), vertices),
    elements: new Uint32Array(buffer, 24 + 16 * vertices + 12 * triangles, triangles),
  };
}

function decodeInterior(buffer: ArrayBuffer, view: DataView): Interior {
  const nodes = view.getUint32(12, true), tetrahedra = view.getUint32(16, true);
  return {
    body: view.getUint32(8, true),
    nodes: new Uint32Array(buffer, 24, nodes),
    tetrahedra: new Uint32Array(buffer, 24 + 4 * nodes, 4 * tetrahedra),
    elements: new Uint32Array(buffer, 24 + 4 * nodes + 16 * tetrahedra, tetrahedra),
  };
}

function decodePick(buffer: ArrayBuffer, at: number, bytes: number): Pick {
  const [body, kind, number, material, nodes] = new Uint32Array(buffer, at, 5);
  const [volume] = new Float32Array(buffer, at + 20, 1), places = at + 24, fields = places + 24 * nodes;
  return {body, kind: kind === 1 ? 'element' : 'node', number, material, volume,
          positions: new Float32Array(buffer, places, 3 * nodes), rest: new Float32Array(buffer, places + 12 * nodes, 3 * nodes),
          fields: new Float32Array(buffer, fields, (at + bytes - fields) / 4)};
}

function decodeFrame(buffer: ArrayBuffer, view: DataView): Frame {
  const count = view.getUint32(12, true);
  const frame: Frame = {
    sequence: view.getUint32(8, true),
    step: Number(view.getBigUint64(16, true)),
    time: view.getFloat64(24, true),
    hash: view.getBigUint64(32, true).toString(16).padStart(16, '0'),
    signals: new Float64Array(buffer, 40, count),
    positions: new Map(), fields: new Map(), contacts: new Map(), inner: new Map(), innerFields: new Map(),
  };
  for (let at = 40 + 8 * count; at + 8 <= buffer.byteLength;) {
    const kind = view.getUint16(at, true), index = view.getUint16(at + 2, true);
    const bytes = view.getUint32(at + 4, true);
    at += 8;
    if (kind === 2 || kind === 13) {
      const values = new Float32Array(buffer, at + 4, bytes / 4 - 1);
      if (kind === 2) frame.fields.set(index, {field: view.getUint32(at, true), values});
      else frame.innerFields.set(index, values);
    } else if (kind === 10) {
      frame.pick = decodePick(buffer, at, bytes);
    } else if (kind === 11) {
      const [oldest, latest, shown] = new Uint32Array(buffer, at, 3);
      const [oldestTime, latestTime] = new Float32Array(buffer, at + 12, 2);
      frame.timeline = {oldest, latest, shown, oldestTime, latestTime};
    } else {
      const values = new Float32Array(buffer, at, bytes / 4);
      if (kind === 1) frame.positions.set(index, values);
      if (kind === 3) frame.cables = values;
      if (kind === 4) frame.effectors = values;
      if (kind === 5) frame.targets = values;
      if (kind === 6) frame.pull = values;
      if (kind === 7) frame.probes = values;
      if (kind === 8) frame.contacts.set(index, values);
      if (kind === 9) frame.joints = values;
      if (kind === 12) frame.inner.set(index, values);
    }
    at += bytes;
  }
  return frame;
}
