// The one toolbar: the file at the left, what one does with the picture at the right.
import { viewFrom } from "../camera/navigation";
import { IconButton } from "../controls/button";
import { Icon } from "../controls/icon";
import { Menu, MenuItem } from "../controls/menu";
import { canRedo, canUndo, data, redoEdit, undoEdit } from "../state/document";
import { saveScene } from "../state/files";
import { dialog } from "../state/interface";
import {
  panelOpen,
  showAxes,
  showColorBars,
  showScaleBar,
  showStatistics,
  tab,
  theme,
  type Theme,
} from "../state/preferences";
import { clients } from "../state/session";
import { toggleProjection } from "../state/shortcuts";
import { camera, fit } from "../state/view";

const themes: { value: Theme; label: string }[] = [
  { value: "system", label: "Automatic appearance" },
  { value: "light", label: "Light" },
  { value: "dark", label: "Dark" },
];

function ViewMenu() {
  return (
    <Menu icon="cube" label="View">
      <MenuItem icon="fit" label="Show everything" shortcut="F" onClick={fit} />
      <MenuItem
        label="Parallel projection"
        shortcut="P"
        checked={camera.value?.orthographic !== undefined}
        onClick={toggleProjection}
      />
      <hr />
      {(["x", "y", "z"] as const).map((name, axis) => (
        <MenuItem
          key={name}
          label={`From +${name}`}
          shortcut={name.toUpperCase()}
          onClick={() => viewFrom(axis as 0 | 1 | 2, 1)}
        />
      ))}
      {(["x", "y", "z"] as const).map((name, axis) => (
        <MenuItem
          key={name}
          label={`From −${name}`}
          shortcut={`⇧ ${name.toUpperCase()}`}
          onClick={() => viewFrom(axis as 0 | 1 | 2, -1)}
        />
      ))}
      <hr />
      {[
        { label: "Axes", shown: showAxes },
        { label: "Scale bar", shown: showScaleBar },
        { label: "Colour bars", shown: showColorBars },
      ].map(({ label, shown }) => (
        <MenuItem
          key={label}
          label={label}
          checked={shown.value}
          onClick={() => (shown.value = !shown.value)}
        />
      ))}
    </Menu>
  );
}

function SaveMenu() {
  return (
    <Menu icon="save" label="Save and share">
      <MenuItem icon="camera" label="Save picture…" onClick={() => (dialog.value = "picture")} />
      <MenuItem icon="file" label="Save scene" shortcut="Ctrl + S" onClick={saveScene} />
      <MenuItem
        icon="command"
        label="Copy command line…"
        onClick={() => (dialog.value = "command")}
      />
      <MenuItem icon="edit" label="Edit scene as text…" onClick={() => (dialog.value = "text")} />
    </Menu>
  );
}

function MoreMenu() {
  const showClients = () => {
    panelOpen.value = true;
    tab.value = "info";
  };
  return (
    <Menu icon="more" label="More">
      <MenuItem
        icon="chart"
        label="Statistics"
        shortcut="S"
        checked={showStatistics.value}
        onClick={() => (showStatistics.value = !showStatistics.value)}
      />
      {clients.value.length > 1 && (
        <MenuItem icon="people" label={`${clients.value.length} viewers`} onClick={showClients} />
      )}
      <MenuItem icon="help" label="Help" shortcut="?" onClick={() => (dialog.value = "help")} />
      <hr />
      {themes.map(({ value, label }) => (
        <MenuItem
          key={value}
          label={label}
          checked={theme.value === value}
          onClick={() => (theme.value = value)}
        />
      ))}
    </Menu>
  );
}

export function Toolbar() {
  const file = data.value?.file.split("/").at(-1) ?? "Open a file";
  return (
    <header class="toolbar">
      <h1 class="unseen">Motes</h1>
      <div class="bar file-bar">
        <button
          type="button"
          class="file-button"
          title="Open a file (Ctrl + O)"
          onClick={() => (dialog.value = "files")}
        >
          <Icon name="folder" />
          <span>{file}</span>
          <Icon name="chevronDown" />
        </button>
      </div>
      <div class="bar" role="toolbar" aria-label="Tools">
        <IconButton
          icon="undo"
          label="Undo"
          shortcut="Ctrl + Z"
          disabled={!canUndo.value}
          onClick={undoEdit}
        />
        <IconButton
          icon="redo"
          label="Redo"
          shortcut="Ctrl + Shift + Z"
          disabled={!canRedo.value}
          onClick={redoEdit}
        />
        <span class="divider wide-only" />
        <IconButton
          class="wide-only"
          icon="fit"
          label="Show everything"
          shortcut="F"
          onClick={fit}
        />
        <ViewMenu />
        <SaveMenu />
        <MoreMenu />
        <span class="divider wide-only" />
        <IconButton
          icon="panel"
          label={panelOpen.value ? "Hide the panel" : "Show the panel"}
          shortcut="H"
          expanded={panelOpen.value}
          onClick={() => (panelOpen.value = !panelOpen.value)}
        />
      </div>
    </header>
  );
}
