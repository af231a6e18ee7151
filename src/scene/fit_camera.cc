// A camera that shows all of the data from a pleasing side.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "particles/minimum_image.h"
#include "scene/fit.h"
#include "scene/fit_levels.h"

namespace motes {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double margin = 0.96;       // of the image, that the data may fill
constexpr double default_fov = 45;    // degrees
constexpr double widest = 75;         // degrees across: beyond that balls become ellipses
constexpr double nearly_cubic = 0.8;  // thinnest by largest side
constexpr double flat = 1e-3;         // likewise: seen straight, as obliquely it would be a line
constexpr double nearly_parallel = 0.99;  // cosine
// Of the diagonal, from the eye to the first of the data: a few atoms behind each other are to look
// about as large as they are, unless the scene asks for another view.
constexpr double in_front = 0.3, in_front_of_own_fov = 0.05;
constexpr double easily_seen = 1.75;  // standard deviations: there a Gaussian is at a fifth
constexpr double large = 2.5;         // times the middle radius
constexpr std::size_t particles_looked_at = 1 << 18;  // of one field
constexpr std::size_t samples_looked_at = 1 << 20;    // of one grid

// Strays: one particle in so many at most, farther out than this times the extent of the others.
constexpr std::size_t stray_share = 1000;
constexpr double stray_distance = 0.5;

Vector3d unit(int axis) {
  Vector3d v;
  v[axis] = 1;
  return v;
}

/// Axis along which the box is thinnest, z where none is much thinner.
int viewing_axis(const Vector3d& sides) {
  int thinnest = 2;
  for (int axis = 0; axis < 2; ++axis) {
    if (sides[axis] < sides[thinnest]) thinnest = axis;
  }
  const double largest = std::max({sides.x, sides.y, sides.z});
  return sides[thinnest] < nearly_cubic * largest ? thinnest : 2;
}

/// From the target towards the eye, not of unit length.
Vector3d direction_to_eye(const Vector3d& sides, const Vector3d* up) {
  const double largest = std::max({sides.x, sides.y, sides.z});
  int axis = viewing_axis(sides);
  if (up != nullptr && std::abs(normalize(*up)[axis]) > nearly_parallel) axis = axis == 2 ? 1 : 2;
  // From the front, a little from the right and from above.
  const Vector3d above = up != nullptr ? normalize(*up) : unit(axis == 2 ? 1 : 2);
  Vector3d front = axis == 1 ? -unit(axis) : unit(axis);
  const Vector3d right = cross(above, front);
  if (sides[axis] < flat * largest) return front;
  return front + 0.4 * right + 0.3 * above;
}

/// The default, or less in wide pictures.
double fov_for(double aspect) {
  constexpr double degree = std::numbers::pi / 180;
  return std::min(default_fov, 2 * std::atan(std::tan(widest / 2 * degree) / aspect) / degree);
}

/// The direction that is up where the scene does not say: the axis among y and z (in this order)
/// that is far enough from the view.
Vector3d default_up(const Vector3d& view, int axis) {
  const Vector3d first = unit(axis == 2 ? 1 : 2), second = unit(axis == 2 ? 2 : 1);
  return std::abs(dot(normalize(view), first)) < nearly_parallel ? first : second;
}

/// The largest of `values`, without those of strays; reorders them. Precondition: not empty.
double largest_but_strays(std::vector<double>& values) {
  const std::size_t strays = values.size() / stray_share;
  const double largest = *std::max_element(values.begin(), values.end());
  const auto at = [&values](std::size_t rank) {
    const auto it = values.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(values.begin(), it, values.end());
    return *it;
  };
  const double high = at(values.size() - 1 - strays), low = at(strays);
  return largest - high > stray_distance * (high - low) ? high : largest;
}

/// The largest of measure(sphere), without strays'.
template <class F>
double largest_of(const std::vector<VisibleSphere>& spheres, F&& measure) {
  std::vector<double> values(spheres.size());
  std::transform(spheres.begin(), spheres.end(), values.begin(), measure);
  return largest_but_strays(values);
}

Bounds3d box_of(const std::vector<VisibleSphere>& spheres) {
  Point3d corner[2];
  for (int axis = 0; axis < 3; ++axis) {
    corner[0][axis] =
        -largest_of(spheres, [axis](const VisibleSphere& s) { return s.radius - s.center[axis]; });
    corner[1][axis] =
        largest_of(spheres, [axis](const VisibleSphere& s) { return s.radius + s.center[axis]; });
  }
  return {corner[0], corner[1]};
}

/// Some of the numbers of a grid's samples along an axis: the first, the last and every `stride`-th
/// between them. Of a periodic one the sample behind the last is the first's image.
std::vector<std::size_t> some_samples(const Grid& grid, std::size_t axis, std::size_t stride) {
  const std::size_t last = grid.periodic ? grid.dims[axis] : grid.dims[axis] - 1;
  std::vector<std::size_t> samples;
  for (std::size_t i = 0; i < last; i += stride) samples.push_back(i);
  samples.push_back(last);
  return samples;
}

/// The ends of each of the grid's lines of samples along x in which there is something to be seen:
/// magnitudes of three tenths of the level that encloses most of the field if it `draws_volume`, or
/// of an isosurface at `least_level`. Its corners if there is nothing. Large grids are looked at
/// here and there.
std::vector<Point3d> visible_points(const Grid& grid, bool draws_volume, double least_level) {
  const double excess = static_cast<double>(grid.size()) / samples_looked_at;
  const auto stride = static_cast<std::size_t>(std::max(1.0, std::ceil(std::cbrt(excess))));
  const auto columns = some_samples(grid, 0, stride), rows = some_samples(grid, 1, stride),
             layers = some_samples(grid, 2, stride);
  std::vector<float> values;
  for (const std::size_t k : layers) {
    for (const std::size_t j : rows) {
      for (const std::size_t i : columns) {
        const auto& dims = grid.dims;
        values.push_back(grid.values[grid.index(i % dims[0], j % dims[1], k % dims[2])]);
      }
    }
  }
  double least = least_level;
  if (draws_volume) {
    least = std::min(least, 0.3 * enclosing_level(values, signs_of(values)));
  }
  const auto seen = [least](float value) { return std::abs(static_cast<double>(value)) >= least; };
  std::vector<Point3d> points;
  const float* line = values.data();
  for (const std::size_t k : layers) {
    for (const std::size_t j : rows) {
      const auto add = [&](std::ptrdiff_t n) {
        const std::size_t i = columns[static_cast<std::size_t>(n)];
        points.push_back(
            grid.position(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)));
      };
      const float* const end = line + columns.size();
      const float* const first = std::find_if(line, end, seen);
      if (first != end) {
        const float* last = end - 1;
        while (!seen(*last)) --last;
        // (up to where nothing is seen)
        add(std::max(first - line - 1, std::ptrdiff_t{0}));
        add(std::min(last - line + 1, end - line - 1));
      }
      line = end;
    }
  }
  if (points.empty()) {
    const auto corners = corners_of(grid);
    points.assign(corners.begin(), corners.end());
  }
  return points;
}

