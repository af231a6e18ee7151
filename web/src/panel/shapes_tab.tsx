// Balls and sticks, and the planes that cut.
import { Button } from "../controls/button";
import { Section } from "../controls/section";
import { setClipPlanes, setGeometry } from "../scene/edit";
import { basisOf } from "../camera/camera";
import { dot } from "../camera/vector";
import { data, edit, scene } from "../state/document";
import { camera } from "../state/view";
import { ClipPlaneItem } from "./clip_plane_item";
import { GeometryItem } from "./geometry_item";

function GeometrySection() {
  const items = scene.value!.geometry ?? [];
  const hasSticks = items.some(({ type }) => type === "sticks");
  return (
    <Section title="Balls and sticks">
      {items.length === 0 && <p class="quiet">None are drawn.</p>}
      <ul class="items">
        {items.map((item, index) => (
          <GeometryItem key={index} item={item} index={index} />
        ))}
      </ul>
      <div class="buttons">
        <Button
          icon="add"
          onClick={() => edit(setGeometry((old) => [...old, { type: "spheres", scale: 0.25 }]))}
        >
          Balls
        </Button>
        <Button
          icon="add"
          disabled={hasSticks}
          onClick={() => edit(setGeometry((old) => [...old, { type: "sticks", radius: 0.15 }]))}
        >
          Sticks
        </Button>
      </div>
    </Section>
  );
}

function ClipSection() {
  const planes = scene.value!.render?.clip_planes ?? [];
  // Facing the viewer, through the middle: what lies before it is cut away.
  const add = () => {
    const bounds = data.peek()?.bounds;
    if (!camera.peek() || !bounds) return;
    const forward = basisOf(camera.peek()!).forward;
    const axis = forward.reduce(
      (best, c, i) => (Math.abs(c) > Math.abs(forward[best]!) ? i : best),
      0,
    );
    const normal: [number, number, number] = [0, 0, 0];
    normal[axis] = -Math.sign(forward[axis]!);
    const middle = bounds.min.map((low, i) => (low + bounds.max[i]!) / 2) as typeof normal;
    edit(setClipPlanes((old) => [...old, { normal, distance: dot(normal, middle) }]));
  };
  return (
    <Section title="Clip planes">
      {planes.length === 0 && <p class="quiet">A plane cuts away what lies before it.</p>}
      <ul class="items">
        {planes.map((plane, index) => (
          <ClipPlaneItem key={index} plane={plane} index={index} />
        ))}
      </ul>
      <div class="buttons">
        <Button icon="add" disabled={planes.length >= 16} onClick={add}>
          Plane
        </Button>
      </div>
    </Section>
  );
}

export function ShapesTab() {
  return (
    <>
      <GeometrySection />
      <ClipSection />
    </>
  );
}
