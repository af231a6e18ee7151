// The loop around the sweep: an area of pixels slab by slab, front to back, sampling and
// integrating a few planes at a time. Included once per instruction set.
#if defined(MOTES_RENDER_RENDER_SWEEP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_RENDER_RENDER_SWEEP_INL_H_
#undef MOTES_RENDER_RENDER_SWEEP_INL_H_
#else
#define MOTES_RENDER_RENDER_SWEEP_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <climits>
#include <cstdint>
#include <vector>

#include "core/aligned.h"
#include "field/sweep-inl.h"
#include "field/sweep_columns-inl.h"
#include "field/take_columns-inl.h"
#include "integrate/integrate-inl.h"
#include "render/block_layers-inl.h"
#include "render/ray_packets.h"
#include "render/ray_state-inl.h"
#include "render/sample_grids-inl.h"
#include "render/tile_output-inl.h"
#include "samples/area_buffer.h"
#include "samples/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// What the sweep of an area works with: a few MB, kept by each thread.
struct SweepMemory {
  std::vector<GatheredKernels> gathered;  ///< one a group of fields
  ThinKernels thin;
  PlaneKernels plane_kernels;
  ColumnBuffer columns;
  AreaBuffer buffer;
  AlignedVector<float> groups;         ///< taken from the columns: laid out like those of `buffer`
  std::vector<std::uint64_t> visible;  ///< [group][block][field], a bit a plane
  static constexpr int num_blocks = AreaBuffer::groups * AreaBuffer::groups * group_blocks;
  std::vector<RayState> blocks = std::vector<RayState>(num_blocks);  ///< as in AreaBuffer
  std::vector<FieldRange> fields;  ///< [block][field], if there are grids
  TileLayers layers;
  std::vector<BlockLayers> block_layers;  ///< one a block, if FrameContext::has_cuts()
  /// Of each block's rays, as in RayState.
  std::vector<SampleIndex> begin = std::vector<SampleIndex>(num_blocks), end = begin;
};

/// Number of a group's first block.
constexpr std::size_t first_block(int row, int column) {
  return static_cast<std::size_t>(row * AreaBuffer::groups + column) * std::size_t{group_blocks};
}

/// Kernels on planes that are added in one go: planes are taken together until there are so many.
inline constexpr std::size_t kernels_at_once = 1024;

/// Groups of a row that are taken from the columns before the first is integrated: they fit into
/// the first-level cache.
inline constexpr int taken_groups = 4;

/// Planes of a slab, whose kernels are found together: whole batches, which are sampled and
/// integrated one after the other.
inline int planes_of_slab(const FrameContext& context) {
  constexpr int batch = AreaBuffer::planes, most = 4 * batch;
  return std::clamp(context.samples_per_pass, batch, most) / batch * batch;
}

/// An area being rendered.
class AreaSweep {
 public:
  AreaSweep(const FrameContext& context, const Tile& area, SweepMemory& memory, TileCounts& counts)
      : context_(context),
        constants_(make_constants(*context.kernels)),
        area_(area),
        bounds_(make_ray_bounds(context, area.x, area.y, AreaBuffer::size, AreaBuffer::size)),
        image_bounds_(make_ray_bounds(context, area.x, area.y, area.width, area.height)),
        layout_(make_layout(context)),
        field_floats_(static_cast<std::size_t>(layout_.channels() * layout_.lanes)),
        integrator_(context.classifiers, context.shading, layout_),
        memory_(memory),
        counts_(counts),
        clock_(counts.stages) {
    memory.visible.resize(taken_groups * group_blocks * context.classifiers.size());
    memory.gathered.resize(std::max<std::size_t>(memory.gathered.size(), constants_.num_groups));
  }

  void run(Framebuffer& image) {
    start();
    const int planes = planes_of_slab(context_);
    for (SampleIndex begin = begin_; begin <= end_; begin += planes) {
      sweep_slab({begin, std::min(end_ - begin + 1, planes)});
    }
    finish(image);
  }

