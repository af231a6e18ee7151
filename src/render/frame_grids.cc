#include "render/frame_grids.h"

#include <algorithm>
#include <utility>

namespace motes {
namespace {

/// Whether any value from `low` to `high` has extinction.
bool shows(const TransferFunction& function, double low, double high) {
  const auto& points = function.points;
  const auto is_opaque = [](const TransferFunction::Point& point) { return point.extinction > 0; };
  // From the last point that is not above to the first that is not below: between two of them all
  // is transparent if they are.
  const auto above = std::upper_bound(
      points.begin(), points.end(), low,
      [](double value, const TransferFunction::Point& point) { return value < point.value; });
  const auto first = above == points.begin() ? above : above - 1;
  const auto below = std::lower_bound(
      above, points.end(), high,
      [](const TransferFunction::Point& point, double value) { return point.value < value; });
  return std::any_of(first, below == points.end() ? below : below + 1, is_opaque);
}

/// A value without extinction; 0 if there is none.
double find_transparent(const TransferFunction& function) {
  for (const TransferFunction::Point& point : function.points) {
    if (point.extinction == 0) return point.value;
  }
  return 0;
}

}  // namespace

std::vector<FrameGrid> make_frame_grids(const GridFields& grids, const KernelSet& kernels,
                                        const View& view,
                                        const std::vector<TransferFunction>& transfer_functions,
                                        const std::vector<Classifier>& classifiers) {
  std::vector<FrameGrid> frame_grids;
  const double unit = 1 / kernels.length_scale;
  const Point3d eye = kernels.origin + unit * (view.eye - Point3d{});
  const Vector3d axes[3] = {view.axes.x, view.axes.y, view.axes.forward};
  for (const GridField& grid : grids) {
    const GridSampler& sampler = *grid.sampler;
    const TransferFunction& function = transfer_functions[grid.field];
    FrameGrid out;
    out.field = grid.field;
    out.view = sampler.view();
    out.dims = grid.cells->dims();
    for (const MacroCells::Range& range : grid.cells->ranges()) {
      out.visible.push_back(shows(function, range.min, range.max) ? 1 : 0);
    }
    out.value_scale = static_cast<float>(kernels.fields[grid.field].value_scale);
    if (classifiers[grid.field].visibility.shows_zero()) {
      out.hidden_value = static_cast<float>(find_transparent(function)) * out.value_scale;
    }
    const Point3d eye_index = sampler.to_index(eye);
    for (int i = 0; i < 3; ++i) {
      Vector3d one;
      one[i] = 1;
      const Vector3d gradient = sampler.to_world_gradient(one);  // of index coordinate i
      out.eye[i] = eye_index[i];
      for (int a = 0; a < 3; ++a) {
        out.axes[i][a] = unit * dot(gradient, axes[a]);
        out.gradient[a][i] = static_cast<float>(out.axes[i][a] * double{out.value_scale});
      }
    }
    frame_grids.push_back(std::move(out));
  }
  return frame_grids;
}

}  // namespace motes
