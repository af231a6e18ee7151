// The axes' directions in a corner of the picture; each end is a button to look from there.
import { basisOf } from "../camera/camera";
import { viewFrom } from "../camera/navigation";
import { dot } from "../camera/vector";
import type { Vector } from "../protocol/scene";
import { camera } from "../state/view";

const half = 44;
const arm = 31;
const unit: Vector[] = [
  [1, 0, 0],
  [0, 1, 0],
  [0, 0, 1],
];
const names = ["x", "y", "z"];

interface End {
  axis: 0 | 1 | 2;
  sign: 1 | -1;
  x: number;
  y: number;
  /** Towards the eye. */
  nearness: number;
}

function ends(view: NonNullable<typeof camera.value>): End[] {
  const { right, up, forward } = basisOf(view);
  const all = ([0, 1, 2] as const).flatMap((axis) =>
    ([1, -1] as const).map((sign) => ({
      axis,
      sign,
      x: half + arm * sign * dot(unit[axis]!, right),
      y: half - arm * sign * dot(unit[axis]!, up),
      nearness: -sign * dot(unit[axis]!, forward),
    })),
  );
  return all.sort((a, b) => a.nearness - b.nearness);
}

export function Axes() {
  const view = camera.value;
  if (!view) return null;
  return (
    <svg class="axes" viewBox={`0 0 ${2 * half} ${2 * half}`} role="group" aria-label="Axes">
      {ends(view).map(({ axis, sign, x, y, nearness }) => {
        const label = `Look from ${sign > 0 ? "+" : "−"}${names[axis]}`;
        return (
          <g
            key={`${axis}${sign}`}
            class={`axis axis-${names[axis]} ${sign > 0 ? "positive" : "negative"}`}
            opacity={0.65 + 0.35 * nearness}
            role="button"
            tabIndex={-1}
            aria-label={label}
            onClick={() => viewFrom(axis, sign)}
          >
            <title>{label}</title>
            {sign > 0 && <line x1={half} y1={half} x2={x} y2={y} />}
            <circle cx={x} cy={y} r={sign > 0 ? 8.5 : 5} />
            {sign > 0 && (
              <text x={x} y={y + 3.6} text-anchor="middle">
                {names[axis]}
              </text>
            )}
          </g>
        );
      })}
    </svg>
  );
}
