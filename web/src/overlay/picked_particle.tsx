// The particle that was picked: a ring around it, and what is known of it.
import { lookAt, project } from "../camera/camera";
import { Button, IconButton } from "../controls/button";
import { formatNumber, unitSign } from "../scene/format";
import { data } from "../state/document";
import { picked } from "../state/measurements";
import { camera, glideTo, size } from "../state/view";

export function PickedMarker() {
  const hit = picked.value;
  const place = hit && camera.value && project(camera.value, hit.position);
  if (!place) return null;
  const height = size.value.height / devicePixelRatio;
  return (
    <div
      class="picked-marker"
      aria-hidden="true"
      style={{
        left: `calc(50% + ${place.x * height}px)`,
        top: `calc(50% - ${place.y * height}px)`,
      }}
    />
  );
}

function Rows({ values }: { values: Record<string, number> }) {
  return (
    <>
      {Object.entries(values).map(([name, value]) => (
        <div key={name}>
          <dt>{name}</dt>
          <dd>{formatNumber(value)}</dd>
        </div>
      ))}
    </>
  );
}

export function PickedCard() {
  const hit = picked.value;
  if (!hit) return null;
  const unit = unitSign(data.value?.length_unit ?? "");
  const color = data.value?.species.find(({ name }) => name === hit.species)?.color;
  const show = () => camera.peek() && glideTo(lookAt(camera.peek()!, hit.position));
  return (
    <section class="card picked" aria-label="Picked particle" aria-live="polite">
      <header>
        {color && <span class="dot" style={{ background: color }} />}
        <h2>
          {hit.species || "Particle"}{" "}
          <span class="quiet">{hit.id === null ? `place ${hit.index}` : `id ${hit.id}`}</span>
        </h2>
        <IconButton icon="close" label="Close" onClick={() => (picked.value = null)} />
      </header>
      <dl>
        <div>
          <dt>position{unit && ` (${unit})`}</dt>
          <dd>{hit.position.map(formatNumber).join(", ")}</dd>
        </div>
        <Rows values={hit.properties} />
      </dl>
      {Object.keys(hit.values).length > 0 && (
        <>
          <h3>Fields there</h3>
          <dl>
            <Rows values={hit.values} />
          </dl>
        </>
      )}
      <Button icon="fit" onClick={show}>
        Centre
      </Button>
    </section>
  );
}
