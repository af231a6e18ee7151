// One of the scene's lights: from the camera or from a direction in the world.
import { basisOf } from "../camera/camera";
import { normalized } from "../camera/vector";
import { Button, IconButton } from "../controls/button";
import { Segments, Slider } from "../controls/fields";
import type { LightSource, Vector } from "../protocol/scene";
import { setLights } from "../scene/edit";
import { replaced } from "../scene/lists";
import { edit } from "../state/document";
import { camera } from "../state/view";

const degrees = 180 / Math.PI;

/** Towards a light over the viewer's left shoulder; nothing while there is no camera. */
export function overTheShoulder(): Vector | undefined {
  const present = camera.peek();
  if (!present) return undefined;
  const { right, up, forward } = basisOf(present);
  return normalized([0, 1, 2].map((i) => up[i]! - 0.7 * right[i]! - 1.2 * forward[i]!) as Vector);
}

interface DirectionProps {
  direction: Vector;
  onChange: (direction: Vector) => void;
}

/** In the world: degrees around y from z towards x, and above the plane of x and z. */
function DirectionRows({ direction, onChange }: DirectionProps) {
  const [x, y, z] = normalized(direction);
  const around = Math.atan2(x, z) * degrees;
  const above = Math.asin(y) * degrees;
  const set = (nextAround: number, nextAbove: number) => {
    const a = nextAround / degrees;
    const b = nextAbove / degrees;
    onChange([Math.sin(a) * Math.cos(b), Math.sin(b), Math.cos(a) * Math.cos(b)]);
  };
  return (
    <>
      <Slider
        label="Around"
        value={around}
        min={-180}
        max={180}
        onChange={(next) => set(next, above)}
      />
      <Slider
        label="Above"
        value={above}
        min={-89}
        max={89}
        onChange={(next) => set(around, next)}
      />
    </>
  );
}

export function LightItem({ light, index }: { light: LightSource; index: number }) {
  const { direction, intensity = 1 } = light;
  const change = (patch: Partial<LightSource> | null, what: string | null = null) =>
    edit(
      setLights((lights) => replaced(lights, index, patch)),
      what && `light${index}.${what}`,
    );
  const fromHere = () => {
    const shoulder = overTheShoulder();
    if (shoulder) change({ direction: shoulder });
  };
  return (
    <li class="item">
      <div class="item-head">
        <Segments
          label={`Where light ${index + 1} is`}
          value={direction ? "world" : "camera"}
          choices={[
            { value: "camera", label: "at the camera" },
            { value: "world", label: "in the scene" },
          ]}
          onChange={(place) => (place === "camera" ? change({ direction: undefined }) : fromHere())}
        />
        <IconButton icon="trash" label={`Remove light ${index + 1}`} onClick={() => change(null)} />
      </div>
      {direction && (
        <>
          <DirectionRows
            direction={direction}
            onChange={(next) => change({ direction: next }, "direction")}
          />
          <Button onClick={fromHere}>From over the shoulder</Button>
        </>
      )}
      <Slider
        label="Intensity"
        value={intensity}
        min={0}
        max={2}
        onChange={(next) => change({ intensity: next }, "intensity")}
      />
    </li>
  );
}
