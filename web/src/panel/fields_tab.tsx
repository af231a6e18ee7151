// Styles, and the fields with their transfer functions.
import { Button } from "../controls/button";
import { Icon, type IconName } from "../controls/icon";
import { newFieldName, setFields, styleOf, withStyle } from "../scene/edit";
import { data, edit, pastScenes, scene } from "../state/document";
import { hello } from "../state/session";
import { FieldCard } from "./field_card";

const looks: Record<string, { label: string; icon: IconName }> = {
  volume: { label: "Volume", icon: "volume" },
  spheres: { label: "Balls", icon: "balls" },
  "ball-and-stick": { label: "Sticks", icon: "ballAndStick" },
  "volume+balls": { label: "Both", icon: "both" },
  surface: { label: "Surface", icon: "surface" },
};

function Styles() {
  const present = styleOf(scene.value!);
  return (
    <div class="styles" role="group" aria-label="Style">
      {hello.value?.styles.map((style) => (
        <button
          key={style}
          type="button"
          title={style}
          aria-pressed={style === present}
          onClick={() => edit((old) => withStyle(old, style, pastScenes.peek()))}
        >
          <Icon name={looks[style]?.icon ?? "cube"} />
          {looks[style]?.label ?? style}
        </button>
      ))}
    </div>
  );
}

export function FieldsTab() {
  const fields = scene.value!.fields ?? [];
  // The server fits its radius and transfer function.
  const add = () =>
    edit(
      setFields((old) => [
        ...old,
        { name: newFieldName(old, "all"), transfer_function: "viridis" },
      ]),
    );
  return (
    <>
      <Styles />
      {fields.map((field, index) => (
        <FieldCard
          key={index}
          field={field}
          index={index}
          open={fields.length <= 2 || index === 0}
        />
      ))}
      {(data.value?.particles ?? 0) > 0 && (
        <div class="padded">
          <Button icon="add" onClick={add}>
            Add a field
          </Button>
        </div>
      )}
    </>
  );
}
