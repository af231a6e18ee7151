#include "render/make_surface.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "particles/bonds.h"
#include "scene/transfer_function.h"
#include "surface/find_bonds.h"
#include "surface/make_sticks.h"

namespace motes {
namespace {

/// For each kernel its number among the drawn particles, once for each of these.
UninitializedVector<std::uint32_t> find_drawn(
    const std::vector<bool>& is_drawn, const UninitializedVector<std::uint32_t>& particle_of) {
  std::vector<std::uint32_t> number(is_drawn.size(), not_drawn);
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < is_drawn.size(); ++i) {
    if (is_drawn[i]) number[i] = count++;
  }
  UninitializedVector<std::uint32_t> drawn(particle_of.size());
  for (std::size_t i = 0; i < particle_of.size(); ++i) {
    drawn[i] = std::exchange(number[particle_of[i]], not_drawn);
  }
  return drawn;
}

void set_radii(const GeometrySource& geometry, const UninitializedVector<std::uint32_t>& drawn,
               double length_scale, Surface& surface) {
  const auto scale = static_cast<float>(length_scale);
  const auto [least, most] = std::minmax_element(geometry.radius.begin(), geometry.radius.end());
  const bool all = std::find(drawn.begin(), drawn.end(), not_drawn) == drawn.end();
  if (all && *least == *most) {
    surface.radius.share(*most * scale);
    return;
  }
  surface.radius.allocate(drawn.size());
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    surface.radius.at(i) = drawn[i] == not_drawn ? 0 : geometry.radius_of(drawn[i]) * scale;
  }
}

/// Numbers colours in the order in which they come, as many as a byte tells apart. There may be one
/// for each of millions of particles: a table that is never half full finds them in a step or two.
class Palette {
 public:
  static constexpr std::size_t max_size = 256;

  /// nullopt where there is no room for one more.
  std::optional<std::uint8_t> number_of(std::uint32_t srgb) {
    std::size_t slot = (srgb * 2654435761U) >> 22;
    while (used_[slot]) {
      if (key_[slot] == srgb) return number_[slot];
      slot = (slot + 1) % slots;
    }
    if (size_ == max_size) return std::nullopt;
    used_[slot] = true;
    key_[slot] = srgb;
    number_[slot] = static_cast<std::uint8_t>(size_++);
    return number_[slot];
  }

 private:
  static constexpr std::size_t slots = 1024;  // 2^(32 - 22)
  std::array<bool, slots> used_{};
  std::array<std::uint32_t, slots> key_{};
  std::array<std::uint8_t, slots> number_{};
  std::size_t size_ = 0;
};

/// One colour for all, a palette where it has room for them, or each particle's own.
void set_colors(const GeometrySource& geometry, const UninitializedVector<std::uint32_t>& drawn,
                SurfaceColors& colors) {
  colors.palette.clear();
  Palette palette;
  std::vector<std::uint8_t> number;
  number.reserve(geometry.srgb.size());
  for (const std::uint32_t srgb : geometry.srgb) {
    const auto found = palette.number_of(srgb);
    if (!found) break;
    if (*found == colors.palette.size()) colors.palette.push_back(color_from_srgb(srgb & 0xffffff));
    number.push_back(*found);
  }
  if (colors.palette.size() == 1) return;
  const auto drawn_or_first = [&](std::size_t i) { return drawn[i] == not_drawn ? 0 : drawn[i]; };
  if (number.size() == geometry.srgb.size()) {
    colors.index.resize(drawn.size());
    for (std::size_t i = 0; i < drawn.size(); ++i) colors.index[i] = number[drawn_or_first(i)];
  } else {
    colors.srgb.resize(drawn.size());
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      colors.set_srgb(i, geometry.srgb[drawn_or_first(i)]);
    }
  }
}

}  // namespace

Surface make_surface(const ParticleSet& particles, GeometrySource& geometry,
                     const std::vector<bool>& is_drawn, const std::vector<FieldSource>& sources,
                     const KernelOrder& order, const KernelSet& kernels,
                     FieldValues& field_values) {
  Surface surface;
  surface.kernels = &kernels;
  const auto particle_of = particles_in_order(sources, order);
  const auto drawn = find_drawn(is_drawn, particle_of);
  set_radii(geometry, drawn, kernels.length_scale, surface);
  set_colors(geometry, drawn, surface.colors);
  field_values = find_field_values(kernels, geometry, particle_of, drawn);
  if (!geometry.bonds_among.empty()) {
    // Both sorted: those of the file, which there may be too, are mostly found again.
    std::vector<Bond> found = find_bonds(particles, geometry.bonds_among, particle_of, kernels);
    if (!geometry.bonds.empty()) {
      const std::vector<Bond> of_file = std::exchange(geometry.bonds, {});
      std::set_union(of_file.begin(), of_file.end(), found.begin(), found.end(),
                     std::back_inserter(geometry.bonds), bond_comes_first);
    } else {
      geometry.bonds = std::move(found);
    }
  }
  if (!geometry.bonds.empty()) {
    surface.sticks = make_sticks(particles, geometry.bonds, particle_of, kernels,
                                 static_cast<float>(geometry.stick_radius * kernels.length_scale));
  }
  fit_reach(surface);
  return surface;
}

std::optional<FieldSource> find_drawn_only(const ParticleSet& particles,
                                           const GeometrySource& geometry,
                                           const std::vector<FieldSource>& sources) {
  std::vector<bool> in_field(particles.size());
  for (const FieldSource& source : sources) {
    for (const std::uint32_t i : source.index) in_field[i] = true;
  }
  const auto is_missing = [&](std::uint32_t i) { return !in_field[i]; };
  FieldSource drawn_only;
  drawn_only.drawn_only = true;
  // (room for just so many: there may be tens of millions)
  drawn_only.index.reserve(static_cast<std::size_t>(
      std::count_if(geometry.index.begin(), geometry.index.end(), is_missing)));
  std::copy_if(geometry.index.begin(), geometry.index.end(), std::back_inserter(drawn_only.index),
               is_missing);
  if (drawn_only.index.empty()) return std::nullopt;
  // A radius that fields have keeps theirs in one number, if it is; else the view is fitted by it.
  const float largest = *std::max_element(geometry.radius.begin(), geometry.radius.end());
  const auto of_particles =
      std::find_if(sources.begin(), sources.end(), [](const FieldSource& s) { return !s.grid; });
  const bool any = of_particles != sources.end();
  drawn_only.radius = {any ? of_particles->radius[0] : 0.5F * largest};
  drawn_only.weight = {any ? of_particles->weight[0] : 1.0F};
  return drawn_only;
}

std::vector<bool> pack_index(GeometrySource& geometry, std::size_t num_particles) {
  std::vector<bool> is_drawn(num_particles);
  for (const std::uint32_t i : std::exchange(geometry.index, {})) is_drawn[i] = true;
  return is_drawn;
}

void unpack_index(const std::vector<bool>& is_drawn, GeometrySource& geometry) {
  geometry.index.reserve(
      static_cast<std::size_t>(std::count(is_drawn.begin(), is_drawn.end(), true)));
  for (std::uint32_t i = 0; i < is_drawn.size(); ++i) {
    if (is_drawn[i]) geometry.index.push_back(i);
  }
}

}  // namespace motes
