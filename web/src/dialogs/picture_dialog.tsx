// Saves the picture at any size, at full quality.
import { useRef, useState } from "preact/hooks";
import { Button } from "../controls/button";
import { Dialog } from "../controls/dialog";
import { NumberRow, Segments } from "../controls/fields";
import { baseName, fetchPicture, saveBlob } from "../state/files";
import { dialog } from "../state/interface";
import { size } from "../state/view";

const largest = 16384;
const formats = [
  { value: "png", label: "PNG" },
  { value: "jpg", label: "JPEG" },
  { value: "exr", label: "EXR" },
  { value: "npy", label: "NPY" },
];
const notes: Record<string, string> = {
  png: "Lossless, over the background.",
  jpg: "Small, over the background.",
  exr: "Linear floating-point colours and opacity.",
  npy: "Linear floating-point colours and opacity, for NumPy.",
};

export function PictureDialog() {
  const [wanted, setWanted] = useState(size.peek());
  const [format, setFormat] = useState("png");
  const [busy, setBusy] = useState(false);
  const [fault, setFault] = useState("");
  const controller = useRef(new AbortController());

  const save = async () => {
    setBusy(true);
    setFault("");
    controller.current = new AbortController();
    try {
      const blob = await fetchPicture(wanted, format, controller.current.signal);
      saveBlob(blob, `${baseName.peek()}.${format}`);
      dialog.value = null;
    } catch (error) {
      if (!controller.current.signal.aborted) setFault((error as Error).message);
      setBusy(false);
    }
  };
  const close = () => {
    controller.current.abort();
    dialog.value = null;
  };
  const times = (factor: number) => () =>
    setWanted({ width: size.peek().width * factor, height: size.peek().height * factor });

  return (
    <Dialog title="Save picture" onClose={close}>
      <NumberRow
        label="Width"
        unit="pixels"
        whole
        min={1}
        max={largest}
        value={wanted.width}
        onChange={(width) => setWanted({ ...wanted, width })}
      />
      <NumberRow
        label="Height"
        unit="pixels"
        whole
        min={1}
        max={largest}
        value={wanted.height}
        onChange={(height) => setWanted({ ...wanted, height })}
      />
      <div class="buttons">
        <Button onClick={times(1)}>As on screen</Button>
        <Button onClick={times(2)}>2 ×</Button>
        <Button onClick={times(4)}>4 ×</Button>
      </div>
      <Segments label="Format" value={format} choices={formats} onChange={setFormat} />
      <p class="quiet">{notes[format]}</p>
      {fault && (
        <p class="fault" role="alert">
          {fault}
        </p>
      )}
      <footer>
        {busy && (
          <span role="status">
            <span class="spinner" /> Rendering…
          </span>
        )}
        <Button onClick={close}>Cancel</Button>
        <Button primary icon="download" disabled={busy} onClick={() => void save()}>
          Save
        </Button>
      </footer>
    </Dialog>
  );
}
