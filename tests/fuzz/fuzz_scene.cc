// Feeds the scene parser with any bytes: it gives a scene that survives being written and read
// again, or throws Error.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/error.h"
#include "scene/scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  motes::Scene scene;
  try {
    scene = motes::parse_scene(text, "/scenes/scene.json");
  } catch (const motes::Error&) {
    return 0;  // a bad scene, refused
  }
  const std::string written = motes::scene_to_json(scene, "/scenes");
  if (!(motes::parse_scene(written, "/scenes/scene.json") == scene)) std::abort();
  return 0;
}
