#include "pipeline/tracking/camera/calibration_file.h"

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/tracking/pose/tracker.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::tracking {
namespace {

constexpr const char* kValid = R"(image_size = [1280, 720]
fx = 1050.0
fy = 1052
cx = 636.8
cy = 364.1
)";

CameraModel read(const std::string& text) {
  const auto document = config::TomlDocument::parseText(text, "camera.toml");
  const CameraModel camera = readCalibration(document.root());
  document.root().finish();
  return camera;
}

/// The message with which the text is refused.
std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const config::ConfigError& error) {
    return error.what();
  }
  return "taken";
}

/// kValid with the line of one key replaced.
std::string with(const std::string& key, const std::string& line) {
  std::string text = kValid;
  const std::size_t begin = text.find(key + " =");
  return text.replace(begin, text.find('\n', begin) - begin, line);
}

TEST(CalibrationFile, ReadsHalfPixelCentresWithoutDistortion) {
  const CameraModel camera = read(kValid);
  EXPECT_EQ(camera.imageSize(), (hal::FrameSize{1280, 720}));
  EXPECT_EQ(camera.intrinsics().fx, 1050.0);
  EXPECT_EQ(camera.intrinsics().fy, 1052.0);
  EXPECT_EQ(camera.intrinsics().cx, 636.8);
  EXPECT_EQ(camera.intrinsics().cy, 364.1);
  EXPECT_EQ(camera.distortion().k1, 0.0);
}

TEST(CalibrationFile, ShiftsIntegerPixelCentresByAHalf) {
  const CameraModel camera = read(std::string(kValid) + "pixel_centres = \"integer\"\n");
  EXPECT_EQ(camera.intrinsics().cx, 637.3);
  EXPECT_EQ(camera.intrinsics().cy, 364.6);
  EXPECT_EQ(read(std::string(kValid) + "pixel_centres = \"half\"\n").intrinsics().cx, 636.8);
}

TEST(CalibrationFile, TakesDistortionInOpenCvsOrder) {
  const Distortion five = read(std::string(kValid) + "distortion = [1, 2, 3, 4, 5]\n").distortion();
  EXPECT_EQ(five.k1, 1.0);
  EXPECT_EQ(five.k2, 2.0);
  EXPECT_EQ(five.p1, 3.0);
  EXPECT_EQ(five.p2, 4.0);
  EXPECT_EQ(five.k3, 5.0);
  EXPECT_EQ(five.k4, 0.0);
  const Distortion eight =
      read(std::string(kValid) + "distortion = [1, 2, 3, 4, 5, 6, 7, 8]\n").distortion();
  EXPECT_EQ(eight.k4, 6.0);
  EXPECT_EQ(eight.k5, 7.0);
  EXPECT_EQ(eight.k6, 8.0);
}

TEST(CalibrationFile, RefusesWithFileLineAndKey) {
  using testing::StartsWith;
  EXPECT_EQ(refusal(with("fx", "fx = 0.0")),
            "camera.toml:2: fx: found 0, allowed: a number of px in (0, 1000000]");
  EXPECT_EQ(refusal(with("fy", "fy = \"wide\"")),
            "camera.toml:3: fy: found \"wide\" (string), allowed: a number of px in (0, 1000000]");
  EXPECT_THAT(refusal(with("cx", "")), StartsWith("camera.toml: cx: missing"));
  EXPECT_EQ(
      refusal(with("image_size", "image_size = [1280.5, 720]")),
      "camera.toml:1: image_size: no size of a picture, allowed: width and height in whole px");
  EXPECT_THAT(refusal(with("image_size", "image_size = [1280, 99999]")),
              StartsWith("camera.toml:1: image_size[1]: found 99999"));
  EXPECT_EQ(
      refusal(with("image_size", "image_size = [8192, 8192]")),
      "camera.toml:1: image_size: no size of a picture, allowed: width and height in whole px");
  EXPECT_EQ(refusal(std::string(kValid) + "pixel_centres = \"middle\"\n"),
            "camera.toml:6: pixel_centres: found \"middle\", allowed: half, integer");
  EXPECT_THAT(refusal(std::string(kValid) + "distortion = [0,0,0,0,0,0,0,0,0]\n"),
              StartsWith("camera.toml:6: distortion: found an array of 9"));
  EXPECT_THAT(refusal(std::string(kValid) + "focal = 3\n"),
              StartsWith("camera.toml:6: focal: unknown key"));
}

TEST(CalibrationFile, IsLoadedFromDisk) {
  const support::TemporaryFolder folder;
  const auto path = folder.path() / "camera.toml";
  EXPECT_THROW(loadCalibration(path), config::ConfigError);
  std::ofstream(path) << kValid;
  EXPECT_EQ(loadCalibration(path).intrinsics().fy, 1052.0);
  std::ofstream(path, std::ios::app) << "fz = 1\n";
  EXPECT_THROW(loadCalibration(path), config::ConfigError);
}

TEST(CheckSize, NamesBothSizes) {
  const CameraModel camera = read(kValid);
  EXPECT_TRUE(checkSize(camera, {1280, 720}, "camera.toml"));
  const auto refused = checkSize(camera, {640, 480}, "camera.toml");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message(),
            "camera.toml: the calibration is for 1280x720 px, the frames have 640x480; "
            "calibrate the camera at the size that it delivers");
  EXPECT_EQ(refused.error().kind, hal::ErrorKind::kInvalidInput);
}

}  // namespace
}  // namespace pleinair::tracking
