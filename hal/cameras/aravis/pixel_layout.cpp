#include "hal/cameras/aravis/pixel_layout.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include <fmt/format.h>

namespace pleinair::hal::aravis {
namespace {

// Codes: PFNC 2.4, table of 32-bit values.
constexpr std::array<PixelLayout, 17> kLayouts{{
    {0x01080009, "BayerRG8", PixelFormat::kBayerRggb8, Packing::kNone},
    {0x01080008, "BayerGR8", PixelFormat::kBayerGrbg8, Packing::kNone},
    {0x0108000A, "BayerGB8", PixelFormat::kBayerGbrg8, Packing::kNone},
    {0x0108000B, "BayerBG8", PixelFormat::kBayerBggr8, Packing::kNone},
    {0x010C0059, "BayerRG12p", PixelFormat::kBayerRggb8, Packing::kLsb12},
    {0x010C0057, "BayerGR12p", PixelFormat::kBayerGrbg8, Packing::kLsb12},
    {0x010C0055, "BayerGB12p", PixelFormat::kBayerGbrg8, Packing::kLsb12},
    {0x010C0053, "BayerBG12p", PixelFormat::kBayerBggr8, Packing::kLsb12},
    {0x010C002B, "BayerRG12Packed", PixelFormat::kBayerRggb8, Packing::kSplit12},
    {0x010C002A, "BayerGR12Packed", PixelFormat::kBayerGrbg8, Packing::kSplit12},
    {0x010C002C, "BayerGB12Packed", PixelFormat::kBayerGbrg8, Packing::kSplit12},
    {0x010C002D, "BayerBG12Packed", PixelFormat::kBayerBggr8, Packing::kSplit12},
    {0x02100032, "YUV422_8", PixelFormat::kYuyv, Packing::kNone},
    {0x02180014, "RGB8", PixelFormat::kRgb8, Packing::kNone},
    {0x01080001, "Mono8", PixelFormat::kGrey8, Packing::kNone},
    {0x010C0047, "Mono12p", PixelFormat::kGrey8, Packing::kLsb12},
    {0x010C0006, "Mono12Packed", PixelFormat::kGrey8, Packing::kSplit12},
}};

}  // namespace

std::size_t PixelLayout::bytesOf(std::size_t pixels) const {
  const std::size_t bits = pfnc >> 16 & 0xFF;  // PFNC: bits a pixel occupies
  return (pixels * bits + 7) / 8;
}

std::span<const PixelLayout> pixelLayouts() {
  return kLayouts;
}

const PixelLayout* findLayout(std::uint32_t pfnc) {
  const auto* const found = std::ranges::find(kLayouts, pfnc, &PixelLayout::pfnc);
  return found == kLayouts.end() ? nullptr : found;
}

std::string layoutName(std::uint32_t pfnc) {
  const PixelLayout* const layout = findLayout(pfnc);
  return layout != nullptr ? std::string(layout->name) : fmt::format("0x{:08X}", pfnc);
}

Result<const PixelLayout*> chooseLayout(const std::vector<std::uint32_t>& offered,
                                        std::string_view name, std::optional<PixelFormat> format) {
  const PixelLayout* first = nullptr;
  for (const PixelLayout& layout : kLayouts) {
    if (std::ranges::find(offered, layout.pfnc) == offered.end()) continue;
    if (name == layout.name) return &layout;
    if (name != "auto") continue;
    if (!format || layout.pixelFormat == *format) return &layout;
    if (first == nullptr) first = &layout;
  }
  if (first != nullptr) return first;
  std::string all;
  for (const std::uint32_t each : offered) all += (all.empty() ? "" : ", ") + layoutName(each);
  if (name == "auto") {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .problem = "has no pixel format that can be read",
                                .remedy = "it offers " + (all.empty() ? "none" : all)});
  }
  return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                              .problem = "has no pixel format " + std::string(name),
                              .remedy = "choose another camera.aravis.pixel_format: auto, or of " +
                                        (all.empty() ? "none" : all)});
}

}  // namespace pleinair::hal::aravis
