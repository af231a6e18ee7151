// The folder that the server was started for, and files from this computer.
import { useEffect, useRef } from "preact/hooks";
import { Button } from "../controls/button";
import { Dialog } from "../controls/dialog";
import { Icon } from "../controls/icon";
import { formatBytes } from "../scene/format";
import { list, listing, open, openLocalFile } from "../state/files";
import { dialog } from "../state/interface";

const close = () => (dialog.value = null);

function Path({ path }: { path: string }) {
  const parts = path.split("/").filter(Boolean);
  return (
    <nav class="path" aria-label="Folder">
      <button type="button" onClick={() => list("")}>
        <Icon name="folder" /> Folder
      </button>
      {parts.map((part, i) => (
        <button type="button" key={i} onClick={() => list(parts.slice(0, i + 1).join("/"))}>
          {part}
        </button>
      ))}
    </nav>
  );
}

function Entries() {
  const shown = listing.value;
  if (!shown) return <p class="quiet">Reading the folder…</p>;
  const pathOf = (name: string) => (shown.path ? `${shown.path}/${name}` : name);
  const choose = (name: string, folder: boolean) => {
    if (folder) {
      list(pathOf(name));
      return;
    }
    open(pathOf(name));
    close();
  };
  const folders = shown.entries.filter((entry) => entry.folder);
  const files = shown.entries.filter((entry) => !entry.folder);
  if (shown.entries.length === 0) return <p class="quiet">Nothing is in this folder.</p>;
  return (
    <ul class="entries">
      {[...folders, ...files].map(({ name, folder, size }) => (
        <li key={name}>
          <button type="button" onClick={() => choose(name, folder)}>
            <Icon name={folder ? "folder" : "file"} />
            <span>{name}</span>
            {!folder && <span class="quiet">{formatBytes(size)}</span>}
          </button>
        </li>
      ))}
    </ul>
  );
}

export function FilesDialog() {
  const input = useRef<HTMLInputElement>(null);
  useEffect(() => {
    list(listing.peek()?.path ?? "");
  }, []);
  return (
    <Dialog title="Open" onClose={close}>
      <Path path={listing.value?.path ?? ""} />
      <Entries />
      <footer>
        <p class="quiet">Or drop a file anywhere on the page.</p>
        <Button icon="upload" onClick={() => input.current?.click()}>
          From this computer…
        </Button>
        <input
          ref={input}
          type="file"
          hidden
          aria-label="File from this computer"
          onChange={(event) => {
            const [file] = event.currentTarget.files ?? [];
            if (file) void openLocalFile(file);
            close();
          }}
        />
      </footer>
    </Dialog>
  );
}
