// This page's camera: every change goes to the server, at most one in each frame of the display.
import { computed, effect, signal } from "@preact/signals";
import { between, centre, zoom } from "../camera/camera";
import { connectionState, nextSequence, onMessage, send } from "../protocol/connection";
import type { Camera } from "../protocol/scene";
import { following, hello } from "./session";

export const camera = signal<Camera | null>(null);
/** Of the picture, in pixels of the device. */
export const size = signal({ width: 0, height: 0 });
/** Sequence of the newest view that was sent and was another than the one before. */
export const sentView = signal(0);
let sentText = "";
/** Whether the camera moves, so that what costs time can wait. */
export const moving = signal(false);

const restMs = 150;
const glideMs = 350;

let scheduled = 0;
let restTimer = 0;
let gliding = 0;

export const aspect = computed(() => size.value.width / Math.max(1, size.value.height));

function sendView(): void {
  scheduled = 0;
  const present = camera.peek();
  if (!present) return;
  const sequence = nextSequence();
  const sent = send({ type: "view", sequence, camera: present, moving: moving.peek() });
  const text = JSON.stringify(present);
  if (sent && text !== sentText) sentView.value = sequence;
  sentText = text;
}

function schedule(): void {
  scheduled ||= requestAnimationFrame(sendView);
}

/** The interaction has ended: the server may refine the picture. */
export function rest(): void {
  clearTimeout(restTimer);
  if (!moving.peek()) return;
  moving.value = false;
  schedule();
}

/** Shows another view. Without `rest()` it counts as moving until nothing comes for a while. */
export function moveCamera(next: Camera, held = false): void {
  cancelAnimationFrame(gliding);
  camera.value = next;
  moving.value = true;
  schedule();
  clearTimeout(restTimer);
  if (!held) restTimer = window.setTimeout(rest, restMs);
}

export function changeCamera(change: (camera: Camera) => Camera, held = false): void {
  if (camera.peek()) moveCamera(change(camera.peek()!), held);
}

/** Goes to another view in a short movement, or at once where the user wants none. */
export function glideTo(end: Camera): void {
  const start = camera.peek();
  if (!start || matchMedia("(prefers-reduced-motion: reduce)").matches) {
    moveCamera(end);
    return;
  }
  const begun = performance.now();
  const step = (now: number) => {
    const t = Math.min(1, Math.max(0, (now - begun) / glideMs));
    moveCamera(between(start, end, t * t * (3 - 2 * t)), t < 1);
    if (t < 1) gliding = requestAnimationFrame(step);
    else rest();
  };
  cancelAnimationFrame(gliding);
  gliding = requestAnimationFrame(step);
}

export function fit(): void {
  send({ type: "fit" });
}

/** CSS pixels at the picture's bottom that are covered from side to side. */
export const coveredBelow = signal(0);

/** What was fitted to the whole picture and what came of it, as long as that is what is shown. */
let fitted: { whole: Camera; shown: Camera } | null = null;

/** Farther away, so that what fills the picture's height is not covered below. */
function uncovered(camera: Camera): Camera {
  const width = size.peek().width / devicePixelRatio;
  const height = size.peek().height / devicePixelRatio;
  const free = height - 2 * coveredBelow.peek();
  return free < width && free > height / 2 ? zoom(camera, height / free, centre) : camera;
}

/** Shows what was fitted to the picture, and keeps it so while nobody moves. */
export function showFitted(whole: Camera, show: (camera: Camera) => void = moveCamera): void {
  fitted = { whole, shown: uncovered(whole) };
  show(fitted.shown);
}

effect(() => {
  const covers = coveredBelow.value > 0;
  if (covers && fitted && camera.peek() === fitted.shown) showFitted(fitted.whole);
});

effect(() => {
  const { width, height } = size.value;
  if (width > 0 && connectionState.value.kind === "open") send({ type: "size", width, height });
});

// Across the shorter side one sees as much as before, when a panel opens or a phone is turned.
let before = { width: 0, height: 0 };
effect(() => {
  const longer = ({ width, height }: typeof before) => height / Math.min(width, height);
  const now = size.value;
  const factor = longer(now) / longer(before);
  before = now;
  const present = camera.peek();
  if (present && following.peek() === null && factor !== 1)
    moveCamera(zoom(present, factor, centre));
});

// A new connection knows nothing of this page's view.
effect(() => {
  if (connectionState.value.kind === "open" && camera.peek()) schedule();
});

onMessage("camera", (message) => {
  if (message.client === hello.value?.client) {
    showFitted(message.camera, glideTo);
  } else if (!moving.peek()) {
    // Of the one that is followed. It is not sent: a view of its own would end the following.
    cancelAnimationFrame(gliding);
    camera.value = message.camera;
  }
});
