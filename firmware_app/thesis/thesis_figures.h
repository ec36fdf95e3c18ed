#pragma once

#include <string>
#include <vector>

#include "firmware_app/thesis/thesis_bench.h"
#include "firmware_app/thesis/thesis_figure.h"

namespace pleinair::app {

/// A figure of the thesis, or its table: what is said of it, and how it is made.
struct ThesisFigureKind {
  std::string name;          ///< of its files, and for --only: "29_32"
  std::string title;         ///< "Figures 29 and 32: …"
  std::vector<int> numbers;  ///< of the thesis's figures; none for its table and §6.1
  std::string thesis;        ///< what the thesis shows, in our words
  std::string ours;          ///< what is shown here
  ThesisFigure (*make)(ThesisBench& bench);
};

/// All of them, in the thesis's order.
const std::vector<ThesisFigureKind>& thesisFigures();

// One for each subject; see their texts.
ThesisFigure fieldFigure(ThesisBench& bench);           // 15, 16, 21
ThesisFigure featureFigure(ThesisBench& bench);         // 17, 18
ThesisFigure strokeFigure(ThesisBench& bench);          // 19, 20
ThesisFigure blendingFigure(ThesisBench& bench);        // 23, 31
ThesisFigure photographFigure(ThesisBench& bench);      // 22, 24, 25
ThesisFigure livesFigure(ThesisBench& bench);           // 26
ThesisFigure densityFigure(ThesisBench& bench);         // 28
ThesisFigure staticModelFigure(ThesisBench& bench);     // 29, 32, 34, 35
ThesisFigure skinnedModelFigure(ThesisBench& bench);    // 30, 33
ThesisFigure morphingModelFigure(ThesisBench& bench);   // beyond the thesis
ThesisFigure staticSpacesFigure(ThesisBench& bench);    // 36, 37
ThesisFigure animatedSpacesFigure(ThesisBench& bench);  // 38, 39
ThesisFigure memoryFigure(ThesisBench& bench);          // 40
ThesisFigure clipFigure(ThesisBench& bench);            // 41
ThesisFigure bumpFigure(ThesisBench& bench);            // 42
ThesisFigure stagesFigure(ThesisBench& bench);          // 14, 27, table 1
ThesisFigure divisionsFigure(ThesisBench& bench);       // §6.1

}  // namespace pleinair::app
