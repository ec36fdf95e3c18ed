#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pleinair::measure {

/// Text of a page, without what HTML would take for its own.
std::string escaped(const std::string& text);

/// One line of a plot; where it has no value, the line has a gap.
struct PlotLine {
  std::string name;
  std::string style;  ///< class of the page's style sheet: "painting", "input"
  std::vector<std::optional<double>> values;
};

struct PlotText {
  std::string title;
  std::string unit;  ///< along the axis of values: "levels"
};

/// A plot over frames as inline SVG, that takes its colours from the page. Empty where no line has
/// two values. Precondition: as many values a line as frames.
std::string plotSvg(const PlotText& text, const std::vector<std::uint64_t>& frames,
                    const std::vector<PlotLine>& lines);

}  // namespace pleinair::measure
