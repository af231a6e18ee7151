// docs.kernel.org/filesystems/proc.html, docs.kernel.org/admin-guide/cgroup-v2.html and
// .../cgroup-v1/memory.html
#include "core/memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

namespace motes {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();

/// The number in a file of one; nothing if there is none ("max").
std::optional<std::uint64_t> number_in(const fs::path& path) {
  std::ifstream file(path);
  std::uint64_t number = 0;
  if (file >> number) return number;
  return std::nullopt;
}

/// The number behind `name` in a file of lines of names and numbers.
std::optional<std::uint64_t> number_of(const fs::path& path, const std::string& name) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(name) || line.size() == name.size()) continue;
    try {
      return std::stoull(line.substr(name.size()));
    } catch (const std::logic_error&) {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

/// Names of a version's files.
struct GroupFiles {
  const char *limit, *usage, *cache;
};

/// What is left under the limits of the control groups from `group` up to `top`.
std::uint64_t left_in_groups(const fs::path& top, const fs::path& group, const GroupFiles& files) {
  std::uint64_t least = no_limit;
  fs::path relative = group.relative_path();
  for (;;) {
    const fs::path directory = relative.empty() ? top : top / relative;
    const auto limit = number_in(directory / files.limit),
               usage = number_in(directory / files.usage);
    if (limit && usage) {
      const std::uint64_t cache = number_of(directory / "memory.stat", files.cache).value_or(0);
      const std::uint64_t held = *usage - std::min(*usage, cache);
      least = std::min(least, *limit - std::min(*limit, held));
    }
    if (relative.empty()) return least;
    relative = relative.parent_path();
  }
}

}  // namespace

std::uint64_t available_memory(const fs::path& root) {
  std::uint64_t available = no_limit;
  if (const auto kib = number_of(root / "proc/meminfo", "MemAvailable:")) available = *kib * 1024;
  // Lines of /proc/self/cgroup are "0::/group" in version 2, "5:memory:/group" in version 1.
  std::ifstream groups(root / "proc/self/cgroup");
  const fs::path mount = root / "sys/fs/cgroup";
  for (std::string line; std::getline(groups, line);) {
    const auto path = line.find(":/");
    if (path == line.npos) continue;
    const fs::path group = line.substr(path + 1);
    if (line.starts_with("0::")) {
      const GroupFiles files{"memory.max", "memory.current", "inactive_file "};
      available = std::min(available, left_in_groups(mount, group, files));
    } else if (line.find(":memory:") != line.npos) {
      const GroupFiles files{"memory.limit_in_bytes", "memory.usage_in_bytes",
                             "total_inactive_file "};
      available = std::min(available, left_in_groups(mount / "memory", group, files));
    }
  }
  return available;
}

}  // namespace motes
