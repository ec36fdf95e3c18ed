#pragma once

#include <string>
#include <vector>

#include "firmware_app/thesis/thesis_figures.h"

namespace pleinair::app {

/// A finished figure and the names of its picture files, one for each of its pictures.
struct ThesisEntry {
  ThesisFigureKind kind;
  ThesisFigure figure;
  std::vector<std::string> files;
  double seconds = 0.0;  ///< that it took
};

struct ThesisReport {
  std::string settings;  ///< "480x360, …"
  std::vector<ThesisEntry> entries;
  /// Negative controls of measured films that did not read as they must: nothing can be relied on.
  std::vector<std::string> failedControls;
};

/// One page, with the pictures beside it.
std::string thesisHtml(const ThesisReport& report);
/// All numbers, and the pictures' names.
std::string thesisJson(const ThesisReport& report);
/// "0.0384", "81.2", "2430": four digits that count.
std::string readingText(double value);

}  // namespace pleinair::app
