// Scene files, version 1 (docs/scene.md), as the server sends them: every default filled in.

export type Vector = [number, number, number];

/** A name or "#rrggbb" in sRGB, or linear components. */
export type Color = string | Vector;

export interface Camera {
  eye: Vector;
  target: Vector;
  up: Vector;
  /** Vertical field of view in degrees; parallel rays have `orthographic` instead. */
  fov?: number;
  /** Height of the picture in the data's unit of length. */
  orthographic?: number;
}

export type Scale = "linear" | "log";

export interface TransferPoint {
  value: number;
  color: Color;
  /** Per unit of length. */
  extinction: number;
}

export interface TransferFunction {
  points: TransferPoint[];
  scale?: Scale;
}

/** What a page may send in place of points: the server fits what is left out. */
export interface NamedTransferFunction {
  name: string;
  range?: [number, number];
  extinction?: number;
  scale?: Scale;
}

export interface Selection {
  species?: string | string[];
  index?: [number, number];
  expression?: string;
}

export interface Isosurface {
  value: number;
  color?: Color;
  opacity?: number;
}

export interface Kernel {
  type?: string;
  support_factor?: number;
  kernel_scale?: number;
  path?: string;
}

export interface GridSource {
  path?: string;
  array?: string;
  interpolation?: string;
}

export interface Field {
  name?: string;
  visible?: boolean;
  grid?: GridSource | string;
  select?: Selection;
  radius?: number | string;
  weight?: number | string;
  normalise?: boolean;
  kernel?: Kernel;
  transfer_function?: TransferFunction | NamedTransferFunction | string;
  isosurfaces?: Isosurface[];
}

export interface ColorByProperty {
  property: string;
  map?: string;
  range?: [number, number];
}

export interface Geometry {
  type: "spheres" | "sticks";
  select?: Selection;
  radius?: number | string;
  scale?: number;
  color?: Color | ColorByProperty;
  bonds?: string;
}

export interface LightSource {
  /** Towards the light; none: from the camera. */
  direction?: Vector;
  intensity?: number;
}

export const maxLights = 8;

export interface Lighting {
  enabled?: boolean;
  ambient?: number;
  diffuse?: number;
  specular?: number;
  shininess?: number;
  /** Of the only light. */
  direction?: Vector;
  /** Instead of the direction; none: one light, from the camera. */
  lights?: LightSource[];
}

export interface SurfaceSettings {
  antialiasing?: number;
  ambient_occlusion?: number;
  occlusion_distance?: number;
  shadows?: boolean;
  light_angle?: number;
  seed?: number;
}

export interface ClipPlane {
  normal: Vector;
  distance: number;
}

export interface RenderSettings {
  size?: [number, number];
  step_size?: number;
  termination_opacity?: number;
  lighting?: Lighting;
  surface?: SurfaceSettings;
  clip_planes?: ClipPlane[];
  background?: Color;
  engine?: string;
}

export interface Scene {
  version: 1;
  data?: { path: string; frame?: number; types?: Record<string, string> };
  camera?: Camera;
  kernel?: Kernel;
  fields?: Field[];
  geometry?: Geometry[];
  /** Only ever sent: the server answers with what it came to. */
  style?: string;
  render?: RenderSettings;
}
