// Starts the page.
import { effect } from "@preact/signals";
import { render } from "preact";
import { Page } from "./page";
import { connect } from "./protocol/connection";
import { data } from "./state/document";
import { listenForKeys } from "./state/shortcuts";
import { size } from "./state/view";
import "./styles/base.css";
import "./styles/controls.css";
import "./styles/dialogs.css";
import "./styles/inputs.css";
import "./styles/overlay.css";
import "./styles/panel.css";
import "./styles/status.css";

render(<Page />, document.getElementById("page")!);
listenForKeys();

effect(() => {
  document.title = data.value ? `${data.value.file} – Motes` : "Motes";
});

// The size of the picture is the first thing that the server is told.
let begun = false;
effect(() => {
  if (begun || size.value.width === 0) return;
  begun = true;
  connect();
});
