// Calls rtcBuildBVH with callbacks that do no more than a tree needs.
#include "motes/bench/embree.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <vector>

#include "core/aligned.h"
#include "core/error.h"

namespace motes {
namespace {

constexpr std::size_t width = 8;  // the most that rtcBuildBVH takes
constexpr std::size_t leaf_size = Bvh::leaf_size;
static_assert(leaf_size <= RTC_BUILD_MAX_PRIMITIVES_PER_LEAF);

/// Children that are not there are null and have empty boxes.
struct Node {
  float lower[3][width], upper[3][width];
  void* children[width];
};

/// A leaf is the number of its boxes, then their indices. Pointers to leaves are one byte off,
/// which tells them from nodes.
void* mark_as_leaf(std::uint32_t* leaf) { return reinterpret_cast<char*>(leaf) + 1; }
bool is_leaf(const void* child) { return (reinterpret_cast<std::uintptr_t>(child) & 1) != 0; }
std::uint32_t size_of_leaf(const void* child) {
  return *reinterpret_cast<const std::uint32_t*>(static_cast<const char*>(child) - 1);
}
constexpr std::size_t bytes_of_leaf(std::size_t size) { return (1 + size) * sizeof(std::uint32_t); }

// The callbacks.

void* create_node(RTCThreadLocalAllocator allocator, unsigned, void*) {
  return rtcThreadLocalAlloc(allocator, sizeof(Node), cache_line_bytes);
}

void set_children(void* node_pointer, void** children, unsigned count, void*) {
  Node& node = *static_cast<Node*>(node_pointer);
  for (std::size_t c = 0; c < width; ++c) node.children[c] = c < count ? children[c] : nullptr;
}

void set_bounds(void* node_pointer, const RTCBounds** bounds, unsigned count, void*) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  constexpr RTCBounds empty{infinity, infinity, infinity, 0, -infinity, -infinity, -infinity, 0};
  Node& node = *static_cast<Node*>(node_pointer);
  for (std::size_t c = 0; c < width; ++c) {
    const RTCBounds& box = c < count ? *bounds[c] : empty;
    node.lower[0][c] = box.lower_x;
    node.lower[1][c] = box.lower_y;
    node.lower[2][c] = box.lower_z;
    node.upper[0][c] = box.upper_x;
    node.upper[1][c] = box.upper_y;
    node.upper[2][c] = box.upper_z;
  }
}

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* boxes,
                  std::size_t count, void*) {
  auto* const leaf =
      static_cast<std::uint32_t*>(rtcThreadLocalAlloc(allocator, bytes_of_leaf(count), 16));
  leaf[0] = static_cast<std::uint32_t>(count);
  for (std::size_t i = 0; i < count; ++i) leaf[1 + i] = boxes[i].primID;
  return mark_as_leaf(leaf);
}

class Builder final : public EmbreeBuilder {
 public:
  explicit Builder(int threads)
      : device_(rtcNewDevice(threads > 0 ? fmt::format("threads={}", threads).c_str() : nullptr)) {
    if (device_ == nullptr) fail();
  }
  Builder(const Builder&) = delete;
  Builder& operator=(const Builder&) = delete;
  ~Builder() override {
    release_tree();
    rtcReleaseDevice(device_);
  }

  std::string version() const override {
    const auto number = [this](RTCDeviceProperty part) {
      return rtcGetDeviceProperty(device_, part);
    };
    return fmt::format("{}.{}.{}", number(RTC_DEVICE_PROPERTY_VERSION_MAJOR),
                       number(RTC_DEVICE_PROPERTY_VERSION_MINOR),
                       number(RTC_DEVICE_PROPERTY_VERSION_PATCH));
  }

  void set_boxes(std::span<const Sphere> spheres) override {
    boxes_.resize(spheres.size());
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, spheres.size(), 1 << 14), [&](const auto& range) {
          for (std::size_t i = range.begin(); i != range.end(); ++i) {
            const auto& [x, y, z, r] = spheres[i];
            boxes_[i] = {x - r, y - r, z - r, 0, x + r, y + r, z + r, static_cast<unsigned>(i)};
          }
        });
  }

  void build(EmbreeQuality quality) override {
    if (bvh_ == nullptr) bvh_ = rtcNewBVH(device_);
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality =
        quality == EmbreeQuality::morton ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
    arguments.maxBranchingFactor = width;
    arguments.minLeafSize = arguments.maxLeafSize = leaf_size;
    arguments.bvh = bvh_;
    arguments.primitives = boxes_.data();
    arguments.primitiveCount = arguments.primitiveArrayCapacity = boxes_.size();
    arguments.createNode = create_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_bounds;
    arguments.createLeaf = create_leaf;
    root_ = rtcBuildBVH(&arguments);
    if (root_ == nullptr) fail();
  }

  EmbreeTree tree() const override {
    EmbreeTree tree;
    std::vector<const void*> open;
    if (root_ != nullptr) open.push_back(root_);
    while (!open.empty()) {
      const void* const at = open.back();
      open.pop_back();
      if (is_leaf(at)) {
        ++tree.leaves;
        tree.particles += size_of_leaf(at);
        tree.bytes += bytes_of_leaf(size_of_leaf(at));
        continue;
      }
      ++tree.nodes;
      tree.bytes += sizeof(Node);
      const Node& node = *static_cast<const Node*>(at);
      std::copy_if(std::begin(node.children), std::end(node.children), std::back_inserter(open),
                   [](const void* child) { return child != nullptr; });
    }
    return tree;
  }

  void clear() override {
    release_tree();
    boxes_ = UninitializedVector<RTCBuildPrimitive>();  // ({} would keep the memory)
  }

 private:
  [[noreturn]] void fail() const {
    throw Error(
        fmt::format("Embree failed with error {}", static_cast<int>(rtcGetDeviceError(device_))));
  }
  void release_tree() {
    if (bvh_ != nullptr) rtcReleaseBVH(bvh_);
    bvh_ = nullptr;
    root_ = nullptr;
  }

  RTCDevice device_;
  UninitializedVector<RTCBuildPrimitive> boxes_;
  RTCBVH bvh_ = nullptr;
  void* root_ = nullptr;
};

}  // namespace

std::unique_ptr<EmbreeBuilder> make_embree_builder(int threads) {
  return std::make_unique<Builder>(threads);
}

}  // namespace motes
