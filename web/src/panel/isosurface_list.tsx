// Surfaces on which a field takes a value.
import { IconButton } from "../controls/button";
import { ColorField, Select, Slider } from "../controls/fields";
import type { Color, Field, Isosurface } from "../protocol/scene";
import { hasPoints, setField } from "../scene/edit";
import { replaced } from "../scene/lists";
import { sample } from "../scene/transfer_function";
import { data, edit } from "../state/document";
import { histograms } from "../state/measurements";

interface Props {
  field: Field;
  index: number;
}

const byParticles = ["element", "species"];

function colorAt(field: Field, value: number): Color {
  return hasPoints(field.transfer_function)
    ? sample(field.transfer_function, value).color
    : (data.value?.species[0]?.color ?? "#c0c0c0");
}

function Level({
  field,
  index,
  level,
  place,
  greatest,
}: Props & {
  level: Isosurface;
  place: number;
  greatest: number;
}) {
  const change = (patch: Partial<Isosurface> | null, what: string | null = null) =>
    edit(
      setField(index, { isosurfaces: replaced(field.isosurfaces!, place, patch) }),
      what && `field${index}.isosurface${place}.${what}`,
    );
  const color = level.color ?? colorAt(field, level.value);
  const named = typeof color === "string" && byParticles.includes(color);
  return (
    <li class="item">
      <div class="item-head">
        <Select
          label="Colour of the isosurface"
          value={named ? (color as string) : "one"}
          choices={[
            { value: "one", label: "one colour" },
            { value: "element", label: "by element" },
            { value: "species", label: "by species" },
          ]}
          onChange={(choice) =>
            change({ color: choice === "one" ? colorAt(field, level.value) : choice })
          }
        />
        {!named && (
          <ColorField
            label="Colour"
            value={color}
            onChange={(next) => change({ color: next }, "color")}
          />
        )}
        <IconButton icon="trash" label="Remove this isosurface" onClick={() => change(null)} />
      </div>
      <Slider
        label="Value"
        value={level.value}
        min={0}
        max={greatest}
        onChange={(value) => change({ value }, "value")}
      />
      <Slider
        label="Opacity"
        value={level.opacity ?? 1}
        min={0}
        max={1}
        hardMax={1}
        onChange={(opacity) => change({ opacity }, "opacity")}
      />
    </li>
  );
}

export function IsosurfaceList({ field, index }: Props) {
  const levels = field.isosurfaces ?? [];
  const seen = histograms.value.find(({ name }) => name === field.name);
  const greatest = Math.max(seen?.max ?? 1, ...levels.map(({ value }) => value));
  const add = () => {
    const value = Number((greatest / 2).toPrecision(2));
    edit(setField(index, { isosurfaces: [...levels, { value, opacity: 1 }] }));
  };
  return (
    <>
      <div class="subhead">
        <h3>Isosurfaces</h3>
        <IconButton icon="add" label="Add an isosurface" onClick={add} />
      </div>
      {levels.length > 0 && (
        <ul class="items">
          {levels.map((level, place) => (
            <Level key={place} {...{ field, index, level, place, greatest }} />
          ))}
        </ul>
      )}
    </>
  );
}
