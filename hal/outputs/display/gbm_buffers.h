#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "hal/outputs/display/card.h"
#include "hal/pixel_format.h"

struct gbm_device;

namespace pleinair::hal::display {

/// Buffers of a card that a GPU draws into and the card scans out, allocated through GBM. Answers
/// 0, or −errno. Thread-safe.
class GbmBuffers {
 public:
  /// `card`: an open card, which outlives it.
  explicit GbmBuffers(int card) : card_(card) {}
  ~GbmBuffers();
  GbmBuffers(const GbmBuffers&) = delete;
  GbmBuffers& operator=(const GbmBuffers&) = delete;

  /// As Card::createGpuBuffer(). Loads the driver at the first call.
  int create(FrameSize size, std::span<const std::uint64_t> modifiers, GpuBuffer& buffer);
  void destroy(const GpuBuffer& buffer);
  /// As Card::readGpuBuffer().
  int read(const GpuBuffer& buffer, FrameSize size, std::span<std::uint8_t> pixels);

 private:
  gbm_device* device();
  int finish(FrameSize size, GpuBuffer& buffer) const;

  int card_;
  std::mutex mutex_;
  gbm_device* device_ = nullptr;
};

/// The layouts of a format in a plane's IN_FORMATS (struct drm_format_modifier_blob); none where
/// the bytes are no such list.
std::vector<std::uint64_t> modifiersIn(std::span<const std::uint8_t> inFormats,
                                       std::uint32_t fourcc);

}  // namespace pleinair::hal::display
