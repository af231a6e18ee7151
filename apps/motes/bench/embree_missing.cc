// Stands for embree.cc where CMake finds no Embree.
#include "motes/bench/embree.h"

namespace motes {

std::unique_ptr<EmbreeBuilder> make_embree_builder(int) { return nullptr; }

}  // namespace motes
