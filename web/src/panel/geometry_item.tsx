// Balls or sticks: of which particles, how large, in what colour.
import { IconButton } from "../controls/button";
import { ColorField, Select, SelectRow, Slider } from "../controls/fields";
import type { Color, ColorByProperty, Geometry } from "../protocol/scene";
import { setGeometry } from "../scene/edit";
import { replaced } from "../scene/lists";
import { data, edit } from "../state/document";
import { colorMaps } from "../state/session";
import { SelectionEditor } from "./selection_editor";
import { SizeRow } from "./size_row";

const named = ["element", "species", "field"];
const bondSources = ["automatic", "file", "distance"].map((value) => ({ value, label: value }));

type Change = (patch: Partial<Geometry> | null, what?: string | null) => void;

function isByProperty(color: Geometry["color"]): color is ColorByProperty {
  return typeof color === "object" && !Array.isArray(color);
}

function ColorRow({ item, change }: { item: Geometry; change: Change }) {
  const color = item.color ?? "element";
  const byProperty = isByProperty(color);
  const kind = byProperty
    ? `property ${color.property}`
    : typeof color === "string" && named.includes(color)
      ? color
      : "one";
  const ofData = data.value?.properties.map(({ name }) => name) ?? [];
  const properties = [...new Set(["x", "y", "z", ...ofData])];
  const choices = [
    { value: "element", label: "by element" },
    { value: "species", label: "by species" },
    { value: "field", label: "as the field" },
    { value: "one", label: "one colour" },
    ...properties.map((name) => ({ value: `property ${name}`, label: `by ${name}` })),
  ];
  const choose = (choice: string) => {
    if (choice === "one") change({ color: "#c0c0c0" });
    else if (named.includes(choice)) change({ color: choice });
    else change({ color: { property: choice.slice("property ".length), map: "viridis" } });
  };
  return (
    <div class="row">
      <span class="row-label">Colour</span>
      <div class="row-control">
        <Select label="Colour" value={kind} choices={choices} onChange={choose} />
        {kind === "one" && (
          <ColorField
            label="Colour of all"
            value={color as Color}
            onChange={(next) => change({ color: next }, "color")}
          />
        )}
        {byProperty && (
          <Select
            label="Colour map"
            value={color.map ?? "viridis"}
            choices={Object.keys(colorMaps.value).map((value) => ({ value, label: value }))}
            onChange={(map) => change({ color: { ...color, map } })}
          />
        )}
      </div>
    </div>
  );
}

export function GeometryItem({ item, index }: { item: Geometry; index: number }) {
  const change: Change = (patch, what = null) =>
    edit(
      setGeometry((items) => replaced(items, index, patch)),
      what && `geometry${index}.${what}`,
    );
  const balls = item.type === "spheres";
  return (
    <li class="item">
      <div class="item-head">
        <h3>{balls ? "Balls" : "Sticks"}</h3>
        <IconButton
          icon="trash"
          label={balls ? "Remove these balls" : "Remove the sticks"}
          onClick={() => change(null)}
        />
      </div>
      {balls ? (
        <>
          <SizeRow
            label="Radius"
            value={item.radius ?? "van_der_waals"}
            names={["van_der_waals", "covalent"]}
            typical={1}
            onChange={(radius) => change({ radius }, "radius")}
          />
          <Slider
            label="Scale"
            value={item.scale ?? 1}
            min={0.05}
            max={2}
            log
            onChange={(scale) => scale > 0 && change({ scale }, "scale")}
          />
        </>
      ) : (
        <>
          <Slider
            label="Radius"
            value={typeof item.radius === "number" ? item.radius : 0.15}
            min={0.02}
            max={1}
            log
            onChange={(radius) => radius > 0 && change({ radius }, "radius")}
          />
          <SelectRow
            label="Bonds"
            value={item.bonds ?? "automatic"}
            choices={bondSources}
            onChange={(bonds) => change({ bonds })}
          />
        </>
      )}
      <ColorRow item={item} change={change} />
      <SelectionEditor selection={item.select} onChange={(select) => change({ select })} />
    </li>
  );
}
