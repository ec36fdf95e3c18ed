#include "firmware_app/live/status/machine_notice.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;

class MachineNoticeTest : public testing::Test {
 protected:
  void write(const std::string& text) const { std::ofstream(file_, std::ios::binary) << text; }

  support::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "notice";
};

TEST_F(MachineNoticeTest, IsTheTextOfTheFile) {
  write("Installing version 2.0: 40 %.\nLeave the stick in.\n");
  EXPECT_EQ(readNotice(file_), "Installing version 2.0: 40 %.\nLeave the stick in.");
}

TEST_F(MachineNoticeTest, IsNothingWithoutAFile) {
  EXPECT_EQ(readNotice(file_), "");
  EXPECT_EQ(readNotice(folder_.path()), "") << "a folder";
  write("\n");
  EXPECT_EQ(readNotice(file_), "");
}

TEST_F(MachineNoticeTest, HoldsNothingThatAScreenCannotShow) {
  write("grün \xff \x1b[2J\n");
  EXPECT_EQ(readNotice(file_), "grün ? ?[2J");
}

TEST_F(MachineNoticeTest, HasAnEnd) {
  write(std::string(5000, 'x'));
  EXPECT_EQ(readNotice(file_).size(), kMostNoticeBytes);
  write("1\n2\n3\n4\n5\n6\n7\n8\n9\n");
  EXPECT_EQ(readNotice(file_), "1\n2\n3\n4\n5\n6\n7\n8");
}

TEST_F(MachineNoticeTest, FollowsTheFile) {
  const MachineNotice notice(file_, 1ms);
  EXPECT_EQ(notice.text(), "");
  const auto becomes = [&notice](const std::string& text) {
    const auto end = std::chrono::steady_clock::now() + 20s;
    while (notice.text() != text && std::chrono::steady_clock::now() < end) {
      std::this_thread::yield();
    }
    return notice.text() == text;
  };
  write("refused");
  EXPECT_TRUE(becomes("refused"));
  std::filesystem::remove(file_);
  EXPECT_TRUE(becomes(""));
}

}  // namespace
}  // namespace pleinair::app
