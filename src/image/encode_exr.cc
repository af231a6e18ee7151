// OpenEXR through its own library.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>

#include <cstring>

#include "image/encode.h"

namespace motes {

namespace {

/// An output file of OpenEXR in memory.
class MemoryStream : public Imf::OStream {
 public:
  MemoryStream() : Imf::OStream("memory") {}
  void write(const char bytes[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (position_ + size > bytes_.size()) bytes_.resize(position_ + size);
    std::memcpy(bytes_.data() + position_, bytes, size);
    position_ += size;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
  std::size_t position_ = 0;
};

}  // namespace

std::string encode_exr(const Framebuffer& framebuffer) {
  Imf::Header header(framebuffer.width, framebuffer.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer slices;
  constexpr std::size_t pixel_bytes = 4 * sizeof(float);
  const char* const names[4] = {"R", "G", "B", "A"};
  for (std::size_t c = 0; c < 4; ++c) {
    header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
    // OpenEXR takes one type of pointer for reading and writing; it only reads here.
    char* first = reinterpret_cast<char*>(const_cast<float*>(framebuffer.rgba.data() + c));
    slices.insert(names[c], Imf::Slice(Imf::FLOAT, first, pixel_bytes,
                                       pixel_bytes * static_cast<std::size_t>(framebuffer.width)));
  }
  MemoryStream stream;
  {
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(slices);
    file.writePixels(framebuffer.height);
  }  // the file's table of rows is written when it is closed
  return stream.take();
}

}  // namespace motes
