#include "hal/file_descriptor.h"

#include <utility>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace pleinair::hal {
namespace {

class NotingCloser final : public DescriptorCloser {
 public:
  int close(int fd) override {
    closed.push_back(fd);
    return 0;
  }
  std::vector<int> closed;
};

TEST(FileDescriptor, ClosesOnceWhatItHolds) {
  NotingCloser closer;
  {
    FileDescriptor first(0, closer);  // a descriptor like any other
    FileDescriptor second(7, closer);
    FileDescriptor moved(std::move(first));
    EXPECT_FALSE(first);  // NOLINT(bugprone-use-after-move): it holds nothing then
    EXPECT_TRUE(moved);
    EXPECT_EQ(moved.get(), 0);
    second = std::move(moved);
    EXPECT_EQ(closer.closed, std::vector{7}) << "what was assigned to";
    EXPECT_EQ(second.get(), 0);
  }
  EXPECT_EQ(closer.closed, (std::vector{7, 0}));
}

TEST(FileDescriptor, ClosesNothingThatItDoesNotHold) {
  NotingCloser closer;
  {
    const FileDescriptor failed(-1, closer);
    EXPECT_FALSE(failed);
    FileDescriptor released(5, closer);
    EXPECT_EQ(released.release(), 5);
    released.reset();
    const FileDescriptor empty;
  }
  EXPECT_TRUE(closer.closed.empty());
}

TEST(FileDescriptor, ClosesTheSystems) {
  const int fd = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ASSERT_GE(fd, 0);
  FileDescriptor owner(fd);
  EXPECT_NE(::fcntl(fd, F_GETFD), -1);
  owner.reset();
  EXPECT_EQ(::fcntl(fd, F_GETFD), -1);
}

}  // namespace
}  // namespace pleinair::hal
