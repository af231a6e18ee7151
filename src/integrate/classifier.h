// Transfer functions compiled for pass 2: tables in the units of the sample buffer.
#pragma once

#include <vector>

#include "core/aligned.h"
#include "scene/transfer_function.h"

namespace motes {

/// Segments of a piecewise linear transfer function; every array has one entry a segment and is
/// padded to whole vectors. The argument is the buffer's value or, with log_scale, its base-10
/// logarithm.
struct Classifier {
  bool log_scale = false;
  float log_shift = 0;  ///< with log_scale: log10(value) = log10(buffer's value) + log_shift
  int num_segments = 0;
  AlignedVector<float> begin, inverse_width;
  /// Values at the segment's begin and their rise over it: red, green, blue, and extinction times
  /// the step in depth (file's lengths), so that times |D| it is a sample's optical depth.
  AlignedVector<float> base[4], rise[4];
  float transparent_below = 0;       ///< arguments up to this have no extinction (-infinity: none)
  bool zero_is_transparent = false;  ///< a sample that no kernel reaches shows nothing
};

/// `value_scale`: buffer's value over field's value; `step_size`: file's lengths.
Classifier compile_transfer_function(const TransferFunction& function, double value_scale,
                                     double step_size);

}  // namespace motes
