// Editing of transfer functions: from a field's value to colour and extinction, linear between points.
import type { Color, Scale, TransferFunction, TransferPoint } from "../protocol/scene";
import { hexOf, mixedColor } from "./color";
import { replaced, withItem, withoutItem } from "./lists";

/** Values of the horizontal axis; the middle of it on a logarithmic scale is the geometric mean. */
export interface Axis {
  min: number;
  max: number;
  scale: Scale;
}

// Values increase strictly: neighbours keep this part of the axis between them.
const leastGap = 1e-3;
// Points that a colour map adds.
const mapPoints = 7;

export function scaleOf(transfer: TransferFunction): Scale {
  return transfer.scale ?? "linear";
}

/** 0 at the axis' left end, 1 at its right. */
export function positionOf(value: number, axis: Axis): number {
  if (axis.scale === "linear") return (value - axis.min) / (axis.max - axis.min);
  return Math.log(Math.max(value, Number.MIN_VALUE) / axis.min) / Math.log(axis.max / axis.min);
}

export function valueAt(position: number, axis: Axis): number {
  if (axis.scale === "linear") return axis.min + position * (axis.max - axis.min);
  return axis.min * (axis.max / axis.min) ** position;
}

export function extentOf(transfer: TransferFunction): Axis {
  const { points } = transfer;
  return { min: points[0]!.value, max: points.at(-1)!.value, scale: scaleOf(transfer) };
}

export function greatestExtinction(transfer: TransferFunction): number {
  return Math.max(...transfer.points.map((point) => point.extinction));
}

/** Colour and extinction at a value; beyond the ends they stay. */
export function sample(transfer: TransferFunction, value: number): TransferPoint {
  const { points } = transfer;
  const right = points.findIndex((point) => point.value > value);
  if (right === 0) return { ...points[0]!, value };
  if (right < 0) return { ...points.at(-1)!, value };
  const from = points[right - 1]!;
  const to = points[right]!;
  const t = positionOf(value, { min: from.value, max: to.value, scale: scaleOf(transfer) });
  return {
    value,
    color: mixedColor(from.color, to.color, t),
    extinction: from.extinction + t * (to.extinction - from.extinction),
  };
}

function withPoints(transfer: TransferFunction, points: TransferPoint[]): TransferFunction {
  return { ...transfer, points };
}

/** Changes one point; its value stays between its neighbours'. */
export function movePoint(
  transfer: TransferFunction,
  index: number,
  to: { value: number; extinction: number },
  axis: Axis,
): TransferFunction {
  const { points } = transfer;
  const limit = (neighbour: TransferPoint | undefined, side: number) =>
    neighbour && valueAt(positionOf(neighbour.value, axis) + side * leastGap, axis);
  const least = axis.scale === "log" && to.value <= 0 ? axis.min : -Infinity;
  const low = limit(points[index - 1], 1) ?? least;
  const high = limit(points[index + 1], -1) ?? Infinity;
  // Where neighbours leave no room the point stays where it is.
  const value = low > high ? points[index]!.value : Math.min(high, Math.max(low, to.value));
  const extinction = Math.max(0, to.extinction);
  return withPoints(transfer, replaced(points, index, { value, extinction }));
}

export function recolorPoint(transfer: TransferFunction, index: number, color: Color) {
  return withPoints(transfer, replaced(transfer.points, index, { color }));
}

/** A new point on the curve, or at another extinction; null where there is one already. */
export function addPoint(
  transfer: TransferFunction,
  value: number,
  axis: Axis,
  extinction?: number,
): { transfer: TransferFunction; index: number } | null {
  const near = (point: TransferPoint) =>
    Math.abs(positionOf(point.value, axis) - positionOf(value, axis)) < 2 * leastGap;
  if (transfer.points.some(near)) return null;
  const onCurve = sample(transfer, value);
  const point = {
    ...onCurve,
    color: hexOf(onCurve.color),
    extinction: Math.max(0, extinction ?? onCurve.extinction),
  };
  const after = transfer.points.findIndex((other) => other.value > value);
  const index = after < 0 ? transfer.points.length : after;
  return { transfer: withPoints(transfer, withItem(transfer.points, index, point)), index };
}

/** The value in the middle of the widest gap, for a new point that no pointer places. */
export function widestGap(transfer: TransferFunction, axis: Axis): number {
  const ends = transfer.points.map((point) => positionOf(point.value, axis));
  if (ends.length < 2) return valueAt(ends[0]! < 0.5 ? 0.75 : 0.25, axis);
  let best = 1;
  for (let i = 2; i < ends.length; ++i) {
    if (ends[i]! - ends[i - 1]! > ends[best]! - ends[best - 1]!) best = i;
  }
  return valueAt((ends[best]! + ends[best - 1]!) / 2, axis);
}

/** The last point stays. */
export function removePoint(transfer: TransferFunction, index: number): TransferFunction {
  if (transfer.points.length === 1) return transfer;
  return withPoints(transfer, withoutItem(transfer.points, index));
}

export function withGreatestExtinction(transfer: TransferFunction, greatest: number) {
  const present = greatestExtinction(transfer);
  return withPoints(
    transfer,
    transfer.points.map((point, i) => ({
      ...point,
      // A function that is 0 everywhere becomes a ramp.
      extinction:
        present > 0
          ? (point.extinction / present) * greatest
          : (i / Math.max(1, transfer.points.length - 1)) * greatest,
    })),
  );
}

/** Stretches all points over another range. */
export function withRange(transfer: TransferFunction, min: number, max: number): TransferFunction {
  const from = extentOf(transfer);
  const to: Axis = { ...from, min, max };
  return withPoints(
    transfer,
    transfer.points.map((point) => ({
      ...point,
      value: from.min < from.max ? valueAt(positionOf(point.value, from), to) : min,
    })),
  );
}

/** The colours of a map over the present range; extinctions stay as they are. */
export function withColorMap(transfer: TransferFunction, colors: string[]): TransferFunction {
  const axis = extentOf(transfer);
  if (!(axis.min < axis.max)) return transfer;
  let result = transfer;
  for (let i = 1; i < mapPoints; ++i) {
    const position = i / mapPoints;
    const taken = transfer.points.some(
      (point) => Math.abs(positionOf(point.value, axis) - position) < 0.5 / mapPoints,
    );
    if (!taken) result = addPoint(result, valueAt(position, axis), axis)?.transfer ?? result;
  }
  const colorAt = (position: number) =>
    colors[Math.round(Math.min(1, Math.max(0, position)) * (colors.length - 1))]!;
  return withPoints(
    result,
    result.points.map((point) => ({ ...point, color: colorAt(positionOf(point.value, axis)) })),
  );
}

/** On the other scale, the points at the same values; a logarithm takes only positive ones. */
export function withScale(
  transfer: TransferFunction,
  scale: Scale,
  leastPositive: number,
): TransferFunction {
  if (scale === "linear") return { ...transfer, scale };
  const positive = transfer.points.filter((point) => point.value > leastPositive);
  if (positive.length === transfer.points.length) return { ...transfer, scale };
  const first = { ...sample(transfer, leastPositive), value: leastPositive };
  return { scale, points: [{ ...first, color: hexOf(first.color) }, ...positive] };
}
