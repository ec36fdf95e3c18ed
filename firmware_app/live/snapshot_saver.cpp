#include "firmware_app/live/snapshot_saver.h"

#include <array>
#include <cassert>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <string>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "hal/media/picture_file.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;

std::string stem(std::time_t time) {
  std::tm local{};
  localtime_r(&time, &local);
  std::array<char, 32> text{};
  const std::size_t length =
      std::strftime(text.data(), text.size(), "pleinair-%Y%m%d-%H%M%S", &local);
  return {text.data(), length};
}

/// 0, or errno.
int renameToNew(const fs::path& from, const fs::path& to) {
  const int status = renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE);
  return status == 0 ? 0 : errno;
}

}  // namespace

hal::Result<fs::path> saveSnapshot(const fs::path& folder, const hal::ImageView& image,
                                   std::time_t time) {
  const std::string name = stem(time);
  // The file is written under a hidden name that is unique to this process, then renamed.
  const fs::path hidden = folder / fmt::format(".{}.{}.png", name, getpid());
  if (auto written = hal::writePng(hidden, image); !written) {
    return tl::unexpected(std::move(written.error()));
  }
  fs::path path = folder / (name + ".png");
  int status = renameToNew(hidden, path);
  for (int number = 2; status == EEXIST; ++number) {
    path = folder / fmt::format("{}-{}.png", name, number);
    status = renameToNew(hidden, path);
  }
  if (status != 0) {
    unlink(hidden.c_str());
    return tl::unexpected(hal::errnoError(path.string(), "cannot write", status,
                                          "choose another folder with --snapshots DIR"));
  }
  return path;
}

void SnapshotSaver::save(hal::Image snapshot) {
  assert(!isBusy());
  saving_ = std::async(std::launch::async, [folder = folder_, image = std::move(snapshot)] {
    return saveSnapshot(folder, image.view(), std::time(nullptr));
  });
}

std::optional<hal::Result<std::filesystem::path>> SnapshotSaver::takeResult() {
  const bool isThere =
      saving_.valid() && saving_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  if (!isThere) return std::nullopt;
  return saving_.get();
}

std::optional<hal::Result<std::filesystem::path>> SnapshotSaver::awaitResult() {
  if (!isBusy()) return std::nullopt;
  return saving_.get();
}

}  // namespace pleinair::app
