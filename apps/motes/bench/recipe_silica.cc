// The fractured silica: copies of a block of glass, displaced as around a crack.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "motes/bench/carve.h"
#include "motes/bench/recipes.h"

namespace motes {
namespace {

/// A periodic self-affine surface (Hurst exponent 0.8) over the unit square, variance 1: what
/// fracture faces look like.
class RoughSurface {
 public:
  explicit RoughSurface(std::uint64_t seed) : heights_(size * size) {
    constexpr int max_wave = 16;
    constexpr double hurst = 0.8;
    const Random random(seed);
    std::uint64_t wave = 0;
    for (int kx = 0; kx <= max_wave; ++kx) {
      for (int ky = kx == 0 ? 1 : -max_wave; ky <= max_wave; ++ky) {
        const double amplitude = random.normal(2 * wave) * std::pow(std::hypot(kx, ky), -1 - hurst);
        const double phase = random.uniform(2 * wave + 1);
        add_wave(kx, ky, amplitude, phase);
        ++wave;
      }
    }
    double sum = 0;
    for (const double h : heights_) sum += h * h;
    const double deviation = std::sqrt(sum / static_cast<double>(heights_.size()));
    for (double& h : heights_) h /= deviation;
  }

  /// Bilinear; u and v of 0 or more.
  double operator()(double u, double v) const {
    const double x = u * size, y = v * size;
    const auto i = static_cast<std::size_t>(x), j = static_cast<std::size_t>(y);
    const double a = x - std::floor(x), b = y - std::floor(y);
    return std::lerp(std::lerp(at(i, j), at(i + 1, j), a),
                     std::lerp(at(i, j + 1), at(i + 1, j + 1), a), b);
  }

 private:
  static constexpr std::size_t size = 128;

  double at(std::size_t i, std::size_t j) const { return heights_[i % size * size + j % size]; }
  void add_wave(int kx, int ky, double amplitude, double phase) {
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j < size; ++j) {
        const double turns = (kx * static_cast<double>(i) + ky * static_cast<double>(j)) / size;
        heights_[i * size + j] += amplitude * std::cos(2 * std::numbers::pi * (turns + phase));
      }
    }
  }

  std::vector<double> heights_;
};

struct Cavity {
  Vector3d center, radii;
  bool contains(const Vector3d& p) const {
    const Vector3d d = p - center;
    return std::pow(d.x / radii.x, 2) + std::pow(d.y / radii.y, 2) + std::pow(d.z / radii.z, 2) <=
           1;
  }
};

/// Small cavities in a plume ahead of the crack's front.
std::vector<Cavity> make_cavities(const Vector3d& size, double front) {
  const Random random(2);
  std::vector<Cavity> cavities;
  for (std::uint64_t i = 0; i < 60; ++i) {
    const double ahead = -0.06 * size.x * std::log(1 - random.uniform(5 * i));
    const Vector3d center{front + ahead + 5,
                          0.5 * size.y + random.normal(5 * i + 1) * (0.04 * size.y + 0.25 * ahead),
                          random.uniform(5 * i + 2) * size.z};
    const double radius = random.uniform(5 * i + 3, 5, 14);
    cavities.push_back({center, {1.3 * radius, 0.8 * radius, radius}});
  }
  return cavities;
}

}  // namespace

ParticleSet make_fractured_silica(const ParticleSet& glass) {
  constexpr int copies[3] = {13, 5, 4};
  constexpr double opening = 80, roughness = 18, noise = 0.08;
  const Block block = make_block(glass);
  const Vector3d size{copies[0] * block.size.x, copies[1] * block.size.y, copies[2] * block.size.z};
  const double front = 0.62 * size.x;
  const RoughSurface face(4), front_line(5);
  const std::vector<Cavity> cavities = make_cavities(size, front);
  const Random random(1);
  ParticleSet atoms;
  atoms.species_names = glass.species_names;
  const auto place = [&](Vector3d p, std::uint64_t index, std::uint16_t species) {
    p = p + jitter(random, index, noise);
    if (std::ranges::any_of(cavities, [&p](const Cavity& c) { return c.contains(p); })) return;
    const double u = std::clamp(p.x / size.x, 0.0, 1.0), v = std::clamp(p.z / size.z, 0.0, 1.0);
    const double tip = front + 0.03 * size.x * front_line(v, 0.5);
    const double plane = 0.5 * size.y + roughness * face(u, v);
    const double width = opening / 2 * std::sqrt(std::max(0.0, (tip - p.x) / front));
    // The displacement fades away from the crack, as in a solid that is held at its far faces.
    const double fade = std::max(0.0, 1 - std::abs(p.y - plane) / (0.5 * size.y));
    p.y += (p.y > plane ? 1 : -1) * width * (0.75 + 0.25 * fade);
    add_atom(atoms, p, species);
  };
  std::uint64_t index = 0;
  for (int copy = 0; copy < copies[0] * copies[1] * copies[2]; ++copy) {
    const int i = copy / (copies[1] * copies[2]), j = copy / copies[2] % copies[1];
    const Vector3d corner{i * block.size.x, j * block.size.y, copy % copies[2] * block.size.z};
    for (std::size_t a = 0; a < block.positions.size(); ++a) {
      place(block.positions[a] + corner, index++, block.species[a]);
    }
  }
  return atoms;
}

}  // namespace motes
