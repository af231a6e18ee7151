// The panel: everything that a scene holds, under five tabs.
import type { FunctionComponent } from "preact";
import { useRef } from "preact/hooks";
import { IconButton } from "../controls/button";
import { scene } from "../state/document";
import { panelOpen, tab } from "../state/preferences";
import { FieldsTab } from "./fields_tab";
import { InfoTab } from "./info_tab";
import { LightTab } from "./light_tab";
import { QualityTab } from "./quality_tab";
import { ShapesTab } from "./shapes_tab";

const tabs: { id: string; label: string; content: FunctionComponent }[] = [
  { id: "fields", label: "Fields", content: FieldsTab },
  { id: "shapes", label: "Shapes", content: ShapesTab },
  { id: "light", label: "Light", content: LightTab },
  { id: "quality", label: "Quality", content: QualityTab },
  { id: "info", label: "Info", content: InfoTab },
];

function Tabs({ present }: { present: string }) {
  const list = useRef<HTMLDivElement>(null);
  const onKeyDown = (event: KeyboardEvent) => {
    const direction = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!direction) return;
    const index = tabs.findIndex(({ id }) => id === present);
    const next = (index + direction + tabs.length) % tabs.length;
    tab.value = tabs[next]!.id;
    list.current?.querySelectorAll<HTMLElement>("[role=tab]")[next]?.focus();
    event.preventDefault();
  };
  return (
    <div class="tabs" role="tablist" aria-label="Settings" ref={list} onKeyDown={onKeyDown}>
      {tabs.map(({ id, label }) => (
        <button
          key={id}
          type="button"
          role="tab"
          id={`tab-${id}`}
          aria-selected={id === present}
          aria-controls="tab-panel"
          tabIndex={id === present ? 0 : -1}
          onClick={() => (tab.value = id)}
        >
          {label}
        </button>
      ))}
    </div>
  );
}

export function Panel() {
  if (!panelOpen.value) return null;
  const present = tabs.find(({ id }) => id === tab.value) ?? tabs[0]!;
  const Content = present.content;
  return (
    <aside class="panel" aria-label="Scene">
      <div class="panel-head">
        <Tabs present={present.id} />
        <IconButton
          class="narrow-only"
          icon="chevronDown"
          label="Hide the panel"
          onClick={() => (panelOpen.value = false)}
        />
      </div>
      <div
        id="tab-panel"
        class="panel-body"
        role="tabpanel"
        aria-labelledby={`tab-${present.id}`}
        key={present.id}
      >
        {scene.value ? <Content /> : <p class="quiet padded">Nothing is open.</p>}
      </div>
    </aside>
  );
}
