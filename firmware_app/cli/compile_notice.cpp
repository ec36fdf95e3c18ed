#include "firmware_app/cli/compile_notice.h"

#include <atomic>
#include <chrono>

#include <spdlog/spdlog.h>

#include "firmware_app/cli/interrupt.h"

namespace pleinair::app {
namespace {

constexpr auto kSilence = std::chrono::seconds(1);

}  // namespace

std::function<bool()> cancelledBySignal() {
  static std::atomic<bool> isTold = false;
  return [began = std::chrono::steady_clock::now()] {
    if (std::chrono::steady_clock::now() - began > kSilence && !isTold.exchange(true)) {
      spdlog::info(
          "compiling shaders: half a minute the first time; `pleinair warm-up` does it beforehand");
    }
    return Interrupt::received() != 0;
  };
}

}  // namespace pleinair::app
