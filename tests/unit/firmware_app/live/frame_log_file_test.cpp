#include "firmware_app/live/status/frame_log_file.h"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;

std::string textOf(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

constexpr const char* kHead =
    "output,frame,captured_s,ready_s,due_s,due_refresh,shown_s,refresh,outcome\n";

TEST(FrameLogFile, HasARowForEachFrame) {
  const support::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "frames.csv";
  FrameLogFile file(path, {"display", "a, b"});
  file.log().add({.output = 0,
                  .sequence = 7,
                  .captured = hal::TimePoint(1s),
                  .ready = hal::TimePoint(1s + 20ms),
                  .due = hal::TimePoint(1s + 120ms),
                  .dueRefresh = 60,
                  .outcome = runtime::Outcome::kShownOffSchedule,
                  .shown = hal::TimePoint(1s + 137ms),
                  .refresh = 61});
  ASSERT_TRUE(file.update());
  file.log().add({.output = 1, .sequence = 8, .outcome = runtime::Outcome::kLate});
  ASSERT_TRUE(file.update());
  EXPECT_EQ(textOf(path), std::string(kHead) +
                              "display,7,1.000000000,1.020000000,1.120000000,60,1.137000000,61,"
                              "shown_off_schedule\n"
                              "\"a, b\",8,0.000000000,0.000000000,0.000000000,,,,late\n");
}

TEST(FrameLogFile, CannotBeWrittenWhereThereIsNoFolder) {
  EXPECT_THROW(FrameLogFile("/no/such/folder/frames.csv", {"display"}), hal::Failure);
}

TEST(FrameLogFile, IsRefusedWhereTheDiskIsFull) {
  EXPECT_THROW(FrameLogFile("/dev/full", {"display"}), hal::Failure);
}

TEST(FrameLogFile, ReportsOnceThatItCannotGrow) {
  const support::TemporaryFolder folder;
  FrameLogFile file(folder.path() / "frames.csv", {"display"});
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit small = before;
  small.rlim_cur = 80;  // the first row, and no other
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  file.log().add({});
  const auto first = file.update();
  file.log().add({});
  const auto second = file.update();
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_FALSE(first);
  EXPECT_TRUE(second);
}

TEST(FrameLog, CountsWhatItHasNoRoomFor) {
  runtime::FrameLog log;
  for (std::size_t i = 0; i < runtime::FrameLog::kCapacity + 3; ++i) log.add({.sequence = i});
  std::vector<runtime::FrameRecord> records;
  EXPECT_EQ(log.take(records), 3u);
  EXPECT_EQ(records.size(), runtime::FrameLog::kCapacity);
  EXPECT_EQ(records.back().sequence, runtime::FrameLog::kCapacity - 1) << "the first are kept";
  EXPECT_EQ(log.take(records), 0u);
  EXPECT_TRUE(records.empty());
}

}  // namespace
}  // namespace pleinair::app
