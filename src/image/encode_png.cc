// PNG through libspng.
#include <fmt/format.h>
#include <spng.h>

#include <cstdlib>
#include <memory>

#include "core/error.h"
#include "core/report.h"
#include "image/encode.h"

namespace motes {

namespace {

void check(int status) {
  if (status != 0) throw Error(fmt::format("cannot encode as PNG: {}", spng_strerror(status)));
}

}  // namespace

std::string encode_png(const DisplayImage& image, const std::atomic<bool>* cancel) {
  const std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)> context(spng_ctx_new(SPNG_CTX_ENCODER),
                                                                    &spng_ctx_free);
  spng_ihdr header{};
  header.width = static_cast<std::uint32_t>(image.width);
  header.height = static_cast<std::uint32_t>(image.height);
  header.bit_depth = 8;
  header.color_type = SPNG_COLOR_TYPE_TRUECOLOR;
  check(spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1));
  check(spng_set_ihdr(context.get(), &header));
  check(spng_set_srgb(context.get(), 0));  // perceptual
  check(spng_encode_image(context.get(), nullptr, 0, SPNG_FMT_PNG,
                          SPNG_ENCODE_PROGRESSIVE | SPNG_ENCODE_FINALIZE));
  const std::size_t row_bytes = std::size_t{3} * header.width;
  for (std::size_t row = 0; row < header.height; ++row) {
    if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) throw Cancelled();
    const int status =
        spng_encode_row(context.get(), image.rgb.data() + row * row_bytes, row_bytes);
    if (status != SPNG_EOI) check(status);
  }
  std::size_t size = 0;
  int status = 0;
  const std::unique_ptr<void, decltype(&std::free)> bytes(
      spng_get_png_buffer(context.get(), &size, &status), &std::free);
  check(status);
  return {static_cast<const char*>(bytes.get()), size};
}

}  // namespace motes
