// Images to files, in the format that the file's name asks for.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>

#include "core/atomic_file.h"
#include "core/color.h"
#include "image/framebuffer.h"

namespace motes {

enum class ImageFormat { png, jpeg, exr, npy };

/// By suffix: .png, .jpg or .jpeg, .exr, .npy, in any case. Throws Error for others.
ImageFormat image_format(const std::filesystem::path& path);

/// The bytes of a file of that format. PNG and JPEG show `framebuffer` as to_display() does; EXR
/// and NPY hold it as it is. Of PNG, which takes longest, throws Cancelled soon after `cancel`,
/// which may be null, becomes true.
std::string encode_image(ImageFormat format, const Framebuffer& framebuffer,
                         double termination_opacity, const Color& background,
                         const std::atomic<bool>* cancel = nullptr);

/// Writes `framebuffer` to `file`, as encode_image() has it, but does not commit it.
void write_image(AtomicFile& file, ImageFormat format, const Framebuffer& framebuffer,
                 double termination_opacity, const Color& background);

/// The same, whole or not at all, in the format of `path`. Throws Error.
void write_image(const std::filesystem::path& path, const Framebuffer& framebuffer,
                 double termination_opacity, const Color& background);

}  // namespace motes
