// Transfer functions compiled for pass 2: tables in the units of the sample buffer.
#pragma once

#include <cstddef>

#include "core/aligned.h"
#include "samples/samples.h"
#include "scene/transfer_function.h"

namespace motes {

/// Segments of a piecewise linear transfer function. The argument is the buffer's value or, with
/// log_scale, its base-10 logarithm.
struct Classifier {
  /// Rows of the table, one entry a segment: its begin, one over its width, values at its begin and
  /// their rise over it. Values are red, green, blue, and extinction times the step in depth
  /// (file's lengths), so that times |D| it is a sample's optical depth.
  enum Row { begin, inverse_width, base, rise = base + 4, num_rows = rise + 4 };

  bool log_scale = false;
  float log_shift = 0;  ///< with log_scale: log10(value) = log10(buffer's value) + log_shift
  int num_segments = 0;
  /// One over the width of the segments if that is the same for all, else 0.
  float inverse_spacing = 0;
  std::size_t row_size = 0;    ///< whole vectors
  AlignedVector<float> table;  ///< rows, and room to load one more vector behind the last
  const float* row(int i) const { return table.data() + static_cast<std::size_t>(i) * row_size; }
  /// The values again, those of a segment together: four at its begin, then their rises.
  static constexpr std::size_t record_size = 8;
  AlignedVector<float> records;

  Visibility visibility{};  ///< buffer's values that have extinction
  float max_depth = 0;      ///< largest extinction times step
};

/// `value_scale`: buffer's value over field's value; `step_size`: file's lengths.
Classifier compile_transfer_function(const TransferFunction& function, double value_scale,
                                     double step_size);

}  // namespace motes
