// The whole page: the picture, what lies over it, the panel, dialogs.
import { CommandDialog } from "./dialogs/command_dialog";
import { DropZone } from "./dialogs/drop_zone";
import { FilesDialog } from "./dialogs/files_dialog";
import { HelpDialog } from "./dialogs/help_dialog";
import { PictureDialog } from "./dialogs/picture_dialog";
import { TextDialog } from "./dialogs/text_dialog";
import { Axes } from "./overlay/axes";
import { ColorBars } from "./overlay/color_bars";
import { PickedCard, PickedMarker } from "./overlay/picked_particle";
import { ScaleBar } from "./overlay/scale_bar";
import { StatisticsCard } from "./overlay/statistics_card";
import { Hint, Opening, Status } from "./overlay/status";
import { Timeline } from "./overlay/timeline";
import { Toolbar } from "./overlay/toolbar";
import { Panel } from "./panel/panel";
import { PictureView } from "./picture/picture_view";
import { hexOf, isLight } from "./scene/color";
import { scene } from "./state/document";
import { dialog } from "./state/interface";
import {
  panelOpen,
  showAxes,
  showColorBars,
  showScaleBar,
  showStatistics,
} from "./state/preferences";

const dialogs = {
  files: FilesDialog,
  picture: PictureDialog,
  command: CommandDialog,
  text: TextDialog,
  help: HelpDialog,
};

function Stage() {
  const background = scene.value?.render?.background ?? "#000000";
  return (
    <main
      class={isLight(background) ? "stage over-light" : "stage over-dark"}
      style={{ background: hexOf(background) }}
    >
      <PictureView />
      <PickedMarker />
      {showColorBars.value && <ColorBars />}
      {showAxes.value && <Axes />}
      {showScaleBar.value && <ScaleBar />}
      <div class="cards">
        <PickedCard />
        {showStatistics.value && <StatisticsCard />}
      </div>
      <Opening />
      <div class="stage-foot">
        <Hint />
        <Timeline />
      </div>
      <Toolbar />
      <Status />
    </main>
  );
}

export function Page() {
  const Shown = dialog.value && dialogs[dialog.value];
  return (
    <div class={panelOpen.value ? "page with-panel" : "page"}>
      <Stage />
      <Panel />
      {Shown && <Shown />}
      <DropZone />
    </div>
  );
}
