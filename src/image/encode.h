// Images as the bytes of a file format, in memory.
#pragma once

#include <atomic>
#include <string>

#include "image/display.h"
#include "image/framebuffer.h"

namespace motes {

/// PNG, 8-bit RGB, marked as sRGB. Throws Error where the format cannot hold the image, and
/// Cancelled soon after `cancel`, which may be null, becomes true: a screen takes a fifth of a
/// second.
std::string encode_png(const DisplayImage& image, const std::atomic<bool>* cancel = nullptr);

/// JPEG, without chroma subsampling. `quality` as libjpeg's, 1 to 100. Throws Error where the
/// format cannot hold the image (more than 65500 pixels on a side).
std::string encode_jpeg(const DisplayImage& image, int quality = 92);

/// OpenEXR: channels R, G, B, A in 32-bit float, linear and premultiplied, ZIP compression.
std::string encode_exr(const Framebuffer& framebuffer);

/// What stands before the framebuffer's floats in an NPY file: [height][width][4], little-endian.
std::string npy_header(const Framebuffer& framebuffer);

}  // namespace motes
