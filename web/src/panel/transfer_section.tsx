// A field's transfer function: the editor, the point that is chosen, and what changes all of it.
import { useState } from "preact/hooks";
import { Button, IconButton } from "../controls/button";
import { ColorField, Slider, Toggle } from "../controls/fields";
import { Icon } from "../controls/icon";
import { Menu, MenuItem } from "../controls/menu";
import { NumberField } from "../controls/number_field";
import type { Field, TransferFunction } from "../protocol/scene";
import { gradientOf } from "../overlay/color_bars";
import { hasPoints, setField } from "../scene/edit";
import {
  addPoint,
  extentOf,
  greatestExtinction,
  movePoint,
  recolorPoint,
  removePoint,
  scaleOf,
  widestGap,
  withColorMap,
  withGreatestExtinction,
  withRange,
  withScale,
} from "../scene/transfer_function";
import { data, edit } from "../state/document";
import { histograms } from "../state/measurements";
import { colorMaps } from "../state/session";
import { TransferEditor, axisFor } from "./transfer_editor";

interface EditProps {
  transfer: TransferFunction;
  onChange: (transfer: TransferFunction, what: string | null) => void;
}

function PointRow({
  transfer,
  selected,
  onChange,
  onSelect,
}: EditProps & {
  selected: number;
  onSelect: (index: number) => void;
}) {
  const point = transfer.points[selected]!;
  const axis = axisFor(transfer, undefined);
  const move = (to: Partial<{ value: number; extinction: number }>) =>
    onChange(movePoint(transfer, selected, { ...point, ...to }, axis), "point");
  const add = () => {
    const added = addPoint(transfer, widestGap(transfer, extentOf(transfer)), axis);
    if (!added) return;
    onChange(added.transfer, null);
    onSelect(added.index);
  };
  const remove = () => {
    onChange(removePoint(transfer, selected), null);
    onSelect(Math.max(0, selected - 1));
  };
  return (
    <div class="point-row">
      <ColorField
        label="Colour of the point"
        value={point.color}
        onChange={(color) => onChange(recolorPoint(transfer, selected, color), `color${selected}`)}
      />
      <label>
        Value
        <NumberField
          label="Value of the point"
          value={point.value}
          onChange={(value) => move({ value })}
        />
      </label>
      <label>
        Extinction
        <NumberField
          label="Extinction of the point"
          value={point.extinction}
          min={0}
          onChange={(extinction) => move({ extinction })}
        />
      </label>
      <IconButton icon="add" label="Add a point" onClick={add} />
      <IconButton
        icon="trash"
        label="Remove the point"
        disabled={transfer.points.length === 1}
        onClick={remove}
      />
    </div>
  );
}

function MapMenu({ transfer, onChange, onFit }: EditProps & { onFit: (map: string) => void }) {
  return (
    <Menu
      class="map-menu"
      label="Colours"
      face={
        <>
          <span class="swatch" style={{ background: gradientOf(transfer, "to right") }} /> Colours
          <Icon name="chevronDown" />
        </>
      }
    >
      {Object.entries(colorMaps.value).map(([name, colors]) => (
        <MenuItem
          key={name}
          label={name}
          onClick={() => onChange(withColorMap(transfer, colors), null)}
        >
          <span
            class="swatch"
            style={{ background: `linear-gradient(to right, ${colors.join()})` }}
          />
        </MenuItem>
      ))}
      <hr />
      <MenuItem label="viridis, fitted to the view" onClick={() => onFit("viridis")} />
    </Menu>
  );
}

function WholeRows({ transfer, onChange, leastPositive }: EditProps & { leastPositive: number }) {
  const { min, max } = extentOf(transfer);
  const greatest = greatestExtinction(transfer);
  const least = scaleOf(transfer) === "log" ? 0 : -Infinity;
  // In the middle of the slider is what makes the data's size about opaque.
  const bounds = data.value?.bounds;
  const size = bounds ? Math.max(...bounds.max.map((high, i) => high - bounds.min[i]!)) || 1 : 1;
  return (
    <>
      <Slider
        label="Peak extinction"
        value={greatest}
        min={0.1 / size}
        max={1000 / size}
        log
        onChange={(value) =>
          value >= 0 && onChange(withGreatestExtinction(transfer, value), "peak")
        }
      />
      <div class="row">
        <span class="row-label">Range</span>
        <div class="row-control">
          <NumberField
            label="Lowest value"
            value={min}
            onChange={(low) =>
              low < max && low > least && onChange(withRange(transfer, low, max), "range")
            }
          />
          <span class="quiet">to</span>
          <NumberField
            label="Highest value"
            value={max}
            onChange={(high) => high > min && onChange(withRange(transfer, min, high), "range")}
          />
        </div>
      </div>
      <Toggle
        label="Logarithmic scale"
        checked={scaleOf(transfer) === "log"}
        onChange={(log) =>
          onChange(withScale(transfer, log ? "log" : "linear", leastPositive), null)
        }
      />
    </>
  );
}

export function TransferSection({ field, index }: { field: Field; index: number }) {
  const [selected, setSelected] = useState(0);
  const [close, setClose] = useState(false);
  const transfer = field.transfer_function;
  const fitAnew = (name: string) => edit(setField(index, { transfer_function: { name } }));
  if (!hasPoints(transfer)) {
    return (
      <div class="row">
        <span class="quiet">{transfer ? "Fitting…" : "No volume is drawn."}</span>
        {!transfer && <Button onClick={() => fitAnew("viridis")}>Draw the volume</Button>}
      </div>
    );
  }
  const histogram = histograms.value.find(({ name }) => name === field.name);
  const onChange = (next: TransferFunction, what: string | null) =>
    edit(setField(index, { transfer_function: next }), what && `field${index}.transfer.${what}`);
  const chosen = Math.min(selected, transfer.points.length - 1);
  const edits = { transfer, onChange };
  const highest = transfer.points.at(-1)!.value;
  const leastPositive = Math.max(
    histogram?.positive_min ?? highest * 1e-3,
    highest > 0 ? highest * 1e-6 : 1e-6,
  );
  return (
    <div class="transfer">
      <TransferEditor
        {...edits}
        {...{ histogram, close }}
        selected={chosen}
        onSelect={setSelected}
      />
      <PointRow {...edits} selected={chosen} onSelect={setSelected} />
      <div class="row">
        <MapMenu {...edits} onFit={fitAnew} />
        <IconButton
          icon="zoom"
          label="Close to the points"
          pressed={close}
          onClick={() => setClose(!close)}
        />
      </div>
      <WholeRows {...edits} leastPositive={leastPositive} />
    </div>
  );
}
