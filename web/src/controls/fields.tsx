// Rows of a panel: a label and what changes the value.
import type { ComponentChildren } from "preact";
import { useId, useState } from "preact/hooks";
import { hexOf } from "../scene/color";
import { formatNumber } from "../scene/format";
import type { Color } from "../protocol/scene";
import { NumberField, type NumberFieldProps } from "./number_field";

export function Row({
  label,
  for: id,
  children,
}: {
  label: string;
  for?: string;
  children: ComponentChildren;
}) {
  return (
    <div class="row">
      <label class="row-label" for={id}>
        {label}
      </label>
      <div class="row-control">{children}</div>
    </div>
  );
}

export function NumberRow(props: NumberFieldProps & { unit?: string }) {
  const id = useId();
  return (
    <Row label={props.label} for={id}>
      <NumberField {...props} id={id} />
      {props.unit && <span class="unit">{props.unit}</span>}
    </Row>
  );
}

interface TrackProps {
  label: string;
  value: number;
  min: number;
  max: number;
  /** Equal ways are equal factors. */
  log?: boolean;
  whole?: boolean;
  onChange: (value: number) => void;
  id?: string;
}

const trackSteps = 400;

/** The usual values of a number, to be slid over. */
export function SliderTrack({ label, value, min, max, log, whole, onChange, id }: TrackProps) {
  const steps = whole ? max - min : trackSteps;
  const place = log ? Math.log(value / min) / Math.log(max / min) : (value - min) / (max - min);
  const filled = Math.min(1, Math.max(0, place || 0));
  const slide = (t: number) => {
    const exact = log ? min * (max / min) ** t : min + t * (max - min);
    onChange(whole ? Math.round(exact) : Number(exact.toPrecision(3)));
  };
  return (
    <input
      id={id}
      type="range"
      aria-label={label}
      min={0}
      max={steps}
      step={1}
      value={filled * steps}
      style={{ "--filled": `${100 * filled}%` }}
      aria-valuetext={formatNumber(value)}
      onInput={(event) => slide(Number(event.currentTarget.value) / steps)}
    />
  );
}

interface SliderProps extends TrackProps {
  /** The number beside the slider takes more than the usual values. */
  hardMin?: number;
  hardMax?: number;
}

export function Slider({ hardMin, hardMax, ...track }: SliderProps) {
  const id = useId();
  return (
    <div class="slider-row">
      <label class="row-label" for={id}>
        {track.label}
      </label>
      <NumberField {...track} min={hardMin} max={hardMax} />
      <SliderTrack {...track} id={id} />
    </div>
  );
}

export function Toggle({
  label,
  checked,
  onChange,
}: {
  label: string;
  checked: boolean;
  onChange: (checked: boolean) => void;
}) {
  return (
    <label class="row toggle">
      <span class="row-label">{label}</span>
      <input
        type="checkbox"
        role="switch"
        checked={checked}
        onChange={(event) => onChange(event.currentTarget.checked)}
      />
    </label>
  );
}

export interface Choice {
  value: string;
  label: string;
}

export function Select({
  label,
  value,
  choices,
  onChange,
  id,
}: {
  label: string;
  value: string;
  choices: Choice[];
  onChange: (value: string) => void;
  id?: string;
}) {
  return (
    <select
      id={id}
      aria-label={label}
      value={value}
      onChange={(event) => onChange(event.currentTarget.value)}
    >
      {choices.map((choice) => (
        <option key={choice.value} value={choice.value}>
          {choice.label}
        </option>
      ))}
    </select>
  );
}

export function SelectRow(props: {
  label: string;
  value: string;
  choices: Choice[];
  onChange: (value: string) => void;
}) {
  const id = useId();
  return (
    <Row label={props.label} for={id}>
      <Select {...props} id={id} />
    </Row>
  );
}

export function ColorField({
  label,
  value,
  onChange,
  id,
}: {
  label: string;
  value: Color;
  onChange: (value: string) => void;
  id?: string;
}) {
  return (
    <input
      id={id}
      class="color"
      type="color"
      aria-label={label}
      title={label}
      value={hexOf(value)}
      onInput={(event) => onChange(event.currentTarget.value)}
    />
  );
}

/** Text that is taken with Enter or on leaving. */
export function TextField({
  label,
  value,
  placeholder,
  onChange,
  id,
}: {
  label: string;
  value: string;
  placeholder?: string;
  onChange: (value: string) => void;
  id?: string;
}) {
  const [text, setText] = useState<string | null>(null);
  const commit = () => {
    if (text !== null && text !== value) onChange(text);
    setText(null);
  };
  return (
    <input
      id={id}
      class="text"
      type="text"
      autocomplete="off"
      spellcheck={false}
      aria-label={label}
      placeholder={placeholder}
      value={text ?? value}
      onInput={(event) => setText(event.currentTarget.value)}
      onBlur={commit}
      onKeyDown={(event) => {
        if (event.key === "Enter") commit();
        if (event.key === "Escape") setText(null);
      }}
    />
  );
}

/** A few choices side by side, of which one holds. */
export function Segments({
  label,
  value,
  choices,
  onChange,
}: {
  label: string;
  value: string;
  choices: Choice[];
  onChange: (value: string) => void;
}) {
  const name = useId();
  return (
    <fieldset class="segments" aria-label={label}>
      {choices.map((choice) => (
        <label key={choice.value}>
          <input
            type="radio"
            name={name}
            checked={choice.value === value}
            onChange={() => onChange(choice.value)}
          />
          <span>{choice.label}</span>
        </label>
      ))}
    </fieldset>
  );
}