/// Whether field f does; those that are not there say nothing else.
bool draws_volume(const std::vector<Field>& fields, std::size_t f) {
  return f >= fields.size() || fields[f].draws_volume();
}

/// The least magnitude of the isosurfaces of field f; infinity if it has none.
double least_level_of(const std::vector<Field>& fields, std::size_t f) {
  double least = infinity;
  if (f >= fields.size()) return least;
  for (const Isosurface& isosurface : fields[f].isosurfaces) {
    least = std::min(least, std::abs(isosurface.value));
  }
  return least;
}

/// Calls use(i) with `particles_looked_at` or more of the numbers below `count`.
template <class F>
void for_some(std::size_t count, std::mt19937& random, F&& use) {
  const std::size_t stride = 1 + count / particles_looked_at;
  // (evenly many would beat with a lattice)
  for (std::size_t begin = 0; begin < count; begin += stride) {
    use(std::min(begin + random() % stride, count - 1));
  }
}

/// Where a kernel that is `height` times a level high falls to it, in radii; its support where the
/// shape may rise again.
double distance_to_level(const Kernel& kernel, double height) {
  double low = 0, high = kernel.support();
  if (kernel.shape.type == KernelType::tabulated || height == infinity) return high;
  if (!(height > 1)) return 0;
  for (int step = 0; step < 40; ++step) {
    const double middle = (low + high) / 2;
    (height * evaluate(kernel, middle).value > 1 ? low : high) = middle;
  }
  return high;
}

