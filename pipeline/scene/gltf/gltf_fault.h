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

/// An error in a glTF file. Thrown within this folder; readGltf() converts it to a value.
class Fault : public std::runtime_error {
 public:
  /// `where` is a position in the file's JSON, such as "nodes[3].mesh"; empty for the file itself.
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

/// Throws Fault for a file that breaks the specification or exceeds our limits.
[[noreturn]] inline void refuse(const std::string& where, const std::string& problem,
                                std::string remedy = {}) {
  throw Fault(hal::ErrorKind::kInvalidInput, where, problem, std::move(remedy));
}

/// Throws Fault for a file that may be valid but uses an unsupported feature.
[[noreturn]] inline void refuseUnsupported(const std::string& where, const std::string& problem,
                                           std::string remedy = {}) {
  throw Fault(hal::ErrorKind::kUnsupported, where, problem, std::move(remedy));
}

/// Text from a file, made fit for a message of one line: control characters become spaces.
inline std::string oneLine(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < ' ' || c == '\x7f'; }, ' ');
  return text;
}

/// A comma-separated list, shortened to stay readable.
inline std::string shortList(const std::vector<std::string>& names) {
  constexpr std::size_t kMaxNames = 8;
  const std::span<const std::string> first =
      std::span(names).first(std::min(kMaxNames, names.size()));
  return fmt::format("{}{}", fmt::join(first, ", "), names.size() > kMaxNames ? ", ..." : "");
}

}  // namespace pleinair::scene::gltf
