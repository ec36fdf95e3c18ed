#include "firmware_app/live/still_saver.h"

#include <cassert>
#include <chrono>
#include <ctime>
#include <utility>

#include "firmware_app/live/still_file.h"

namespace pleinair::app {

void StillSaver::save(hal::Image still) {
  assert(!isBusy());
  saving_ = std::async(std::launch::async, [folder = folder_, image = std::move(still)] {
    return saveStill(folder, image.view(), std::time(nullptr));
  });
}

std::optional<hal::Result<std::filesystem::path>> StillSaver::takeResult() {
  const bool isThere =
      saving_.valid() && saving_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  if (!isThere) return std::nullopt;
  return saving_.get();
}

std::optional<hal::Result<std::filesystem::path>> StillSaver::awaitResult() {
  if (!isBusy()) return std::nullopt;
  return saving_.get();
}

}  // namespace pleinair::app
