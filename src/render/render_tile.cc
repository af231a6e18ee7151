#include "render/render_tile.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/render_tile.cc"
#include <hwy/foreach_target.h>
// Included again for each instruction set.
#include <hwy/highway.h>

#include "core/flush_tiny.h"
#include "field/cells-inl.h"
#include "field/coherent-inl.h"
#include "field/direct-inl.h"
#include "integrate/integrate-inl.h"
#include "render/block_layers-inl.h"
#include "render/ray_packets.h"
#include "render/ray_state-inl.h"
#include "render/render_sweep-inl.h"
#include "render/sample_grids-inl.h"
#include "render/tile_output-inl.h"
#include "samples/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Pass 1 for one slab, by the engine and with the channels of the frame.
std::uint64_t sample_field(const FrameContext& context, const SamplingConstants& constants,
                           const RayPacket& packet, const RayState& rays, const Slab& slab,
                           SampleBuffer& buffer) {
  const auto sample = [&]<bool kGradients, bool kAbsolute>() {
    if (context.engine == Engine::cells) {
      return sample_cells<kGradients, kAbsolute>(*context.kernels, constants, *context.cells,
                                                 context.view, packet, rays, slab, buffer);
    }
    return context.engine == Engine::direct
               ? sample_direct<kGradients, kAbsolute>(*context.kernels, constants, context.view,
                                                      packet, slab, buffer)
               : sample_coherent<kGradients, kAbsolute>(*context.kernels, constants, context.view,
                                                        packet, slab, buffer);
  };
  if (context.gradients) {
    return context.absolute ? sample.template operator()<true, true>()
                            : sample.template operator()<true, false>();
  }
  return sample.template operator()<false, false>();
}

/// Pass 1 for one slab, of the fields that are grids.
void sample_grids(const FrameContext& context, const RayPacket& packet, const RayState& rays,
                  const Slab& slab, SampleBuffer& buffer) {
  const std::size_t stride = buffer.layout().floats_per_sample();
  for (const FrameGrid& grid : context.grids) {
    sample_frame_grid(grid, packet, rays.fields[grid.field], context.view.planes, slab,
                      context.gradients, context.absolute,
                      buffer.at(0, static_cast<int>(grid.field)), stride,
                      [&](int i) { buffer.touch(i, i); });
  }
}

/// The paper's multi-pass algorithm (section 4.2): slab by slab, sampling then integrating, until
/// all rays of the packet have ended. Returns kernel evaluations.
std::uint64_t render_packet(const FrameContext& context, const SamplingConstants& constants,
                            const Integrator& integrator, const RayPacket& packet,
                            SampleBuffer& buffer, BlockLayers* layers, RayState& rays,
                            StageClock& clock) {
  std::uint64_t evaluations = 0;
  for (SampleIndex k = rays.begin; k <= rays.end; k += context.samples_per_pass) {
    const Slab slab{k, std::min(rays.end - k + 1, context.samples_per_pass)};
    buffer.reserve(slab.count);
    if (context.any_kernels) {
      evaluations += sample_field(context, constants, packet, rays, slab, buffer);
    }
    sample_grids(context, packet, rays, slab, buffer);
    clock.lap(Stage::sums);
    integrator.run(slab, buffer, rays, layers);
    clear_touched(buffer);
    clock.lap(Stage::integrate);
  }
  if (layers != nullptr) integrator.finish(*layers, rays);
  return evaluations;
}

