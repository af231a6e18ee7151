// A number as text: taken with Enter or on leaving; arrow keys change it by a tenth of its size.
import { useState } from "preact/hooks";
import { formatNumber } from "../scene/format";

export interface NumberFieldProps {
  label: string;
  value: number;
  min?: number;
  max?: number;
  whole?: boolean;
  onChange: (value: number) => void;
  id?: string;
}

function stepFor(value: number, whole: boolean | undefined): number {
  if (whole) return 1;
  const size = Math.abs(value) || 1;
  return 10 ** Math.floor(Math.log10(size) - 0.5);
}

export function NumberField(props: NumberFieldProps) {
  const { label, value, min = -Infinity, max = Infinity, whole, onChange } = props;
  const [text, setText] = useState<string | null>(null);

  const take = (wanted: number) => {
    if (!Number.isFinite(wanted)) return;
    const kept = Math.min(max, Math.max(min, whole ? Math.round(wanted) : wanted));
    if (kept !== value) onChange(kept);
  };
  const commit = () => {
    if (text !== null && text.trim() !== "") take(Number(text.replace(",", ".")));
    setText(null);
  };
  const onKeyDown = (event: KeyboardEvent) => {
    const direction = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (event.key === "Enter") commit();
    else if (event.key === "Escape") setText(null);
    else if (direction) {
      take(Number((value + direction * stepFor(value, whole)).toPrecision(6)));
      setText(null);
      event.preventDefault();
    }
  };

  const shown = text ?? formatNumber(value);
  return (
    <input
      class="number"
      style={{ "--characters": shown.length }}
      id={props.id}
      type="text"
      inputMode="decimal"
      autocomplete="off"
      spellcheck={false}
      aria-label={label}
      value={shown}
      onInput={(event) => setText(event.currentTarget.value)}
      onFocus={(event) => event.currentTarget.select()}
      onBlur={commit}
      onKeyDown={onKeyDown}
    />
  );
}
