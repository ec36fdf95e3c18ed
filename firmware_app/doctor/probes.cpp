#include "firmware_app/doctor/probes.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>

#include <sys/resource.h>
#include <unistd.h>

#include "hal/outputs/display/display_output.h"
#include "pipeline/gpu/context/shared_displays.h"

namespace pleinair::app::doctor {
namespace {

namespace fs = std::filesystem;

std::optional<std::string> readText(const fs::path& path) {
  constexpr std::size_t kMost = 4096;
  std::ifstream file(path);
  std::string text(kMost, '\0');
  if (!file) return std::nullopt;
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad()) return std::nullopt;
  text.resize(static_cast<std::size_t>(file.gcount()));
  text.erase(text.find_last_not_of(" \t\r\n") + 1);
  return text;
}

std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code failure;
  for (fs::directory_iterator each(folder, failure), end; !failure && each != end;
       each.increment(failure)) {
    paths.push_back(each->path());
  }
  std::ranges::sort(paths);
  return paths;
}

int accessOf(const fs::path& path) {
  std::error_code ignored;
  const int enter = fs::is_directory(path, ignored) ? X_OK : 0;
  return ::access(path.c_str(), R_OK | W_OK | enter) == 0 ? 0 : errno;
}

std::optional<std::uint64_t> freeBytesOf(const fs::path& folder) {
  std::error_code failure;
  const fs::space_info space = fs::space(folder, failure);
  return failure ? std::nullopt : std::optional<std::uint64_t>(space.available);
}

std::uint64_t softLimit(int resource) {
  rlimit limit{};
  getrlimit(static_cast<__rlimit_resource>(resource), &limit);
  return limit.rlim_cur;
}

hal::Result<gpu::ContextInfo> makeContext() {
  try {
    const gpu::ContextInfo info = gpu::EglContext().info();
    gpu::terminateDisplays();  // a software driver that has a card open may be its master
    return info;
  } catch (const hal::Failure& error) {
    return tl::unexpected(error.error());
  }
}

}  // namespace

Probes systemProbes() {
  return {.read = readText,
          .list = entries,
          .access = accessOf,
          .freeBytes = freeBytesOf,
          .limit = softLimit,
          .graphics = makeContext,
          .frameImport = tryFrameImport,
          .cameras = {},
          .loopbacks = [] { return hal::listLoopbacks(); },
          .displays = [] { return hal::listDisplays(); },
          .displayProblem = [] { return hal::displayKind().problemOf("display"); },
          .displayTiming = [] { return hal::displayTiming("display"); },
          .scanOut = [] { return tryScanOut("display"); },
          .keyboards = [] { return listKeyboards(hal::kernelKeyboards()); },
          .configurationError = {},
          .snapshots = {}};
}

}  // namespace pleinair::app::doctor
