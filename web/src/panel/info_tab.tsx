// What the file holds, who else is looking, and statistics.
import { Button } from "../controls/button";
import { Row, TextField, Toggle } from "../controls/fields";
import { Section } from "../controls/section";
import { formatCount, formatNumber, unitSign } from "../scene/format";
import { data, edit, scene } from "../state/document";
import { showStatistics } from "../state/preferences";
import { clients, follow, following, hello } from "../state/session";
import type { Data } from "../protocol/messages";

function FileSection({ shown }: { shown: Data }) {
  const unit = unitSign(shown.length_unit);
  const size = shown.bounds.max.map((high, i) => formatNumber(high - shown.bounds.min[i]!));
  const rows: [string, string][] = [
    ["File", shown.file],
    ["Format", shown.format],
    ["Particles", formatCount(shown.particles)],
    ["Extent", `${size.join(" × ")} ${unit}`.trim()],
  ];
  if (shown.frames !== null && shown.frames > 1) rows.push(["Time steps", String(shown.frames)]);
  if (shown.time !== null) rows.push(["Time", formatNumber(shown.time)]);
  for (const grid of shown.grids) rows.push([`Grid ${grid.name}`, grid.size.join(" × ")]);
  return (
    <Section title="Data">
      <dl class="facts">
        {rows.map(([name, value]) => (
          <div key={name}>
            <dt>{name}</dt>
            <dd>{value}</dd>
          </div>
        ))}
      </dl>
    </Section>
  );
}

/** Files of LAMMPS number their types: names for them bring radii and colours of elements. */
function TypeNames({ shown }: { shown: Data }) {
  const types = scene.value?.data?.types ?? {};
  const numbered =
    Object.keys(types).length > 0
      ? Object.keys(types)
      : shown.species.map(({ name }) => name).filter((name) => /^\d+$/.test(name));
  if (numbered.length === 0) return null;
  const set = (type: string, name: string) =>
    edit((old) => {
      const { [type]: _, ...others } = old.data?.types ?? {};
      const next = name.trim() ? { ...others, [type]: name.trim() } : others;
      return { ...old, data: { ...old.data!, types: next } };
    });
  return (
    <Section title="Names of types">
      {numbered.map((type) => (
        <Row key={type} label={`Type ${type}`}>
          <TextField
            label={`Element or name of type ${type}`}
            placeholder="element, such as Si"
            value={types[type] ?? ""}
            onChange={(name) => set(type, name)}
          />
        </Row>
      ))}
    </Section>
  );
}

function SpeciesSection({ shown }: { shown: Data }) {
  return (
    <Section title="Species">
      <dl class="facts">
        {shown.species.map(({ name, count, color }) => (
          <div key={name}>
            <dt>
              <span class="dot" style={{ background: color }} /> {name}
            </dt>
            <dd>{formatCount(count)}</dd>
          </div>
        ))}
      </dl>
    </Section>
  );
}

function PropertySection({ shown }: { shown: Data }) {
  return (
    <Section title="Properties" closed>
      <dl class="facts">
        {shown.properties.map(({ name, min, max }) => (
          <div key={name}>
            <dt>{name}</dt>
            <dd>
              {formatNumber(min)} … {formatNumber(max)}
            </dd>
          </div>
        ))}
      </dl>
    </Section>
  );
}

function ViewersSection() {
  const own = hello.value?.client;
  return (
    <Section title="Viewers">
      <ul class="viewers">
        {clients.value.map(({ client, following: followed }) => (
          <li key={client}>
            <span>
              Viewer {client}
              {client === own && " (you)"}
              {followed !== null && <span class="quiet"> follows {followed}</span>}
            </span>
            {client !== own && (
              <Button onClick={() => follow(following.value === client ? null : client)}>
                {following.value === client ? "Stop" : "Follow"}
              </Button>
            )}
          </li>
        ))}
      </ul>
    </Section>
  );
}

export function InfoTab() {
  const shown = data.value;
  if (!shown) return null;
  return (
    <>
      <FileSection shown={shown} />
      <TypeNames shown={shown} />
      {shown.species.length > 0 && <SpeciesSection shown={shown} />}
      {shown.properties.length > 0 && <PropertySection shown={shown} />}
      <ViewersSection />
      <Section title="Statistics">
        <Toggle
          label="Show over the picture"
          checked={showStatistics.value}
          onChange={(on) => (showStatistics.value = on)}
        />
      </Section>
    </>
  );
}
