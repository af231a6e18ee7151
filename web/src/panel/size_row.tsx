// A radius or weight: a number, or the name of a property of the particles.
import { NumberField } from "../controls/number_field";
import { Select, SliderTrack } from "../controls/fields";
import { data } from "../state/document";

interface SizeRowProps {
  label: string;
  value: number | string;
  /** Names besides the properties'. */
  names: string[];
  /** In the middle of the slider. */
  typical: number;
  /** Whether it may be 0 or less. */
  signed?: boolean;
  onChange: (value: number | string) => void;
}

const words: Record<string, string> = {
  van_der_waals: "van der Waals radii",
  covalent: "covalent radii",
};

// No property has this name.
const oneForAll = "\u0000";

export function SizeRow({ label, value, names, typical, signed, onChange }: SizeRowProps) {
  const properties = data.value?.properties.map(({ name }) => name) ?? [];
  const known = [...new Set([...names, ...properties])];
  if (typeof value === "string" && !known.includes(value)) known.push(value);
  const choices = [
    { value: oneForAll, label: "one for all" },
    ...known.map((name) => ({ value: name, label: words[name] ?? name })),
  ];
  const setNumber = (next: number) => {
    if (signed || next > 0) onChange(next);
  };
  const range = signed
    ? { min: -2 * typical, max: 2 * typical }
    : { min: typical / 8, max: 8 * typical, log: true };
  return (
    <div class="size-row">
      <div class="row">
        <span class="row-label">{label}</span>
        <Select
          label={`${label}: from where`}
          value={typeof value === "string" ? value : oneForAll}
          choices={choices}
          onChange={(choice) => onChange(choice === oneForAll ? typical : choice)}
        />
        {typeof value === "number" && (
          <NumberField label={label} value={value} onChange={setNumber} />
        )}
      </div>
      {typeof value === "number" && (
        <SliderTrack label={label} value={value} {...range} onChange={setNumber} />
      )}
    </div>
  );
}
