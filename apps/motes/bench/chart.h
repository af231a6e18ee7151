// Small charts as SVG.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace motes {

/// Groups of bars; a value may be missing. An axis that is not logarithmic starts at 0.
struct BarChart {
  struct Series {
    std::string name;
    std::vector<std::optional<double>> values;  ///< one a category; > 0 if `log`
  };
  std::string title, value_name;
  std::vector<std::string> categories;
  std::vector<Series> series;
  bool log = true;
};

/// Lines through points; a vertical axis that is not logarithmic starts at 0.
struct LineChart {
  struct Series {
    std::string name;
    std::vector<std::pair<double, double>> points;
  };
  std::string title, x_name, y_name;
  bool log_x = false, log_y = false;
  std::vector<Series> series;
};

std::string to_svg(const BarChart& chart);
std::string to_svg(const LineChart& chart);

}  // namespace motes
