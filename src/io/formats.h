// The formats that the table lists; each is defined in the file that reads it.
#pragma once

#include "io/format.h"

namespace motes {}  // namespace motes
