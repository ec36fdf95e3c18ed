// A program that is killed at any moment loses no step that it has acknowledged. (What a power cut
// takes beside that, the disk's cache, is power_cut_test.cpp's.)
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <random>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/unit/record/session_fixture.h"

namespace pleinair::record {
namespace {

/// It is killed after so many lines, however long they take on this disk.
constexpr int kMostLines = 12;

class KilledTest : public SessionFixture {
 protected:
  /// Works without an end, back and forth with stills, and writes a byte for each line that is
  /// acknowledged. In a process of its own.
  [[noreturn]] void workWithoutEnd(int acknowledge) {
    auto session = begin();
    if (!session) _exit(1);
    const std::vector<std::uint8_t> still(20'000, 7);
    for (int i = 0;; ++i) {
      const bool isWritten = i % 3 == 2   ? session->back().has_value()
                             : i % 3 == 1 ? session->addStill("extra", still).has_value()
                                          : session->answer(procedure::Done{}).has_value();
      if (!isWritten || write(acknowledge, "+", 1) != 1) _exit(1);
    }
  }

  /// Lets a program write `lines` lines, and go on for the `share` of the time that one took; then
  /// kills it. Returns the number of lines that it acknowledged.
  std::size_t killAfter(int lines, double share) {
    std::array<int, 2> pipe{};
    if (pipe2(pipe.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    const pid_t program = fork();
    if (program == 0) workWithoutEnd(pipe[1]);
    close(pipe[1]);
    // From its first line on: a start takes longer than any of them.
    std::size_t acknowledged = readSome(pipe[0], 1);
    const auto began = std::chrono::steady_clock::now();
    acknowledged += readSome(pipe[0], static_cast<std::size_t>(lines) - 1);
    const std::chrono::duration<double> each =
        (std::chrono::steady_clock::now() - began) / (lines - 1);
    std::this_thread::sleep_for(share * each);
    kill(program, SIGKILL);
    int status = 0;
    waitpid(program, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status)) << "it ended by itself";
    acknowledged += readSome(pipe[0], 1'000'000);
    close(pipe[0]);
    return acknowledged;
  }

  static std::size_t readSome(int from, std::size_t most) {
    std::size_t count = 0;
    for (char byte = 0; count < most;) {
      const ssize_t got = read(from, &byte, 1);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) break;
      ++count;
    }
    return count;
  }
};

TEST_F(KilledTest, FiftyKillsLoseNoCompletedStep) {
  std::mt19937 random(72);
  std::uniform_int_distribution<int> lines(2, kMostLines);
  std::uniform_real_distribution<double> share(0, 2);
  for (int i = 0; i < 50; ++i) {
    SCOPED_TRACE(i);
    std::filesystem::remove(path());
    std::filesystem::remove_all(folder_.path() / "work.stills");
    const int atLeast = lines(random);
    const std::size_t acknowledged = killAfter(atLeast, share(random));
    EXPECT_GE(acknowledged, static_cast<std::size_t>(atLeast)) << "it was not at work";
    now_ += std::chrono::hours(1);  // the other process had a clock of its own
    auto session = resume();
    ASSERT_TRUE(session) << session.error().message();
    // "begin" before the work, "resumed" after it; the last line may not have been acknowledged.
    const std::size_t written = session->record().entries().size() - 2;
    EXPECT_GE(written, acknowledged);
    EXPECT_LE(written, acknowledged + 1);
    EXPECT_EQ(session->stepper().step().id, written % 3 == 0 ? "a" : "b");
    const RecordReading reading = checkRecordFile(path()).value();
    EXPECT_EQ(reading.findings.size(), 1U) << "it is not signed off, and nothing else";
    ASSERT_TRUE(session->signOff());
    EXPECT_TRUE(checkRecordFile(path())->findings.empty());
  }
}

}  // namespace
}  // namespace pleinair::record
