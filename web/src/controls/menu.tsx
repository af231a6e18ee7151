// A button that opens a short list of commands.
import type { ComponentChildren } from "preact";
import { useLayoutEffect, useRef, useState } from "preact/hooks";
import { Icon, type IconName } from "./icon";

interface MenuProps {
  icon?: IconName;
  label: string;
  /** In place of a drawing. */
  face?: ComponentChildren;
  class?: string;
  children: ComponentChildren;
}

function items(list: HTMLElement | null): HTMLElement[] {
  return [...(list?.querySelectorAll<HTMLElement>("[role^=menuitem]:not(:disabled)") ?? [])];
}

/** Arrow keys go from item to item, as in menus of the desktop. */
function moveFocus(list: HTMLElement | null, key: string): boolean {
  const all = items(list);
  const present = all.indexOf(document.activeElement as HTMLElement);
  const next = {
    ArrowDown: (present + 1) % all.length,
    ArrowUp: (present - 1 + all.length) % all.length,
    Home: 0,
    End: all.length - 1,
  }[key];
  if (next === undefined) return false;
  all[next]?.focus();
  return true;
}

export function Menu({ icon, label, face, class: extra, children }: MenuProps) {
  const [open, setOpen] = useState(false);
  const root = useRef<HTMLDivElement>(null);
  const list = useRef<HTMLDivElement>(null);

  useLayoutEffect(() => {
    if (!open) return undefined;
    items(list.current)[0]?.focus({ preventScroll: true });
    const outside = (event: Event) => {
      if (!root.current?.contains(event.target as Node)) setOpen(false);
    };
    document.addEventListener("pointerdown", outside, true);
    document.addEventListener("focusin", outside);
    return () => {
      document.removeEventListener("pointerdown", outside, true);
      document.removeEventListener("focusin", outside);
    };
  }, [open]);

  const close = () => {
    setOpen(false);
    root.current?.querySelector<HTMLElement>("button")?.focus();
  };
  const onKeyDown = (event: KeyboardEvent) => {
    if (!open) return;
    if (event.key === "Escape") close();
    else if (!moveFocus(list.current, event.key)) return;
    event.preventDefault();
    event.stopPropagation();
  };

  return (
    <div class={`menu ${extra ?? ""}`} ref={root} onKeyDown={onKeyDown}>
      <button
        type="button"
        class={face ? "button" : "icon-button"}
        aria-label={label}
        aria-haspopup="menu"
        aria-expanded={open}
        title={label}
        onClick={() => setOpen(!open)}
      >
        {face ?? (icon && <Icon name={icon} />)}
      </button>
      {open && (
        <div class="menu-list" role="menu" aria-label={label} ref={list} onClick={close}>
          {children}
        </div>
      )}
    </div>
  );
}

interface MenuItemProps {
  icon?: IconName;
  label: string;
  shortcut?: string;
  /** For items that switch something on and off. */
  checked?: boolean;
  disabled?: boolean;
  class?: string;
  onClick: () => void;
  children?: ComponentChildren;
}

export function MenuItem(props: MenuItemProps) {
  const { icon, label, shortcut, checked } = props;
  return (
    <button
      type="button"
      class={`menu-item ${props.class ?? ""}`}
      role={checked === undefined ? "menuitem" : "menuitemcheckbox"}
      aria-checked={checked}
      disabled={props.disabled}
      onClick={props.onClick}
    >
      {props.children}
      {icon && <Icon name={icon} />}
      <span class="menu-label">{label}</span>
      {shortcut && <kbd>{shortcut}</kbd>}
      {checked && <Icon name="check" />}
    </button>
  );
}
