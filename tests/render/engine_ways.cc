#include "render/engine_ways.h"

#include <fmt/format.h>

#include "render/render_tile.h"

namespace motes {

std::string Way::name() const {
  return fmt::format("{} on {}, {} samples a pass", name_of(engine), instruction_set,
                     samples_per_pass ? std::to_string(*samples_per_pass) : "default");
}

std::vector<Way> all_ways() {
  std::vector<Way> ways;
  for (const std::string& set : instruction_sets()) {
    for (const std::optional<int> samples_per_pass : {std::optional<int>{}, {0}, {7}}) {
      ways.push_back({set, Engine::coherent, samples_per_pass});
      ways.push_back({set, Engine::sweep, samples_per_pass});
    }
    ways.push_back({set, Engine::direct, {}});
    ways.push_back({set, Engine::cells, {}});
  }
  return ways;
}

Framebuffer render_in(const Way& way, const Renderer& renderer, ResolvedScene scene, int threads,
                      RenderStatistics* statistics, const LayerSource& layers) {
  force_instruction_set(way.instruction_set);
  scene.render.engine = way.engine;
  RenderOptions options;
  options.threads = threads;
  options.layers = layers;
  options.samples_per_pass = way.samples_per_pass;
  Framebuffer image = renderer.render(scene, options, statistics);
  force_instruction_set("");
  return image;
}

}  // namespace motes
