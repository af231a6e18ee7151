// Images read back with the formats' own libraries, for tests.
#pragma once

#include <string>

#include "image/display.h"
#include "image/framebuffer.h"

namespace motes {

DisplayImage decode_png(const std::string& bytes);
Framebuffer decode_exr(const std::string& bytes);

}  // namespace motes
