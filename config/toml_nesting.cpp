#include "config/toml_nesting.h"

#include <algorithm>

namespace pleinair::config {
namespace {

/// End of the string that opens at `begin`: just past its closing quotes, or the end of the line or
/// text if it is not closed.
std::size_t endOfString(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const bool escapes = quote == '"';
  const std::string_view triple = escapes ? "\"\"\"" : "'''";
  const bool multiLine = text.substr(begin, 3) == triple;
  std::size_t i = begin + (multiLine ? 3 : 1);
  while (i < text.size()) {
    if (escapes && text[i] == '\\') {
      i += 2;
    } else if (multiLine && text.substr(i, 3) == triple) {
      i += 3;
      // Up to two quotes before the closing three belong to the string.
      for (int extra = 0; extra < 2 && i < text.size() && text[i] == quote; ++extra) ++i;
      return i;
    } else if (!multiLine && (text[i] == quote || text[i] == '\n')) {
      return text[i] == quote ? i + 1 : i;
    } else {
      ++i;
    }
  }
  return text.size();
}

}  // namespace

std::optional<int> lineNestedTooDeep(std::string_view text, int limit) {
  int line = 1;
  int brackets = 0;
  int dots = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    switch (text[i]) {
      case '\n':
        ++line;
        dots = 0;
        break;
      case '#':
        i = std::min(text.find('\n', i), text.size()) - 1;
        break;
      case '"':
      case '\'': {
        const std::size_t end = endOfString(text, i);
        line += static_cast<int>(std::count(text.begin() + static_cast<std::ptrdiff_t>(i),
                                            text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
        i = end - 1;
        break;
      }
      case '[':
      case '{':
        dots = 0;
        if (++brackets > limit) return line;
        break;
      case ']':
      case '}':
        dots = 0;
        brackets = std::max(brackets - 1, 0);
        break;
      case '=':
      case ',':
        dots = 0;
        break;
      case '.':
        if (++dots >= limit) return line;
        break;
      default:
        break;
    }
  }
  return std::nullopt;
}

}  // namespace pleinair::config
