// The scene: edited here at once, by the server for good. At most one edit is under way; of those
// made meanwhile only the newest is sent. What the server answers has everything filled in.
import { computed, effect, signal } from "@preact/signals";
import { connectionState, nextSequence, onMessage, send } from "../protocol/connection";
import type { Data } from "../protocol/messages";
import { centre, zoom } from "../camera/camera";
import type { Camera, Scene } from "../protocol/scene";
import { type History, amend, begin, record, redo, undo, withdraw } from "../scene/history";
import { notify } from "./notices";
import { hello } from "./session";
import { aspect, camera, moveCamera, size } from "./view";

const history = signal<History<Scene> | null>(null);

export const scene = computed(() => history.value?.present ?? null);
export const data = signal<Data | null>(null);
export const canUndo = computed(() => (history.value?.past.length ?? 0) > 0);
export const canRedo = computed(() => (history.value?.future.length ?? 0) > 0);
/** Earlier scenes of these data, oldest first. */
export const pastScenes = computed(() => history.value?.past ?? []);
/** Sequence of the newest scene that was sent. */
export const sentSequence = signal(0);

let inFlight: number | null = null;
let waiting = false;
let takesCamera = false;

/** The scene as it looks on this page: what is saved, copied and sent. */
export function presentScene(): Scene | null {
  const present = scene.peek();
  if (!present) return null;
  const { width, height } = size.peek();
  return {
    ...present,
    camera: camera.peek() ?? present.camera,
    render: { ...present.render, size: [width, height] },
  };
}

/** Whether the server has answered all edits. */
export function settled(): boolean {
  return inFlight === null && !waiting;
}

function transmit(): void {
  const present = presentScene();
  if (inFlight !== null) {
    waiting = true;
  } else if (present) {
    const sequence = nextSequence();
    if (!send({ type: "scene", sequence, scene: present })) return;
    inFlight = sequence;
    sentSequence.value = sequence;
  }
}

/** Edits the scene. Edits of one group that follow closely are undone together. */
export function edit(change: (scene: Scene) => Scene, group: string | null = null): void {
  if (!history.peek()) return;
  const before = history.peek()!;
  history.value = record(before, change(before.present), group, performance.now());
  transmit();
}

/** Shows another time step: no edit that could be undone. */
export function showFrame(frame: number): void {
  const present = history.peek();
  if (!present?.present.data) return;
  const data = { ...present.present.data, frame };
  history.value = amend(present, { ...present.present, data });
  transmit();
}

/** Takes the scene of a file, with its camera. */
export function loadScene(loaded: Scene): void {
  takesCamera = true;
  edit(() => loaded);
}

function travel(step: (history: History<Scene>) => History<Scene>): void {
  const before = history.peek();
  if (!before) return;
  const after = step(before);
  if (after === before) return;
  // Time is not undone: the step that is shown stays.
  const { data } = after.present;
  const frame = before.present.data?.frame;
  history.value = amend(
    after,
    data ? { ...after.present, data: { ...data, frame } } : after.present,
  );
  transmit();
}

export const undoEdit = (): void => travel(undo);
export const redoEdit = (): void => travel(redo);

/** The next edit that waited, if one did. */
function next(): boolean {
  inFlight = null;
  if (!waiting) return false;
  waiting = false;
  transmit();
  return true;
}

function adopt(scene: Scene): void {
  history.value = history.peek() ? amend(history.peek()!, scene) : begin(scene);
}

/** A scene that no edit of this page led to. */
function takeOver(scene: Scene): void {
  const before = history.peek();
  if (!before) {
    history.value = begin(scene);
  } else if (
    JSON.stringify({ ...scene, camera: 0 }) !== JSON.stringify({ ...before.present, camera: 0 })
  ) {
    history.value = record(before, scene, null, 0);
  }
}

/** Farther away where the window is narrower than the scene's picture, so that it holds as much. */
function framed(camera: Camera, of: [number, number] = [1, 1]): Camera {
  const narrower = of[0] / of[1] / aspect.peek();
  return narrower > 1 && Number.isFinite(narrower) ? zoom(camera, narrower, centre) : camera;
}

onMessage("scene", (message) => {
  const first = !history.peek();
  const otherData = message.data.file !== data.peek()?.file;
  data.value = message.data;
  if (message.new_data || otherData) {
    inFlight = null;
    waiting = false;
    history.value = begin(message.scene);
  } else if (message.client === hello.value?.client && message.sequence === inFlight) {
    if (!next()) adopt(message.scene);
  } else if (settled()) {
    takeOver(message.scene);
  }
  if (message.scene.camera && (first || message.new_data || otherData || takesCamera)) {
    takesCamera = false;
    moveCamera(framed(message.scene.camera, message.scene.render?.size));
  }
});

onMessage("error", ({ sequence, message }) => {
  notify("error", message);
  if (sequence === null || sequence !== inFlight) return;
  takesCamera = false;
  if (!next() && history.peek()) history.value = withdraw(history.peek()!);
});

// What was under way when the connection broke will not be answered.
effect(() => {
  if (connectionState.value.kind === "open") return;
  inFlight = null;
  waiting = false;
  sentSequence.value = 0;
});
