// JPEG through libjpeg-turbo.
#include <fmt/format.h>

#include <csetjmp>
#include <cstdio>  // before jpeglib.h, which needs it
#include <cstdlib>
#include <memory>

#include <jpeglib.h>

#include "core/error.h"
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

}  // namespace motes
