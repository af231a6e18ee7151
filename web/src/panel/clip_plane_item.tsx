// A plane that cuts away what lies farther along its normal.
import { basisOf } from "../camera/camera";
import { dot, normalized, scaled } from "../camera/vector";
import { Button, IconButton } from "../controls/button";
import { Segments, Slider } from "../controls/fields";
import type { ClipPlane, Vector } from "../protocol/scene";
import { setClipPlanes } from "../scene/edit";
import { replaced } from "../scene/lists";
import { data, edit } from "../state/document";
import { camera } from "../state/view";

const axes: Record<string, Vector> = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };
const directions = [
  { value: "x", label: "x" },
  { value: "y", label: "y" },
  { value: "z", label: "z" },
  { value: "free", label: "view" },
];

/** From where to where the data reach along a normal. */
function reach(normal: Vector): [number, number] {
  const bounds = data.value?.bounds;
  if (!bounds) return [-1, 1];
  const ends = normal.map((c, i) => [c * bounds.min[i]!, c * bounds.max[i]!]);
  const low = ends.reduce((sum, pair) => sum + Math.min(...pair), 0);
  const high = ends.reduce((sum, pair) => sum + Math.max(...pair), 0);
  return low < high ? [low, high] : [low - 1, high + 1];
}

function directionOf({ normal }: ClipPlane): string {
  const unit = normalized(normal);
  return Object.keys(axes).find((name) => Math.abs(dot(axes[name]!, unit)) > 1 - 1e-9) ?? "free";
}

export function ClipPlaneItem({ plane, index }: { plane: ClipPlane; index: number }) {
  const change = (patch: Partial<ClipPlane> | null, what: string | null = null) =>
    edit(
      setClipPlanes((planes) => replaced(planes, index, patch)),
      what && `clip${index}.${what}`,
    );
  const [low, high] = reach(plane.normal);
  const turn = (normal: Vector) => {
    const [from, to] = reach(normal);
    change({ normal, distance: (from + to) / 2 });
  };
  const choose = (direction: string) => {
    if (axes[direction]) turn(axes[direction]);
    else if (camera.peek()) turn(scaled(basisOf(camera.peek()!).forward, -1));
  };
  return (
    <li class="item">
      <div class="item-head">
        <Segments
          label="Normal of the plane"
          value={directionOf(plane)}
          choices={directions}
          onChange={choose}
        />
        <Button
          onClick={() =>
            change({
              normal: scaled(plane.normal, -1).map((c) => c + 0) as Vector,
              distance: -plane.distance,
            })
          }
        >
          Flip
        </Button>
        <IconButton icon="trash" label="Remove this plane" onClick={() => change(null)} />
      </div>
      <Slider
        label="Distance"
        value={plane.distance}
        min={low}
        max={high}
        onChange={(distance) => change({ distance }, "distance")}
      />
    </li>
  );
}
