#include "firmware_app/live/still_file.h"

#include <array>
#include <cerrno>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "hal/libav/picture_file.h"

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

}  // namespace

hal::Result<fs::path> saveStill(const fs::path& folder, const hal::ImageView& picture,
                                std::time_t time) {
  const std::string name = stem(time);
  // Written whole under a hidden name of this process's, then linked, which replaces nothing.
  const fs::path hidden = folder / fmt::format(".{}.{}.png", name, getpid());
  if (auto written = hal::writePng(hidden, picture); !written) {
    return tl::unexpected(std::move(written.error()));
  }
  fs::path path = folder / (name + ".png");
  std::error_code status;
  fs::create_hard_link(hidden, path, status);
  for (int number = 2; status == std::errc::file_exists; ++number) {
    path = folder / fmt::format("{}-{}.png", name, number);
    fs::create_hard_link(hidden, path, status);
  }
  std::error_code ignored;
  fs::remove(hidden, ignored);
  if (status) {
    return tl::unexpected(hal::errnoError(path.string(), "cannot write", status.value(),
                                          "choose another folder with --stills DIR"));
  }
  return path;
}

}  // namespace pleinair::app
