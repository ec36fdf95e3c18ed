#include "config/config_error.h"

#include <utility>

#include <fmt/format.h>

namespace pleinair::config {
namespace {

/// Escapes control characters, so that a file's contents stay on one line of a terminal.
std::string onOneLine(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\n') {
      line += "\\n";
    } else if (byte < 0x20 || byte == 0x7F) {
      line += fmt::format("\\x{:02x}", byte);
    } else {
      line += c;
    }
  }
  return line;
}

std::string messageOf(const ConfigFault& fault) {
  std::string text = fault.file;
  if (fault.line > 0) text += fmt::format(":{}", fault.line);
  if (!text.empty()) text += ": ";
  if (!fault.key.empty()) text += fault.key + ": ";
  text += fault.problem.empty() ? "found " + fault.found : fault.problem;
  if (!fault.allowed.empty()) text += ", allowed: " + fault.allowed;
  return onOneLine(text);
}

}  // namespace

ConfigError::ConfigError(ConfigFault fault)
    : std::runtime_error(messageOf(fault)), fault_(std::move(fault)) {}

std::string quoted(const std::string& text) {
  constexpr std::size_t kMaxBytes = 60;
  if (text.size() <= kMaxBytes) return '"' + text + '"';
  std::size_t end = kMaxBytes;
  const auto continuesCharacter = [&](std::size_t i) {
    return (static_cast<unsigned char>(text[i]) & 0xC0u) == 0x80u;
  };
  while (end > 0 && continuesCharacter(end)) --end;
  return '"' + text.substr(0, end) + "...\"";
}

}  // namespace pleinair::config
