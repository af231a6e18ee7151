// The colours of the fields' values.
import type { TransferFunction } from "../protocol/scene";
import { hexOf } from "../scene/color";
import { hasPoints, isVisible } from "../scene/edit";
import { formatNumber, logTicks, ticks } from "../scene/format";
import { extentOf, positionOf, sample, valueAt } from "../scene/transfer_function";
import { scene } from "../state/document";

const mostBars = 4;
const stops = 24;

/** For CSS: colours along a transfer function's range. */
export function gradientOf(transfer: TransferFunction, direction: string): string {
  const axis = extentOf(transfer);
  const colors = Array.from({ length: stops + 1 }, (_, i) =>
    hexOf(sample(transfer, valueAt(i / stops, axis)).color),
  );
  return `linear-gradient(${direction}, ${colors.join(", ")})`;
}

function ColorBar({ name, transfer }: { name: string; transfer: TransferFunction }) {
  const axis = extentOf(transfer);
  if (!(axis.min < axis.max)) return null;
  const marks = axis.scale === "log" ? logTicks(axis.min, axis.max) : ticks(axis.min, axis.max, 5);
  const range = `${formatNumber(axis.min)} to ${formatNumber(axis.max)}`;
  return (
    <div class="color-bar" role="img" aria-label={`Colours of ${name}, ${range}`}>
      <div class="color-bar-name">{name}</div>
      <div class="color-bar-body">
        <div class="color-bar-colors" style={{ background: gradientOf(transfer, "to top") }} />
        <div class="color-bar-ticks">
          {marks.map((value) => (
            <span key={value} style={{ bottom: `${100 * positionOf(value, axis)}%` }}>
              {formatNumber(value)}
            </span>
          ))}
        </div>
      </div>
    </div>
  );
}

export function ColorBars() {
  const bars = (scene.value?.fields ?? []).flatMap((field, i) =>
    isVisible(field) && hasPoints(field.transfer_function)
      ? [{ name: field.name ?? `field ${i + 1}`, transfer: field.transfer_function }]
      : [],
  );
  return (
    <div class="color-bars">
      {bars.slice(0, mostBars).map((bar) => (
        <ColorBar key={bar.name} {...bar} />
      ))}
    </div>
  );
}
