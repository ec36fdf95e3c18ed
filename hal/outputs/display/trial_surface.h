#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "hal/error.h"
#include "hal/image.h"
#include "hal/outputs/display/card.h"
#include "hal/outputs/display/shared_card.h"
#include "hal/surface.h"

namespace pleinair::hal {

/// A small buffer of a display's card that a GPU is to draw into: to find out, beforehand, whether
/// pictures can reach that display without a copy. Takes no display and sets no mode. One thread.
class TrialSurface {
 public:
  /// `target`: as for openDisplay(); the first card that has it. `modifiers`: the layouts that the
  /// GPU draws into. Errors: kNotFound (there is no card), kUnsupported, kNoSpace; those of
  /// Cards::open().
  static Result<std::unique_ptr<TrialSurface>> make(const std::string& target,
                                                    std::span<const std::uint64_t> modifiers,
                                                    display::Cards& cards = display::kernelCards());
  TrialSurface(std::shared_ptr<display::SharedCard> card, const display::GpuBuffer& buffer);
  ~TrialSurface();
  TrialSurface(const TrialSurface&) = delete;
  TrialSurface& operator=(const TrialSurface&) = delete;

  GpuSurface surface() const;
  /// What lies in it, as the card sees it: RGBA8. Errors: kUnsupported.
  Result<Image> copy();

 private:
  std::shared_ptr<display::SharedCard> card_;
  display::GpuBuffer buffer_;
};

}  // namespace pleinair::hal