 private:
  template <class Visit>
  void for_each_block(Visit&& visit) {
    for (int row = 0; row < AreaBuffer::groups; ++row) {
      for (int column = 0; column < AreaBuffer::groups; ++column) {
        for (int v = 0; v < group_blocks; ++v) {
          visit(first_block(row, column) + static_cast<std::size_t>(v),
                area_.x + column * AreaBuffer::group_size,
                area_.y + row * AreaBuffer::group_size + v * block_rows);
        }
      }
    }
  }

  void start() {
    begin_ = INT_MAX;
    end_ = -1;
    if (context_.layers) context_.layers(area_, memory_.layers);
    if (context_.has_cuts()) memory_.block_layers.resize(SweepMemory::num_blocks);
    const std::size_t num_fields = context_.grids.empty() ? 0 : context_.classifiers.size();
    memory_.fields.resize(SweepMemory::num_blocks * num_fields);
    for_each_block([&](std::size_t b, int x, int y) {
      RayState& rays = memory_.blocks[b];
      start_rays(context_, x, y, AreaBuffer::group_size, block_rows,
                 memory_.fields.data() + b * num_fields, rays);
      if (context_.has_cuts()) {
        take_layers(context_, memory_.layers, area_, x, y, AreaBuffer::group_size,
                    memory_.block_layers[b], rays);
      }
      memory_.begin[b] = rays.begin;
      memory_.end[b] = rays.end;
      begin_ = std::min(begin_, rays.begin);
      end_ = std::max(end_, rays.end);
    });
    clock_.lap(Stage::setup);
  }

  void finish(Framebuffer& image) {
    for_each_block([&](std::size_t b, int x, int y) {
      if (BlockLayers* const layers = layers_of(b)) integrator_.finish(*layers, memory_.blocks[b]);
      counts_.samples += count_samples(memory_.blocks[b]);
      store_pixels(memory_.blocks[b], x, y, AreaBuffer::group_size, image);
    });
    clock_.lap(Stage::setup);
  }

  /// Null where nothing cuts the steps of rays.
  BlockLayers* layers_of(std::size_t block) {
    if (!context_.has_cuts()) return nullptr;
    BlockLayers& layers = memory_.block_layers[block];
    return layers.most == 0 && context_.clip_planes.empty() ? nullptr : &layers;
  }

  /// Finds the groups that have rays under way on some of the planes, and where the last of all
  /// rays ends; true if there are such groups.
  bool find_live(const Slab& slab) {
    std::array<GroupBits, AreaBuffer::groups> rows{};
    GroupBits any = 0;
    end_ = -1;
    for (int row = 0; row < AreaBuffer::groups; ++row) {
      GroupBits bits = 0;
      for (int column = 0; column < AreaBuffer::groups; ++column) {
        bool live = false;
        for (std::size_t b = first_block(row, column); b < first_block(row, column + 1); ++b) {
          live |= memory_.begin[b] < slab.first + slab.count && memory_.end[b] >= slab.first;
          end_ = std::max(end_, memory_.end[b]);
        }
        bits |= static_cast<GroupBits>(live) << column;
      }
      rows[static_cast<std::size_t>(row)] = bits;
      any |= bits;
    }
    live_.set(rows);
    return any != 0;
  }

  void sweep_slab(const Slab& slab) {
    if (!find_live(slab)) return;
    const SlabFrame frame = make_slab_frame(bounds_, slab, context_.view);
    const Frustum frustum = make_frustum(bounds_, frame, context_.view);
    std::size_t num_gathered = 0;
    for (std::uint32_t g = 0; g < constants_.num_groups; ++g) {
      GatheredKernels& gathered = memory_.gathered[g];
      gather_kernels(*context_.kernels, constants_, g, frame, frustum, gathered);
      num_gathered += gathered.size;
    }
    clock_.lap(Stage::traverse);
    if (num_gathered == 0 && !integrator_.zero_shows() && context_.grids.empty()) return;
    const AreaPixels pixels = place_pixels(bounds_, image_bounds_, frame);
    for (std::uint32_t g = 0; g < constants_.num_groups; ++g) {
      find_thin_kernels(pixels, frame, memory_.gathered[g]);
    }
    clock_.lap(Stage::cull);
    memory_.buffer.reserve(layout_);
    memory_.columns.reserve(layout_);
    memory_.groups.resize(taken_groups * memory_.buffer.group_floats());
    for (int begin = 0; begin < slab.count; begin += AreaBuffer::planes) {
      const Slab batch{slab.first + begin, std::min(AreaBuffer::planes, slab.count - begin)};
      if (begin > 0 && !find_live(batch)) continue;
      render_batch(frame, pixels, begin, batch);
    }
  }

