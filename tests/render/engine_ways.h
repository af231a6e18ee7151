// All the ways in which a picture can be made, for tests that take each of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "image/framebuffer.h"
#include "render/renderer.h"
#include "scene/scene.h"

namespace motes {

struct Way {
  std::string instruction_set;
  Engine engine = Engine::coherent;
  std::optional<int> samples_per_pass;

  std::string name() const;
};

/// Every engine on every instruction set that this machine has: the coherent one in passes of the
/// default size, in one, and in passes of an odd size.
std::vector<Way> all_ways();

Framebuffer render_in(const Way& way, const Renderer& renderer, ResolvedScene scene,
                      int threads = 2, RenderStatistics* statistics = nullptr,
                      const LayerSource& layers = {});

}  // namespace motes
