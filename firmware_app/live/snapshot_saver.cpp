#include "firmware_app/live/snapshot_saver.h"

#include <array>
#include <cassert>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "hal/media/png_file.h"
#include "hal/pending_file.h"

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

/// `write` makes a file under a hidden name that is unique to this process, which is then renamed.
hal::Result<fs::path> saveAsNew(const fs::path& folder, std::string_view ending, std::time_t time,
                                const std::function<hal::Result<void>(const fs::path&)>& write) {
  const std::string name = stem(time);
  const fs::path hidden = folder / fmt::format(".{}.{}{}", name, getpid(), ending);
  if (auto written = write(hidden); !written) return tl::unexpected(std::move(written.error()));
  fs::path path = folder / fmt::format("{}{}", name, ending);
  int status = renameToNew(hidden, path);
  for (int number = 2; status == EEXIST; ++number) {
    path = folder / fmt::format("{}-{}{}", name, number, ending);
    status = renameToNew(hidden, path);
  }
  if (status != 0) {
    unlink(hidden.c_str());
    return tl::unexpected(hal::errnoError(path.string(), "cannot write", status,
                                          "choose another folder with --snapshots DIR"));
  }
  return path;
}

}  // namespace

hal::Result<fs::path> saveSnapshot(const fs::path& folder, const hal::ImageView& image,
                                   std::time_t time) {
  return saveAsNew(folder, ".png", time,
                   [&](const fs::path& hidden) { return hal::writePng(hidden, image); });
}

hal::Result<fs::path> saveLook(const fs::path& folder, const std::string& text, std::time_t time) {
  return saveAsNew(folder, ".toml", time, [&](const fs::path& hidden) -> hal::Result<void> {
    hal::Result<hal::PendingFile> file = hal::PendingFile::create(hidden);
    if (!file) return tl::unexpected(file.error());
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
    if (auto written = file->write({bytes, text.size()}); !written) return written;
    return file->publish();
  });
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