  /// Samples and integrates the planes of a batch, the first of which is plane `first` of the slab.
  void render_batch(const SlabFrame& frame, const AreaPixels& pixels, int first,
                    const Slab& batch) {
    EvaluationCounts evaluations;
    for (std::uint32_t g = 0; g < constants_.num_groups; ++g) {
      const GatheredKernels& gathered = memory_.gathered[g];
      const auto sum = [&](const auto& shape) {
        sum_group(shape, gathered, frame, pixels, first, batch.count, evaluations);
      };
      with_shape(constants_, constants_.first_field[g], sum);
    }
    for (int row = 0; row < AreaBuffer::groups; ++row) {
      for (int column = 0; column < AreaBuffer::groups; column += taken_groups) {
        integrate_groups(row, column, batch);
      }
      memory_.columns.touched(row) = 0;
    }
    counts_.kernel_evaluations += evaluations.carried_out;
    counts_.evaluations_inside += evaluations.inside_support;
  }

  /// Adds the kernels of a group of fields to planes `first` to first + count - 1 of the slab.
  template <class Shape>
  void sum_group(const Shape& shape, const GatheredKernels& gathered, const SlabFrame& frame,
                 const AreaPixels& pixels, int first, int count, EvaluationCounts& evaluations) {
    const auto sum = [&]<class C>() {
      if (gathered.num_others != 0) {
        sum_by_planes<C>(shape, gathered, frame, pixels, first, count, evaluations);
      }
      if (gathered.num_thin != 0) {
        sum_by_columns<C>(shape, gathered, frame, pixels, first, evaluations);
      }
    };
    if constexpr (Shape::is_product) {
      if (context_.count_inside) return sum.template operator()<Channels<false, false, true>>();
    }
    if (!context_.gradients) {
      sum.template operator()<Channels<false, false, false, Shape>>();
    } else if (context_.absolute) {
      sum.template operator()<Channels<true, true, false, Shape>>();
    } else {
      sum.template operator()<Channels<true, false, false, Shape>>();
    }
  }

  /// Those that are thin.
  template <class C>
  void sum_by_columns(const typename C::Shape& shape, const GatheredKernels& gathered,
                      const SlabFrame& frame, const AreaPixels& pixels, int first,
                      EvaluationCounts& evaluations) {
    const AreaPlanes planes = place_planes(pixels, frame, first);
    find_pixels(pixels, planes, gathered, memory_.thin);
    clock_.lap(Stage::cull);
    const std::size_t field_floats =
        static_cast<std::size_t>(layout_.channels()) * std::size_t{ColumnBuffer::planes};
    sum_columns<C>(shape, gathered, memory_.thin, {planes, live_, field_floats, memory_.columns},
                   evaluations);
    clock_.lap(Stage::sums);
  }

  /// Those that are not.
  template <class C>
  void sum_by_planes(const typename C::Shape& shape, const GatheredKernels& gathered,
                     const SlabFrame& frame, const AreaPixels& pixels, int first, int count,
                     EvaluationCounts& evaluations) {
    std::array<AreaPlane, AreaBuffer::planes> planes;
    for (int k = 0; k < count;) {
      memory_.plane_kernels.clear();
      for (; k < count && memory_.plane_kernels.size() < kernels_at_once; ++k) {
        AreaPlane& plane = planes[static_cast<std::size_t>(k)];
        plane = place_plane(pixels, frame, first + k);
        find_boxes(gathered, plane, k, memory_.plane_kernels);
      }
      memory_.plane_kernels.sort();
      clock_.lap(Stage::cull);
      sum_planes<C>(shape, gathered, memory_.plane_kernels,
                    {planes.data(), memory_.buffer, field_floats_, live_}, evaluations);
      clock_.lap(Stage::sums);
    }
  }

