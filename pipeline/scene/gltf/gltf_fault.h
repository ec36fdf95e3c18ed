#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "hal/error.h"

namespace pleinair::scene::gltf {

/// What is wrong with a glTF file. Thrown within this folder; readGltf() makes it a value.
class Fault : public std::runtime_error {
 public:
  /// `where` is a place of the file's JSON: "nodes[3].mesh"; empty for the file itself.
  Fault(hal::ErrorKind kind, const std::string& where, const std::string& problem,
        std::string remedy = {})
      : std::runtime_error(where.empty() ? problem : where + ": " + problem),
        kind_(kind),
        remedy_(std::move(remedy)) {}

  hal::ErrorKind kind() const { return kind_; }
  const std::string& remedy() const { return remedy_; }

 private:
  hal::ErrorKind kind_;
  std::string remedy_;
};

/// The file breaks the specification, or our limits on what is sane.
[[noreturn]] inline void refuse(const std::string& where, const std::string& problem,
                                std::string remedy = {}) {
  throw Fault(hal::ErrorKind::kInvalidInput, where, problem, std::move(remedy));
}

/// The file may be sound, but uses what is not there.
[[noreturn]] inline void refuseUnsupported(const std::string& where, const std::string& problem,
                                           std::string remedy = {}) {
  throw Fault(hal::ErrorKind::kUnsupported, where, problem, std::move(remedy));
}

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
