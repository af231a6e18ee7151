// Files that are dropped anywhere on the page are opened.
import { useEffect, useState } from "preact/hooks";
import { Icon } from "../controls/icon";
import { openLocalFile } from "../state/files";
import { notify } from "../state/notices";

function holdsFiles(event: DragEvent): boolean {
  return event.dataTransfer?.types.includes("Files") ?? false;
}

export function DropZone() {
  const [over, setOver] = useState(false);
  useEffect(() => {
    const controller = new AbortController();
    const { signal } = controller;
    const on = (type: "dragover" | "dragleave" | "drop", handle: (event: DragEvent) => void) =>
      window.addEventListener(type, handle, { signal });
    on("dragover", (event) => {
      if (!holdsFiles(event)) return;
      event.preventDefault();
      setOver(true);
    });
    // Leaving the window has nothing it goes to; going from element to element has.
    on("dragleave", (event) => event.relatedTarget === null && setOver(false));
    on("drop", (event) => {
      if (!holdsFiles(event)) return;
      event.preventDefault();
      setOver(false);
      const files = [...(event.dataTransfer?.files ?? [])];
      if (files.length > 1) notify("news", `Of ${files.length} files ${files[0]!.name} is opened.`);
      if (files[0]) void openLocalFile(files[0]);
    });
    return () => controller.abort();
  }, []);
  if (!over) return null;
  return (
    <div class="drop-zone" aria-hidden="true">
      <div>
        <Icon name="upload" />
        <p>Drop to open</p>
      </div>
    </div>
  );
}