/// Adds field f's particles with how far its isosurfaces may lie from them. If p is what a plane
/// has of a point x at distance d, and all particles lie behind the plane, then Φ(x) <= shape(d)
/// Φ(p) for Gaussians of one sigma, and about so for others. So the surface lies at most so far
/// beyond a plane that touches the particles as shape(d) Φ takes to fall to the level, with Φ on
/// the plane, which is not much more than at the particles next to it.
void add_isosurfaces(const ParticleSet& particles, const FieldSource& source, const Field& field,
                     std::size_t f, const FieldValuesAt& values_at, std::mt19937& random,
                     std::vector<VisibleSphere>& spheres) {
  constexpr double between = 1.25;  // more between particles than at them
  std::vector<std::size_t> chosen;
  std::vector<Point3d> centers;
  for_some(source.index.size(), random, [&](std::size_t i) {
    chosen.push_back(i);
    centers.push_back(particles.position(source.index[i]));
  });
  const auto [least, most] = std::minmax_element(source.weight.begin(), source.weight.end());
  const bool both_signs = *least < 0 && *most > 0;
  std::vector<double> values(chosen.size(), infinity);
  if (values_at && !both_signs) values = values_at(f, centers);
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    double height = 0;  // over that of the level that lies farthest out
    for (const Isosurface& isosurface : field.isosurfaces) {
      const bool anywhere = std::isinf(values[k]) || isosurface.value == 0;
      height = std::max(height, anywhere ? infinity : between * values[k] / isosurface.value);
    }
    const double radii = distance_to_level(source.kernel, height);
    spheres.push_back({centers[k], radii * source.radius_of(chosen[k])});
  }
}

/// How far a point lies beyond a plane.
double beyond(const ClipPlane& plane, const Point3d& p) {
  return (dot(plane.normal, p - Point3d{}) - plane.distance) / length(plane.normal);
}

/// Takes out the spheres that lie beyond a plane, from number `first` on: their centres or, if
/// `in_part` counts, all of them.
void cut_spheres(const std::vector<ClipPlane>& planes, std::size_t first, bool in_part,
                 std::vector<VisibleSphere>& spheres) {
  const auto is_cut = [&](const VisibleSphere& sphere) {
    return std::any_of(planes.begin(), planes.end(), [&](const ClipPlane& plane) {
      return beyond(plane, sphere.center) > (in_part ? sphere.radius : 0);
    });
  };
  spheres.erase(
      std::remove_if(spheres.begin() + static_cast<std::ptrdiff_t>(first), spheres.end(), is_cut),
      spheres.end());
}

/// Cuts the lines between points 0 and 1, 2 and 3, ... off at the planes.
void cut_lines(const std::vector<ClipPlane>& planes, std::vector<Point3d>& points) {
  for (const ClipPlane& plane : planes) {
    std::size_t size = 0;
    for (std::size_t i = 0; i + 1 < points.size(); i += 2) {
      Point3d ends[2] = {points[i], points[i + 1]};
      const double outside[2] = {beyond(plane, ends[0]), beyond(plane, ends[1])};
      if (outside[0] > 0 && outside[1] > 0) continue;
      const Point3d at_plane =
          ends[0] + outside[0] / (outside[0] - outside[1]) * (ends[1] - ends[0]);
      for (int end = 0; end < 2; ++end) {
        points[size++] = outside[end] > 0 ? at_plane : ends[end];
      }
    }
    points.resize(size);
  }
}

/// Adds what is to be seen of all grids, as often as it takes to be no strays.
void add_grids(const std::vector<FieldSource>& sources, const std::vector<Field>& fields,
               const std::vector<ClipPlane>& planes, std::vector<VisibleSphere>& spheres) {
  constexpr std::size_t parts = 8;  // of a grid, none of which is a stray
  const std::size_t others = spheres.size();
  for (std::size_t f = 0; f < sources.size(); ++f) {
    if (!sources[f].grid) continue;
    std::vector<Point3d> points =
        visible_points(*sources[f].grid, draws_volume(fields, f), least_level_of(fields, f));
    cut_lines(planes, points);
    if (points.empty()) continue;
    const std::size_t times = 1 + parts * others / (stray_share * points.size());
    for (std::size_t n = 0; n < times; ++n) {
      for (const Point3d& point : points) spheres.push_back({point, 0});
    }
  }
}

