// A part of the panel under a heading, which can be closed.
import type { ComponentChildren } from "preact";
import { useId, useState } from "preact/hooks";
import { Icon } from "./icon";

interface SectionProps {
  title: string;
  /** Beside the heading. */
  actions?: ComponentChildren;
  closed?: boolean;
  children: ComponentChildren;
}

export function Section({ title, actions, closed = false, children }: SectionProps) {
  const [open, setOpen] = useState(!closed);
  const id = useId();
  return (
    <section class="section">
      <div class="section-head">
        <h2>
          <button
            type="button"
            aria-expanded={open}
            aria-controls={id}
            onClick={() => setOpen(!open)}
          >
            <Icon name={open ? "chevronDown" : "chevronRight"} />
            {title}
          </button>
        </h2>
        {actions}
      </div>
      <div id={id} class="section-body" hidden={!open}>
        {open && children}
      </div>
    </section>
  );
}
