// Draws axes, bars and lines; no styling beyond what a reader needs.
#include "motes/bench/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "core/vec.h"

namespace motes {
namespace {

// Told apart by people with any colour vision, and on paper.
constexpr std::array<std::string_view, 8> colors{"#0f6fc6", "#f28e2b", "#9a9a9a", "#2a9d6f",
                                                 "#c23b4e", "#7a5195", "#8c6d31", "#17becf"};
constexpr double left = 70, top = 62, plot_height = 300, right = 20;

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else {
      out += c;
    }
  }
  return out;
}

/// A drawing that grows by elements.
class Drawing {
 public:
  Drawing(double width, double height) : width_(width), height_(height) {}

  void line(double x1, double y1, double x2, double y2, std::string_view color, double width = 1) {
    body_ += fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" "
        "stroke-width=\"{}\"/>\n",
        x1, y1, x2, y2, color, width);
  }
  void rectangle(double x, double y, double width, double height, std::string_view color,
                 std::string_view tip = {}) {
    body_ += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
        "fill=\"{}\"><title>{}</title></rect>\n",
        x, y, width, height, color, escaped(tip));
  }
  void circle(double x, double y, std::string_view color) {
    body_ +=
        fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>\n", x, y, color);
  }
  /// `anchor` is start, middle or end; `turn` in degrees.
  void text(double x, double y, std::string_view text, std::string_view anchor = "middle",
            double size = 12, double turn = 0) {
    body_ += fmt::format(
        "<text x=\"{0:.1f}\" y=\"{1:.1f}\" text-anchor=\"{2}\" font-size=\"{3}\" "
        "transform=\"rotate({4} {0:.1f} {1:.1f})\">{5}</text>\n",
        x, y, anchor, size, turn, escaped(text));
  }
  std::string svg() const {
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
        "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"sans-serif\" fill=\"#222\">\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{2}</svg>\n",
        width_, height_, body_);
  }

 private:
  double width_, height_;
  std::string body_;
};

/// From the name of a series to the next one's.
double caption_width(const std::string& name) {
  return 30 + 6.4 * static_cast<double>(name.size());
}

/// What draw_captions() needs, margins included.
template <class Series>
double captions_width(const std::string& title, const std::vector<Series>& series) {
  double names = 0;
  for (const Series& each : series) names += caption_width(each.name);
  return left + std::max(8.0 * static_cast<double>(title.size()), names) + right;
}

/// Title, name of the vertical axis and the names of the series with their colours.
template <class Series>
void draw_captions(Drawing& drawing, const std::string& title, const std::string& value_name,
                   const std::vector<Series>& series) {
  drawing.text(left, 22, title, "start", 15);
  drawing.text(18, top + plot_height / 2, value_name, "middle", 12, -90);
  double x = left;
  for (std::size_t s = 0; s < series.size(); ++s) {
    drawing.rectangle(x, 36, 12, 12, colors[s % colors.size()]);
    drawing.text(x + 17, 46, series[s].name, "start");
    x += caption_width(series[s].name);
  }
}

/// A step of 1, 2 or 5 times a power of ten that divides `range` into about five.
double tick_step(double range) {
  const double power = std::pow(10, std::floor(std::log10(range / 4)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (range / (factor * power) <= 6) return factor * power;
  }
  return 10 * power;
}

/// Values to places along an axis, from 0 to 1; logarithmic axes span whole decades.
class Axis {
 public:
  Axis(bool log, double low, double high) : log_(log) {
    low_ = log ? std::floor(std::log10(low)) : low;
    high_ = log ? std::ceil(std::log10(high)) : high;
    if (!(high_ > low_)) high_ = low_ + 1;
    step_ = log ? 1 : tick_step(high_ - low_);
    if (!log) high_ = step_ * std::ceil(high_ / step_);
  }
  double place(double value) const {
    return ((log_ ? std::log10(value) : value) - low_) / (high_ - low_);
  }
  std::vector<double> ticks() const {
    std::vector<double> values;
    for (int i = 0; i <= static_cast<int>(std::round((high_ - low_) / step_)); ++i) {
      const double at = low_ + i * step_;
      values.push_back(log_ ? std::pow(10, at) : at);
    }
    return values;
  }

 private:
  bool log_;
  double low_, high_, step_;
};

}  // namespace

