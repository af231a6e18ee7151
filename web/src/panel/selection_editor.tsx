// Which particles: species, an expression, places in the file. All that is given must hold.
import { useId } from "preact/hooks";
import { Row, TextField } from "../controls/fields";
import type { Selection } from "../protocol/scene";
import { data } from "../state/document";

interface SelectionEditorProps {
  selection: Selection | undefined;
  onChange: (selection: Selection | undefined) => void;
}

/** Without keys that say nothing; nothing at all where all particles are selected. */
function tidied(selection: Selection): Selection | undefined {
  const { species, index, expression } = selection;
  const kept: Selection = {};
  if (species && species.length > 0) kept.species = species;
  if (index) kept.index = index;
  if (expression?.trim()) kept.expression = expression.trim();
  return Object.keys(kept).length > 0 ? kept : undefined;
}

function SpeciesChoice({ selection, onChange }: SelectionEditorProps) {
  const all = data.value?.species ?? [];
  if (all.length < 2) return null;
  const chosen = new Set([selection?.species ?? []].flat());
  const toggle = (name: string) => {
    const next = new Set(chosen.size === 0 ? all.map((species) => species.name) : chosen);
    if (!next.delete(name)) next.add(name);
    const species = next.size === all.length ? [] : [...next];
    onChange(tidied({ ...selection, species }));
  };
  return (
    <fieldset class="chips" aria-label="Species">
      {all.map(({ name, color }) => (
        <label key={name}>
          <input
            type="checkbox"
            checked={chosen.size === 0 || chosen.has(name)}
            onChange={() => toggle(name)}
          />
          <span>
            <i class="dot" style={{ background: color }} />
            {name}
          </span>
        </label>
      ))}
    </fieldset>
  );
}

export function SelectionEditor({ selection, onChange }: SelectionEditorProps) {
  const expressionId = useId();
  const indexId = useId();
  const setIndex = (text: string) => {
    const match = /^\s*(\d+)\s*(?:-|–|,|to)\s*(\d+)\s*$/.exec(text);
    const index = match ? ([Number(match[1]), Number(match[2])] as [number, number]) : undefined;
    onChange(tidied({ ...selection, index }));
  };
  return (
    <>
      <SpeciesChoice selection={selection} onChange={onChange} />
      <Row label="Only where" for={expressionId}>
        <TextField
          id={expressionId}
          label="Only particles for which this holds"
          placeholder="z > 3 && charge < 0"
          value={selection?.expression ?? ""}
          onChange={(expression) => onChange(tidied({ ...selection, expression }))}
        />
      </Row>
      <Row label="Only places" for={indexId}>
        <TextField
          id={indexId}
          label="First and last place in the file"
          placeholder="0 – 999"
          value={selection?.index?.join(" – ") ?? ""}
          onChange={setIndex}
        />
      </Row>
    </>
  );
}
