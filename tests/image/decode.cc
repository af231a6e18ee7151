#include "decode.h"

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <spng.h>

#include <cstring>
#include <memory>
#include <stdexcept>

namespace motes {

DisplayImage decode_png(const std::string& bytes) {
  const std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)> context(spng_ctx_new(0),
                                                                    &spng_ctx_free);
  spng_ihdr header{};
  std::size_t size = 0;
  DisplayImage image;
  if (spng_set_png_buffer(context.get(), bytes.data(), bytes.size()) != 0 ||
      spng_get_ihdr(context.get(), &header) != 0 ||
      spng_decoded_image_size(context.get(), SPNG_FMT_RGB8, &size) != 0) {
    throw std::runtime_error("no PNG");
  }
  image.width = static_cast<int>(header.width);
  image.height = static_cast<int>(header.height);
  image.rgb.resize(size);
  if (spng_decode_image(context.get(), image.rgb.data(), size, SPNG_FMT_RGB8, 0) != 0) {
    throw std::runtime_error("broken PNG");
  }
  return image;
}

namespace {

class MemoryInput : public Imf::IStream {
 public:
  explicit MemoryInput(const std::string& bytes) : Imf::IStream("memory"), bytes_(bytes) {}
  bool read(char out[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (position_ + size > bytes_.size()) throw std::runtime_error("EXR ends early");
    std::memcpy(out, bytes_.data() + position_, size);
    position_ += size;
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  const std::string& bytes_;
  std::size_t position_ = 0;
};

}  // namespace

Framebuffer decode_exr(const std::string& bytes) {
  MemoryInput stream(bytes);
  Imf::InputFile file(stream);
  const auto window = file.header().dataWindow();
  Framebuffer framebuffer(window.max.x + 1, window.max.y + 1);
  Imf::FrameBuffer slices;
  const char* const names[4] = {"R", "G", "B", "A"};
  for (std::size_t c = 0; c < 4; ++c) {
    slices.insert(names[c],
                  Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(framebuffer.rgba.data() + c), 16,
                             16 * static_cast<std::size_t>(framebuffer.width)));
  }
  file.setFrameBuffer(slices);
  file.readPixels(0, window.max.y);
  return framebuffer;
}

}  // namespace motes
