// Mouse, pen, touch and wheel on the picture. One finger or the left button turns, two fingers or the
// right button shift; fingers also zoom and roll; two clicks or taps at one place pick a particle.
import { pick } from "../state/measurements";
import { hintSeen } from "../state/preferences";
import { rest } from "../state/view";
import type { Place } from "./camera";
import { orbitBy, panBy, rollBy, zoomBy } from "./navigation";

type Mode = "orbit" | "pan" | "roll";

interface Pointer {
  place: Place;
  mode: Mode;
}

// Across the shorter side of the picture.
const turnPerSide = Math.PI;
const zoomPerWheelPixel = 0.0015;
// Trackpads say a pinch as a wheel with Control, in small steps.
const zoomPerPinchPixel = 0.01;
const pixelsPerLine = 16;
const tapMs = 350;
const tapPixels = 24;
const stillPixels = 5;

function modeOf(event: PointerEvent): Mode {
  if (event.altKey || (event.ctrlKey && event.button === 0)) return "roll";
  return event.button !== 0 || event.shiftKey || event.metaKey ? "pan" : "orbit";
}

/** Listens on the picture; returns what ends that. */
export function listen(element: HTMLElement): () => void {
  const pointers = new Map<number, Pointer>();
  let pressedAt = { x: 0, y: 0 };
  let still = false;
  let lastTap = { x: 0, y: 0, time: -Infinity };

  const placeOf = (event: MouseEvent): Place => {
    const box = element.getBoundingClientRect();
    return {
      x: (event.clientX - box.left - box.width / 2) / box.height,
      y: (box.height / 2 - (event.clientY - box.top)) / box.height,
    };
  };

  const moveOne = (pointer: Pointer, to: Place) => {
    const { place: from, mode } = pointer;
    const turn = turnPerSide * Math.max(1, element.clientHeight / element.clientWidth);
    if (mode === "orbit") orbitBy((to.x - from.x) * turn, (from.y - to.y) * turn, true);
    else if (mode === "pan") panBy(from, to, true);
    else rollBy(Math.atan2(to.y, to.x) - Math.atan2(from.y, from.x), undefined, true);
  };

  const moveTwo = (moved: Pointer, to: Place) => {
    const [other] = [...pointers.values()].filter((pointer) => pointer !== moved);
    const fixed = other!.place;
    const middle = (a: Place) => ({ x: (a.x + fixed.x) / 2, y: (a.y + fixed.y) / 2 });
    const span = (a: Place) => Math.hypot(a.x - fixed.x, a.y - fixed.y);
    const angle = (a: Place) => Math.atan2(a.y - fixed.y, a.x - fixed.x);
    panBy(middle(moved.place), middle(to), true);
    if (span(to) > 0) zoomBy(span(moved.place) / span(to), middle(to), true);
    rollBy(angle(to) - angle(moved.place), middle(to), true);
  };

  const down = (event: PointerEvent) => {
    element.focus({ preventScroll: true });
    element.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, { place: placeOf(event), mode: modeOf(event) });
    pressedAt = { x: event.clientX, y: event.clientY };
    still = pointers.size === 1;
    event.preventDefault();
  };

  const move = (event: PointerEvent) => {
    const pointer = pointers.get(event.pointerId);
    if (!pointer) return;
    const away = Math.hypot(event.clientX - pressedAt.x, event.clientY - pressedAt.y);
    // A click whose hand trembles is no drag.
    if (still && away < stillPixels) return;
    still = false;
    hintSeen.value = true;
    const to = placeOf(event);
    if (pointers.size === 2) moveTwo(pointer, to);
    else if (pointers.size === 1) moveOne(pointer, to);
    pointer.place = to;
  };

  const tap = (event: PointerEvent) => {
    const near = Math.hypot(event.clientX - lastTap.x, event.clientY - lastTap.y) < tapPixels;
    if (near && event.timeStamp - lastTap.time < tapMs) {
      const box = element.getBoundingClientRect();
      const scale = devicePixelRatio;
      pick((event.clientX - box.left) * scale, (event.clientY - box.top) * scale);
      hintSeen.value = true;
      lastTap.time = -Infinity;
    } else {
      lastTap = { x: event.clientX, y: event.clientY, time: event.timeStamp };
    }
  };

  const up = (event: PointerEvent) => {
    if (!pointers.delete(event.pointerId)) return;
    if (pointers.size > 0) return;
    if (still && event.type === "pointerup" && event.button === 0) tap(event);
    rest();
  };

  const wheel = (event: WheelEvent) => {
    event.preventDefault();
    hintSeen.value = true;
    const pixels =
      event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? 1 : pixelsPerLine);
    const rate = event.ctrlKey ? zoomPerPinchPixel : zoomPerWheelPixel;
    zoomBy(Math.exp(pixels * rate), placeOf(event));
  };

  const controller = new AbortController();
  const { signal } = controller;
  element.addEventListener("pointerdown", down, { signal });
  element.addEventListener("pointermove", move, { signal });
  element.addEventListener("pointerup", up, { signal });
  element.addEventListener("pointercancel", up, { signal });
  element.addEventListener("wheel", wheel, { signal, passive: false });
  element.addEventListener("contextmenu", (event) => event.preventDefault(), { signal });
  return () => controller.abort();
}
