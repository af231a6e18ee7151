#include "image/write_image.h"

#include <algorithm>
#include <cctype>

#include "core/error.h"
#include "image/display.h"
#include "image/encode.h"

namespace motes {

ImageFormat image_format(const std::filesystem::path& path) {
  std::string suffix = path.extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (suffix == ".png") return ImageFormat::png;
  if (suffix == ".jpg" || suffix == ".jpeg") return ImageFormat::jpeg;
  if (suffix == ".exr") return ImageFormat::exr;
  if (suffix == ".npy") return ImageFormat::npy;
  throw Error(path, "unknown image format, expected a name that ends in .png, .jpg, .exr or .npy");
}

std::string encode_image(ImageFormat format, const Framebuffer& framebuffer,
                         double termination_opacity, const Color& background,
                         const std::atomic<bool>* cancel) {
  switch (format) {
    case ImageFormat::png:
      return encode_png(to_display(framebuffer, termination_opacity, background), cancel);
    case ImageFormat::jpeg:
      return encode_jpeg(to_display(framebuffer, termination_opacity, background));
    case ImageFormat::exr:
      return encode_exr(framebuffer);
    case ImageFormat::npy:
      break;
  }
  return npy_header(framebuffer)
      .append(reinterpret_cast<const char*>(framebuffer.rgba.data()),
              framebuffer.rgba.size() * sizeof(float));
}

void write_image(AtomicFile& file, ImageFormat format, const Framebuffer& framebuffer,
                 double termination_opacity, const Color& background) {
  file.write(encode_image(format, framebuffer, termination_opacity, background));
}

void write_image(const std::filesystem::path& path, const Framebuffer& framebuffer,
                 double termination_opacity, const Color& background) {
  const ImageFormat format = image_format(path);
  AtomicFile file(path);
  write_image(file, format, framebuffer, termination_opacity, background);
  file.commit();
}

}  // namespace motes
