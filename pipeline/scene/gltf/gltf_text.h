#pragma once

#include <algorithm>
#include <string>

namespace pleinair::scene::gltf {

/// A file's own words, fit for a line of a message: control characters become spaces.
inline std::string oneLine(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return (c >= '\0' && c < ' ') || c == '\x7f'; }, ' ');
  return text;
}

}  // namespace pleinair::scene::gltf