/// How a camera moves from its target to where it sees all.
struct Placing {
  Vector3d shift;  ///< of the target, across the view
  double distance = 0;
};

/// As near as all spheres allow where half of the image's height is `tangent` at depth 1; the shift
/// is 0 unless it `may_shift`. With the camera moved by (x, y) across the view, a sphere of radius
/// r at (u, v, w) in camera axes about the target is in the image where |u - x| + r sqrt(1 +
/// tan_x^2) <= tan_x (distance + w), and so in y.
Placing place_camera(const std::vector<VisibleSphere>& spheres, const Camera& camera,
                     const CameraAxes& axes, double aspect, double tangent, bool may_shift) {
  const double tan_x = tangent * aspect, tan_y = tangent;
  // Smallest distance that shows all spheres on one side, towards `across`.
  const auto distance_for = [&](const Vector3d& across, double tan) {
    const double around = std::sqrt(1 + tan * tan);
    return largest_of(spheres, [&](const VisibleSphere& sphere) {
      const Vector3d v = sphere.center - camera.target;
      const double w = camera.orthographic_height ? 0 : dot(v, axes.forward);
      return (dot(v, across) + sphere.radius * around) / tan - w;
    });
  };
  const double right = distance_for(axes.x, tan_x), left = distance_for(-axes.x, tan_x);
  const double top = distance_for(axes.y, tan_y), bottom = distance_for(-axes.y, tan_y);
  if (!may_shift) return {{}, std::max({right, left, top, bottom})};
  return {tan_x * (right - left) / 2 * axes.x + tan_y * (top - bottom) / 2 * axes.y,
          std::max(right + left, top + bottom) / 2};
}

/// The same, but no nearer than `least`: as if the view were less wide, if it must be.
template <class Place>
Placing place_in_front(const Place& place, double tangent, double least) {
  Placing placing = place(tangent);
  if (placing.distance >= least) return placing;
  double low = std::min(tangent, 0.01), high = tangent;
  for (int step = 0; step < 20; ++step) {
    const double middle = std::sqrt(low * high);
    (place(middle).distance < least ? high : low) = middle;
  }
  placing = place(low);
  placing.distance = std::max(placing.distance, least);
  return placing;
}

/// Takes for smaller what is far larger than is typical.
void limit_radii(std::vector<VisibleSphere>& spheres) {
  if (spheres.empty()) return;
  std::vector<double> radii(spheres.size());
  std::transform(spheres.begin(), spheres.end(), radii.begin(),
                 [](const VisibleSphere& sphere) { return sphere.radius; });
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  for (VisibleSphere& sphere : spheres) sphere.radius = std::min(sphere.radius, large * *middle);
}

/// Adds balls, and the ends of half-bonds that leave the cell; other sticks lie between balls that
/// are as wide.
void add_geometry(const ParticleSet& particles, const GeometrySource& geometry,
                  std::mt19937& random, std::vector<VisibleSphere>& spheres) {
  for_some(geometry.index.size(), random, [&](std::size_t i) {
    spheres.push_back({particles.position(geometry.index[i]), geometry.radius_of(i)});
  });
  const MinimumImage image(particles.cell);
  if (image.edges().empty()) return;
  for_some(geometry.bonds.size(), random, [&](std::size_t b) {
    const Bond& bond = geometry.bonds[b];
    const Point3d first = particles.position(bond.first), second = particles.position(bond.second);
    const Vector3d across = image(second - first) + image.shift(bond.image);
    const double shift = length(across - (second - first));
    if (!(shift > 1e-6 * length(across))) return;
    spheres.push_back({first + 0.5 * across, geometry.stick_radius});
    spheres.push_back({second - 0.5 * across, geometry.stick_radius});
  });
}

}  // namespace

