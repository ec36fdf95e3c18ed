#include "firmware_app/offline/poses_file.h"

#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;

/// Columns of the numbers by which their rows count.
const glm::dmat4 kNumbered{0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15};

TEST(PosesLine, SaysWhereWorldAndTagsAreByRows) {
  tracking::TrackingResult tracking;
  tracking.cameraFromWorld = kNumbered;
  const tracking::TrackedTag tag{
      .id = 7, .corners = {{{1, 2.5}, {3, 4}, {5, 6}, {7, 8}}}, .cameraFromTag = glm::dmat4(1.0)};
  tracking.tags = {&tag, 1};
  EXPECT_EQ(posesLine(12, 480ms, tracking),
            R"({"frame":12,"time_s":0.48,)"
            R"("cameraFromWorld":[0.0,1.0,2.0,3.0,4.0,5.0,6.0,7.0,)"
            R"(8.0,9.0,10.0,11.0,12.0,13.0,14.0,15.0],)"
            R"("tags":[{"id":7,"corners":[[1.0,2.5],[3.0,4.0],[5.0,6.0],[7.0,8.0]],)"
            R"("cameraFromTag":[1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,)"
            R"(0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0]}]})"
            "\n");
}

TEST(PosesLine, LeavesOutWhatIsNotKnown) {
  EXPECT_EQ(posesLine(0, 0ms, {}), R"({"frame":0,"time_s":0.0,"tags":[]})"
                                   "\n");
  const tracking::TrackedTag tag{.id = 1};
  EXPECT_EQ(posesLine(1, 40ms, {.tags = {&tag, 1}}),
            R"({"frame":1,"time_s":0.04,"tags":[)"
            R"({"id":1,"corners":[[0.0,0.0],[0.0,0.0],[0.0,0.0],[0.0,0.0]]}]})"
            "\n");
}

TEST(PosesFile, StandsUnderItsNameOnceItIsWhole) {
  const support::TemporaryFolder folder;
  const auto path = folder.path() / "poses.jsonl";
  auto file = PosesFile::create(path);
  ASSERT_TRUE(file) << file.error().message();
  ASSERT_TRUE(file->write(0, 0ms, {}));
  ASSERT_TRUE(file->write(1, 40ms, {}));
  EXPECT_FALSE(std::filesystem::exists(path));
  ASSERT_TRUE(file->publish());
  std::ifstream stream(path);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_EQ(text, posesLine(0, 0ms, {}) + posesLine(1, 40ms, {}));
}

}  // namespace
}  // namespace pleinair::app
