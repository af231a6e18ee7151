#include "render/render_tile.h"

#include <algorithm>
#include <bit>
#include <climits>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/render_tile.cc"
#include <hwy/foreach_target.h>
// Included again for each instruction set.
#include <hwy/highway.h>

#include "field/coherent-inl.h"
#include "field/direct-inl.h"
#include "field/sweep-inl.h"
#include "integrate/integrate-inl.h"
#include "render/ray_packets.h"
#include "render/ray_state-inl.h"
#include "samples/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// While it lives, this thread takes numbers below 1e-38 for zero: far from a kernel's centre its
/// factors are so small, and arithmetic with them takes the processor many times as long.
class FlushTinyToZero {
 public:
  FlushTinyToZero() : saved_(_mm_getcsr()) {
    constexpr unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x0040;
    _mm_setcsr(saved_ | flush_to_zero | denormals_are_zero);
  }
  ~FlushTinyToZero() { _mm_setcsr(saved_); }
  FlushTinyToZero(const FlushTinyToZero&) = delete;
  FlushTinyToZero& operator=(const FlushTinyToZero&) = delete;

 private:
  unsigned saved_;
};

/// Pass 1 for one slab, by the engine and with the channels of the frame.
std::uint64_t sample_field(const FrameContext& context, const SamplingConstants& constants,
                           const RayPacket& packet, const Slab& slab, SampleBuffer& buffer) {
  const auto sample = [&]<bool kGradients, bool kAbsolute>() {
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

/// Samples of all rays, up to each ray's end.
std::uint64_t count_samples(const RayState& rays) {
  std::uint64_t samples = 0;
  for (std::size_t l = 0; l < hn::Lanes(LaneTag()); ++l) {
    samples += static_cast<std::uint64_t>(rays.last[l] - rays.first[l] + 1);
  }
  return samples;
}

/// Writes the colours of the packet whose top left pixel is (px, py).
void store_pixels(const RayState& rays, int px, int py, int width, Framebuffer& image) {
  const LaneTag d;
  alignas(64) float rgba[4 * max_lanes];
  hn::StoreInterleaved4(hn::Load(d, rays.r), hn::Load(d, rays.g), hn::Load(d, rays.b),
                        hn::Load(d, rays.a), d, rgba);
  const int columns = std::min(width, image.width - px);
  const int rows = std::min(static_cast<int>(hn::Lanes(d)) / width, image.height - py);
  for (int row = 0; row < rows; ++row) {
    std::copy_n(rgba + 4 * width * row, 4 * std::max(columns, 0), image.pixel(px, py + row));
  }
}

/// The paper's multi-pass algorithm (section 4.2): slab by slab, sampling then integrating, until
/// all rays of the packet have ended. Returns kernel evaluations.
std::uint64_t render_packet(const FrameContext& context, const SamplingConstants& constants,
                            const RayPacket& packet, SampleBuffer& buffer, RayState& rays,
                            StageClock& clock) {
  std::uint64_t evaluations = 0;
  for (SampleIndex k = rays.begin; k <= rays.end; k += context.samples_per_pass) {
    const Slab slab{k, std::min(rays.end - k + 1, context.samples_per_pass)};
    buffer.reserve(slab.count);
    evaluations += sample_field(context, constants, packet, slab, buffer);
    clock.lap(Stage::sums);
    integrate_buffer(context.classifiers, context.shading, slab, buffer, rays);
    clear_touched(buffer);
    clock.lap(Stage::integrate);
  }
  return evaluations;
}

SampleLayout make_layout(const FrameContext& context) {
  return {.num_fields = static_cast<int>(context.classifiers.size()),
          .gradients = context.gradients,
          .absolute = context.absolute,
          .lanes = static_cast<int>(hn::Lanes(LaneTag()))};
}

/// Packet by packet, as the paper does.
TileCounts render_packets(const FrameContext& context, const Tile& tile, Framebuffer& image) {
  const int lanes = static_cast<int>(hn::Lanes(LaneTag()));
  const int packet_width = lanes >= 8 ? 4 : 2, packet_height = lanes / packet_width;
  const SamplingConstants constants = make_constants(*context.kernels);
  SampleBuffer buffer(make_layout(context), std::min(context.samples_per_pass, 64));
  TileCounts counts;
  StageClock clock(counts.stages);
  for (int py = tile.y; py < tile.y + tile.height; py += packet_height) {
    for (int px = tile.x; px < tile.x + tile.width; px += packet_width) {
      const RayPacket packet = make_ray_packet(context, px, py, packet_width, packet_height);
      RayState rays;
      start_rays(context, px, py, packet_width, packet_height, rays);
      clock.lap(Stage::setup);
      counts.kernel_evaluations += render_packet(context, constants, packet, buffer, rays, clock);
      counts.samples += count_samples(rays);
      store_pixels(rays, px, py, packet_width, image);
    }
  }
  clock.lap(Stage::setup);
  return counts;
}

/// A tile of the sweep: its rays, block by block.
struct SweepTile {
  int x, y;
  RayBounds bounds;
  SampleIndex begin[sweep_blocks], end[sweep_blocks];  ///< of each block's rays, as in RayState
  RayState blocks[sweep_blocks];
};

void start_tile(const FrameContext& context, int x, int y, SweepTile& tile) {
  tile.x = x;
  tile.y = y;
  tile.bounds = make_ray_bounds(context, x, y, sweep_tile, sweep_tile);
  for (int b = 0; b < sweep_blocks; ++b) {
    RayState& rays = tile.blocks[b];
    start_rays(context, x + b % sweep_blocks_across * sweep_block_width,
               y + b / sweep_blocks_across * sweep_block_height, sweep_block_width,
               sweep_block_height, rays);
    tile.begin[b] = rays.begin;
    tile.end[b] = rays.end;
  }
}

/// Blocks that have rays under way in the slab, a bit each.
std::uint64_t live_blocks(const SweepTile& tile, const Slab& slab) {
  std::uint64_t live = 0;
  for (int b = 0; b < sweep_blocks; ++b) {
    const bool is_live = tile.begin[b] < slab.first + slab.count && tile.end[b] >= slab.first;
    live |= static_cast<std::uint64_t>(is_live) << b;
  }
  return live;
}

/// Samples that no kernel reaches show nothing.
bool zero_is_transparent(const FrameContext& context) {
  return std::all_of(context.classifiers.begin(), context.classifiers.end(),
                     [](const Classifier& c) { return !c.visibility.shows_zero(); });
}

/// What the sweep of an area works with: a few MB, kept by each thread.
struct SweepMemory {
  GatheredKernels gathered;
  TileKernels tile_kernels;
  FactorLists lists;
  AlignedVector<float> samples;        ///< of the blocks of a tile, one after the other
  std::vector<std::uint64_t> visible;  ///< [block][field], as in BlockSamples
  /// Of each field; and where nothing is ruled out.
  Visibility visibility[max_fields], everything[max_fields];
};

/// Pass 1 of the sweep for the blocks of a tile in a slab, with the channels of the frame. Returns
/// kernel evaluations.
template <bool kGradients, bool kAbsolute>
std::uint64_t sample_tile(const FrameContext& context, const SamplingConstants& constants,
                          const TileSamples& placed, const Slab& slab, std::uint64_t live,
                          const BlockSamples& blocks, SweepMemory& memory, StageClock& clock) {
  std::uint64_t evaluations = 0;
  std::size_t listed = 0;
  do {
    const bool first = listed == 0;
    listed =
        list_factors<kGradients>(*context.kernels, constants, memory.gathered, memory.tile_kernels,
                                 placed, slab.count, listed, memory.lists);
    clock.lap(Stage::factors);
    // What may be seen is known only where all kernels are there at once.
    const bool only = first && listed == memory.tile_kernels.size;
    unsigned strips = strips_of(live);
    if (only && zero_is_transparent(context)) strips &= strips_of(memory.lists.any_rows);
    const SweepRound round{memory.lists, placed, only ? memory.visibility : memory.everything,
                           first};
    evaluations +=
        sum_planes<kGradients, kAbsolute>(round, make_layout(context), strips, slab.count, blocks);
    clock.lap(Stage::sums);
  } while (listed != memory.tile_kernels.size);
  return evaluations;
}

/// Samples and integrates a tile in a slab. Returns kernel evaluations.
std::uint64_t sweep_slab(const FrameContext& context, const SamplingConstants& constants,
                         const SlabFrame& frame, const Slab& slab, SweepMemory& memory,
                         SweepTile& tile, StageClock& clock) {
  const SampleLayout layout = make_layout(context);
  const auto num_fields = static_cast<std::size_t>(layout.num_fields);
  const std::size_t stride = static_cast<std::size_t>(slab.count) * layout.floats_per_sample();
  memory.samples.resize(sweep_blocks * stride);
  memory.visible.assign(sweep_blocks * num_fields, 0);
  const BlockSamples blocks{stride, memory.samples.data(), memory.visible.data()};
  const TileSamples placed = place_samples(tile.bounds, frame);
  const auto sample = !context.gradients ? &sample_tile<false, false>
                      : context.absolute ? &sample_tile<true, true>
                                         : &sample_tile<true, false>;
  const std::uint64_t live = live_blocks(tile, slab);
  const std::uint64_t evaluations =
      sample(context, constants, placed, slab, live, blocks, memory, clock);
  for (std::uint64_t left = live; left != 0; left &= left - 1) {
    const auto b = static_cast<std::size_t>(std::countr_zero(left));
    const std::uint64_t* const visible = blocks.visible + b * num_fields;
    if (std::all_of(visible, visible + num_fields, [](std::uint64_t v) { return v == 0; }))
      continue;
    integrate(context.classifiers, context.shading, slab, layout, blocks.samples + b * stride,
              visible, tile.blocks[b]);
    tile.end[b] = tile.blocks[b].end;
  }
  clock.lap(Stage::integrate);
  return evaluations;
}

/// Slab by slab: one traversal for all tiles, then tile by tile sampling and integrating.
TileCounts render_sweep(const FrameContext& context, const Tile& area, Framebuffer& image) {
  TileCounts counts;
  StageClock clock(counts.stages);
  const SamplingConstants constants = make_constants(*context.kernels);
  const auto tiles_along = [](int pixels) { return (pixels + sweep_tile - 1) / sweep_tile; };
  const auto num_tiles = static_cast<std::size_t>(tiles_along(area.width)) *
                         static_cast<std::size_t>(tiles_along(area.height));
  const auto storage = std::make_unique_for_overwrite<SweepTile[]>(num_tiles);
  const std::span<SweepTile> tiles(storage.get(), num_tiles);
  std::size_t next_tile = 0;
  SampleIndex begin = INT_MAX, end = -1;
  for (int y = area.y; y < area.y + area.height; y += sweep_tile) {
    for (int x = area.x; x < area.x + area.width; x += sweep_tile) {
      SweepTile& tile = tiles[next_tile++];
      start_tile(context, x, y, tile);
      begin = std::min(begin, *std::min_element(tile.begin, tile.begin + sweep_blocks));
      end = std::max(end, *std::max_element(tile.end, tile.end + sweep_blocks));
    }
  }
  const RayBounds bounds =
      make_ray_bounds(context, area.x, area.y, tiles_along(area.width) * sweep_tile,
                      tiles_along(area.height) * sweep_tile);
  const int planes = std::min(context.samples_per_pass, max_sweep_planes);
  static thread_local SweepMemory memory;
  std::fill_n(
      memory.everything, max_fields,
      Visibility{-std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity()});
  std::transform(context.classifiers.begin(), context.classifiers.end(), memory.visibility,
                 [](const Classifier& c) { return c.visibility; });
  clock.lap(Stage::setup);
  while (begin <= end) {
    const Slab slab{begin, std::min(end - begin + 1, planes)};
    const SlabFrame frame = make_slab_frame(bounds, slab, context.view);
    gather_kernels(*context.kernels, constants, frame, make_frustum(bounds, frame, context.view),
                   memory.gathered);
    clock.lap(Stage::traverse);
    end = -1;
    for (SweepTile& tile : tiles) {
      if (live_blocks(tile, slab) != 0) {
        find_tile_kernels(constants, memory.gathered, frame,
                          make_frustum(tile.bounds, frame, context.view), memory.tile_kernels);
        clock.lap(Stage::cull);
        if (memory.tile_kernels.size != 0 || !zero_is_transparent(context)) {
          counts.kernel_evaluations +=
              sweep_slab(context, constants, frame, slab, memory, tile, clock);
        }
      }
      end = std::max(end, *std::max_element(tile.end, tile.end + sweep_blocks));
    }
    begin += slab.count;
  }
  for (const SweepTile& tile : tiles) {
    for (int b = 0; b < sweep_blocks; ++b) {
      counts.samples += count_samples(tile.blocks[b]);
      store_pixels(tile.blocks[b], tile.x + b % sweep_blocks_across * sweep_block_width,
                   tile.y + b / sweep_blocks_across * sweep_block_height, sweep_block_width, image);
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