std::vector<VisibleSphere> visible_spheres(const ParticleSet& particles,
                                           const std::vector<FieldSource>& sources,
                                           const GeometrySource& geometry,
                                           const std::vector<Field>& fields,
                                           const FieldValuesAt& values_at,
                                           const std::vector<ClipPlane>& clip_planes) {
  std::vector<VisibleSphere> spheres;
  std::mt19937 random(1);
  for (std::size_t f = 0; f < sources.size(); ++f) {
    const FieldSource& source = sources[f];
    if (!draws_volume(fields, f)) continue;
    const double widths = source.kernel.support() / source.kernel.standard_deviation();
    const double extent = std::min(widths, easily_seen);
    for_some(source.index.size(), random, [&](std::size_t i) {
      spheres.push_back({particles.position(source.index[i]), extent * source.width_of(i)});
    });
  }
  limit_radii(spheres);
  for (std::size_t f = 0; f < std::min(fields.size(), sources.size()); ++f) {
    if (sources[f].grid || fields[f].isosurfaces.empty()) continue;
    add_isosurfaces(particles, sources[f], fields[f], f, values_at, random, spheres);
  }
  cut_spheres(clip_planes, 0, true, spheres);
  const std::size_t of_fields = spheres.size();
  add_geometry(particles, geometry, random, spheres);
  cut_spheres(clip_planes, of_fields, false, spheres);
  add_grids(sources, fields, clip_planes, spheres);
  if (spheres.empty() && !clip_planes.empty()) {
    return visible_spheres(particles, sources, geometry, fields, values_at);
  }
  // Nothing is drawn: the place where something could be.
  if (const Bounds3d box = particles.bounds(); spheres.empty() && !box.empty()) {
    spheres = {{box.min, 0}, {box.max, 0}};
  }
  return spheres;
}

Camera fit_camera(const Scene& scene, const std::vector<VisibleSphere>& spheres, double aspect) {
  if (scene.eye && scene.target && scene.up) {
    const Camera given{*scene.eye, *scene.target, *scene.up,
                       scene.fov_degrees.value_or(default_fov), scene.orthographic_height};
    camera_axes(given);
    return given;
  }
  const Bounds3d box = box_of(spheres);
  const Vector3d sides = box.diagonal();
  const double diagonal = length(sides) > 0 ? length(sides) : 1;
  Camera camera;
  camera.fov_degrees = scene.fov_degrees.value_or(scene.eye ? default_fov : fov_for(aspect));
  camera.orthographic_height = scene.orthographic_height;
  camera.target = scene.target.value_or(box.center());
  // (by the diagonal: so that it is told apart from the target, however large all is)
  camera.eye = scene.eye.value_or(
      camera.target + diagonal * direction_to_eye(sides, scene.up ? &*scene.up : nullptr));
  if (scene.eye && !scene.target && camera.eye == camera.target) {
    camera.target = camera.eye - diagonal * direction_to_eye(sides, nullptr);
  }
  camera.up = scene.up.value_or(default_up(camera.target - camera.eye, viewing_axis(sides)));
  const CameraAxes axes = camera_axes(camera);
  if (scene.eye) return camera;

  // Depth of a sphere's nearest point from the target on.
  const auto front = [&, target = camera.target](const VisibleSphere& sphere) {
    return dot(sphere.center - target, axes.forward) - sphere.radius;
  };
  const auto place = [&](double tangent) {
    return place_camera(spheres, camera, axes, aspect, tangent, !scene.target);
  };
  if (camera.orthographic_height) {
    const Placing placing = place(margin);
    camera.target = camera.target + placing.shift;
    // In front of all, strays too.
    double nearest = 0;
    for (const VisibleSphere& sphere : spheres) nearest = std::max(nearest, -front(sphere));
    camera.eye = camera.target - (nearest + 0.01 * diagonal) * axes.forward;
    return camera;
  }
  const double nearest = largest_of(spheres, [&](const VisibleSphere& s) { return -front(s); });
  const double tangent = margin * std::tan(camera.fov_degrees * std::numbers::pi / 360);
  const double room = diagonal * (scene.fov_degrees ? in_front_of_own_fov : in_front);
  // (also behind a target that lies before all of it)
  const Placing placing = place_in_front(place, tangent, std::max(nearest, 0.0) + room);
  camera.target = camera.target + placing.shift;
  camera.eye = camera.target - placing.distance * axes.forward;
  return camera;
}

}  // namespace motes
