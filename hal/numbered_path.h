#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "hal/error.h"

namespace pleinair::hal {

/// A path with one number in its file name, written as printf's %d or %04d: "out/%04d.png". It is
/// parsed here and never passed to printf. "%%" is a percent sign.
class NumberedPath {
 public:
  /// Errors: kInvalidArgument unless the file name, and only it, holds exactly one conversion, %d
  /// or %0Nd with N from 1 to 18.
  static Result<NumberedPath> parse(std::string_view pattern);

  std::filesystem::path at(std::uint64_t number) const;

  /// The number for which at(number) has this file name, if any.
  std::optional<std::uint64_t> numberOf(std::string_view fileName) const;

  std::filesystem::path folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  std::string prefix_;
  std::string suffix_;
  std::size_t minDigits_ = 1;
};

/// Whether the file name contains a percent sign, so that the caller means a NumberedPath.
bool looksNumbered(const std::filesystem::path& path);

}  // namespace pleinair::hal
