// Buttons: with a drawing, or with text.
import type { ComponentChildren } from "preact";
import { Icon, type IconName } from "./icon";

interface IconButtonProps {
  icon: IconName;
  label: string;
  onClick: () => void;
  /** Key that does the same, for the tooltip. */
  shortcut?: string;
  pressed?: boolean;
  expanded?: boolean;
  disabled?: boolean;
  class?: string;
}

export function IconButton(props: IconButtonProps) {
  const { icon, label, shortcut, pressed, expanded } = props;
  return (
    <button
      type="button"
      class={`icon-button ${props.class ?? ""}`}
      aria-label={label}
      aria-pressed={pressed}
      aria-expanded={expanded}
      title={shortcut ? `${label} (${shortcut})` : label}
      disabled={props.disabled}
      onClick={props.onClick}
    >
      <Icon name={icon} />
    </button>
  );
}

interface ButtonProps {
  icon?: IconName;
  onClick: () => void;
  primary?: boolean;
  disabled?: boolean;
  children: ComponentChildren;
}

export function Button({ icon, onClick, primary, disabled, children }: ButtonProps) {
  return (
    <button
      type="button"
      class={primary ? "button primary" : "button"}
      disabled={disabled}
      onClick={onClick}
    >
      {icon && <Icon name={icon} />}
      {children}
    </button>
  );
}
