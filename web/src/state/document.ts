// The scene: edited here at once, by the server for good. At most one edit is under way; of those
// made meanwhile only the newest is sent. What the server answers has everything filled in.
import { computed, effect, signal } from "@preact/signals";
import { connectionState, nextSequence, onMessage, send } from "../protocol/connection";
import type { Data } from "../protocol/messages";
import { centre, zoom } from "../camera/camera";
import type { Camera, Scene } from "../protocol/scene";
import { type History, amend, begin, record, redo, undo } from "../scene/history";
import { notify } from "./notices";
import { hello } from "./session";
import { aspect, camera, moveCamera, showFitted, size } from "./view";

const history = signal<History<Scene> | null>(null);

export const scene = computed(() => history.value?.present ?? null);
export const data = signal<Data | null>(null);
export const canUndo = computed(() => (history.value?.past.length ?? 0) > 0);
export const canRedo = computed(() => (history.value?.future.length ?? 0) > 0);
/** Earlier scenes of these data, oldest first. */
export const pastScenes = computed(() => history.value?.past ?? []);
/** Sequence of the newest scene of this page that the server has taken. */
export const takenSequence = signal(0);

/** The edit that the server is at, and the history that ended with it. */
const inFlight = signal<{ sequence: number; history: History<Scene> } | null>(null);
/** Whether the server has answered all edits. */
export const settled = computed(() => inFlight.value === null);
/** Whether there are newer edits. */
let waiting = false;
/** As far as the server has agreed: where a refused edit leads back to. */
let agreed: History<Scene> | null = null;
/** Whether the scene that is sent comes with a camera of its own. */
let takesCamera = false;

/** The scene as it looks on this page: what is saved, copied and sent. */
export function presentScene(): Scene | null {
  const present = scene.peek();
  if (!present || takesCamera) return present;
  const { width, height } = size.peek();
  return {
    ...present,
    camera: camera.peek() ?? present.camera,
    render: { ...present.render, size: [width, height] },
  };
}

function transmit(): void {
  const present = presentScene();
  if (inFlight.peek()) {
    waiting = true;
  } else if (present) {
    const sequence = nextSequence();
    if (!send({ type: "scene", sequence, scene: present })) return;
    inFlight.value = { sequence, history: history.peek()! };
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

/** Time is not undone: of the same data the step that is shown stays. */
function atPresentFrame(scene: Scene, present: Scene): Scene {
  if (!scene.data || scene.data.path !== present.data?.path) return scene;
  return { ...scene, data: { ...scene.data, frame: present.data.frame } };
}

function travel(step: (history: History<Scene>) => History<Scene>): void {
  const before = history.peek();
  if (!before) return;
  const after = step(before);
  if (after === before) return;
  takesCamera ||= after.present.data?.path !== before.present.data?.path;
  history.value = amend(after, atPresentFrame(after.present, before.present));
  transmit();
}

export const undoEdit = (): void => travel(undo);
export const redoEdit = (): void => travel(redo);

/** Agrees with the server about all that is shown. */
function settle(present: History<Scene>): void {
  inFlight.value = null;
  waiting = false;
  agreed = present;
  history.value = present;
}

/** Sends the newest edit, if one waited for the answer that has come. */
function sendWaiting(): boolean {
  inFlight.value = null;
  if (!waiting) return false;
  waiting = false;
  transmit();
  return true;
}

function isAnswer(message: { sequence: number | null }): boolean {
  return message.sequence !== null && message.sequence === inFlight.peek()?.sequence;
}

/** What an edit of this page came to. */
function takeAnswer(scene: Scene): void {
  takenSequence.value = inFlight.peek()!.sequence;
  agreed = amend(inFlight.peek()!.history, scene);
  if (!sendWaiting()) settle(amend(history.peek()!, scene));
}

/** A scene that no edit of this page led to. */
function takeOver(scene: Scene): void {
  const before = history.peek()!;
  // Every page has its own camera and size.
  const text = (scene: Scene) =>
    JSON.stringify({ ...scene, camera: null, render: { ...scene.render, size: null } });
  if (text(scene) !== text(before.present)) settle(record(before, scene, null, 0));
}

/** Farther away where the window is narrower than the scene's picture, so that it holds as much. */
function framed(camera: Camera, of: [number, number] = [1, 1]): Camera {
  const narrower = of[0] / of[1] / aspect.peek();
  return narrower > 1 && Number.isFinite(narrower) ? zoom(camera, narrower, centre) : camera;
}

onMessage("scene", (message) => {
  // After a restart the server opens again what this page still looks at: that is nothing new.
  const mine = message.client === hello.value?.client;
  const newData = (message.new_data && mine) || message.data.file !== data.peek()?.file;
  const own = isAnswer(message) && mine;
  data.value = message.data;
  if (own) takeAnswer(message.scene);
  else if (newData || !history.peek()) settle(begin(message.scene));
  else if (settled.peek()) takeOver(message.scene);
  const { camera: its, render } = message.scene;
  if (its && (newData || (own && takesCamera))) {
    takesCamera = false;
    const camera = framed(its, render?.size);
    if (message.fitted) showFitted(camera);
    else moveCamera(camera);
  }
});

onMessage("error", (message) => {
  notify("error", message.message);
  if (!isAnswer(message)) return;
  takesCamera = false;
  if (!sendWaiting() && agreed) settle(agreed);
});

// What was under way when the connection broke will not be answered.
effect(() => {
  if (connectionState.value.kind === "open") return;
  inFlight.value = null;
  waiting = false;
  takenSequence.value = 0;
});
