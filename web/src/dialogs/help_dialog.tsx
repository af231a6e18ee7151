// Mouse, touch and keys.
import { Dialog } from "../controls/dialog";
import { dialog } from "../state/interface";
import { hello } from "../state/session";
import { shortcuts } from "../state/shortcuts";

const gestures: [string, string, string][] = [
  ["Turn", "drag", "one finger"],
  ["Shift", "drag with Shift or the right button", "two fingers"],
  ["Zoom", "wheel", "pinch"],
  ["Roll", "drag with Alt", "turn two fingers"],
  ["Pick and centre", "double click", "double tap"],
];

export function HelpDialog() {
  const keys = shortcuts.filter(({ shown }) => shown !== "");
  return (
    <Dialog title="Help" onClose={() => (dialog.value = null)}>
      <table>
        <thead>
          <tr>
            <td />
            <th>Mouse</th>
            <th>Touch</th>
          </tr>
        </thead>
        <tbody>
          {gestures.map(([deed, mouse, touch]) => (
            <tr key={deed}>
              <th scope="row">{deed}</th>
              <td>{mouse}</td>
              <td>{touch}</td>
            </tr>
          ))}
        </tbody>
      </table>
      <h3>Keys</h3>
      <dl class="keys">
        {keys.map(({ label, shown }) => (
          <div key={label}>
            <dt>{label}</dt>
            <dd>
              <kbd>{shown}</kbd>
            </dd>
          </div>
        ))}
      </dl>
      <p class="quiet">Motes {hello.value?.version}</p>
    </Dialog>
  );
}
