#include "firmware_app/cli/text_table.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace pleinair::app {
namespace {

constexpr std::size_t kIndent = 4;
constexpr std::size_t kGap = 2;

/// The number of UTF-8 characters.
std::size_t widthOf(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::vector<std::string> wrapped(std::string_view text, std::size_t width) {
  std::vector<std::string> lines(1);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    std::string& line = lines.back();
    if (line.empty()) {
      line = word;
    } else if (widthOf(line) + 1 + widthOf(word) <= width) {
      line += fmt::format(" {}", word);
    } else {
      lines.emplace_back(word);
    }
  }
  return lines;
}

}  // namespace

std::string textTable(const std::vector<TextRow>& rows, std::size_t columns) {
  std::size_t names = 0;
  for (const TextRow& row : rows) names = std::max(names, widthOf(row.name));
  const std::size_t margin = kIndent + names + kGap;
  std::string table;
  for (const TextRow& row : rows) {
    std::string beside = row.name + std::string(names - widthOf(row.name), ' ');
    for (const std::string& line : wrapped(row.text, columns > margin ? columns - margin : 1)) {
      table += fmt::format("{:{}}{}{:{}}{}\n", "", kIndent, beside, "", kGap, line);
      beside.assign(names, ' ');
    }
  }
  return table;
}

}  // namespace pleinair::app
