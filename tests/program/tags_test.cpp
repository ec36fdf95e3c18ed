// Printed sheets of tags and boards, measured where they are rendered at 10 px a millimetre.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/media/picture_file.h"
#include "pipeline/calibration/board.h"
#include "pipeline/calibration/board_detector.h"
#include "pipeline/tracking/pose/tag_detector.h"
#include "tests/program/program.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::support {
namespace {

using testing::HasSubstr;

constexpr double kPixelsPerMm = 10.0;
/// What a print may be off, in millimetres.
constexpr double kAccuracyMm = 0.2;

class Tags : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("gs --version >/dev/null 2>&1") != 0) {
      GTEST_SKIP() << "ghostscript, which renders the PDF, is not installed";
    }
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  ProgramRun print(std::vector<std::string> options) const {
    options.insert(options.begin(), {"tags", "--sheet", path("tags.pdf")});
    return runProgram(options);
  }

  /// The pages, in grey.
  std::vector<hal::Image> rendered() const {
    const std::string command =
        "gs -q -dBATCH -dNOPAUSE -dSAFER -sDEVICE=pnggray -dGraphicsAlphaBits=4 -r254 -o '" +
        path("page-%02d.png") + "' '" + path("tags.pdf") + "'";
    std::vector<hal::Image> pages;
    if (std::system(command.c_str()) != 0) return pages;
    for (int page = 1; std::filesystem::exists(pathOf(page)); ++page) {
      pages.push_back(hal::orThrow(hal::readPicture(pathOf(page))));
    }
    return pages;
  }

  std::string bytesOf(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  TemporaryFolder folder_;

 private:
  std::string pathOf(int page) const {
    return path(page < 10 ? "page-0" + std::to_string(page) + ".png"
                          : "page-" + std::to_string(page) + ".png");
  }
};

std::vector<tracking::TagDetection> tagsIn(hal::Image& page) {
  tracking::TagDetector detector;
  tracking::DetectionCounters counters;
  const auto found = detector.detect(page.view().planes[0], page.size(), counters);
  return {found.begin(), found.end()};
}

void expectEdges(const tracking::TagDetection& tag, double edgeMm) {
  for (std::size_t i = 0; i < 4; ++i) {
    const double edge = glm::distance(tag.corners[i], tag.corners[(i + 1) % 4]) / kPixelsPerMm;
    EXPECT_NEAR(edge, edgeMm, kAccuracyMm) << "tag " << tag.id;
  }
  EXPECT_GT(tag.corners[0].y, tag.corners[3].y) << "upright";
  EXPECT_LT(tag.corners[0].x, tag.corners[1].x);
}

/// The longest run of dark pixels along rows.
double longestRunMm(hal::Image& page) {
  int longest = 0;
  for (int y = 0; y < page.size().height; ++y) {
    int run = 0;
    for (const std::uint8_t pixel : page.row(0, y)) {
      run = pixel < 100 ? run + 1 : 0;
      longest = std::max(longest, run);
    }
  }
  return longest / kPixelsPerMm;
}

TEST_F(Tags, HaveTheSizeThatTheSceneSays) {
  const ProgramRun run = print({"--ids", "3-5,11", "--edge", "0.06"});
  ASSERT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(run.out, HasSubstr("4 tags of tag36h11\n\n[[tag]]\nid = 3\nedge_m = 0.06\n"));
  std::vector<hal::Image> pages = rendered();
  ASSERT_EQ(pages.size(), 1U) << "two by two have room on A4";
  EXPECT_NEAR(pages[0].size().width, 2100, 1);
  EXPECT_NEAR(pages[0].size().height, 2970, 1);
  const auto tags = tagsIn(pages[0]);
  ASSERT_EQ(tags.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(tags[i].id, (std::vector{3, 4, 5, 11})[i]);
    expectEdges(tags[i], 60);
  }
}

TEST_F(Tags, HaveARulerOf100Millimetres) {
  ASSERT_EQ(print({"--edge", "0.05"}).status, 0);
  std::vector<hal::Image> pages = rendered();
  ASSERT_EQ(pages.size(), 1U);
  EXPECT_NEAR(longestRunMm(pages[0]), 100, kAccuracyMm);
}

