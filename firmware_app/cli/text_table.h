#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace pleinair::app {

struct TextRow {
  std::string name;
  std::string text;
};

/// Formats rows for a terminal: names in one column, their texts in a second one, wrapped within it
/// at `columns`. Longer words are not broken.
std::string textTable(const std::vector<TextRow>& rows, std::size_t columns = 100);

}  // namespace pleinair::app
