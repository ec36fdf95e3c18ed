#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pleinair::measure {

/// Escapes text for HTML.
std::string escaped(const std::string& text);

/// One line of a plot. Where a value is missing, the line has a gap.
struct PlotLine {
  std::string name;
  std::string style;  ///< class in the page's style sheet: "painting", "input"
  std::vector<std::optional<double>> values;
};

struct PlotText {
  std::string title;
  std::string unit;  ///< on the value axis: "levels"
};

/// A plot over frames as inline SVG, with colours from the page. Empty if no line has two values.
/// Precondition: each line has one value per frame.
std::string plotSvg(const PlotText& text, const std::vector<std::uint64_t>& frames,
                    const std::vector<PlotLine>& lines);

}  // namespace pleinair::measure
