// Feeds a reader with any bytes: it gives particles or throws Error, whatever they are.
#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "core/error.h"
#include "fuzz/memory_file.h"
#include "io/format.h"

namespace {

/// The format of this program (MOTES_FUZZ_FORMAT): called by name, so that no mark in the content
/// has to be hit first.
const motes::Format& fuzzed_format() {
  const auto& formats = motes::formats();
  const auto found = std::find_if(formats.begin(), formats.end(), [](const motes::Format& format) {
    return format.name == MOTES_FUZZ_FORMAT;
  });
  if (found == formats.end()) std::abort();
  return *found;
}

/// What every frame promises, whatever the file.
void check(const motes::ParticleSet& particles) {
  const std::size_t n = particles.size();
  bool sound = particles.y.size() == n && particles.z.size() == n &&
               (particles.species.empty() || particles.species.size() == n) &&
               (particles.ids.empty() || particles.ids.size() == n);
  for (const auto species : particles.species) {
    sound = sound && species < particles.species_names.size();
  }
  for (const auto& property : particles.properties) sound = sound && property.values.size() == n;
  for (const auto& bond : particles.bonds) {
    sound = sound && bond.first <= bond.second && bond.second < n;
  }
  if (!sound) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const motes::Format& format = fuzzed_format();
  static const motes::MemoryFile file;
  file.assign(data, size);
  motes::Warnings warnings;
  const motes::ReadOptions options{.warnings = &warnings};
  try {
    // Through the recognition too: it sees every file there is.
    (void)format.matches({reinterpret_cast<const char*>(data), size});
    const auto trajectory = format.open(file.path, options);
    check(trajectory->read_frame(0));
    const std::size_t frames = trajectory->num_frames();
    if (frames > 1) check(trajectory->read_frame(frames - 1));
  } catch (const motes::Error&) {
    // A bad file, refused.
  }
  return 0;
}
