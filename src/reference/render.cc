#include "reference/render.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "reference/grid.h"

namespace motes::reference {

namespace {

/// Relative to the distance from the eye for lengths, absolute for opacities.
constexpr double stability_tolerance = 1e-5;
/// Of a grid's values in single precision, relative to its largest coefficient.
constexpr double grid_rounding = 2e-6;
/// Where kernels have come down to so little of their peak, single precision knows no direction.
constexpr double faintest_normal = 1e-20;

/// All fields' kernels, and what of the scene is the same for every ray.
struct Volume {
  std::vector<std::vector<ParticleKernel>> fields;
  std::vector<std::optional<GridField>> grids;  ///< one a field, where it is one
  std::vector<double> smallest_radius;          ///< of each field's particles
  std::vector<double> largest_peak;             ///< of each field's kernels, or coefficients
  Bounds3d box;
  Vector3d forward;
  double near = 0,
         far = -1;  ///< depths between which all of the box lies; far < near without particles
};

double shortest_step(const Grid& grid) {
  return std::min({length(grid.steps[0]), length(grid.steps[1]), length(grid.steps[2])});
}

std::vector<Point3d> hull_corners(const Grid& grid) {
  const double less = grid.periodic ? 0 : 1;
  std::vector<Point3d> corners;
  for (const double i : {0., static_cast<double>(grid.dims[0]) - less}) {
    for (const double j : {0., static_cast<double>(grid.dims[1]) - less}) {
      for (const double k : {0., static_cast<double>(grid.dims[2]) - less}) {
        corners.push_back(grid.origin + i * grid.steps[0] + j * grid.steps[1] + k * grid.steps[2]);
      }
    }
  }
  return corners;
}

Volume make_volume(const ParticleSet& particles, const ResolvedScene& scene) {
  Volume volume;
  for (const FieldSource& source : scene.fields) {
    volume.fields.push_back(particle_kernels(particles, source));
    volume.grids.emplace_back();
    if (source.grid) {
      volume.grids.back().emplace(*source.grid, source.interpolation);
      volume.largest_peak.push_back(volume.grids.back()->largest_coefficient());
      volume.smallest_radius.push_back(shortest_step(*source.grid));
      continue;
    }
    double smallest = std::numeric_limits<double>::infinity(), largest = 0;
    for (const ParticleKernel& kernel : volume.fields.back()) {
      smallest = std::min(smallest, kernel.radius);
      largest = std::max(largest, std::abs(kernel.amplitude));
    }
    volume.largest_peak.push_back(largest);
    volume.smallest_radius.push_back(smallest);
  }
  volume.box = volume_box(volume.fields);
  for (const FieldSource& source : scene.fields) {
    if (!source.grid) continue;
    for (const Point3d& corner : hull_corners(*source.grid)) volume.box.add(corner);
  }
  volume.forward = normalize(scene.camera.target - scene.camera.eye);
  if (volume.box.empty()) return volume;
  volume.near = std::numeric_limits<double>::infinity();
  volume.far = -volume.near;
  for (int corner = 0; corner < 8; ++corner) {
    const Point3d p{corner & 1 ? volume.box.max.x : volume.box.min.x,
                    corner & 2 ? volume.box.max.y : volume.box.min.y,
                    corner & 4 ? volume.box.max.z : volume.box.min.z};
    const double depth = dot(p - scene.camera.eye, volume.forward);
    volume.near = std::min(volume.near, depth);
    volume.far = std::max(volume.far, depth);
  }
  return volume;
}

/// Distance from x to the surface of the box.
double distance_to_faces(const Bounds3d& box, const Point3d& x) {
  // Along each axis: how far x lies outside (positive) or inside (negative) of the nearer face.
  Vector3d outside;
  for (int axis = 0; axis < 3; ++axis) {
    outside[axis] = std::max(box.min[axis] - x[axis], x[axis] - box.max[axis]);
  }
  const double nearest = std::max({outside.x, outside.y, outside.z});
  if (nearest <= 0) return -nearest;
  return length(
      Vector3d{std::max(outside.x, 0.), std::max(outside.y, 0.), std::max(outside.z, 0.)});
}

/// The kernels that a sample of the ray can lie in, or within the tolerance of: nothing else adds
/// to the field or makes it unstable, and leaving the others out only saves time.
std::vector<ParticleKernel> kernels_near_ray(const std::vector<ParticleKernel>& kernels,
                                             const CameraRay& ray, const Point3d& eye) {
  std::vector<ParticleKernel> near;
  const double direction2 = dot(ray.direction, ray.direction);
  for (const ParticleKernel& kernel : kernels) {
    const Vector3d offset = kernel.center - ray.origin;
    const double z = dot(offset, ray.direction) / direction2;
    const double distance = length(offset - z * ray.direction);
    const double reach = length(kernel.center - eye) + kernel.support_radius;
    if (distance <= kernel.support_radius + 2 * stability_tolerance * reach) near.push_back(kernel);
  }
  return near;
}

struct Pixel {
  RayColor color;
  bool unstable = false, faint = false;
  std::uint64_t samples = 0, kernel_evaluations = 0;
};

/// The normal of the field, or none where the gradient is too small to have a direction.
std::optional<Vector3d> normal_of(const FieldValue& field, double smallest_radius) {
  const double steepness = length(field.gradient);
  if (steepness == 0 || steepness * smallest_radius < 1e-6 * field.absolute) return std::nullopt;
  return -field.gradient / steepness;
}

struct Depths {
  double near, far;
};

/// A field at a sample, and the depths that it stands for.
struct FieldSample {
  Classified classified;
  Depths part;
};

/// Whether the rounding of a grid's value is seen over a step, or turns its normal.
bool is_delicate(const TransferFunction& function, const FieldValue& field, double largest,
                 double step_length, bool lit, double shortest_edge) {
  const double off = grid_rounding * largest;
  const double more = classify(function, field.value + off).extinction;
  const double less = classify(function, field.value - off).extinction;
  if (std::abs(more - less) * step_length > 1e-3) return true;
  // Where values are larger, what is only rounding of a gradient is no normal anyway.
  constexpr double turn = 0.01, large = 0.2;
  return lit && field.absolute < large * largest &&
         length(field.gradient) * shortest_edge < off / turn;
}

/// The fields of the volume at the sample of that depth, each within its part of the ray.
std::vector<FieldSample> classify_sample(const Volume& volume, const ResolvedScene& scene,
                                         const std::vector<std::vector<ParticleKernel>>& fields,
                                         const CameraRay& ray, double depth,
                                         const std::vector<Depths>& parts, Pixel& pixel) {
  const Vector3d view = -normalize(ray.direction);
  const Lighting& lighting = scene.render.lighting;
  std::vector<FieldSample> samples;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const Depths& part = parts[f];
    if (part.near >= part.far) continue;
    // Where the grid ends before its sample, the nearest place that it has.
    const double z = volume.grids[f] ? std::clamp(depth, part.near, part.far) : depth;
    const Point3d x = ray.origin + z * ray.direction;
    const double tolerance = stability_tolerance * length(x - scene.camera.eye);
    const FieldValue field =
        volume.grids[f] ? volume.grids[f]->at(x) : evaluate_field(fields[f], x);
    if (field.boundary_distance <= tolerance) pixel.unstable = true;
    pixel.kernel_evaluations += field.num_kernels;
    Classified sample = classify(scene.transfer_functions[f], field.value);
    if (volume.grids[f] &&
        is_delicate(scene.transfer_functions[f], field, volume.largest_peak[f],
                    scene.step_size * length(ray.direction),
                    lighting.enabled && sample.extinction > 0, volume.smallest_radius[f])) {
      pixel.unstable = true;
    }
    if (lighting.enabled) {
      if (!volume.grids[f] && field.absolute > 0 &&
          field.absolute < faintest_normal * volume.largest_peak[f]) {
        pixel.faint = true;
      }
      sample = shade(sample, lighting, normal_of(field, volume.smallest_radius[f]), view);
    }
    samples.push_back({sample, part});
  }
  return samples;
}

/// A ray on its way through samples and layers.
class Way {
 public:
  Way(const std::vector<Layer>& layers, double termination, Pixel& pixel)
      : layers_(layers), termination_(termination), pixel_(pixel) {}

