// JPEG through libjpeg-turbo.
#include <fmt/format.h>

#include <csetjmp>
#include <cstdio>  // before jpeglib.h, which needs it
#include <cstdlib>
#include <memory>

#include <jpeglib.h>

#include "core/error.h"
#include "image/decode_jpeg.h"
#include "image/encode.h"

namespace motes {

namespace {

/// libjpeg reports failures through a function that must not return: ours jumps back.
struct JpegErrors {
  jpeg_error_mgr manager;
  std::jmp_buf jump;
  char message[JMSG_LENGTH_MAX];
};

void jump_back(j_common_ptr info) {
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  info->err->format_message(info, errors->message);
  std::longjmp(errors->jump, 1);
}

/// Encodes into *bytes, which the caller frees whatever happens; false on failure, with its message
/// in `errors`. Holds nothing with a destructor, since jump_back leaves it.
bool compress(const DisplayImage& image, int quality, JpegErrors& errors, unsigned char** bytes,
              unsigned long* size) {
  jpeg_compress_struct info;
  info.err = jpeg_std_error(&errors.manager);
  errors.manager.error_exit = jump_back;
  jpeg_create_compress(&info);
  if (setjmp(errors.jump) != 0) {
    jpeg_destroy_compress(&info);
    return false;
  }
  jpeg_mem_dest(&info, bytes, size);
  info.image_width = static_cast<JDIMENSION>(image.width);
  info.image_height = static_cast<JDIMENSION>(image.height);
  info.input_components = 3;
  info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, quality, TRUE);
  // Thin coloured features would bleed with subsampled colour.
  info.comp_info[0].h_samp_factor = info.comp_info[0].v_samp_factor = 1;
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    const std::size_t row = std::size_t{3} * info.image_width * info.next_scanline;
    JSAMPROW rows[] = {const_cast<JSAMPLE*>(image.rgb.data() + row)};
    jpeg_write_scanlines(&info, rows, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  return true;
}

struct Decompress {
  explicit Decompress(JpegErrors& errors) {
    info.err = jpeg_std_error(&errors.manager);
    errors.manager.error_exit = jump_back;
    jpeg_create_decompress(&info);
  }
  ~Decompress() { jpeg_destroy_decompress(&info); }
  Decompress(const Decompress&) = delete;
  Decompress& operator=(const Decompress&) = delete;

  jpeg_decompress_struct info;
};

/// Decodes into `image`; as compress().
bool decompress(std::string_view bytes, JpegErrors& errors, jpeg_decompress_struct& info,
                DisplayImage& image) {
  if (setjmp(errors.jump) != 0) return false;
  jpeg_mem_src(&info, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&info, TRUE);
  info.out_color_space = JCS_RGB;
  jpeg_start_decompress(&info);
  image.width = static_cast<int>(info.output_width);
  image.height = static_cast<int>(info.output_height);
  image.rgb.resize(std::size_t{3} * info.output_width * info.output_height);
  while (info.output_scanline < info.output_height) {
    const std::size_t row = std::size_t{3} * info.output_width * info.output_scanline;
    JSAMPROW rows[] = {image.rgb.data() + row};
    jpeg_read_scanlines(&info, rows, 1);
  }
  jpeg_finish_decompress(&info);
  return true;
}

}  // namespace

std::string encode_jpeg(const DisplayImage& image, int quality) {
  JpegErrors errors;
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const bool ok = compress(image, quality, errors, &bytes, &size);
  const std::unique_ptr<unsigned char, decltype(&std::free)> owner(bytes, &std::free);
  if (!ok) throw Error(fmt::format("cannot encode as JPEG: {}", errors.message));
  return {reinterpret_cast<const char*>(bytes), size};
}

DisplayImage decode_jpeg(std::string_view bytes) {
  JpegErrors errors;
  Decompress decoder(errors);
  DisplayImage image;
  if (!decompress(bytes, errors, decoder.info, image)) {
    throw Error(fmt::format("cannot decode as JPEG: {}", errors.message));
  }
  return image;
}

}  // namespace motes
