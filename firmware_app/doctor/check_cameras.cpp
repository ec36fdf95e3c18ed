#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "firmware_app/doctor/checks.h"

namespace pleinair::app::doctor {
namespace {

std::string nameOf(const hal::CameraDescription& camera) {
  const std::string& what = camera.identity.description;
  if (camera.node.empty()) return what;
  return what.empty() ? camera.node : fmt::format("{} ({})", camera.node, what);
}

bool isUsable(const hal::CameraDescription& camera) {
  return !camera.problem && std::ranges::any_of(camera.modes, &hal::CameraMode::isSupported);
}

/// How bad a camera's problem is, and what fixes it.
Finding troubled(Finding finding, const hal::CameraDescription& camera) {
  const hal::Error& problem = *camera.problem;
  finding.text = fmt::format("{}: {}", nameOf(camera), problem.problem);
  finding.verdict = Verdict::kWarning;
  finding.remedy = problem.remedy;
  if (problem.kind == hal::ErrorKind::kPermissionDenied) {
    finding.verdict = Verdict::kWrong;
    finding.remedy = "sudo usermod -aG video $USER, then log in again";
  } else if (problem.kind == hal::ErrorKind::kBusy) {
    finding.remedy = fmt::format("end the program that uses it: fuser -v {}", camera.node);
  }
  return finding;
}

}  // namespace

Finding checkCameras(const Probes& probes) {
  Finding finding{.check = "cameras"};
  const auto [cameras, problems] = probes.cameras();
  if (!problems.empty()) {
    finding.verdict = Verdict::kWrong;
    finding.text = problems.front().problem;
    finding.remedy = problems.front().remedy;
    return finding;
  }
  std::vector<std::string> usable;
  for (const hal::CameraDescription& camera : cameras) {
    if (isUsable(camera)) usable.push_back(nameOf(camera));
  }
  // A camera that may not be opened is to be fixed even where another one works.
  const auto forbidden = std::ranges::find_if(cameras, [](const auto& camera) {
    return camera.problem && camera.problem->kind == hal::ErrorKind::kPermissionDenied;
  });
  if (forbidden != cameras.end()) return troubled(finding, *forbidden);
  const auto ill =
      std::ranges::find_if(cameras, [](const auto& camera) { return camera.problem.has_value(); });
  if (ill != cameras.end()) return troubled(finding, *ill);
  finding.text = fmt::format("{}", fmt::join(usable, ", "));
  if (!usable.empty()) return finding;
  finding.verdict = Verdict::kWarning;
  finding.text = cameras.empty() ? "none: only recordings and the built-in one"
                                 : "none delivers frames that can be read";
  finding.remedy = cameras.empty() ? "plug one in; lsusb and sudo dmesg tell whether it is seen"
                                   : "`pleinair devices` lists what they offer";
  return finding;
}

}  // namespace pleinair::app::doctor
