#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "hal/error.h"

namespace pleinair::digest {

using Sha256 = std::array<std::uint8_t, 32>;

/// Computes a SHA-256 (FIPS 180-4) piece by piece, with nettle. One thread at a time.
class Sha256Stream {
 public:
  Sha256Stream();
  ~Sha256Stream();
  Sha256Stream(const Sha256Stream&) = delete;
  Sha256Stream& operator=(const Sha256Stream&) = delete;

  void add(std::span<const std::uint8_t> bytes);
  void add(std::string_view text);
  /// The digest of what was added since the last finish(), or the beginning.
  Sha256 finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

Sha256 sha256(std::string_view bytes);
/// 64 lower-case hexadecimal digits.
std::string hexOf(const Sha256& digest);
/// The digest of a regular file's content, in hexadecimal. Errors: kNotFound, kPermissionDenied,
/// kInvalidInput (no regular file), kIo.
hal::Result<std::string> hexOfFile(const std::filesystem::path& path);

}  // namespace pleinair::digest
