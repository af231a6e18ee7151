// Feeds a reader of grids with any bytes: it gives grids or throws Error, whatever they are.
#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "core/error.h"
#include "fuzz/memory_file.h"
#include "io/format.h"
#include "io/grid_format.h"

namespace {

/// The entry of this program (MOTES_FUZZ_FORMAT) in a table: called by name, so that no mark in the
/// content has to be hit first. Null if there is none.
template <class Format>
const Format* find_fuzzed(const std::vector<Format>& formats) {
  const auto found = std::find_if(formats.begin(), formats.end(), [](const Format& format) {
    return format.name == MOTES_FUZZ_FORMAT;
  });
  return found == formats.end() ? nullptr : &*found;
}

void check(const std::vector<motes::Grid>& grids) {
  bool sound = !grids.empty();
  for (const motes::Grid& grid : grids) {
    sound = sound && grid.size() > 0 && grid.values.size() == grid.size() && !grid.name.empty();
  }
  if (!sound) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const motes::GridFormat* const grids = find_fuzzed(motes::grid_formats());
  static const motes::Format* const particles = find_fuzzed(motes::formats());
  static const motes::MemoryFile file;
  if (grids == nullptr) std::abort();
  file.assign(data, size);
  motes::Warnings warnings;
  const motes::ReadOptions options{.warnings = &warnings};
  // Through the recognition too: it sees every file there is.
  const bool matches = grids->matches({reinterpret_cast<const char*>(data), size});
  if (matches && grids->has_grid != nullptr) (void)grids->has_grid(file.path);
  try {
    check(grids->read(file.path, options));
  } catch (const motes::Error&) {
    // A bad file, refused.
  }
  try {
    if (particles != nullptr) (void)particles->open(file.path, options)->read_frame(0);
  } catch (const motes::Error&) {
  }
  return 0;
}
