#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "hal/outputs/display/display_output.h"
#include "tests/support/fake_card.h"

namespace pleinair::support {

inline constexpr std::uint32_t kPainted = 0x00A0B0C0;

class DisplayTest : public testing::Test {
 protected:
  static constexpr hal::FrameSize kSize{64, 48};

  FakeCardSpec& plug(FakeCardSpec spec = {}) { return cards_.add(std::move(spec)); }

  hal::Result<hal::OutputFormat> start(const std::string& name = "display",
                                       hal::DisplaySettings settings = {}) {
    output_ = *hal::openDisplay(name, settings, cards_, clock_);
    hal::Result<hal::OutputFormat> format = output_->start({.size = kSize, .framePeriod = {}});
    if (format && format->refresh) period_ = format->refresh->period;
    return format;
  }

  /// Fills one with a colour and has it shown.
  hal::Result<void> show(hal::TimePoint due, std::uint32_t pixel = kPainted) {
    const auto surface = output_->acquire();
    if (!surface) return tl::unexpected(surface.error());
    if (!*surface)
      return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kBusy, .problem = "none free"});
    {
      const auto mapping = output_->map(**surface);
      const std::span<std::uint8_t> bytes = mapping->plane(0);
      for (std::size_t i = 0; i + 4 <= bytes.size(); i += 4) {
        std::memcpy(bytes.data() + i, &pixel, sizeof(pixel));
      }
    }
    return output_->submit(**surface, hal::Fence(), due);
  }
  hal::Result<void> runTo(hal::TimePoint time) {
    while (clock_.now() < time) {
      const auto next = output_->nextEvent();
      clock_.sleepUntil(next ? std::clamp(*next, clock_.now() + hal::Duration{1}, time) : time);
      if (auto taken = output_->takeEvents(events_); !taken) return taken;
    }
    return {};
  }
  hal::Result<void> showAndWait(std::uint32_t pixel = kPainted) {
    const hal::TimePoint due = clock_.now() + period_;
    if (auto shown = show(due, pixel); !shown) return shown;
    return runTo(due + 2 * period_);
  }

  hal::SteppedClock clock_{hal::TimePoint(std::chrono::seconds(100))};
  FakeCards cards_{clock_};
  std::unique_ptr<hal::SurfaceOutput> output_;
  hal::Duration period_ = std::chrono::milliseconds(17);
  std::vector<hal::PresentationEvent> events_;
};

}  // namespace pleinair::support
