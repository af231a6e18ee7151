// The front of a text file, read no farther than its parser must look.
#pragma once

#include <filesystem>

#include "io/text.h"
#include "io/text_source.h"

namespace motes {

/// parse(lines) of a text from its first line on, which is loaded as far as it takes. Throws what
/// `parse` throws.
template <class Parse>
auto parse_head(const std::filesystem::path& path, const ReadOptions& options, Parse&& parse) {
  TextSource source(path, options);
  for (;;) {
    LineReader lines(path, {source.loaded(), 1}, source.complete());
    try {
      return parse(lines);
    } catch (const TextEnds&) {
      if (source.complete()) throw;
    }
    source.load_more();
  }
}

}  // namespace motes
