#include "surface/phong.h"

#include <algorithm>
#include <cmath>

namespace motes {
namespace {

/// s c + plus
Color scaled(const Color& c, double s, double plus) {
  const auto channel = [&](float x) {
    return static_cast<float>(s * static_cast<double>(x) + plus);
  };
  return {channel(c.r), channel(c.g), channel(c.b)};
}

/// The cosine of a normal's angle with the halfway vector; 0 where there is none, the light being
/// straight behind. (A grid's surface that is seen from the side may face it all the same.)
double mirrored_by(const Vector3d& halfway, const Vector3d& normal) {
  const double square = dot(halfway, halfway);
  return square > 0 ? std::max(dot(normal, halfway) / std::sqrt(square), 0.0) : 0;
}

}  // namespace

Vector3d unit(const Vector3d& v) { return v / std::sqrt(dot(v, v)); }

Color phong(const Lighting& lighting, const Color& base, const Vector3d& normal,
            const Vector3d& view, const Light& light) {
  const double sky = static_cast<double>(light.sky);
  if (!lighting.enabled) return scaled(base, sky, 0);
  double body = lighting.ambient * sky, highlight = 0;
  for (std::size_t l = 0; l < lighting.lights.size(); ++l) {
    const auto& [direction, intensity] = lighting.lights[l];
    // What a headlight does not reach would lie behind what is seen: the open sky stands for it.
    const double lit = intensity * (direction ? static_cast<double>(light.lamps[l]) : sky);
    const double cosine = dot(normal, direction.value_or(view));
    if (!(cosine > 0) || lit == 0) continue;
    const double mirrored = direction ? mirrored_by(*direction + view, normal) : cosine;
    const float gloss =
        std::pow(static_cast<float>(mirrored), static_cast<float>(lighting.shininess));
    body += lit * lighting.diffuse * cosine;
    highlight += lit * lighting.specular * static_cast<double>(gloss);
  }
  return scaled(base, body, highlight);
}

}  // namespace motes
