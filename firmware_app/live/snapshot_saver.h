#pragma once

#include <ctime>
#include <filesystem>
#include <future>
#include <optional>

#include "hal/error.h"
#include "hal/image.h"

namespace pleinair::app {

/// Writes RGB8 as a new PNG "pleinair-YYYYmmdd-HHMMSS.png" (of `time`, in local time; "-2" and so
/// on where that exists) in `folder`, and gives its path. What is there is never replaced, and
/// nothing partial stands under the name. Errors: kNotFound (no such folder), kPermissionDenied,
/// kNoSpace, kIo.
hal::Result<std::filesystem::path> saveSnapshot(const std::filesystem::path& folder,
                                                const hal::ImageView& picture, std::time_t time);

/// Saves snapshots beside the live painting, one at a time. One thread.
class SnapshotSaver {
 public:
  explicit SnapshotSaver(std::filesystem::path folder) : folder_(std::move(folder)) {}

  bool isBusy() const { return saving_.valid(); }
  /// Begins to save; precondition: !isBusy().
  void save(hal::Image still);
  /// Where it was saved to, or why not, once that is known.
  std::optional<hal::Result<std::filesystem::path>> takeResult();
  /// The same, waited for; nothing where it is not busy.
  std::optional<hal::Result<std::filesystem::path>> awaitResult();

 private:
  std::filesystem::path folder_;
  std::future<hal::Result<std::filesystem::path>> saving_;
};

}  // namespace pleinair::app
