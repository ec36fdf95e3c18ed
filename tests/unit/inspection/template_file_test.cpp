#include "pipeline/inspection/template_file.h"

#include <fstream>

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>

#include "config/config_error.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::inspection {
namespace {

TEST(TemplateFile, IsReadAsItIsWrittenAndRefusesWhatIsNoPlace) {
  const support::TemporaryFolder folder;
  const std::filesystem::path file = templatePosePath(folder.path() / "seal.png");
  EXPECT_EQ(file.filename(), "seal.toml");
  const TemplatePose pose{
      .camera = {{.fx = 512.1, .fy = 511.9, .cx = 320.3, .cy = 239.7}, {.k1 = -0.12}, {640, 480}},
      .cameraFromModel = glm::rotate(glm::translate(glm::dmat4(1.0), {0.1, -0.2, 0.7}), 1.1,
                                     glm::dvec3(0.6, 0.0, 0.8))};
  std::ofstream(file) << templatePoseText(pose);
  const TemplatePose read = readTemplatePose(file);
  EXPECT_EQ(read.cameraFromModel, pose.cameraFromModel);
  EXPECT_EQ(read.camera.distortion().k1, -0.12);
  EXPECT_EQ(read.camera.intrinsics().cx, 320.3);

  TemplatePose scaled = pose;
  scaled.cameraFromModel[0] *= 1.5;
  std::ofstream(file) << templatePoseText(scaled);
  EXPECT_THROW(readTemplatePose(file), config::ConfigError);
}

}  // namespace
}  // namespace pleinair::inspection
