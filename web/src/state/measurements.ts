// What is asked of the server about the picture: the particle under the pointer, histograms, statistics.
import { effect, signal } from "@preact/signals";
import { lookAt } from "../camera/camera";
import { nextSequence, onMessage, send } from "../protocol/connection";
import type { Histogram, Hit, Statistics } from "../protocol/messages";
import { data, scene } from "./document";
import { notify } from "./notices";
import { panelOpen, showStatistics, tab } from "./preferences";
import { connected } from "./session";
import { camera, glideTo, moving } from "./view";

export const picked = signal<Hit | null>(null);
/** Of the fields that have values in view. */
export const histograms = signal<Histogram[]>([]);
export const statistics = signal<Statistics | null>(null);

const histogramPauseMs = 600;
const statisticsPeriodMs = 1000;

/** Asks for the particle at a pixel of the picture; the answer makes it the centre. */
export function pick(x: number, y: number): void {
  send({ type: "pick", sequence: nextSequence(), x, y });
}

onMessage("picked", ({ hit }) => {
  picked.value = hit;
  if (!hit) notify("news", "No particle there.");
  else if (camera.peek()) glideTo(lookAt(camera.peek()!, hit.position));
});
onMessage("histogram", ({ fields }) => {
  histograms.value = fields.filter(({ counts }) => counts.length > 0);
});
onMessage("statistics", ({ type: _, ...rest }) => {
  statistics.value = rest;
});

// Histograms are of the values in view: new ones whenever view or scene have come to rest.
effect(() => {
  const wanted = connected.value && panelOpen.value && tab.value === "fields";
  if (!wanted || moving.value || !camera.value || !scene.value) return undefined;
  const timer = setTimeout(() => send({ type: "histogram" }), histogramPauseMs);
  return () => clearTimeout(timer);
});

effect(() => {
  if (!connected.value || !showStatistics.value) return undefined;
  send({ type: "statistics" });
  const timer = setInterval(() => send({ type: "statistics" }), statisticsPeriodMs);
  return () => clearInterval(timer);
});

// In other data, or at another time, the particle is elsewhere.
let shown = "";
effect(() => {
  const now = `${scene.value?.data?.frame} ${data.value?.file}`;
  if (now !== shown) picked.value = null;
  shown = now;
});
