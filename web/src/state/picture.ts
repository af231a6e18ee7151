// The newest picture that has come, and how many come in a second.
import { effect, signal } from "@preact/signals";
import { connectionState, onFrame } from "../protocol/connection";
import type { Frame } from "../protocol/frame";

export interface Picture {
  frame: Frame;
  bitmap: ImageBitmap;
}

export const picture = signal<Picture | null>(null);
/** Times in ms at which pictures were shown, the newest last; for the frame rate. */
export const shownAt = signal<number[]>([]);

const rateWindowMs = 2000;

let latest: Frame | null = null;
let decoding = false;
let connection = 0;

async function decode(frame: Frame): Promise<ImageBitmap | null> {
  const blob = new Blob([frame.image], { type: frame.mediaType });
  try {
    return await createImageBitmap(blob, { colorSpaceConversion: "none" });
  } catch {
    return null;
  }
}

/** Decodes one picture at a time, the newest; those that came in between are left out. */
async function show(): Promise<void> {
  if (decoding) return;
  decoding = true;
  while (latest) {
    const frame = latest;
    const begunIn = connection;
    latest = null;
    const bitmap = await decode(frame);
    if (!bitmap) continue;
    if (begunIn !== connection) {
      bitmap.close();
      continue;
    }
    picture.peek()?.bitmap.close();
    picture.value = { frame, bitmap };
    const now = performance.now();
    shownAt.value = [...shownAt.peek().filter((time) => now - time < rateWindowMs), now];
  }
  decoding = false;
}

/** Pictures a second, over those of the last while. */
export function frameRate(): number {
  const now = performance.now();
  return shownAt.peek().filter((time) => now - time < rateWindowMs).length / (rateWindowMs / 1000);
}

let newestId = 0;
onFrame((frame) => {
  // Never back to an older picture.
  if (frame.id <= newestId || frame.recalled) return;
  newestId = frame.id;
  latest = frame;
  void show();
});

// A new connection numbers its pictures anew.
effect(() => {
  if (connectionState.value.kind !== "open") return;
  ++connection;
  newestId = 0;
  latest = null;
});
