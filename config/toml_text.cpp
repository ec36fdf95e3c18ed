#include "config/toml_text.h"

#include <cstddef>

#include <fmt/format.h>

namespace pleinair::config {
namespace {

bool isControl(char c) {
  return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
}

/// Number of bytes of the UTF-8 character at the front of `text`; 0 if it is none (RFC 3629:
/// overlong forms, surrogates and code points above U+10FFFF are none).
std::size_t characterLength(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned>(text[i]) & 0xFFu; };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0u) != 0x80u) return 0;
  }
  const unsigned second = byte(1);
  const bool isOverlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool isSurrogate = first == 0xED && second >= 0xA0;
  const bool isBeyond = first == 0xF4 && second >= 0x90;
  return isOverlong || isSurrogate || isBeyond ? 0 : length;
}

}  // namespace

std::optional<std::string> tomlString(std::string_view text) {
  std::string quotedText = "\"";
  while (!text.empty()) {
    const std::size_t length = characterLength(text);
    if (length == 0) return std::nullopt;
    const char c = text.front();
    if (c == '"' || c == '\\') quotedText += '\\';
    if (isControl(c)) {
      quotedText += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
    } else {
      quotedText += text.substr(0, length);
    }
    text.remove_prefix(length);
  }
  return quotedText + '"';
}

std::string tomlComment(std::string_view text) {
  std::string comment;
  while (!text.empty()) {
    const std::size_t length = characterLength(text);
    const bool isShown = length > 0 && !isControl(text.front());
    comment += isShown ? text.substr(0, length) : "?";
    text.remove_prefix(isShown ? length : 1);
  }
  return comment;
}

}  // namespace pleinair::config
