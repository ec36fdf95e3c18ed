#include "firmware_app/repair_station/still_comparison.h"

#include <string>
#include <system_error>

#include <fmt/format.h>

#include "config/config_error.h"
#include "firmware_app/overlay/machine.h"
#include "hal/media/picture_file.h"

namespace pleinair::app {
namespace {

constexpr double kPartMargin = 1.15;  // of what is compared, about the step's parts

hal::Result<inspection::TemplatePose> templatePoseOf(const std::filesystem::path& picture) {
  try {
    return inspection::readTemplatePose(inspection::templatePosePath(picture));
  } catch (const config::ConfigError& error) {
    return tl::unexpected(
        hal::Error{.kind = hal::ErrorKind::kInvalidInput, .problem = error.what(), .remedy = {}});
  }
}

}  // namespace

bool comparesByItself(const std::filesystem::path& folder, const procedure::Check& check) {
  std::error_code failure;
  return std::filesystem::is_regular_file(inspection::templatePosePath(folder / check.comparison),
                                          failure);
}

hal::Result<inspection::Inspection> compareStill(const procedure::Procedure& procedure,
                                                 const procedure::Step& step,
                                                 const std::filesystem::path& folder,
                                                 const hal::ImageView& still,
                                                 const inspection::TemplatePose& place) {
  const std::filesystem::path file = folder / step.check->comparison;
  const auto picture = hal::readPictureRgb(file);
  if (!picture) return tl::unexpected(picture.error());
  const auto pose = templatePoseOf(file);
  if (!pose) return tl::unexpected(pose.error());
  if (pose->camera.imageSize() != picture->size()) {
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kInvalidInput,
                                     .subject = file.string(),
                                     .problem = "its pose is for another size",
                                     .remedy = "take the template anew"});
  }
  const PartSurface part = surfaceOfParts(*procedure.model, step.parts);
  return inspection::inspectPart({picture->view(), pose->camera, pose->cameraFromModel},
                                 {still, place.camera, place.cameraFromModel},
                                 {.centre = glm::dvec3(part.sphere.centre),
                                  .radiusMetres = kPartMargin * part.sphere.radiusMetres,
                                  .triangles = part.triangles});
}

procedure::Comparison answerOf(inspection::Verdict verdict) {
  switch (verdict) {
    case inspection::Verdict::kPass:
      return procedure::Comparison::kPass;
    case inspection::Verdict::kFail:
      return procedure::Comparison::kFail;
    case inspection::Verdict::kUncertain:
      break;
  }
  return procedure::Comparison::kUncertain;
}

std::string reasonText(const inspection::Inspection& inspection,
                       const procedure::Notices& notices) {
  switch (inspection.reason) {
    case inspection::Uncertainty::kOtherSide:
      return procedure::filled(notices.otherSide, fmt::format("{:.0f}", inspection.viewDeg));
    case inspection::Uncertainty::kNotWholly:
      return std::string(notices.notWholly);
    case inspection::Uncertainty::kTooFar:
      return std::string(notices.comeCloser);
    case inspection::Uncertainty::kNothingToCompare:
      return std::string(notices.nothingToCompare);
    case inspection::Uncertainty::kTooDark:
      return std::string(notices.tooDark);
    case inspection::Uncertainty::kAlmostAlike:
      return std::string(notices.almostAlike);
    case inspection::Uncertainty::kNone:
      break;
  }
  return {};
}

}  // namespace pleinair::app
