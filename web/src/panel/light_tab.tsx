// Background, light, and how surfaces are lit.
import { useId } from "preact/hooks";
import { Button } from "../controls/button";
import { ColorField, Row, Slider, Toggle } from "../controls/fields";
import { Section } from "../controls/section";
import { type Lighting, maxLights } from "../protocol/scene";
import { lightsOf, setLighting, setLights, setRender, setSurface } from "../scene/edit";
import { edit, scene } from "../state/document";
import { LightItem, overTheShoulder } from "./light_item";

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

function LightSection() {
  const lighting: Lighting = scene.value!.render?.lighting ?? {};
  const { enabled = true } = lighting;
  const lights = lightsOf(lighting);
  const set = (patch: Partial<Lighting>, what: string | null = null) =>
    edit(setLighting(patch), what && `light.${what}`);
  return (
    <Section title="Light">
      <Toggle label="Lighting" checked={enabled} onChange={(on) => set({ enabled: on })} />
      {enabled && (
        <>
          {lights.length === 0 && <p class="quiet">Ambient light only.</p>}
          <ul class="items">
            {lights.map((light, index) => (
              <LightItem key={index} light={light} index={index} />
            ))}
          </ul>
          <div class="buttons">
            <Button
              icon="add"
              disabled={lights.length >= maxLights}
              onClick={() =>
                edit(
                  setLights((old) => [
                    ...old,
                    { direction: overTheShoulder() ?? [1, 2, 1.5], intensity: 0.5 },
                  ]),
                )
              }
            >
              Another light
            </Button>
          </div>
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
  const lights = lightsOf(scene.value!.render?.lighting ?? {});
  const directed = lights.some(({ direction }) => direction);
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
          label="Size of lights (°)"
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