TEST_F(Tags, OfASceneEachHaveTheirOwnSize) {
  std::ofstream(path("scene.toml"))
      << "[[tag]]\nid = 0\nedge_m = 0.12\n[[tag]]\nid = 9\nedge_m = 0.04\n";
  ASSERT_EQ(print({"--scene", path("scene.toml")}).status, 0);
  std::vector<hal::Image> pages = rendered();
  ASSERT_EQ(pages.size(), 1U);
  const auto tags = tagsIn(pages[0]);
  ASSERT_EQ(tags.size(), 2U);
  expectEdges(tags[0], 120);
  expectEdges(tags[1], 40);
}

TEST_F(Tags, FillAsManyPagesAsTheyNeed) {
  ASSERT_EQ(print({"--ids", "0-2", "--edge", "0.14", "--paper", "letter"}).status, 0);
  std::vector<hal::Image> pages = rendered();
  ASSERT_EQ(pages.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto tags = tagsIn(pages[i]);
    ASSERT_EQ(tags.size(), 1U);
    EXPECT_EQ(tags[0].id, static_cast<int>(i));
    expectEdges(tags[0], 140);
  }
}

TEST_F(Tags, OfABoardAreWhereCalibrationExpectsThem) {
  struct Case {
    std::vector<std::string> options;
    calibration::Board board;
  };
  for (const Case& each :
       {Case{{"--board", "checkerboard:9x6", "--square", "0.02"},
             calibration::Board(calibration::Checkerboard{9, 6, 0.02})},
        Case{{"--board", "aprilgrid:4x5", "--tag-edge", "0.03", "--spacing", "0.3"},
             calibration::Board(calibration::AprilGrid{4, 5, 0.03, 0.3, 0})}}) {
    const ProgramRun run = print(each.options);
    ASSERT_EQ(run.status, 0) << run.error;
    std::vector<hal::Image> pages = rendered();
    ASSERT_EQ(pages.size(), 1U);
    const auto seen = calibration::makeBoardDetector(each.board)
                          ->detect(pages[0].view().planes[0], pages[0].size());
    ASSERT_TRUE(seen) << each.board.text();
    const auto& corners = each.board.corners();
    ASSERT_EQ(seen->corners.size(), corners.size());
    const auto& first = seen->corners.front();
    double sense = 0;  // a checkerboard may be read upside down
    for (const auto& corner : seen->corners) {
      const glm::dvec3 away = corners[static_cast<std::size_t>(corner.id)] -
                              corners[static_cast<std::size_t>(first.id)];
      const glm::dvec2 expected = 1000.0 * glm::dvec2(away);
      const glm::dvec2 found = (corner.px - first.px) / kPixelsPerMm;
      if (sense == 0 && corner.id != first.id) sense = glm::dot(expected, found) > 0 ? 1 : -1;
      EXPECT_NEAR(found.x, sense * expected.x, kAccuracyMm) << each.board.text() << corner.id;
      EXPECT_NEAR(found.y, sense * expected.y, kAccuracyMm) << each.board.text() << corner.id;
    }
  }
}

TEST_F(Tags, AreTheSameBytesEachTime) {
  ASSERT_EQ(print({"--ids", "0-1"}).status, 0);
  const std::string first = bytesOf("tags.pdf");
  ASSERT_EQ(print({"--ids", "0-1"}).status, 0);
  EXPECT_TRUE(first == bytesOf("tags.pdf"));
  EXPECT_TRUE(first.starts_with("%PDF"));
}

TEST_F(Tags, ThatCannotBePrintedAreRefused) {
  EXPECT_THAT(print({"--edge", "0.2"}).error, HasSubstr("--paper, such as a3"));
  EXPECT_THAT(print({"--ids", "587"}).error,
              HasSubstr("tag 587: is not in tag36h11; give 0 to 586"));
  EXPECT_THAT(print({"--ids", "3-1"}).error, HasSubstr("--ids"));
  EXPECT_THAT(print({"--family", "tag99"}).error, HasSubstr("unknown tag family"));
  EXPECT_THAT(print({"--paper", "a9"}).error, HasSubstr("--paper"));
  EXPECT_EQ(folder_.entryCount(), 0U);
}

}  // namespace
}  // namespace pleinair::support
