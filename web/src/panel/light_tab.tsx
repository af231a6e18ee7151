// Background, light, and how surfaces are lit.
import { useId } from "preact/hooks";
import { basisOf } from "../camera/camera";
import { normalized } from "../camera/vector";
import { Button } from "../controls/button";
import { ColorField, Row, Slider, Toggle } from "../controls/fields";
import { Section } from "../controls/section";
import type { Lighting, Vector } from "../protocol/scene";
import { setLighting, setRender, setSurface } from "../scene/edit";
import { edit, scene } from "../state/document";
import { camera } from "../state/view";

const degrees = 180 / Math.PI;

function BackgroundSection() {
  const id = useId();
  const background = scene.value!.render?.background ?? "#000000";
  const set = (color: string) => edit(setRender({ background: color }), "background");
  return (
    <Section title="Background">
      <Row label="Colour" for={id}>
        <Button onClick={() => set("#000000")}>Black</Button>
        <Button onClick={() => set("#ffffff")}>White</Button>
        <ColorField id={id} label="Background" value={background} onChange={set} />
      </Row>
    </Section>
  );
}

/** In the world: degrees around y from z towards x, and above the plane of x and z. */
function DirectionRows({ direction }: { direction: Vector }) {
  const [x, y, z] = normalized(direction);
  const around = Math.atan2(x, z) * degrees;
  const above = Math.asin(y) * degrees;
  const set = (nextAround: number, nextAbove: number) => {
    const a = nextAround / degrees;
    const b = nextAbove / degrees;
    const next: Vector = [Math.sin(a) * Math.cos(b), Math.sin(b), Math.cos(a) * Math.cos(b)];
    edit(setLighting({ direction: next }), "light.direction");
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

function LightSection() {
  const lighting: Lighting = scene.value!.render?.lighting ?? {};
  const { enabled = true, direction } = lighting;
  const set = (patch: Partial<Lighting>, what: string | null = null) =>
    edit(setLighting(patch), what && `light.${what}`);
  const fromHere = () => {
    if (!camera.peek()) return;
    const { right, up, forward } = basisOf(camera.peek()!);
    // From over the left shoulder.
    set({
      direction: normalized(
        [0, 1, 2].map((i) => up[i]! - 0.7 * right[i]! - 1.2 * forward[i]!) as Vector,
      ),
    });
  };
  return (
    <Section title="Light">
      <Toggle label="Lighting" checked={enabled} onChange={(on) => set({ enabled: on })} />
      {enabled && (
        <>
          <Toggle
            label="From the camera"
            checked={direction === undefined}
            onChange={(on) => (on ? set({ direction: undefined }) : fromHere())}
          />
          {direction && <DirectionRows direction={direction} />}
          {direction && <Button onClick={fromHere}>From over the shoulder</Button>}
          <Slider
            label="Ambient"
            value={lighting.ambient ?? 0.3}
            min={0}
            max={1}
            onChange={(ambient) => set({ ambient }, "ambient")}
          />
          <Slider
            label="Diffuse"
            value={lighting.diffuse ?? 0.7}
            min={0}
            max={1}
            onChange={(diffuse) => set({ diffuse }, "diffuse")}
          />
          <Slider
            label="Specular"
            value={lighting.specular ?? 0.2}
            min={0}
            max={1}
            onChange={(specular) => set({ specular }, "specular")}
          />
          <Slider
            label="Shininess"
            value={lighting.shininess ?? 32}
            min={1}
            max={256}
            log
            onChange={(shininess) => set({ shininess }, "shininess")}
          />
        </>
      )}
    </Section>
  );
}

function SurfaceSection() {
  const surface = scene.value!.render?.surface ?? {};
  const directed = scene.value!.render?.lighting?.direction !== undefined;
  return (
    <Section title="Balls, sticks and isosurfaces">
      <Slider
        label="Antialiasing, rays a side"
        value={surface.antialiasing ?? 3}
        min={1}
        max={8}
        whole
        hardMax={8}
        onChange={(antialiasing) => edit(setSurface({ antialiasing }), "surface.antialiasing")}
      />
      <Slider
        label="Ambient occlusion, rays"
        value={surface.ambient_occlusion ?? 16}
        min={0}
        max={64}
        whole
        hardMax={4096}
        onChange={(rays) => edit(setSurface({ ambient_occlusion: rays }), "surface.occlusion")}
      />
      <Toggle
        label="Shadows"
        checked={surface.shadows ?? true}
        onChange={(shadows) => edit(setSurface({ shadows }))}
      />
      {(surface.shadows ?? true) && directed && (
        <Slider
          label="Size of the light (°)"
          value={surface.light_angle ?? 3}
          min={0}
          max={30}
          hardMax={90}
          onChange={(angle) => edit(setSurface({ light_angle: angle }), "surface.angle")}
        />
      )}
    </Section>
  );
}

export function LightTab() {
  return (
    <>
      <BackgroundSection />
      <LightSection />
      <SurfaceSection />
    </>
  );
}
