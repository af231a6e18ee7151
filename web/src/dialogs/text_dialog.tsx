// The scene as text, for what no control of the panel changes.
import { useState } from "preact/hooks";
import { Button } from "../controls/button";
import { Dialog } from "../controls/dialog";
import type { Scene } from "../protocol/scene";
import { sceneText } from "../scene/shell_line";
import { loadScene, presentScene } from "../state/document";
import { dialog } from "../state/interface";

export function TextDialog() {
  const [text, setText] = useState(() => {
    const scene = presentScene();
    return scene ? sceneText(scene) : "";
  });
  const [fault, setFault] = useState("");

  const apply = () => {
    try {
      loadScene(JSON.parse(text) as Scene);
      dialog.value = null;
    } catch (error) {
      setFault((error as Error).message);
    }
  };

  return (
    <Dialog title="The scene as text" onClose={() => (dialog.value = null)}>
      <textarea
        class="code"
        rows={22}
        spellcheck={false}
        aria-label="Scene"
        value={text}
        onInput={(event) => setText(event.currentTarget.value)}
      />
      {fault && (
        <p class="fault" role="alert">
          {fault}
        </p>
      )}
      <footer>
        <p class="quiet">What is left out is fitted anew.</p>
        <Button onClick={() => (dialog.value = null)}>Cancel</Button>
        <Button primary icon="check" onClick={apply}>
          Apply
        </Button>
      </footer>
    </Dialog>
  );
}
