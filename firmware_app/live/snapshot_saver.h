#pragma once

#include <ctime>
#include <filesystem>
#include <future>
#include <optional>
#include <string>

#include "hal/error.h"
#include "hal/image.h"

namespace pleinair::app {

/// Writes RGB8 as a new file "pleinair-YYYYmmdd-HHMMSS.png" (`time` in local time; "-2" and so on
/// if that exists) in `folder`, and returns its path. It replaces no file, and a partial file never
/// has that name. Errors: kNotFound (no such folder), kPermissionDenied, kNoSpace, kIo.
hal::Result<std::filesystem::path> saveSnapshot(const std::filesystem::path& folder,
                                                const hal::ImageView& image, std::time_t time);

/// The same for a text, as "….toml": a look file (look_file.h), as the key w saves it.
hal::Result<std::filesystem::path> saveLook(const std::filesystem::path& folder,
                                            const std::string& text, std::time_t time);

/// Saves snapshots in the background, one at a time. One thread.
class SnapshotSaver {
 public:
  explicit SnapshotSaver(std::filesystem::path folder) : folder_(std::move(folder)) {}

  bool isBusy() const { return saving_.valid(); }
  /// Begins to save. Precondition: !isBusy().
  void save(hal::Image snapshot);
  /// The path or the error, once saving has ended; unset before.
  std::optional<hal::Result<std::filesystem::path>> takeResult();
  /// Waits for the path or the error; unset if it is not busy.
  std::optional<hal::Result<std::filesystem::path>> awaitResult();

 private:
  std::filesystem::path folder_;
  std::future<hal::Result<std::filesystem::path>> saving_;
};

}  // namespace pleinair::app
