// Whatever a page may say: a message or an Error, nothing else.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/error.h"
#include "server/messages.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    motes::server::parse_message({reinterpret_cast<const char*>(data), size});
  } catch (const motes::Error&) {
    // That is how it is told.
  }
  return 0;
}
