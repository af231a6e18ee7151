// A frame's grids as its tiles need them: from the rays' axes to index coordinates, and what shows.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "field/slab_frame.h"
#include "integrate/classifier.h"
#include "render/grid_fields.h"

namespace motes {

/// What a frame's tiles need of a grid. Lengths are internal.
struct FrameGrid {
  std::size_t field = 0;
  GridView view;
  std::array<int, 3> dims{};          ///< of `visible`
  std::vector<std::uint8_t> visible;  ///< whether a macro cell may show anything
  /// Of the buffer, for places that are left out; not 0 only where the field shows at 0.
  float hidden_value = 0;
  double eye[3];          ///< index coordinates
  double axes[3][3];      ///< of those the gradients, in camera axes
  float value_scale = 1;  ///< buffer's value over the grid's
  float gradient[3][3];   ///< camera axes from index axes, value_scale included
};

/// `transfer_functions` are one a field, and so are `classifiers`, made of them.
std::vector<FrameGrid> make_frame_grids(const GridFields& grids, const KernelSet& kernels,
                                        const View& view,
                                        const std::vector<TransferFunction>& transfer_functions,
                                        const std::vector<Classifier>& classifiers);

}  // namespace motes