  /// Pass 1 for a group, of the fields that are grids.
  void sample_grids(int row, int column, const Slab& batch) {
    for (int v = 0; v < group_blocks; ++v) {
      const std::size_t b = first_block(row, column) + static_cast<std::size_t>(v);
      if (memory_.begin[b] >= batch.first + batch.count || memory_.end[b] < batch.first) continue;
      const RayPacket packet =
          make_ray_packet(context_, area_.x + column * AreaBuffer::group_size,
                          area_.y + row * AreaBuffer::group_size + v * block_rows,
                          AreaBuffer::group_size, block_rows);
      for (const FrameGrid& grid : context_.grids) {
        float* const out = memory_.buffer.at(row, column) +
                           static_cast<std::size_t>(v) * memory_.buffer.block_floats() +
                           grid.field * field_floats_;
        AreaBuffer::PlaneBits& touched = memory_.buffer.touched(row, column)[grid.field];
        sample_frame_grid(grid, packet, memory_.blocks[b].fields[grid.field], context_.view.planes,
                          batch, context_.gradients, context_.absolute, out,
                          memory_.buffer.plane_floats(),
                          [&](int k) { touched |= AreaBuffer::PlaneBits{1} << k; });
      }
    }
  }

  /// Pass 2 for some groups of a row, whose samples are zero afterwards.
  void integrate_groups(int row, int first, const Slab& batch) {
    const GroupBits some = ((1u << taken_groups) - 1) << first;
    const GroupBits live = live_.row(row) & some;
    const GroupBits thin = memory_.columns.touched(row) & some;
    if (!context_.grids.empty()) {
      for (GroupBits left = live; left != 0; left &= left - 1) {
        sample_grids(row, std::countr_zero(left), batch);
      }
      clock_.lap(Stage::sums);
    }
    GroupBits visible = 0;
    for (GroupBits left = thin; left != 0; left &= left - 1) {
      const int column = std::countr_zero(left);
      visible |= static_cast<GroupBits>(take_group(row, column, live, batch)) << column;
    }
    if (thin != 0) clock_.lap(Stage::sums);
    for (int column = first; column < first + taken_groups; ++column) {
      if ((visible >> column & 1) != 0) {
        integrate_group(row, column, taken(row, column).out, batch);
      } else if (((live & ~thin) >> column & 1) != 0 && find_visible(row, column, batch.count)) {
        integrate_group(row, column, memory_.buffer.at(row, column), batch);
      }
      clear(row, column);
    }
    clock_.lap(Stage::integrate);
  }

  /// A group that is taken from the columns.
  GroupSamples taken(int row, int column) {
    const auto place = static_cast<std::size_t>(column % taken_groups);
    return {memory_.columns, memory_.buffer, row, column,
            memory_.groups.data() + place * memory_.buffer.group_floats()};
  }

  /// Planes on which fields may be seen, of a group: [block][field].
  std::uint64_t* visible_planes(int column) {
    return memory_.visible.data() + static_cast<std::size_t>(column % taken_groups * group_blocks) *
                                        context_.classifiers.size();
  }

  /// Takes a group that thin kernels reach, gradients only where something may be seen by rays
  /// under way; true if so.
  bool take_group(int row, int column, GroupBits live, const Slab& batch) {
    const GroupSamples group = taken(row, column);
    const AreaBuffer::PlaneBits* const summed = memory_.buffer.touched(row, column);
    const std::uint64_t planes = ~(~std::uint64_t{0} << batch.count);
    const int channels = layout_.channels();
    std::uint64_t any = 0;
    std::uint64_t* visible = visible_planes(column);
    for (int block = 0; block < group_blocks; ++block) {
      for (int f = 0; f < layout_.num_fields; ++f, ++visible) {
        const Visibility& visibility = context_.classifiers[static_cast<std::size_t>(f)].visibility;
        *visible = planes & take_values(group, block, f * channels, summed[f], visibility);
        any |= *visible;
      }
    }
    const bool seen = (live >> column & 1) != 0 && any != 0;
    for (int f = 0; f < layout_.num_fields && channels > 1; ++f) {
      const int first = f * channels + 1, last = (f + 1) * channels;
      if (seen) {
        take_channels(group, first, last, summed[f]);
      } else {
        drop_channels(group, first, last);
      }
    }
    return seen;
  }

