// Starts the page.
import { render } from "preact";
import { Page } from "./page";
import { connect } from "./protocol/connection";
import { listenForKeys } from "./state/shortcuts";
import "./styles/base.css";
import "./styles/controls.css";
import "./styles/overlay.css";
import "./styles/panel.css";

render(<Page />, document.getElementById("page")!);
listenForKeys();
connect();
