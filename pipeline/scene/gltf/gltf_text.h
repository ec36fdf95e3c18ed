#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace pleinair::scene::gltf {

/// A file's own words, fit for a line of a message: control characters become spaces.
inline std::string oneLine(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return (c >= '\0' && c < ' ') || c == '\x7f'; }, ' ');
  return text;
}

/// A comma-separated list that stays readable.
inline std::string shortList(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 8;
  const std::span<const std::string> first = std::span(names).first(std::min(kMost, names.size()));
  return fmt::format("{}{}", fmt::join(first, ", "), names.size() > kMost ? ", ..." : "");
}

}  // namespace pleinair::scene::gltf