  bool ended() const { return pixel_.color.alpha > termination_; }

  /// Meets the layers in front of that depth.
  void meet_layers(double depth) {
    for (; next_ < layers_.size() && layers_[next_].depth < depth && !ended(); ++next_) {
      const Layer& layer = layers_[next_];
      const double visible = (1 - pixel_.color.alpha) * layer.opacity;
      pixel_.color.red += visible * layer.red;
      pixel_.color.green += visible * layer.green;
      pixel_.color.blue += visible * layer.blue;
      pixel_.color.alpha += visible;
      check_termination();
    }
  }

  /// Passes a sample that stands for depths `begin` to `end`, cut where layers are.
  void pass(const std::vector<FieldSample>& fields, double begin, double end,
            double length_per_depth) {
    while (begin < end && !ended()) {
      const bool cut = next_ < layers_.size() && layers_[next_].depth < end;
      const double to = cut ? layers_[next_].depth : end;
      for (const FieldSample& field : fields) {
        const double part = std::min(to, field.part.far) - std::max(begin, field.part.near);
        composite(pixel_.color, field.classified, std::max(part, 0.) * length_per_depth);
      }
      check_termination();
      if (cut) meet_layers(std::nextafter(to, end));
      begin = to;
      if (!cut) break;
    }
  }

