// The libraries that the program loads: libav only for files and Motion-JPEG, and Aravis within the
// sandbox of a service.
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/types.h>

#include "tests/program/program.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::support {
namespace {

using testing::HasSubstr;
using namespace std::chrono_literals;

class Loading : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  TemporaryFolder folder_;
};

/// The files that a process has mapped; empty once it has ended.
std::string mapsOf(pid_t process) {
  const std::string path = "/proc/" + std::to_string(process) + "/maps";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "re"),
                                                             &std::fclose);
  std::string maps;
  if (file == nullptr) return maps;
  std::array<char, 4096> part{};
  while (const std::size_t got = std::fread(part.data(), 1, part.size(), file.get())) {
    maps.append(part.data(), got);
  }
  return maps;
}

/// Whether the program maps a library while it runs. Before it is loaded, the process has the
/// test's own.
bool loads(const std::string& library, std::vector<std::string> arguments) {
  std::atomic<bool> isSeen = false;
  std::atomic<bool> isMapped = false;  // by then, what it is linked to is
  ProgramLimits limits;
  limits.meanwhile = [&](pid_t program) {
    // 500 times none is the end.
    for (int empty = 0; empty < 500;) {
      const std::string maps = mapsOf(program);
      empty = maps.empty() ? empty + 1 : 0;
      if (maps.find(PLEINAIR_PROGRAM) != std::string::npos) {
        if (maps.find("/libEGL") != std::string::npos) isMapped = true;
        if (maps.find("/" + library) != std::string::npos) isSeen = true;
      }
      std::this_thread::sleep_for(1ms);
    }
  };
  arguments.insert(arguments.begin(), "run");
  const ProgramRun run = runProgram(arguments, limits);
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_TRUE(isMapped);
  return isSeen;
}

TEST_F(Loading, LoadsLibavOnlyForWhatNeedsIt) {
  const std::vector<std::string> raw{"--camera", "synthetic:still", "--size",
                                     "160x120",  "--frames",        "3",
                                     "--output", path("%d.png")};
  EXPECT_FALSE(loads("libavcodec", raw));
  EXPECT_FALSE(loads("pleinair-libav.so", raw));
  std::vector<std::string> movie = raw;
  movie.back() = path("out.mkv");
  EXPECT_TRUE(loads("libavcodec", movie)) << "else this test cannot fail";
  EXPECT_TRUE(loads("pleinair-libav.so", movie));
}

TEST_F(Loading, SaysWhatToDoWhereItsModuleIsMissing) {
  const std::filesystem::path folder = std::filesystem::path(PLEINAIR_BUILD_DIR) / "program-alone";
  std::filesystem::create_directory(folder);
  ProgramLimits limits;
  limits.program = folder / "pleinair";
  std::filesystem::remove(limits.program);
  std::filesystem::create_hard_link(PLEINAIR_PROGRAM, limits.program);
  writeMedia(path("in.y4m"), 1);
  const ProgramRun alone =
      runProgram({"render", "--input", path("in.y4m"), "--output", path("out.png")}, limits);
  std::filesystem::remove_all(folder);
  EXPECT_GT(alone.status, 0) << "no signal";
  EXPECT_THAT(alone.error, HasSubstr("pleinair-libav.so: is not there; start pleinair anew"));
}

TEST_F(Loading, LooksForCamerasWhereItMayHaveNoInternetSocket) {
  ProgramLimits limits;
  limits.withoutInternet = true;
  const ProgramRun devices = runProgram({"devices"}, limits);
  EXPECT_EQ(devices.status, 0) << devices.error;
  EXPECT_THAT(devices.error, testing::Not(HasSubstr("assertion"))) << "GLib's";
}

}  // namespace
}  // namespace pleinair::support
