// The curve of a transfer function over the histogram of the values in view. Points are dragged, a press
// beside them adds one; by keyboard, arrows move a point and Delete removes it.
import { useLayoutEffect, useRef, useState } from "preact/hooks";
import type { Histogram } from "../protocol/messages";
import type { TransferFunction } from "../protocol/scene";
import { hexOf } from "../scene/color";
import { formatNumber, logTicks, ticks } from "../scene/format";
import {
  type Axis,
  addPoint,
  extentOf,
  greatestExtinction,
  movePoint,
  positionOf,
  removePoint,
  sample,
  scaleOf,
  valueAt,
} from "../scene/transfer_function";

const height = 132;
const inset = { left: 9, right: 9, top: 10, bottom: 18 };
const stops = 32;
const keyStep = 0.01;
const pointRadius = 6.5;
// A press as close to a point as this takes it.
const reach = 8;
// Of the points' range, beside it where the editor is close to them.
const margin = 0.1;

interface EditorProps {
  transfer: TransferFunction;
  histogram: Histogram | undefined;
  close: boolean;
  selected: number;
  onSelect: (index: number) => void;
  onChange: (transfer: TransferFunction, what: string | null) => void;
}

/** What the editor shows from left to right: all values in view and all points, or close to the points. */
export function axisFor(
  transfer: TransferFunction,
  histogram: Histogram | undefined,
  close = false,
): Axis {
  const own = extentOf(transfer);
  if (close && own.min < own.max) {
    return { ...own, min: valueAt(-margin, own), max: valueAt(1 + margin, own) };
  }
  const log = own.scale === "log";
  const low = log ? histogram?.positive_min : histogram?.min;
  const min = Math.min(own.min, low ?? own.min);
  let max = Math.max(own.max, histogram?.max ?? own.max);
  if (!(max > min)) max = log ? 10 * min : min + 1;
  return { min, max, scale: own.scale };
}

interface Layout {
  axis: Axis;
  top: number;
  width: number;
}

const xOf = (value: number, { axis, width }: Layout) =>
  inset.left + positionOf(value, axis) * (width - inset.left - inset.right);
const yOf = (extinction: number, { top }: Layout) =>
  height - inset.bottom - (extinction / top) * (height - inset.top - inset.bottom);

function histogramPath(histogram: Histogram, layout: Layout): string {
  const log = layout.axis.scale === "log";
  const counts = log ? histogram.log_counts : histogram.counts;
  const min = log ? histogram.positive_min : histogram.min;
  if (!counts?.length || min === null || !(min < histogram.max)) return "";
  const bins: Axis = { min, max: histogram.max, scale: layout.axis.scale };
  // Logarithms of the counts: values are rare where matter is.
  const most = Math.log1p(Math.max(...counts));
  const base = height - inset.bottom;
  let path = `M${xOf(min, layout)} ${base}`;
  counts.forEach((count, i) => {
    const y = base - (Math.log1p(count) / most) * (base - inset.top);
    const from = xOf(valueAt(i / counts.length, bins), layout);
    const to = xOf(valueAt((i + 1) / counts.length, bins), layout);
    path += `L${from.toFixed(1)} ${y.toFixed(1)}L${to.toFixed(1)} ${y.toFixed(1)}`;
  });
  return `${path}L${xOf(histogram.max, layout)} ${base}Z`;
}

function curvePath({ points }: TransferFunction, layout: Layout): string {
  const right = layout.width - inset.right;
  const inner = points.map((p) => `L${xOf(p.value, layout)} ${yOf(p.extinction, layout)}`);
  const first = yOf(points[0]!.extinction, layout);
  const last = yOf(points.at(-1)!.extinction, layout);
  return `M${inset.left} ${first}${inner.join("")}L${right} ${last}`;
}

/** Drawn in units of which `height` make up the element's, whatever the size of text makes that. */
function useWidth(svg: { current: SVGSVGElement | null }): number {
  const [width, setWidth] = useState(300);
  useLayoutEffect(() => {
    const observer = new ResizeObserver(([entry]) => {
      const box = entry!.contentRect;
      setWidth((box.width * height) / box.height);
    });
    observer.observe(svg.current!);
    return () => observer.disconnect();
  }, []);
  return width;
}

function AxisLabels({ layout }: { layout: Layout }) {
  const { min, max, scale } = layout.axis;
  const marks = scale === "log" ? logTicks(min, max) : ticks(min, max, 5);
  return (
    <g class="editor-axis">
      {marks.map((value) => (
        <text key={value} x={xOf(value, layout)} y={height - 4} text-anchor="middle">
          {formatNumber(value)}
        </text>
      ))}
    </g>
  );
}

function Background({
  transfer,
  histogram,
  layout,
  id,
}: {
  transfer: TransferFunction;
  histogram: Histogram | undefined;
  layout: Layout;
  id: string;
}) {
  const curve = curvePath(transfer, layout);
  const base = height - inset.bottom;
  return (
    <>
      <defs>
        <linearGradient id={id}>
          {Array.from({ length: stops + 1 }, (_, i) => (
            <stop
              key={i}
              offset={i / stops}
              stop-color={hexOf(sample(transfer, valueAt(i / stops, layout.axis)).color)}
            />
          ))}
        </linearGradient>
      </defs>
      {histogram && <path class="editor-histogram" d={histogramPath(histogram, layout)} />}
      <path
        d={`${curve}L${layout.width - inset.right} ${base}L${inset.left} ${base}Z`}
        fill={`url(#${id})`}
        opacity={0.55}
      />
      <rect
        x={inset.left}
        y={base}
        width={Math.max(0, layout.width - inset.left - inset.right)}
        height={4}
        fill={`url(#${id})`}
      />
      <path class="editor-curve" d={curve} />
    </>
  );
}