 private:
  /// An opacity of 1 is never exceeded, so that no ray stops there.
  void check_termination() {
    if (termination_ < 1 && std::abs(pixel_.color.alpha - termination_) <= stability_tolerance) {
      pixel_.unstable = true;
    }
  }

  const std::vector<Layer>& layers_;
  double termination_;
  Pixel& pixel_;
  std::size_t next_ = 0;
};

/// Between which depths no plane cuts the ray away.
Depths kept_by(const std::vector<ClipPlane>& planes, const CameraRay& ray) {
  Depths kept{0, std::numeric_limits<double>::infinity()};
  for (const ClipPlane& plane : planes) {
    const Vector3d normal = normalize(plane.normal);
    const double height = dot(normal, ray.origin - Point3d{}) - plane.distance;
    const double rise = dot(normal, ray.direction);
    if (rise > 0) kept.far = std::min(kept.far, -height / rise);
    if (rise < 0) kept.near = std::max(kept.near, -height / rise);
    if (rise == 0 && height > 0) kept.far = -1;
  }
  return kept;
}

/// Between which depths the ray is in a grid's hull. Unstable where it runs along a face.
Depths hull_of(const GridField& grid, const CameraRay& ray, const Point3d& eye, double step_size,
               Pixel& pixel) {
  constexpr double rounding = 1e-9, too_much = 1e-4;
  std::vector<ClipPlane> wider = grid.faces();
  for (ClipPlane& face : wider) {
    face.distance +=
        rounding * (std::abs(face.distance - dot(face.normal, eye - Point3d{})) + step_size);
  }
  const Depths hull = kept_by(grid.faces(), ray), wide = kept_by(wider, ray);
  const double more = std::max(wide.far - wide.near, 0.) - std::max(hull.far - hull.near, 0.);
  if (more > too_much * step_size) pixel.unstable = true;
  return hull;
}

Pixel render_pixel(const Volume& volume, const ResolvedScene& scene,
                   const std::vector<Layer>& layers, int px, int py) {
  const Point3d eye = scene.camera.eye;
  const double step_size = scene.step_size;
  const CameraRay ray = camera_ray(scene.camera, scene.render.width, scene.render.height, px, py);
  std::vector<std::vector<ParticleKernel>> fields;
  for (const auto& kernels : volume.fields) {
    fields.push_back(kernels_near_ray(kernels, ray, eye));
  }

  const Depths kept = kept_by(scene.render.clip_planes, ray);
  Pixel pixel;
  std::vector<std::optional<Depths>> hulls;
  for (const auto& grid : volume.grids) {
    hulls.emplace_back();
    if (grid) hulls.back() = hull_of(*grid, ray, eye, step_size, pixel);
  }
  Way way(layers, scene.render.termination_opacity, pixel);
  // From the last plane before the box, or the first of all, to the first one behind the box.
  const double first = std::max(0., std::floor(volume.near / step_size - 0.5));
  const double last = std::ceil(volume.far / step_size - 0.5);
  for (double k = first; k <= last && !way.ended(); ++k) {
    const Point3d x = ray.origin + (k + 0.5) * step_size * ray.direction;
    const double tolerance = stability_tolerance * length(x - eye);
    if (distance_to_faces(volume.box, x) <= tolerance) pixel.unstable = true;
    const bool in_box = volume.box.contains(x);
    std::vector<Depths> parts;
    bool any = in_box;
    for (const auto& hull : hulls) {
      Depths part{k * step_size, in_box ? (k + 1) * step_size : 0};
      if (hull) {
        part = {std::max(k * step_size, hull->near), std::min((k + 1) * step_size, hull->far)};
      }
      any |= part.near < part.far;
      parts.push_back(part);
    }
    if (!any) continue;
    const double begin = std::max(k * step_size, kept.near);
    const double end = std::min((k + 1) * step_size, kept.far);
    if (begin >= end) continue;
    way.meet_layers(k * step_size);
    if (way.ended()) break;
    ++pixel.samples;
    const auto samples =
        classify_sample(volume, scene, fields, ray, (k + 0.5) * step_size, parts, pixel);
    way.pass(samples, begin, end, length(ray.direction));
  }
  way.meet_layers(std::numeric_limits<double>::infinity());
  return pixel;
}

}  // namespace

