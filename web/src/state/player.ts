// Plays a trajectory: the next step is asked for when the last is on the screen and its time is over.
import { computed, effect, signal } from "@preact/signals";
import { data, scene, settled, takenSequence, showFrame } from "./document";
import { picture } from "./picture";

export const playing = signal(false);
export const loop = signal(true);
/** Time steps a second, at most. */
export const speed = signal(10);

export const frameCount = computed(() => data.value?.frames ?? null);
export const currentFrame = computed(() => scene.value?.data?.frame ?? 0);
export const isTrajectory = computed(() => frameCount.value === null || frameCount.value > 1);

let lastStep = 0;

function onScreen(): boolean {
  return settled.peek() && (picture.peek()?.frame.sceneSequence ?? 0) >= takenSequence.peek();
}

/** A step on or back, around the ends where that is wanted. */
export function step(by: number): void {
  const count = frameCount.peek();
  if (count === null || count < 2) return;
  const next = currentFrame.peek() + by;
  if (next >= 0 && next < count) showFrame(next);
  else if (loop.peek()) showFrame((next + count) % count);
  else playing.value = false;
}

function tick(now: number): void {
  if (!playing.peek()) return;
  if (onScreen() && now - lastStep >= 1000 / speed.peek()) {
    lastStep = now;
    step(1);
  }
  requestAnimationFrame(tick);
}

export function togglePlaying(): void {
  const count = frameCount.peek();
  if (!playing.peek() && !loop.peek() && currentFrame.peek() === (count ?? 0) - 1) showFrame(0);
  playing.value = !playing.peek();
}

effect(() => {
  if (playing.value) requestAnimationFrame(tick);
});
effect(() => {
  if (!isTrajectory.value) playing.value = false;
});
