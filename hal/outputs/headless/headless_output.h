#pragma once

#include <cstdint>
#include <vector>

#include "hal/output.h"
#include "hal/output_kind.h"

namespace pleinair::hal {

/// FNV-1a over 64-bit little-endian words (each row's tail padded with zeros), of the format and
/// then every packed row: equal pictures have equal hashes whatever their strides.
std::uint64_t hashOf(const ImageView& picture);

/// Takes pictures and keeps only what tests and measurements ask for. Needs no file and no display.
class HeadlessOutput final : public MemoryOutput {
 public:
  /// The record of each picture: its hash and time, or nothing, for runs of any length.
  enum class Keeps { kHashes, kNothing };

  explicit HeadlessOutput(PixelFormat format = PixelFormat::kRgb8, ColorEncoding encoding = {},
                          Keeps keeps = Keeps::kHashes);

  OutputIdentity identity() const override;
  Result<OutputFormat> start(const OutputRequest& request) override;
  Result<void> write(const ImageView& picture, Duration time) override;
  Result<void> finish() override;

  std::uint64_t count() const { return hashes_.size(); }
  const std::vector<std::uint64_t>& hashes() const { return hashes_; }
  const std::vector<Duration>& times() const { return times_; }
  /// One hash over all pictures in their order, without their times.
  std::uint64_t runningHash() const { return running_; }

 private:
  FrameFormat format_;
  Keeps keeps_;
  std::vector<std::uint64_t> hashes_;
  std::vector<Duration> times_;
  std::uint64_t running_;
};

/// "headless": it stands in for a display where there is none.
OutputKind headlessKind();

}  // namespace pleinair::hal
