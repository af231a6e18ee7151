// What pass 2 needs besides the transfer functions, in the units of the sample buffer.
#pragma once

#include <vector>

namespace motes {

struct LightConstants {
  bool headlight = true;
  /// Unless it is a headlight: unit vector towards the light, camera axes.
  float direction[3] = {0, 0, -1};
  float intensity = 1;
};

struct ShadingConstants {
  float termination_opacity = 0.97f;
  float max_ray_length = 1;  ///< largest |D| of the frame's rays
  float ambient = 1, diffuse = 0, specular = 0,
        shininess = 1;                 ///< used where the buffer has gradients
  std::vector<LightConstants> lights;  ///< at most max_lights
  /// There are clip planes: fields go on before rays' first samples and behind their last.
  bool clipped = false;
  std::vector<float> min_radius;  ///< internal length, one a field
};

}  // namespace motes
