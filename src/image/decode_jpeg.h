// JPEG files read back.
#pragma once

#include <string_view>

#include "image/display.h"

namespace motes {

/// Throws Error for what is no JPEG file.
DisplayImage decode_jpeg(std::string_view bytes);

}  // namespace motes
