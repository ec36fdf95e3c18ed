#include "firmware_app/service_manager/journal_stream.h"

#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pleinair::app {
namespace {

TEST(JournalStream, IsToldByDeviceAndInode) {
  const int file = open("/dev/null", O_WRONLY);
  struct stat status = {};
  ASSERT_EQ(fstat(file, &status), 0);
  unsetenv("JOURNAL_STREAM");
  EXPECT_FALSE(isJournalStream(file));
  setenv("JOURNAL_STREAM",
         (std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino)).c_str(), 1);
  EXPECT_TRUE(isJournalStream(file));
  int other[2]{};
  ASSERT_EQ(pipe(other), 0);
  EXPECT_FALSE(isJournalStream(other[1])) << "it was redirected";
  EXPECT_FALSE(isJournalStream(-1));
  unsetenv("JOURNAL_STREAM");
  for (const int each : {file, other[0], other[1]}) close(each);
}

}  // namespace
}  // namespace pleinair::app
