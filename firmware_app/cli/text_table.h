#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace pleinair::app {

struct TextRow {
  std::string name;
  std::string text;
};

/// Rows for a terminal: names in one column, beside them their texts, which go on in their own
/// column where they would pass `columns`. Longer words stick out.
std::string textTable(const std::vector<TextRow>& rows, std::size_t columns = 100);

}  // namespace pleinair::app
