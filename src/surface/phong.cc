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

}  // namespace

Vector3d unit(const Vector3d& v) { return v / std::sqrt(dot(v, v)); }

Color phong(const Lighting& lighting, const Color& base, const Vector3d& normal,
            const Vector3d& view, const Light& light) {
  const double sky = static_cast<double>(light.sky);
  if (!lighting.enabled) return scaled(base, sky, 0);
  const Vector3d lamp = lighting.direction.value_or(view);
  // What a headlight does not reach would lie behind what is seen: the open sky stands for it.
  const double lit = lighting.direction ? static_cast<double>(light.lamp) : sky;
  const double cosine = dot(normal, lamp);
  if (!(cosine > 0) || lit == 0) return scaled(base, lighting.ambient * sky, 0);
  const double mirrored =
      lighting.direction ? std::max(dot(normal, unit(lamp + view)), 0.0) : cosine;
  const float gloss =
      std::pow(static_cast<float>(mirrored), static_cast<float>(lighting.shininess));
  return scaled(base, lighting.ambient * sky + lit * lighting.diffuse * cosine,
                lit * lighting.specular * static_cast<double>(gloss));
}

}  // namespace motes