/** Whether the points would touch if all were as large as can be. */
function isDense({ points }: TransferFunction, layout: Layout): boolean {
  const length = xOf(points.at(-1)!.value, layout) - xOf(points[0]!.value, layout);
  return length < 2.2 * pointRadius * (points.length - 1);
}

/** The point that a press at (x, y) is meant for. */
function nearestPoint({ points }: TransferFunction, x: number, y: number, layout: Layout) {
  const distances = points.map((point) =>
    Math.hypot(xOf(point.value, layout) - x, yOf(point.extinction, layout) - y),
  );
  const least = Math.min(...distances);
  return least <= reach ? distances.indexOf(least) : null;
}

let lastId = 0;

/** Dragging: scales stay as they are from press to release. */
function useDrag(props: EditorProps, layout: Layout, setFrozen: (layout: Layout | null) => void) {
  const dragged = useRef<number | null>(null);
  const placeOf = (event: PointerEvent) => {
    const box = (event.currentTarget as SVGElement).getBoundingClientRect();
    const x = ((event.clientX - box.left) * height) / box.height;
    const y = ((event.clientY - box.top) * height) / box.height;
    return { x, y };
  };
  const at = (event: PointerEvent) => {
    const { x, y } = placeOf(event);
    const t = (x - inset.left) / (layout.width - inset.left - inset.right);
    const up = (height - inset.bottom - y) / (height - inset.top - inset.bottom);
    return {
      value: valueAt(Math.min(1.2, Math.max(-0.2, t)), layout.axis),
      extinction: up * layout.top,
    };
  };
  const down = (event: PointerEvent) => {
    if (event.button !== 0) return;
    const svg = event.currentTarget as SVGSVGElement;
    const { x, y } = placeOf(event);
    let index = nearestPoint(props.transfer, x, y, layout);
    if (index === null) {
      const { value, extinction } = at(event);
      const added = addPoint(props.transfer, value, layout.axis, extinction);
      if (!added) return;
      index = added.index;
      props.onChange(added.transfer, "drag");
    }
    dragged.current = index;
    props.onSelect(index);
    setFrozen(layout);
    svg.setPointerCapture(event.pointerId);
    svg.querySelector<SVGElement>(`[data-point="${index}"]`)?.focus();
    event.preventDefault();
  };
  const move = (event: PointerEvent) => {
    if (dragged.current === null) return;
    props.onChange(movePoint(props.transfer, dragged.current, at(event), layout.axis), "drag");
  };
  const up = () => {
    dragged.current = null;
    setFrozen(null);
  };
  return { onPointerDown: down, onPointerMove: move, onPointerUp: up, onPointerCancel: up };
}

function onKey(event: KeyboardEvent, index: number, props: EditorProps, layout: Layout): void {
  const { transfer } = props;
  const point = transfer.points[index]!;
  const along = { ArrowLeft: -1, ArrowRight: 1 }[event.key] ?? 0;
  const upwards = { ArrowUp: 1, ArrowDown: -1 }[event.key] ?? 0;
  if (event.key === "Delete" || event.key === "Backspace") {
    props.onChange(removePoint(transfer, index), null);
    props.onSelect(Math.max(0, index - 1));
  } else if (along !== 0 || upwards !== 0) {
    const to = {
      value: valueAt(positionOf(point.value, layout.axis) + keyStep * along, layout.axis),
      extinction: point.extinction + 2 * keyStep * upwards * layout.top,
    };
    props.onChange(
      movePoint(transfer, index, along ? to : { ...to, value: point.value }, layout.axis),
      "key",
    );
  } else {
    return;
  }
  event.preventDefault();
}

export function TransferEditor(props: EditorProps) {
  const { transfer, histogram, close, selected, onSelect } = props;
  const svg = useRef<SVGSVGElement>(null);
  const [id] = useState(() => `transfer${++lastId}`);
  const [frozen, setFrozen] = useState<Layout | null>(null);
  const width = useWidth(svg);
  const layout = frozen ?? {
    axis: axisFor(transfer, histogram, close),
    top: greatestExtinction(transfer) * 1.1 || 1,
    width,
  };
  const drag = useDrag(props, layout, setFrozen);
  const scale = scaleOf(transfer) === "log" ? ", logarithmic" : "";
  return (
    <svg
      ref={svg}
      class={isDense(transfer, layout) ? "editor dense" : "editor"}
      viewBox={`0 0 ${width} ${height}`}
      role="group"
      aria-label={`Transfer function${scale}: extinction over the field's value`}
      {...drag}
    >
      <Background {...{ transfer, histogram, layout, id }} />
      <AxisLabels layout={layout} />
      {transfer.points.map((point, index) => (
        <circle
          key={index}
          data-point={index}
          class={index === selected ? "editor-point selected" : "editor-point"}
          cx={xOf(point.value, layout)}
          cy={yOf(point.extinction, layout)}
          r={pointRadius}
          fill={hexOf(point.color)}
          tabIndex={0}
          role="slider"
          aria-label={`Point ${index + 1} of ${transfer.points.length}`}
          aria-valuenow={point.value}
          aria-valuetext={`value ${formatNumber(point.value)}, extinction ${formatNumber(point.extinction)}`}
          onFocus={() => onSelect(index)}
          onKeyDown={(event) => onKey(event, index, props, layout)}
        />
      ))}
    </svg>
  );
}
