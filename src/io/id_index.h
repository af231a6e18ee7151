// From the ids that a file gives its particles to their indices.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <optional>
#include <vector>

namespace motes {

class IdIndex {
 public:
  /// `ids` must outlive the index.
  explicit IdIndex(const std::vector<std::int64_t>& ids) : ids_(ids), order_(ids.size()) {
    std::iota(order_.begin(), order_.end(), std::uint32_t{0});
    // Most files are sorted already.
    const auto less = [&](std::uint32_t a, std::uint32_t b) { return ids_[a] < ids_[b]; };
    if (!std::is_sorted(order_.begin(), order_.end(), less)) {
      std::sort(order_.begin(), order_.end(), less);
    }
  }

  /// The particle of that id (one of them, if the id is there twice).
  std::optional<std::uint32_t> find(std::int64_t id) const {
    const auto it = std::lower_bound(order_.begin(), order_.end(), id,
                                     [&](std::uint32_t i, std::int64_t v) { return ids_[i] < v; });
    if (it == order_.end() || ids_[*it] != id) return std::nullopt;
    return *it;
  }

 private:
  const std::vector<std::int64_t>& ids_;
  std::vector<std::uint32_t> order_;  ///< indices sorted by id
};

}  // namespace motes