  /// Finds the visible planes of a group of the buffer; true if there are any.
  bool find_visible(int row, int column, int num_planes) {
    const LaneTag d;
    const std::size_t num_fields = context_.classifiers.size();
    const std::size_t stride = memory_.buffer.plane_floats();
    const AreaBuffer::PlaneBits* const touched = memory_.buffer.touched(row, column);
    std::uint64_t* const visible_of_group = visible_planes(column);
    std::uint64_t any = 0;
    for (std::size_t f = 0; f < num_fields; ++f) {
      const Visibility visibility = context_.classifiers[f].visibility;
      const std::uint64_t planes = visibility.shows_zero() ? ~std::uint64_t{0} : touched[f];
      const float* samples = memory_.buffer.at(row, column) + f * field_floats_;
      for (std::size_t v = 0; v < group_blocks; ++v, samples += memory_.buffer.block_floats()) {
        std::uint64_t visible = 0;
        if (planes != 0) {
          for (int k = 0; k < num_planes; ++k) {
            const Lanes values = hn::Load(d, samples + static_cast<std::size_t>(k) * stride);
            visible |= std::uint64_t{may_be_seen(d, values, visibility)} << k;
          }
        }
        visible_of_group[v * num_fields + f] = visible & planes;
        any |= visible & planes;
      }
    }
    return any != 0;
  }

  void integrate_group(int row, int column, const float* samples, const Slab& batch) {
    const std::size_t num_fields = context_.classifiers.size();
    const std::uint64_t* visible = visible_planes(column);
    std::size_t b = first_block(row, column);
    for (int v = 0; v < group_blocks; ++v, ++b, visible += num_fields) {
      if (std::any_of(visible, visible + num_fields,
                      [](std::uint64_t bits) { return bits != 0; })) {
        integrator_.run(batch, {samples, memory_.buffer.plane_floats(), field_floats_}, visible,
                        memory_.blocks[b], layers_of(b));
        memory_.end[b] = memory_.blocks[b].end;
      }
      samples += memory_.buffer.block_floats();
    }
  }

  void clear(int row, int column) {
    const LaneTag d;
    AreaBuffer& buffer = memory_.buffer;
    const std::size_t stride = buffer.plane_floats(), block_floats = buffer.block_floats();
    const std::size_t field_floats = field_floats_;
    AreaBuffer::PlaneBits* const touched = buffer.touched(row, column);
    for (std::size_t f = 0; f < buffer.num_fields(); ++f) {
      float* const samples = buffer.at(row, column) + f * field_floats;
      for (AreaBuffer::PlaneBits left = touched[f]; left != 0; left &= left - 1) {
        float* block = samples + static_cast<std::size_t>(std::countr_zero(left)) * stride;
        for (int v = 0; v < group_blocks; ++v, block += block_floats) {
          for (std::size_t i = 0; i < field_floats; i += num_lanes) {
            hn::Store(hn::Zero(d), d, block + i);
            __asm__ volatile("");  // or it becomes a call of memset(), which takes longer
          }
        }
      }
      touched[f] = 0;
    }
  }

  const FrameContext& context_;
  const SamplingConstants constants_;
  const Tile area_;
  const RayBounds bounds_, image_bounds_;  ///< of all pixels, and of those within the image
  const SampleLayout layout_;
  const std::size_t field_floats_;  ///< of a block
  const Integrator integrator_;
  SweepMemory& memory_;
  TileCounts& counts_;
  StageClock clock_;
  LiveGroups live_;                   ///< groups with rays under way
  SampleIndex begin_ = 0, end_ = -1;  ///< of all rays
};

TileCounts render_sweep(const FrameContext& context, const Tile& area, Framebuffer& image) {
  static thread_local SweepMemory memory;
  TileCounts counts;
  AreaSweep(context, area, memory, counts).run(image);
  return counts;
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