/// Packet by packet, as the paper does.
TileCounts render_packets(const FrameContext& context, const Tile& tile, Framebuffer& image) {
  const int lanes = static_cast<int>(hn::Lanes(LaneTag()));
  const int packet_width = lanes >= 8 ? 4 : 2, packet_height = lanes / packet_width;
  const SamplingConstants constants = make_constants(*context.kernels);
  const Integrator integrator(context.classifiers, context.shading, make_layout(context));
  SampleBuffer buffer(make_layout(context), std::min(context.samples_per_pass, 64));
  std::vector<FieldRange> fields(context.grids.empty() ? 0 : context.classifiers.size());
  TileLayers layers;
  BlockLayers block_layers;
  TileCounts counts;
  StageClock clock(counts.stages);
  if (context.layers) context.layers(tile, layers);
  for (int py = tile.y; py < tile.y + tile.height; py += packet_height) {
    for (int px = tile.x; px < tile.x + tile.width; px += packet_width) {
      const RayPacket packet = make_ray_packet(context, px, py, packet_width, packet_height);
      RayState rays;
      start_rays(context, px, py, packet_width, packet_height, fields.data(), rays);
      const bool cuts = context.has_cuts() && take_layers(context, layers, tile, px, py,
                                                          packet_width, block_layers, rays);
      clock.lap(Stage::setup);
      counts.kernel_evaluations += render_packet(context, constants, integrator, packet, buffer,
                                                 cuts ? &block_layers : nullptr, rays, clock);
      counts.samples += count_samples(rays);
      store_pixels(rays, px, py, packet_width, image);
    }
  }
  clock.lap(Stage::setup);
  return counts;
}

TileCounts render_tile(const FrameContext& context, const Tile& tile, Framebuffer& image) {
  const FlushTinyToZero guard;
  return context.engine == Engine::sweep ? render_sweep(context, tile, image)
                                         : render_packets(context, tile, image);
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <fmt/format.h>

#include <cctype>
#include <cstdlib>
#include <string_view>

#include "core/error.h"

namespace motes {
namespace {

HWY_EXPORT(render_tile);

/// Targets of this program that the machine has, best first.
std::vector<std::uint32_t> supported_targets() {
  hwy::SetSupportedTargetsForTest(0);
  std::vector<std::uint32_t> targets;
  // Highway numbers better targets lower.
  for (std::uint32_t bits = hwy::SupportedTargets() & HWY_TARGETS; bits != 0; bits &= bits - 1) {
    targets.push_back(bits & (~bits + 1));
  }
  return targets;
}

/// The instruction set's usual name; Highway calls AVX-512 AVX3.
std::string name_of(std::uint32_t target) {
  return target == HWY_AVX3 ? "AVX-512" : hwy::TargetName(target);
}

/// Upper case without punctuation: "avx512" and "AVX-512" are the same.
std::string folded(std::string_view name) {
  std::string out;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      out += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
  }
  return out;
}

void use_target(std::uint32_t target) {
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

/// The target in use; the first call reads MOTES_TARGET.
std::uint32_t& current_target() {
  static std::uint32_t target = 0;
  return target;
}

void choose_target_once() {
  static const bool done = [] {
    const char* forced = std::getenv("MOTES_TARGET");
    force_instruction_set(forced == nullptr ? "" : forced);
    return true;
  }();
  (void)done;
}

}  // namespace

std::vector<std::string> instruction_sets() {
  std::vector<std::string> names;
  for (const std::uint32_t target : supported_targets()) names.push_back(name_of(target));
  if (current_target() != 0) use_target(current_target());
  return names;
}

void force_instruction_set(const std::string& name) {
  const std::vector<std::uint32_t> targets = supported_targets();
  const std::vector<std::string> names = instruction_sets();
  const auto it =
      name.empty() ? names.begin()
                   : std::find_if(names.begin(), names.end(),
                                  [&](const std::string& n) { return folded(n) == folded(name); });
  if (it == names.end()) {
    throw Error(fmt::format("MOTES_TARGET={}: not to be had on this machine, expected one of {}",
                            printable(name), fmt::join(names, ", ")));
  }
  current_target() = targets[static_cast<std::size_t>(it - names.begin())];
  use_target(current_target());
}

std::string instruction_set() {
  choose_target_once();
  return name_of(current_target());
}

TileCounts render_tile(const FrameContext& context, const Tile& tile, Framebuffer& image) {
  return HWY_DYNAMIC_DISPATCH(render_tile)(context, tile, image);
}

}  // namespace motes
#endif
