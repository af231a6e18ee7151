// Embree's builders of trees, to compare with; a program that is built without the library has
// none.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "bvh/bvh.h"

namespace motes {

enum class EmbreeQuality {
  morton,  ///< RTC_BUILD_QUALITY_LOW: along a curve of Morton keys, its fastest
  binned,  ///< RTC_BUILD_QUALITY_MEDIUM, its default: by the surface area heuristic
};

/// What a tree of Embree's consists of: eight-wide nodes, leaves of up to sixteen indices.
struct EmbreeTree {
  std::size_t nodes = 0, leaves = 0, particles = 0;
  std::size_t bytes = 0;  ///< of nodes and leaves, without what the allocator leaves empty
};

/// Builds trees over boxes. Throws Error where Embree fails.
class EmbreeBuilder {
 public:
  virtual ~EmbreeBuilder() = default;
  /// As in "3.13.5".
  virtual std::string version() const = 0;
  /// Takes the boxes around `spheres`, in their order (build() may leave them in another one).
  virtual void set_boxes(std::span<const Sphere> spheres) = 0;
  /// Builds the tree of the boxes; again into the same memory where there is a tree already.
  virtual void build(EmbreeQuality quality) = 0;
  /// Counts what the tree consists of.
  virtual EmbreeTree tree() const = 0;
  /// Frees the tree and the boxes.
  virtual void clear() = 0;
};

/// Null where there is no Embree. threads: 0 for all.
std::unique_ptr<EmbreeBuilder> make_embree_builder(int threads);

}  // namespace motes
