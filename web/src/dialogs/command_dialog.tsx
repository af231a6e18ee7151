// The line for a terminal that makes the same picture.
import { useRef, useState } from "preact/hooks";
import { Button } from "../controls/button";
import { Dialog } from "../controls/dialog";
import { presentRenderLine } from "../state/files";
import { dialog } from "../state/interface";

export function CommandDialog() {
  const [line] = useState(presentRenderLine);
  const [copied, setCopied] = useState(false);
  const text = useRef<HTMLTextAreaElement>(null);

  const copy = async () => {
    try {
      await navigator.clipboard.writeText(line);
    } catch {
      // Browsers lend the clipboard only to secure addresses; what is selected can be copied anywhere.
      text.current?.select();
      document.execCommand("copy");
    }
    setCopied(true);
  };

  return (
    <Dialog title="The same picture in a terminal" onClose={() => (dialog.value = null)}>
      <textarea ref={text} class="code" readOnly rows={14} aria-label="Command line" value={line} />
      <footer>
        <p class="quiet">Paste it into a shell where the data are.</p>
        <Button primary icon={copied ? "check" : "copy"} onClick={() => void copy()}>
          {copied ? "Copied" : "Copy"}
        </Button>
      </footer>
    </Dialog>
  );
}
