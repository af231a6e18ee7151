// Stands for embree.cc and embree_spheres.cc where CMake finds no Embree.
#include "motes/bench/embree.h"
#include "motes/bench/embree_spheres.h"

namespace motes {

std::unique_ptr<EmbreeBuilder> make_embree_builder(int) { return nullptr; }

std::string_view name_of(EmbreeBuild) { return {}; }
std::string_view name_of(EmbreeRays) { return {}; }
std::unique_ptr<EmbreeSpheres> build_embree_spheres(std::span<const Sphere>, EmbreeBuild, int) {
  return nullptr;
}

}  // namespace motes
