// One field: what is selected, how large and heavy its particles are, and how its values look.
import { useId, useState } from "preact/hooks";
import { IconButton } from "../controls/button";
import { Row, Select, Slider, TextField, Toggle } from "../controls/fields";
import { Icon } from "../controls/icon";
import type { Field } from "../protocol/scene";
import { gradientOf } from "../overlay/color_bars";
import { hasPoints, isVisible, newFieldName, setField, setFields } from "../scene/edit";
import { formatCount } from "../scene/format";
import { withItem, withoutItem } from "../scene/lists";
import { data, edit } from "../state/document";
import { IsosurfaceList } from "./isosurface_list";
import { SelectionEditor } from "./selection_editor";
import { SizeRow } from "./size_row";
import { TransferSection } from "./transfer_section";

interface FieldProps {
  field: Field;
  index: number;
}

function GridRows({ field, index }: FieldProps) {
  const id = useId();
  const grid = typeof field.grid === "string" ? { path: field.grid } : field.grid!;
  return (
    <Row label="Between samples" for={id}>
      <Select
        id={id}
        label="Interpolation"
        value={grid.interpolation ?? "trilinear"}
        choices={[
          { value: "trilinear", label: "trilinear" },
          { value: "tricubic", label: "tricubic" },
          { value: "tricubic_smoothing", label: "tricubic, smoothing" },
        ]}
        onChange={(interpolation) => edit(setField(index, { grid: { ...grid, interpolation } }))}
      />
    </Row>
  );
}

function ParticleRows({ field, index }: FieldProps) {
  const known = data.value?.fields[index];
  return (
    <>
      <SizeRow
        label="Radius"
        value={field.radius ?? known?.default_radius ?? 1}
        names={["van_der_waals", "covalent"]}
        typical={known?.default_radius ?? 1}
        onChange={(radius) => edit(setField(index, { radius }), `field${index}.radius`)}
      />
      <SizeRow
        label="Weight"
        value={field.weight ?? 1}
        names={[]}
        typical={1}
        signed
        onChange={(weight) => edit(setField(index, { weight }), `field${index}.weight`)}
      />
      <Toggle
        label="Normalise kernels"
        checked={field.normalise ?? false}
        onChange={(normalise) => edit(setField(index, { normalise }))}
      />
      <SelectionEditor
        selection={field.select}
        onChange={(select) => edit(setField(index, { select }))}
      />
      <IsosurfaceList field={field} index={index} />
      {field.kernel?.support_factor !== undefined && (
        <Slider
          label="Support of this field"
          value={field.kernel.support_factor}
          min={1}
          max={6}
          onChange={(support_factor) =>
            edit(
              setField(index, { kernel: { ...field.kernel, support_factor } }),
              `field${index}.support`,
            )
          }
        />
      )}
    </>
  );
}

function FieldHead({
  field,
  index,
  open,
  onToggle,
}: FieldProps & { open: boolean; onToggle: () => void }) {
  const name = field.name ?? `field ${index + 1}`;
  const visible = isVisible(field);
  const particles = data.value?.fields[index]?.particles;
  const transfer = field.transfer_function;
  return (
    <div class="section-head">
      <h2>
        <button type="button" aria-expanded={open} onClick={onToggle}>
          <Icon name={open ? "chevronDown" : "chevronRight"} />
          {hasPoints(transfer) && (
            <span class="swatch" style={{ background: gradientOf(transfer, "to right") }} />
          )}
          <span class="field-name">{name}</span>
          {particles !== undefined && particles > 0 && (
            <span class="quiet">{formatCount(particles)}</span>
          )}
        </button>
      </h2>
      <IconButton
        icon={visible ? "eye" : "eyeOff"}
        label={visible ? `Hide ${name}` : `Show ${name}`}
        pressed={!visible}
        onClick={() => edit(setField(index, { visible: !visible }))}
      />
    </div>
  );
}

function FieldFoot({ field, index }: FieldProps) {
  const duplicate = () =>
    edit(
      setFields((old) =>
        withItem(old, index + 1, { ...field, name: newFieldName(old, field.name ?? "field") }),
      ),
    );
  return (
    <div class="field-foot">
      <TextField
        label="Name"
        value={field.name ?? ""}
        onChange={(name) => edit(setField(index, { name }))}
      />
      <IconButton icon="duplicate" label="Duplicate this field" onClick={duplicate} />
      <IconButton
        icon="trash"
        label="Remove this field"
        onClick={() => edit(setFields((old) => withoutItem(old, index)))}
      />
    </div>
  );
}

export function FieldCard({ field, index, open: initiallyOpen }: FieldProps & { open: boolean }) {
  const [open, setOpen] = useState(initiallyOpen);
  return (
    <section class={isVisible(field) ? "section" : "section hidden-field"}>
      <FieldHead field={field} index={index} open={open} onToggle={() => setOpen(!open)} />
      {open && (
        <div class="section-body">
          <TransferSection field={field} index={index} />
          {field.grid ? (
            <GridRows field={field} index={index} />
          ) : (
            <ParticleRows field={field} index={index} />
          )}
          <FieldFoot field={field} index={index} />
        </div>
      )}
    </section>
  );
}
