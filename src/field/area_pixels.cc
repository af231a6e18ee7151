#include "field/area_pixels.h"

#include <algorithm>
#include <cmath>

#include "samples/area_buffer.h"

namespace motes {
namespace {

/// A ray: across the view and per depth.
struct Line {
  double origin, direction;
};

PixelLines make_lines(const Line& first, const Line& last, double reference, const SlabFrame& frame,
                      const Range& slopes) {
  constexpr double steps = AreaBuffer::size - 1;
  const double step = (last.direction - first.direction) / steps;
  return {{first.origin + frame.reference_depth * first.direction - reference, first.direction},
          {(last.origin - first.origin) / steps + frame.reference_depth * step, step},
          std::max(std::abs(slopes.low), std::abs(slopes.high))};
}

}  // namespace

AreaPixels place_pixels(const RayBounds& area, const RayBounds& in_image, const SlabFrame& frame) {
  const Line left{area.origin_x.low, area.direction_x.low};
  const Line right{area.origin_x.high, area.direction_x.high};
  const Line top{area.origin_y.high, area.direction_y.high};
  const Line bottom{area.origin_y.low, area.direction_y.low};
  return {make_lines(left, right, frame.reference_x, frame, in_image.direction_x),
          make_lines(top, bottom, frame.reference_y, frame, in_image.direction_y)};
}

AreaPlane place_plane(const AreaPixels& pixels, const SlabFrame& frame, int k) {
  const double z = static_cast<double>(frame.first_depth) + k * static_cast<double>(frame.step);
  return {static_cast<float>(pixels.columns.first.at(z)),
          static_cast<float>(pixels.columns.step.at(z)),
          static_cast<float>(pixels.rows.first.at(z)), static_cast<float>(pixels.rows.step.at(z)),
          static_cast<float>(z)};
}

}  // namespace motes
