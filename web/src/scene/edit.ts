// Small changes of scenes, for what the controls do.
import type {
  ClipPlane,
  Field,
  Geometry,
  Kernel,
  Lighting,
  LightSource,
  NamedTransferFunction,
  RenderSettings,
  Scene,
  SurfaceSettings,
  TransferFunction,
} from "../protocol/scene";
import { replaced } from "./lists";

type Change = (scene: Scene) => Scene;

export const setRender =
  (patch: Partial<RenderSettings>): Change =>
  (scene) => ({ ...scene, render: { ...scene.render, ...patch } });

export const setLighting =
  (patch: Partial<Lighting>): Change =>
  (scene) =>
    setRender({ lighting: { ...scene.render?.lighting, ...patch } })(scene);

export const lightsOf = ({ direction, lights }: Lighting): LightSource[] =>
  lights ?? [direction ? { direction } : {}];

export const setLights =
  (change: (lights: LightSource[]) => LightSource[]): Change =>
  (scene) =>
    setLighting({
      direction: undefined,
      lights: change(lightsOf(scene.render?.lighting ?? {})),
    })(scene);

export const setSurface =
  (patch: Partial<SurfaceSettings>): Change =>
  (scene) =>
    setRender({ surface: { ...scene.render?.surface, ...patch } })(scene);

export const setKernel =
  (patch: Partial<Kernel>): Change =>
  (scene) => ({ ...scene, kernel: { ...scene.kernel, ...patch } });

export const setClipPlanes =
  (change: (planes: ClipPlane[]) => ClipPlane[]): Change =>
  (scene) =>
    setRender({ clip_planes: change(scene.render?.clip_planes ?? []) })(scene);

export const setGeometry =
  (change: (items: Geometry[]) => Geometry[]): Change =>
  (scene) => {
    const items = change(scene.geometry ?? []);
    const { geometry: _, ...rest } = scene;
    return items.length > 0 ? { ...rest, geometry: items } : rest;
  };

export const setFields =
  (change: (fields: Field[]) => Field[]): Change =>
  (scene) => ({ ...scene, fields: change(scene.fields ?? []) });

/** `undefined` takes a key out, so that the server fits its value. */
export const setField = (index: number, patch: Partial<Field>): Change =>
  setFields((fields) => replaced(fields, index, patch));

/** A name that no field has. */
export function newFieldName(fields: Field[], stem: string): string {
  const taken = new Set(fields.map((field) => field.name));
  if (!taken.has(stem)) return stem;
  for (let i = 2; ; ++i) if (!taken.has(`${stem} ${i}`)) return `${stem} ${i}`;
}

export function hasPoints(
  transfer: TransferFunction | NamedTransferFunction | string | undefined,
): transfer is TransferFunction {
  return typeof transfer === "object" && "points" in transfer;
}

export const isVisible = (field: Field): boolean => field.visible !== false;

const isGrid = (field: Field): boolean => field.grid !== undefined;

/** Which style the scene is in, as far as one can tell; null: one of its own. */
export function styleOf(scene: Scene): string | null {
  const types = new Set(scene.geometry?.map((item) => item.type));
  const fields = scene.fields ?? [];
  const volume = fields.some((field) => field.transfer_function !== undefined);
  const surfaces = fields.some((field) => (field.isosurfaces?.length ?? 0) > 0);
  if (types.size === 0) return volume ? (surfaces ? null : "volume") : "surface";
  if (surfaces) return !volume && types.size === 2 && fields.every(isGrid) ? "surface" : null;
  if (volume) return types.size === 2 ? "volume+balls" : null;
  return types.has("sticks") ? "ball-and-stick" : "spheres";
}

/**
 * The scene to send for a style. A style without fields loses the transfer functions: where one with
 * fields follows, they come from the newest earlier scene that had some.
 */
export function withStyle(scene: Scene, style: string, earlier: Scene[]): Scene {
  const { geometry: _, fields, ...rest } = scene;
  const volume = (candidate: Scene) =>
    candidate.fields?.filter((field) => field.transfer_function !== undefined) ?? [];
  const source =
    volume(scene).length > 0 ? scene : [...earlier].reverse().find((s) => volume(s).length > 0);
  const kept = source && volume(source).map(({ isosurfaces: _, ...field }) => field);
  const drawsVolume = style === "volume" || style === "volume+balls";
  if (drawsVolume) return { ...rest, ...(kept && { fields: kept }), style };
  const grids = (fields?.some(isGrid) ? fields : (kept ?? [])).filter(isGrid);
  if (style === "surface" && grids.length > 0) return { ...rest, fields: grids, style };
  return { ...rest, style };
}
