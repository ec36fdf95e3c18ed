#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/error.h"
#include "hal/pixel_format.h"

namespace pleinair::hal::aravis {

/// How samples lie in memory.
enum class Packing {
  kNone,     ///< as in the frames that are delivered
  kLsb12,    ///< two 12-bit samples in 3 bytes, "12p": unpack12.h
  kSplit12,  ///< the same of GigE Vision 1, "12Packed"
};

/// A pixel format of the GenICam Pixel Format Naming Convention (PFNC), and the frames made of it.
struct PixelLayout {
  std::uint32_t pfnc = 0;
  std::string_view name;  ///< "BayerRG12p"
  PixelFormat pixelFormat = PixelFormat::kGrey8;
  Packing packing = Packing::kNone;
  /// Bytes of `pixels` consecutive pixels, rounded up.
  std::size_t bytesOf(std::size_t pixels) const;
};

/// The supported formats, in the order in which "auto" chooses: colour before grey, and few bits on
/// the link before many, because loss begins there.
std::span<const PixelLayout> pixelLayouts();
/// Null if it is not supported.
const PixelLayout* findLayout(std::uint32_t pfnc);
/// "Mono8", or the code in hexadecimal digits.
std::string layoutName(std::uint32_t pfnc);

/// The layout to ask a device for that offers `offered`. `name`: one of pixelLayouts(), or "auto":
/// the first of `format`'s, if that is given and offered, else the first of all. Errors:
/// kUnsupported, with what is offered.
Result<const PixelLayout*> chooseLayout(const std::vector<std::uint32_t>& offered,
                                        std::string_view name, std::optional<PixelFormat> format);

}  // namespace pleinair::hal::aravis
