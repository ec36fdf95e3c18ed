// `pleinair thesis`: every figure is there, with pictures that show something and numbers that say
// what they should.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "hal/media/picture_file.h"
#include "tests/program/program.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::support {
namespace {

using testing::HasSubstr;

class Thesis : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  std::string read(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  ProgramRun made(const std::string& only) const {
    return runProgram({"thesis", "--output", path("report"), "--quick", "--only", only},
                      {.time = std::chrono::seconds(280)});
  }

  /// Standard deviation of a picture's bytes, levels.
  static double contrastOf(const hal::Image& picture) {
    const hal::ImageView view = picture.view();
    const auto bytes = view.planes[0].bytes;
    double sum = 0.0;
    double squares = 0.0;
    for (const std::uint8_t byte : bytes) {
      sum += byte;
      squares += 1.0 * byte * byte;
    }
    const auto count = static_cast<double>(bytes.size());
    return std::sqrt(std::max(0.0, squares / count - sum / count * (sum / count)));
  }

  static double readingOf(const nlohmann::json& report, const std::string& figure,
                          const std::string& key) {
    for (const auto& each : report["figures"]) {
      if (each["name"] == figure) return each["readings"].at(key).get<double>();
    }
    ADD_FAILURE() << "there is no figure " << figure;
    return std::nan("");
  }

  /// Each figure has pictures that show something, and numbers; the page names them all.
  void expectWhole(const nlohmann::json& report) {
    const std::string page = read("report/thesis.html");
    for (const auto& figure : report["figures"]) {
      SCOPED_TRACE(figure["title"].get<std::string>());
      EXPECT_FALSE(figure["pictures"].empty());
      for (const std::string file : figure["pictures"]) {
        const auto picture = hal::readPictureRgb(folder_.path() / "report" / file);
        ASSERT_TRUE(picture) << picture.error().message();
        EXPECT_GT(contrastOf(*picture), 8.0) << file;
        EXPECT_THAT(page, HasSubstr("src=\"" + file + "\""));
      }
      EXPECT_FALSE(figure["readings"].empty());
      bool isSome = false;
      for (const auto& [key, value] : figure["readings"].items()) {
        ASSERT_TRUE(value.is_number()) << key;
        EXPECT_TRUE(std::isfinite(value.get<double>())) << key;
        isSome = isSome || value.get<double>() != 0.0;
      }
      EXPECT_TRUE(isSome);
    }
  }

  /// Makes them, and expects the thesis's figures of these numbers to be there, whole.
  nlohmann::json whole(const std::string& only, const std::set<int>& numbers) {
    const ProgramRun run = made(only);
    EXPECT_EQ(run.status, 0) << run.error << run.out;
    if (run.status != 0) return {};
    const auto report = nlohmann::json::parse(read("report/thesis.json"));
    EXPECT_THAT(report["failed_controls"], testing::IsEmpty());
    expectWhole(report);
    std::set<int> found;
    for (const auto& figure : report["figures"]) {
      for (const int number : figure["numbers"]) found.insert(number);
    }
    EXPECT_EQ(found, numbers);
    return report;
  }

  TemporaryFolder folder_;
};

// All figures, in three runs. The other arm of each comparison is the control.

TEST_F(Thesis, MakesTheFiguresOfPictures) {
  const auto report = whole("15_16_21,17_18,19_20,22_24_25,23_31,27_table_1",
                            {14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 27, 31});
  EXPECT_GT(readingOf(report, "23_31", "changed_short"),
            2.0 * readingOf(report, "23_31", "changed_long"));
}

TEST_F(Thesis, MakesTheFiguresOfAnchors) {
  const auto report = whole("26,28,29_32_34_35,30_33,morphing", {26, 28, 29, 30, 32, 33, 34, 35});
  EXPECT_GT(readingOf(report, "26", "old_held"), 30.0);
  EXPECT_EQ(readingOf(report, "26", "old_anew"), 0.0);
  EXPECT_LT(readingOf(report, "28", "first_anchors_spread"),
            0.8 * readingOf(report, "28", "first_samples_spread"));
  EXPECT_LT(readingOf(report, "30_33", "skinned_slip95"), 0.05);
  EXPECT_LT(readingOf(report, "morphing", "morphing_slip95"), 0.05);
}

TEST_F(Thesis, MakesTheFiguresOfSettings) {
  const auto report = whole("36_37,38_39,40,41,42", {36, 37, 38, 39, 40, 41, 42});
  EXPECT_GT(readingOf(report, "38_39", "image_space_slip"),
            10.0 * readingOf(report, "38_39", "model_space_slip"));
  EXPECT_GT(readingOf(report, "40", "weight_005_pop"),
            2.0 * readingOf(report, "40", "weight_095_pop"));
  EXPECT_GT(readingOf(report, "41", "bleeding_off"), 1.05 * readingOf(report, "41", "bleeding_on"));
  EXPECT_GT(readingOf(report, "42", "fine_contrast_on"),
            1.015 * readingOf(report, "42", "fine_contrast_off"));
}

TEST_F(Thesis, TellsABlankPictureFromOneThatShowsSomething) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = {64, 48}});
  std::ranges::fill(image.plane(0), std::uint8_t{200});
  EXPECT_EQ(contrastOf(image), 0.0);
}

TEST_F(Thesis, MakesSomeFiguresOnRequestAndRefusesOthers) {
  const ProgramRun run = made("6_1");
  ASSERT_EQ(run.status, 0) << run.error;
  const auto report = nlohmann::json::parse(read("report/thesis.json"));
  ASSERT_EQ(report["figures"].size(), 1U);
  expectWhole(report);
  EXPECT_LT(readingOf(report, "6_1", "largest_difference"), 1e-4);
  const ProgramRun refused = made("43");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.error, testing::AllOf(HasSubstr("--only"), HasSubstr("29_32_34_35")));
  EXPECT_EQ(std::ranges::count(refused.error, '\n'), 1);
}

TEST_F(Thesis, ASignalLeavesNoPage) {
  const ProgramRun run = runProgram({"thesis", "--output", path("report"), "--quick"},
                                    {.time = std::chrono::seconds(240),
                                     .terminateWhenExists = path("report/figure_15_16_21_1.png")});
  EXPECT_EQ(run.status, 143) << run.error;
  EXPECT_EQ(read("report/thesis.html"), "");
}

}  // namespace
}  // namespace pleinair::support
