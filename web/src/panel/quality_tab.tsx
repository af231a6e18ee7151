// Kernel, sampling, and the camera's lens.
import { withFov } from "../camera/camera";
import { Button } from "../controls/button";
import { SelectRow, Slider, Toggle } from "../controls/fields";
import { Section } from "../controls/section";
import { setKernel, setRender } from "../scene/edit";
import { data, edit, scene } from "../state/document";
import { hello } from "../state/session";
import { toggleProjection } from "../state/shortcuts";
import { camera, changeCamera } from "../state/view";

const kernels = [
  { value: "gaussian", label: "Gaussian" },
  { value: "cubic_spline", label: "cubic spline (M4)" },
  { value: "quintic_spline", label: "quintic spline (M6)" },
  { value: "wendland_c2", label: "Wendland C2" },
  { value: "wendland_c4", label: "Wendland C4" },
  { value: "wendland_c6", label: "Wendland C6" },
];

function KernelSection() {
  const kernel = scene.value!.kernel ?? {};
  const type = kernel.type ?? "gaussian";
  const choices = kernels.some(({ value }) => value === type)
    ? kernels
    : [...kernels, { value: type, label: type }];
  return (
    <Section title="Kernel">
      <SelectRow
        label="Kernel"
        value={type}
        choices={choices}
        onChange={(next) => edit(setKernel({ type: next }))}
      />
      {type === "gaussian" && (
        <Slider
          label="Support factor σ"
          value={kernel.support_factor ?? 2}
          min={1}
          max={5}
          onChange={(value) =>
            value > 0 && edit(setKernel({ support_factor: value }), "kernel.support")
          }
        />
      )}
      <Slider
        label="Kernel scale κ"
        value={kernel.kernel_scale ?? 1}
        min={0.1}
        max={10}
        log
        onChange={(value) => value > 0 && edit(setKernel({ kernel_scale: value }), "kernel.scale")}
      />
    </Section>
  );
}

function SamplingSection() {
  const render = scene.value!.render ?? {};
  const step = render.step_size ?? 1;
  const radius = data.value?.fields.find((field) => field.default_radius)?.default_radius;
  // The usual step is half of a small radius.
  const typical = radius ? radius / 2 : step;
  return (
    <Section title="Sampling">
      <Slider
        label="Step size"
        value={step}
        min={typical / 8}
        max={typical * 8}
        log
        onChange={(value) => value > 0 && edit(setRender({ step_size: value }), "step")}
      />
      <Slider
        label="Termination opacity"
        value={render.termination_opacity ?? 0.97}
        min={0.5}
        max={1}
        hardMax={1}
        onChange={(value) => edit(setRender({ termination_opacity: value }), "termination")}
      />
      <SelectRow
        label="Engine"
        value={render.engine ?? "sweep"}
        choices={(hello.value?.engines ?? []).map((value) => ({ value, label: value }))}
        onChange={(engine) => edit(setRender({ engine }))}
      />
      <Button
        onClick={() =>
          edit(
            setRender({ step_size: undefined, termination_opacity: undefined, engine: undefined }),
          )
        }
      >
        As usual
      </Button>
    </Section>
  );
}

function LensSection() {
  const view = camera.value;
  if (!view) return null;
  return (
    <Section title="Lens">
      <Toggle
        label="Parallel projection"
        checked={view.orthographic !== undefined}
        onChange={toggleProjection}
      />
      {view.orthographic === undefined && (
        <Slider
          label="Field of view (°)"
          value={view.fov ?? 45}
          min={5}
          max={120}
          hardMax={170}
          onChange={(fov) => fov > 0 && changeCamera((old) => withFov(old, fov))}
        />
      )}
    </Section>
  );
}

export function QualityTab() {
  return (
    <>
      <SamplingSection />
      <KernelSection />
      <LensSection />
    </>
  );
}
