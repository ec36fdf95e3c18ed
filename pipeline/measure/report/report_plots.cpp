#include "pipeline/measure/report/report_plots.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace pleinair::measure {
namespace {

constexpr double kWidth = 420;
constexpr double kHeight = 170;
constexpr double kLeft = 64;
constexpr double kRight = 12;
constexpr double kTop = 22;
constexpr double kBottom = 36;

/// The smallest of 1, 2, 2.5, 5 × 10ⁿ that is not below `value`.
double roundedUp(double value) {
  if (!(value > 0)) return 1;
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 2.5, 5.0}) {
    if (value <= step * decade) return step * decade;
  }
  return 10 * decade;
}

struct Axes {
  double min = 0, max = 1;     ///< of the values
  double first = 0, last = 1;  ///< of the frames

  double x(double frame) const {
    return kLeft + (frame - first) / (last - first) * (kWidth - kLeft - kRight);
  }
  double y(double value) const {
    return kHeight - kBottom - (value - min) / (max - min) * (kHeight - kTop - kBottom);
  }
};

std::string gridLine(const Axes& axes, double value) {
  return fmt::format(R"(<line class="grid" x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}"/>)"
                     R"(<text class="tick" x="{:.1f}" y="{:.1f}" text-anchor="end">{:.4g}</text>)",
                     kLeft, axes.y(value), kWidth - kRight, axes.y(value), kLeft - 5,
                     axes.y(value) + 3.5, value);
}

std::string axisLabels(const std::string& unit) {
  const double middleY = (kTop + kHeight - kBottom) / 2;
  return fmt::format(R"-(<text class="label" x="{:g}" y="{:g}" text-anchor="middle">frame</text>)-"
                     R"-(<text class="label" transform="translate(12 {:g}) rotate(-90)" )-"
                     R"-(text-anchor="middle">{}</text>)-",
                     (kLeft + kWidth - kRight) / 2, kHeight - 7, middleY, escaped(unit));
}

std::string lineSvg(const Axes& axes, const std::vector<std::uint64_t>& frames,
                    const PlotLine& line) {
  std::string path;
  bool isOpen = false;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::optional<double>& value = line.values[i];
    if (value) {
      path += fmt::format("{}{:.1f} {:.1f}", isOpen ? "L" : "M",
                          axes.x(static_cast<double>(frames[i])), axes.y(*value));
    }
    isOpen = value.has_value();
  }
  return fmt::format(R"(<path class="line {}" d="{}"><title>{}</title></path>)", line.style, path,
                     escaped(line.name));
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string plotSvg(const PlotText& text, const std::vector<std::uint64_t>& frames,
                    const std::vector<PlotLine>& lines) {
  Axes axes;
  double min = 0;
  double max = 0;
  std::ptrdiff_t longest = 0;
  for (const PlotLine& line : lines) {
    for (const std::optional<double>& value : line.values) {
      if (!value) continue;
      min = std::min(min, *value);
      max = std::max(max, *value);
    }
    longest = std::max(longest, std::ranges::count_if(line.values, [](const auto& value) {
                         return value.has_value();
                       }));
  }
  if (longest < 2 || frames.size() < 2) return "";
  axes.max = roundedUp(max);
  axes.min = min < 0 ? -roundedUp(-min) : 0;
  axes.first = static_cast<double>(frames.front());
  axes.last = static_cast<double>(frames.back());
  const std::string title = escaped(text.title);
  std::string svg = fmt::format(
      R"(<svg viewBox="0 0 {:g} {:g}" role="img" aria-label="{}"><text class="title" x="{:g}" y="14">{}</text>)",
      kWidth, kHeight, title, kLeft, title);
  svg += axisLabels(text.unit);
  svg += gridLine(axes, axes.min) + gridLine(axes, (axes.min + axes.max) / 2) +
         gridLine(axes, axes.max);
  for (const std::uint64_t frame : {frames.front(), frames.back()}) {
    svg += fmt::format(R"(<text class="tick" x="{:.1f}" y="{:.1f}" text-anchor="middle">{}</text>)",
                       axes.x(static_cast<double>(frame)), kHeight - kBottom + 14, frame);
  }
  for (const PlotLine& line : lines) svg += lineSvg(axes, frames, line);
  return svg + "</svg>\n";
}

}  // namespace pleinair::measure