std::string to_svg(const BarChart& chart) {
  constexpr double label_height = 110;
  double low = 1e300, high = 0;
  for (const auto& series : chart.series) {
    for (const auto& value : series.values) {
      if (!value) continue;
      low = std::min(low, *value);
      high = std::max(high, *value);
    }
  }
  const Axis axis(chart.log, chart.log ? low : 0, high);
  const auto height_of = [&](double value) { return plot_height * axis.place(value); };
  // Bars are 11 wide and groups 12 apart, or as much more as makes the plot as wide as its
  // captions.
  const double captions = captions_width(chart.title, chart.series);
  const auto num_bars = static_cast<double>(chart.series.size());
  const double narrowest = (11 * num_bars + 12) * static_cast<double>(chart.categories.size());
  const double stretch = std::max(1.0, (captions - left - right) / narrowest);
  const double bar = 11 * stretch, gap = 12 * stretch, width = narrowest * stretch;
  const double group = bar * num_bars + gap;
  Drawing drawing(left + width + right, top + plot_height + label_height);
  draw_captions(drawing, chart.title, chart.value_name, chart.series);
  for (const double tick : axis.ticks()) {
    const double y = top + plot_height - height_of(tick);
    drawing.line(left, y, left + width, y, "#ddd");
    drawing.text(left - 6, y + 4, fmt::format("{:g}", tick), "end");
  }
  for (std::size_t c = 0; c < chart.categories.size(); ++c) {
    const double x = left + group * static_cast<double>(c) + gap / 2;
    for (std::size_t s = 0; s < chart.series.size(); ++s) {
      const auto& value = chart.series[s].values[c];
      if (!value) continue;
      drawing.rectangle(
          x + bar * static_cast<double>(s), top + plot_height - height_of(*value), bar - 1,
          height_of(*value), colors[s % colors.size()],
          fmt::format("{}, {}: {:.3g}", chart.categories[c], chart.series[s].name, *value));
    }
    drawing.text(x + (group - gap) / 2 + 4, top + plot_height + 14, chart.categories[c], "end", 11,
                 -40);
  }
  drawing.line(left, top + plot_height, left + width, top + plot_height, "#222");
  return drawing.svg();
}

std::string to_svg(const LineChart& chart) {
  constexpr double width = 620, label_height = 50;
  Bounds3d bounds;
  for (const auto& series : chart.series) {
    for (const auto& [x, y] : series.points) bounds.add(Point3d(x, y, 0));
  }
  const double first_x =
      chart.log_x ? bounds.min.x
                  : tick_step(bounds.max.x) * std::floor(bounds.min.x / tick_step(bounds.max.x));
  const Axis x_axis(chart.log_x, first_x, bounds.max.x);
  const Axis y_axis(chart.log_y, chart.log_y ? bounds.min.y : 0, bounds.max.y);
  const auto to_x = [&](double x) { return left + width * x_axis.place(x); };
  const auto to_y = [&](double y) { return top + plot_height * (1 - y_axis.place(y)); };

  Drawing drawing(std::max(left + width + right, captions_width(chart.title, chart.series)),
                  top + plot_height + label_height);
  draw_captions(drawing, chart.title, chart.y_name, chart.series);
  for (const double y : y_axis.ticks()) {
    drawing.line(left, to_y(y), left + width, to_y(y), "#ddd");
    drawing.text(left - 6, to_y(y) + 4, fmt::format("{:g}", y), "end");
  }
  for (const double x : x_axis.ticks()) {
    drawing.line(to_x(x), top + plot_height, to_x(x), top + plot_height + 5, "#222");
    drawing.text(to_x(x), top + plot_height + 18, fmt::format("{:g}", x));
  }
  drawing.text(left + width / 2, top + plot_height + 38, chart.x_name);
  for (std::size_t s = 0; s < chart.series.size(); ++s) {
    const auto& points = chart.series[s].points;
    const std::string_view color = colors[s % colors.size()];
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double x = to_x(points[i].first), y = to_y(points[i].second);
      if (i > 0) {
        drawing.line(to_x(points[i - 1].first), to_y(points[i - 1].second), x, y, color, 2);
      }
      drawing.circle(x, y, color);
    }
  }
  drawing.line(left, top + plot_height, left + width, top + plot_height, "#222");
  return drawing.svg();
}

}  // namespace motes
