#include "pipeline/measure/measures.h"

#include <array>

#include <fmt/format.h>

namespace pleinair::measure {

std::span<const MeasureColumn> measureColumns() {
  static constexpr std::array kColumns{
      MeasureColumn{
          &Measures::ew2, "EW2", "ew2", "{:.3f}", "mean square × 1000",
          "difference along the motion, lag 2, ×1000; 0 is perfect, blurring is rewarded"},
      MeasureColumn{&Measures::xEw2, "xEW2", "xew2", "{:.2f}", "of the input's",
                    "EW2 over the input's: 1 is as noisy as the camera"},
      MeasureColumn{&Measures::nHw2, "nHW2", "nhw2", "{:.3f}", "of the misaligned",
                    "0: marks follow the image; 1: marks are unrelated between frames"},
      MeasureColumn{&Measures::popPercent, "POP %", "pop_percent", "{:.2f}", "% of the pixels",
                    "pixels that change by more than 24 levels along the motion"},
      MeasureColumn{&Measures::s10Percent, "S10 %", "s10_percent", "{:.1f}", "% of the marks",
                    "marks found again ten frames later"},
      MeasureColumn{
          &Measures::scr, "SCR", "scr", "{:.3f}", "correlation",
          "content that stays on the screen while the image moves: the shower-door effect"},
      MeasureColumn{&Measures::xFlk, "xFLK", "xflk", "{:.3f}", "of the input's",
                    "flicker of a still scene over the camera's noise: 1 passes it through"},
      MeasureColumn{&Measures::dep, "DEP", "dep", "{:.1f}", "levels",
                    "distance from the photograph in levels, apart from a tone curve"},
      MeasureColumn{&Measures::det, "DET", "det", "{:.2f}", "of the input's",
                    "detail kept of the photograph's"},
  };
  return kColumns;
}

std::string textOf(const MeasureColumn& column, const Measures& measures) {
  const std::optional<double>& value = measures.*column.value;
  return value ? fmt::format(fmt::runtime(column.format), *value) : "–";
}

}  // namespace pleinair::measure
