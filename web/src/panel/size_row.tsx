// A radius or weight: a number, or the name of a property of the particles.
import { Select, Slider } from "../controls/fields";
import { data } from "../state/document";

interface SizeRowProps {
  label: string;
  value: number | string;
  /** Names besides the properties'. */
  names: string[];
  /** In the middle of the slider. */
  typical: number;
  signed?: boolean;
  onChange: (value: number | string) => void;
}

const words: Record<string, string> = {
  van_der_waals: "van der Waals radii",
  covalent: "covalent radii",
};

const asNumber = "\u0000";

export function SizeRow({ label, value, names, typical, signed, onChange }: SizeRowProps) {
  const properties = data.value?.properties.map(({ name }) => name) ?? [];
  const known = [...new Set([...names, ...properties])];
  if (typeof value === "string" && !known.includes(value)) known.push(value);
  const choices = [
    { value: asNumber, label: "one for all" },
    ...known.map((name) => ({ value: name, label: words[name] ?? name })),
  ];
  return (
    <div class="size-row">
      <Select
        label={`${label}: from where`}
        value={typeof value === "string" ? value : asNumber}
        choices={choices}
        onChange={(choice) => onChange(choice === asNumber ? typical : choice)}
      />
      {typeof value === "number" ? (
        <Slider
          label={label}
          value={value}
          min={signed ? -2 * typical : typical / 8}
          max={signed ? 2 * typical : typical * 8}
          log={!signed}
          onChange={(next) => (signed || next > 0 ? onChange(next) : undefined)}
        />
      ) : (
        <div class="row-label">{label}</div>
      )}
    </div>
  );
}
