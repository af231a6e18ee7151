// What pointer, touch and keys do to the camera.
import { data } from "../state/document";
import { camera, changeCamera, glideTo } from "../state/view";
import type { Camera, Vector } from "../protocol/scene";
import { type Place, centre, lookAlong, orbit, pan, roll, viewHeight, zoom } from "./camera";
import { length, subtract } from "./vector";

// What may be seen, in sizes of the data.
const smallestView = 1e-6;
const largestView = 1e3;

function sizeOfData(): number {
  const bounds = data.peek()?.bounds;
  return bounds ? length(subtract(bounds.max, bounds.min)) || 1 : 1;
}

/** Zooms, but neither into a point nor out of sight. */
export function zoomBy(factor: number, place: Place = centre, held = false): void {
  changeCamera((present) => {
    const height = (viewHeight(present) * factor) / sizeOfData();
    return height > smallestView && height < largestView ? zoom(present, factor, place) : present;
  }, held);
}

export const orbitBy = (toRight: number, down: number, held = false): void =>
  changeCamera((present) => orbit(present, toRight, down), held);

export const panBy = (from: Place, to: Place, held = false): void =>
  changeCamera((present) => pan(present, from, to), held);

/** Turns the picture about a place of it. */
export function rollBy(angle: number, place: Place = centre, held = false): void {
  const c = Math.cos(angle);
  const s = Math.sin(angle);
  const moved = { x: c * place.x - s * place.y, y: s * place.x + c * place.y };
  changeCamera((present) => pan(roll(present, angle), moved, place), held);
}

/** From +x, -x, +y and so on; upright where the data have their up. */
export function viewFrom(axis: 0 | 1 | 2, sign: 1 | -1): void {
  const present: Camera | null = camera.peek();
  if (!present) return;
  const direction: Vector = [0, 0, 0];
  direction[axis] = -sign;
  // y stays up, and along y z goes down the picture, as in mathematics' drawings of x and z.
  const up: Vector = axis === 1 ? [0, 0, -sign] : [0, 1, 0];
  glideTo(lookAlong(present, direction, up));
}
