// Levels at which a field is worth a surface, from its values.
#pragma once

#include <span>

namespace motes {

/// Of which signs a field's values are. One with less than 1 % of the sum of magnitudes does not
/// count: densities swing a little below 0 next to steep edges.
enum class Signs { positive, negative, both };
/// Of the finite values; positive where all are 0.
Signs signs_of(std::span<const float> values);

/// The magnitude v whose level encloses 85 % of what evenly spread values stand for. Of one sign,
/// as a density, that is their integral (above their lowest magnitude, where that is 10 % or more
/// of the largest); of both, as an orbital's amplitude, the integral of the squares, within -v and
/// v. Values of the other sign count as 0, those that are not finite not at all. Between two values
/// far apart (of a mask) it is their mean. Where all are equal it is that magnitude.
double enclosing_level(std::span<const float> values, Signs signs);

}  // namespace motes
