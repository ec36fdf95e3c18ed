#include "config/suggestion.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "config/config_error.h"

namespace pleinair::config {
namespace {

constexpr std::size_t kMaxWordLength = 64;  // limits the quadratic work for a hostile key

std::string folded(std::string_view word) {
  std::string text(word);
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (c == '-') c = '_';
  }
  return text;
}

/// Number of edits (insert, delete, replace, swap neighbours) between two words: the "optimal
/// string alignment" distance.
std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> beforeLast(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({replace, last[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], beforeLast[j - 2] + 1);
      }
    }
    std::swap(beforeLast, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

/// Length of a common word with a colon: "synthetic:nope" is compared by the part after it.
std::size_t commonWordLength(std::string_view a, std::string_view b) {
  const std::size_t colon = a.find(':');
  if (colon == std::string_view::npos || !b.starts_with(a.substr(0, colon + 1))) return 0;
  return colon + 1;
}

}  // namespace

std::optional<std::string> nearest(std::string_view word, std::span<const std::string> candidates) {
  if (word.size() > kMaxWordLength) return std::nullopt;
  const std::string wanted = folded(word);
  std::optional<std::string> best;
  std::size_t bestDistance = 0;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > kMaxWordLength) continue;
    const std::size_t distance = editDistance(wanted, folded(candidate));
    const std::size_t shorter =
        std::min(word.size(), candidate.size()) - commonWordLength(word, candidate);
    const std::size_t tolerated = std::clamp<std::size_t>(shorter / 3, 1, 3);
    // In a word of one or two letters, one edit leaves too little for a suggestion.
    if (distance > tolerated || (distance > 0 && shorter < 3)) continue;
    if (!best || distance < bestDistance) {
      best = candidate;
      bestDistance = distance;
    }
  }
  return best;
}

std::string unknownText(std::string_view what, std::string_view word,
                        std::span<const std::string> candidates) {
  const std::optional<std::string> near = nearest(word, candidates);
  if (!near) return fmt::format("unknown {}", what);
  return fmt::format("unknown {} (did you mean \"{}\"?)", what, *near);
}

std::string foundText(std::string_view word, std::span<const std::string> candidates) {
  const std::string found = quoted(std::string(word));
  const std::optional<std::string> near = nearest(word, candidates);
  return near ? fmt::format("{} (did you mean \"{}\"?)", found, *near) : found;
}

std::string listText(std::span<const std::string> names) {
  if (names.empty()) return "none";
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace pleinair::config