CameraRay camera_ray(const Camera& camera, int width, int height, int px, int py) {
  const Vector3d forward = normalize(camera.target - camera.eye);
  const Vector3d x = normalize(cross(forward, camera.up));
  const Vector3d y = cross(x, forward);
  const double half_height = camera.orthographic_height
                                 ? *camera.orthographic_height / 2
                                 : std::tan(camera.fov_degrees * std::numbers::pi / 180 / 2);
  const double u = (2 * (px + 0.5) / width - 1) * half_height * width / height;
  const double v = (1 - 2 * (py + 0.5) / height) * half_height;
  if (camera.orthographic_height) return {camera.eye + (u * x + v * y), forward};
  return {camera.eye, forward + u * x + v * y};
}

Bounds3d volume_box(const std::vector<std::vector<ParticleKernel>>& fields) {
  Bounds3d centers;
  double largest = 0;
  for (const auto& kernels : fields) {
    for (const ParticleKernel& kernel : kernels) {
      centers.add(kernel.center);
      largest = std::max(largest, kernel.support_radius);
    }
  }
  return centers.empty() ? centers : centers.extended(largest);
}

Classified classify(const TransferFunction& transfer_function, double value) {
  const auto& points = transfer_function.points;
  const auto at = [](const TransferFunction::Point& p) {
    return Classified{p.color.r, p.color.g, p.color.b, p.extinction};
  };
  // Clamped at both ends; below the first point also catches what has no logarithm.
  if (value <= points.front().value) return at(points.front());
  if (value >= points.back().value) return at(points.back());
  std::size_t i = 1;
  while (points[i].value < value) ++i;
  const auto scale = [&](double v) { return transfer_function.log_scale ? std::log10(v) : v; };
  const double low = scale(points[i - 1].value), high = scale(points[i].value);
  const double t = (scale(value) - low) / (high - low);
  const Classified a = at(points[i - 1]), b = at(points[i]);
  return {a.red + t * (b.red - a.red), a.green + t * (b.green - a.green),
          a.blue + t * (b.blue - a.blue), a.extinction + t * (b.extinction - a.extinction)};
}

Classified shade(const Classified& sample, const Lighting& lighting,
                 const std::optional<Vector3d>& normal, const Vector3d& view) {
  double body = lighting.ambient, highlight = 0;
  for (const LightSource& light : lighting.lights) {
    const Vector3d to_light = light.direction ? normalize(*light.direction) : view;
    double n_dot_l = 0, n_dot_h = 0;
    if (normal) {
      n_dot_l = dot(*normal, to_light);
      // A light straight behind the sample has no halfway vector, and no highlight.
      const Vector3d halfway = to_light + view;
      if (length(halfway) > 0) n_dot_h = dot(*normal, normalize(halfway));
    }
    body += light.intensity * lighting.diffuse * std::abs(n_dot_l);
    highlight +=
        light.intensity * lighting.specular * std::pow(std::abs(n_dot_h), lighting.shininess);
  }
  return {sample.red * body + highlight, sample.green * body + highlight,
          sample.blue * body + highlight, sample.extinction};
}

void composite(RayColor& ray, const Classified& sample, double step_length) {
  const double alpha = 1 - std::exp(-sample.extinction * step_length);
  const double visible = (1 - ray.alpha) * alpha;
  ray.red += visible * sample.red;
  ray.green += visible * sample.green;
  ray.blue += visible * sample.blue;
  ray.alpha += visible;
}

Image render(const ParticleSet& particles, const ResolvedScene& scene,
             const std::vector<std::vector<Layer>>& layers) {
  assert(scene.step_size > 0);
  assert(scene.fields.size() == scene.transfer_functions.size());
  const Volume volume = make_volume(particles, scene);
  const int width = scene.render.width, height = scene.render.height;
  std::vector<Pixel> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels.size()), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const auto pixel = static_cast<int>(i);
      const std::vector<Layer> none;
      pixels[i] = render_pixel(volume, scene, layers.empty() ? none : layers[i], pixel % width,
                               pixel / width);
    }
  });

  Image image;
  image.width = width;
  image.height = height;
  for (const Pixel& pixel : pixels) {
    const RayColor& c = pixel.color;
    image.rgba.insert(image.rgba.end(), {c.red, c.green, c.blue, c.alpha});
    image.unstable.push_back(pixel.unstable || pixel.faint ? 1 : 0);
    image.faint.push_back(pixel.faint ? 1 : 0);
    image.samples += pixel.samples;
    image.kernel_evaluations += pixel.kernel_evaluations;
  }
  return image;
}

}  // namespace motes::reference
