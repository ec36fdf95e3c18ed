#include "firmware_app/cli/shell_text.h"

#include <algorithm>
#include <string_view>

namespace pleinair::app {
namespace {

bool isPlainForShells(char c) {
  constexpr std::string_view kOthers = "@%+=:,./_-";
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         kOthers.find(c) != std::string_view::npos;
}

std::string quotedForShells(const std::string& word) {
  if (!word.empty() && std::ranges::all_of(word, isPlainForShells)) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace

std::string shellText(std::span<const std::string> words) {
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += ' ';
    text += quotedForShells(word);
  }
  return text;
}

}  // namespace pleinair::app
